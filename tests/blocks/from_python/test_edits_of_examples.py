"""The Python of each example edited as people edit it: nothing is lost, nothing crashes.

Each edit is tried with some of the examples: with all of them by hand, NEP_EDITS_SHARE=1.
"""

# ruff: noqa: E501 - Python in Python is read more easily in one line

from __future__ import annotations

import os
import re
import textwrap
from collections.abc import Callable
from pathlib import Path

import pytest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.from_python.learning import CodeUnread
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from tests.blocks.from_python.test_python_of_people import said

pytestmark = pytest.mark.long

EXAMPLES = sorted((Path(__file__).parents[3] / "resources/examples").glob("*.nep"))
SHARE = int(os.environ.get("NEP_EDITS_SHARE", "7"))
"""One of so many pairs of an edit and an example is tried."""

GAP = "\n\n\n"
EDITS: dict[str, Callable[[str], str]] = {}


def edit(change: Callable[[str], str]) -> Callable[[str], str]:
    EDITS[change.__name__] = change
    return change


def parts(text: str) -> list[str]:
    return re.split(r"\n\n\n(?=@behavior|def |# |behavior\.run)", text)


def rules(found: list[str]) -> list[int]:
    return [number for number, part in enumerate(found) if "@behavior" in part]


def say(text: str) -> str:
    """What makes the first robot of a program speak."""
    robots = re.findall(r"^(\w+) = Robot\(", text, re.M)
    return f"{robots[0]}.say" if robots else "print"


def importing(text: str, *names: str) -> str:
    line = re.search(r"from nep_core import (.*)", text)
    every = {*line[1].split(", "), *names}
    return text.replace(line[0], f"from nep_core import {', '.join(sorted(every))}")


def with_rule(text: str, body: str, top: str = "") -> str:
    rule = '@behavior.when("touched_head")\ndef when_more():\n' + textwrap.indent(body, "    ")
    more = GAP.join(filter(None, [top, rule]))
    return importing(text, "together", "wait").replace("\nbehavior.run()", f"{more}{GAP}behavior.run()")  # fmt: skip


def in_first(text: str, body: str) -> str:
    """The text with more lines at the end of its first rule."""
    found = parts(importing(text, "together", "wait"))
    first = rules(found)[0]
    found[first] = found[first].rstrip("\n") + "\n" + textwrap.indent(body, "    ")
    return GAP.join(found)


def at_head(text: str, line: str) -> str:
    return re.sub(r"^(behavior = .*)$", lambda m: f"{m[1]}\n{line}", text, count=1, flags=re.M)


def two_parts(text: str) -> str:
    return f'def left():\n    {say(text)}("left")\n\n\ndef right():\n    {say(text)}("right")'


@edit
def a_sentence(text):
    return re.sub(r'say\("([^"]*)"', lambda m: f'say("Changed {m[1]}"', text, count=1)


@edit
def together_of_functions(text):
    return with_rule(a_sentence(text), "together(left, right)", two_parts(text))


@edit
def together_of_functions_inside(text):
    return with_rule(a_sentence(text), f"{two_parts(text)}\n\n\ntogether(left, right)")


@edit
def together_of_nothing(text):
    return with_rule(a_sentence(text), "together(left, right)")


@edit
def together_in_a_rule(text):
    return in_first(text, f"{two_parts(text)}\n\n\ntogether(left, right)")


@edit
def a_rule_is_moved(text):
    found = [part.rstrip("\n") for part in parts(text)]
    first, *_, last = (rules(found) * 2)[: max(2, len(rules(found)))]
    found[first], found[last] = found[last], found[first]
    return GAP.join(found) + "\n"


@edit
def a_function_is_renamed(text):
    return re.sub(r"(@behavior[^\n]*\ndef )(\w+)\(", r"\1my_rule(", text, count=1)


@edit
def imports(text):
    text = text.replace("from nep_core", "import time  # clock\nfrom nep_core", 1)
    return re.sub(r"(from nep_core import .*)", r"\1\nfrom math import floor", text, count=1)


@edit
def a_first_value(text):
    return at_head(text, "score = 5")


@edit
def type_hints(text):
    return at_head(with_rule(text, "f(2)", "def f(n: int) -> int:\n    return n"), "p: int = 5")


@edit
def a_rule_that_gives_none(text):
    return re.sub(r"(@behavior[^\n]*\ndef \w+\(\)):", r"\1 -> None:", text, count=1)


@edit
def a_class(text):
    return with_rule(
        text, "Dog(2)", "class Dog:\n    def __init__(self, age):\n        self.age = age"
    )


@edit
def a_docstring(text):
    text = re.sub(r"(@behavior[^\n]*\ndef \w+\(\):\n)", r'\1    """Says it."""\n', text, count=1)
    return re.sub(r'^""".*?"""', '"""My own.\n\nText.\n"""', text, count=1, flags=re.S)


@edit
def a_try(text):
    return in_first(
        text, "try:\n    wait(1)\nexcept ValueError as e:\n    print(e)\nfinally:\n    pass"
    )


@edit
def a_file(text):
    return in_first(text, 'with open("notes") as f:\n    print(f.read())')


@edit
def texts_with_braces(text):
    return in_first(text, f'who = "Bo"\n{say(text)}(f"Hello {{who}}, {{1 + 2:>3}}")')


@edit
def a_lambda(text):
    return in_first(text, f"double = lambda n: n * 2\n{say(text)}(str(double(2)))")


@edit
def loops(text):
    return in_first(
        text, "n = 0\nwhile True:\n    n += 1\n    if n > 3:\n        break\nelse:\n    print(n)"
    )


@edit
def a_match(text):
    return in_first(
        text,
        "match 3:\n    case 1 | 2:\n        wait(1)\n    case [a, *b]:\n        print(a)\n    case _:\n        wait(0)",
    )


@edit
def comments_behind(text):
    lines = enumerate(text.split("\n"))
    return "\n".join(
        f"{line}  # {n}" if line.startswith("    ") and n % 3 == 0 else line for n, line in lines
    )


@edit
def comments_above(text):
    lines = [
        (
            [f"{line[: len(line) - len(line.lstrip())]}# {n}"]
            if line.startswith("    ") and n % 4 == 0
            else []
        )
        + [line]
        for n, line in enumerate(text.split("\n"))
    ]
    return "\n".join(line for two in lines for line in two)


@edit
def an_own_block(text):
    return with_rule(
        text,
        "greet(2)",
        f'def greet(times):\n    for _ in range(times):\n        {say(text)}("hi")',
    )


@edit
def a_guard(text):
    return text.replace("\nbehavior.run()", '\nif __name__ == "__main__":\n    behavior.run()')


@edit
def tabs_and_line_ends(text):
    return text.replace("    ", "\t").replace("\n", "\r\n")


@edit
def everything_is_imported(text):
    return re.sub(r"from nep_core import .*", "from nep_core import *", text, count=1)


@edit
def a_robot_is_renamed(text):
    return re.sub(r"\bnao\b", "otto", text).replace('otto = Robot("NAO")', 'otto = Robot("Otto")')


@edit
def a_variable_of_a_robot(text):
    return re.sub(r"\bnao\b", "robbi", text)


@edit
def a_call_above_all(text):
    return at_head(text, "\n\ndef helper():\n    return 5\n\n\nVALUE = helper()")


PAIRS = [
    (path, name)
    for row, path in enumerate(EXAMPLES)
    for column, name in enumerate(EDITS)
    if (row + column) % SHARE == 0
]


def example(path: Path, language) -> Editor:
    return Editor(from_bytes(path.read_bytes(), path.name, language), language)


@pytest.mark.parametrize(("path", "name"), PAIRS, ids=[f"{p.stem}-{n}" for p, n in PAIRS])
def test_an_edit_is_kept_or_refused(language, path, name):
    editor = example(path, language)
    text = EDITS[name](generate_program(editor.project, language).text)
    before = to_bytes(editor.project)

    try:
        update_from_python(editor, text)
    except CodeUnread as refused:
        assert "could not be read" not in str(refused.sentence)
        assert "say the same" not in str(refused.sentence)
        assert refused.checklist and to_bytes(editor.project) == before
        return

    made = generate_program(editor.project, language).text
    for ours, theirs in zip(said(text.replace("\r\n", "\n")), said(made), strict=True):
        assert not ours - theirs
    update_from_python(editor, made)
    assert generate_program(editor.project, language).text == made


def test_a_rule_that_is_deleted_takes_nothing_else_along(language):
    for path in EXAMPLES:
        editor = example(path, language)
        found = parts(generate_program(editor.project, language).text)
        gone = found.pop(rules(found)[-1])

        update_from_python(editor, GAP.join(found))

        left = generate_program(editor.project, language).text
        assert gone.strip() not in left
        assert all(found[number].strip() in left for number in rules(found))
