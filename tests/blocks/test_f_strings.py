"""A join becomes an f-string, and f-strings become joins."""

from __future__ import annotations

import ast

import pytest
from block_building import B, build, read_program

from nep_core.program.behavior import Behavior
from nep_studio.blocks.edits.project import SetScope
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import SCOPE_PROGRAM, Project

HEAD = """from nep_core import Behavior, Robot, as_text

nao = Robot("NAO")
behavior = Behavior("Test")


@behavior.when_started
def go():
    n = 1
"""


def said(value):
    """A program whose robot says that."""
    return f"{HEAD}    nao.say({value})\n\n\nbehavior.run()\n"


def get(variable):
    return B("variable.get", {"variable": variable})


def text(value):
    return B("text.text", {"text": value})


def join(*items):
    """A join of texts that are typed and of blocks."""
    block = B("text.join", groups={"item": len(items)})
    for number, item in enumerate(items, 1):
        (block.inputs if isinstance(item, B) else block.fields)[f"item.{number}"] = item
    return block


def put(variable, value):
    if isinstance(value, B):
        return B("variable.set", {"variable": variable}, {"value": value})
    return B("variable.set", {"variable": variable, "value": value})


def made(language, value, *before):
    """The Python of a value in a place for a text, and what it gives when it runs."""
    rule = [B("event.started"), *before, put("v1", value)]
    editor = build(language, rule, variables=("out", "n", "w"))
    editor.apply(SetScope("v1", SCOPE_PROGRAM))
    project = editor.project
    code = generate_program(project, language).text
    assert generate_program(read_program(code, language), language).text == code
    (line,) = (line for line in code.splitlines() if line.startswith("    program.out = "))
    held = {}
    exec(compile(code.replace("\nbehavior.run()\n", ""), "program.py", "exec"), held)
    held["when_started"]()
    return line.removeprefix("    program.out = "), held["program"].out


POINTS, WORD = put("v2", 3), put("v3", "Ada")
HASH = B("text.case", {"text": "#1", "case": "lower"})
"""A value that Python 3.11 cannot write in braces: there is a comment sign in it."""


@pytest.mark.parametrize(
    ("value", "code", "gives"),
    [
        (join("You have ", get("v2"), " points."), 'f"You have {n} points."', "You have 3 points."),
        (join(get("v3"), get("v3")), 'f"{w}{w}"', "AdaAda"),
        (join("Hi ", get("v3")), 'f"Hi {w}"', "Hi Ada"),
        (join("a", "b"), '"a" + "b"', "ab"),
        (join("{", get("v2"), "}"), 'f"{{{n}}}"', "{3}"),
        (join('say "hi", it\'s ', get("v2")), 'f"say \\"hi\\", it\'s {n}"', 'say "hi", it\'s 3'),
        (join("C:\\n\n", get("v2")), 'f"C:\\\\n\\n{n}"', "C:\\n\n3"),
        (join("is ", B("logic.truth")), 'f"is {as_text(True)}"', "is true"),
        (join("a", join(get("v2"), "b"), "c"), 'f"a{n}bc"', "a3bc"),
        (
            join("a ", B("text.case", {"text": "x y", "case": "upper"})),
            "f\"a {'x y'.upper()}\"",
            "a X Y",
        ),
        (join("a ", HASH), '"a " + "#1".lower()', "a #1"),
        (join(get("v2"), HASH), 'str(n) + "#1".lower()', "3#1"),
    ],
)
def test_a_join_is_the_f_string_that_a_teacher_would_write(language, value, code, gives):
    assert made(language, value, POINTS, WORD) == (code, gives)


def test_a_value_that_may_be_a_truth_or_a_fraction_is_told_in_the_braces(language):
    half = B("math.arithmetic", {"operation": "divide", "a": 1, "b": 2})

    assert made(language, join("half: ", half)) == ('f"half: {as_text(1 / 2)}"', "half: 0.5")
    Behavior("T", language="en")


@pytest.mark.parametrize(
    ("written", "again"),
    [
        ('f"You have {n} points."', 'f"You have {n} points."'),
        ('"You have " + str(n) + " points."', 'f"You have {n} points."'),
        ("f'{n}'", 'f"{n}"'),
        ('f"plain"', '"plain"'),
        ('f"half {n / 2}"', 'f"half {as_text(n / 2)}"'),
        ('f"{n}" + "!" + f"{n}"', 'f"{n}!{n}"'),
    ],
)
def test_texts_with_values_are_read_as_joins_however_they_are_written(language, written, again):
    read = read_program(said(written), language, Project())

    assert not [b for b in read.blocks.values() if b.type.startswith("code.")]
    assert f"    nao.say({again})" in generate_program(read, language).text.splitlines()


@pytest.mark.parametrize("written", ['f"{n:>5}"', 'f"{n!r}"', 'f"{n=}"'])
def test_an_f_string_with_a_format_stays_python(language, written):
    code = generate_program(read_program(said(written), language, Project()), language).text

    found, *_ = [node for node in ast.walk(ast.parse(code)) if isinstance(node, ast.JoinedStr)]
    assert ast.dump(found) == ast.dump(ast.parse(written, mode="eval").body)


def test_joins_in_joins_are_written_however_deep_they_are_allowed(language):
    value = get("v2")
    for number in range(4):
        value = join(HASH, value, *[str(number)] * 18)  # sums: no braces take the sign

    code, gives = made(language, value, POINTS)

    assert code.count("+") > 57 and gives.startswith("#1" * 4 + "3")
    for number in range(4):
        value = join(HASH, value, *[str(number)] * 18)
    with pytest.raises(CodeRefused):
        made(language, value, POINTS)
