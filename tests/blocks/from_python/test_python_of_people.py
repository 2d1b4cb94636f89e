"""Python as people write it: each line is kept, became blocks, or is refused with its line."""

from __future__ import annotations

import ast
import textwrap
from collections import Counter

import pytest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.from_python.learning import CodeUnread
from nep_studio.blocks.from_python.scoping import with_shared_names
from nep_studio.blocks.from_python.source import read_source
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project
from tests.blocks.from_python.python_pieces import IN_RULE, MAKE, OUTSIDE, RUN, START, TOP, WHOLE
from tests.blocks.from_python.python_traces import assert_does_the_same

HEAD = '"""T. Made with NEP Studio."""\nfrom nep_core import Behavior, Robot, together, wait\n\n'
MADE = 'nao = Robot("NAO")\nbehavior = Behavior("T")\n'


def program(*, top: str = "", outside: str = "", rule: str = "nao.say('hi')") -> str:
    """A program with a piece in one of its places."""
    body = textwrap.indent(rule, "    ")
    begin = "\n\n@behavior.when_started\ndef when_started():\n"
    more = "\n\n@behavior.when('touched_head')\ndef more():\n    nao.say('More')\n"
    return f"{top}\n{HEAD}{MADE}{outside}\n{begin}{body}\n{more}\n\nbehavior.run()\n"


PROGRAMS = (
    [program(outside=piece) for piece in OUTSIDE]
    + [program(rule=piece) for piece in IN_RULE]
    + [program(top=piece) for piece in TOP]
    + WHOLE
)


def said(text: str) -> tuple[Counter[str], Counter[str]]:
    """The statements of a program and its comments, without what depends on the blocks alone."""
    source = read_source(text)
    with_shared_names(source.tree, {})
    for node in ast.walk(source.tree):
        if isinstance(body := getattr(node, "body", None), list):
            node.body = [one for one in body if not isinstance(one, ast.Global)]
        match node:  # braces mean a value as a block tells it
            case ast.FormattedValue(value=ast.Call(func=ast.Name(id="as_text"), args=[told])):
                node.value = told
            case ast.For(iter=ast.Call(func=ast.Name(id="list"), args=[items])):
                node.iter = items
            case ast.Assign(value=ast.Call(func=ast.Name(id="to_power"), args=[base, power])):
                node.value = ast.BinOp(base, ast.Pow(), power)
    statements = Counter(
        ast.dump(node)
        for node in ast.walk(source.tree)
        if isinstance(node, ast.stmt)
        and not isinstance(node, ast.Global | ast.Pass | ast.FunctionDef | ast.ImportFrom)
    )
    return statements, Counter(" ".join(c.split()) for c in source.comments.values())


def order(text: str) -> list[str]:
    """What stands outside of the functions, and the functions by what they do, in their order."""
    by_program = ("Made with NEP", "Import", "id='Robot'", "id='Behavior'")  # has places of its own
    body = read_source(text).tree.body
    said = [ast.dump(n.body[-1] if isinstance(n, ast.FunctionDef) else n) for n in body]
    return [one for one in said if not any(part in one for part in by_program)]


@pytest.mark.parametrize("text", PROGRAMS, ids=range(len(PROGRAMS)))
def test_each_line_is_kept_or_refused_with_its_line(language, text, monkeypatch):
    editor = Editor(Project("T"), language)
    before = to_bytes(editor.project)

    try:
        update_from_python(editor, text)
    except CodeUnread as refused:
        assert "could not be read" not in str(refused.sentence)
        assert 1 <= refused.line <= text.count("\n") + 1
        assert to_bytes(editor.project) == before
        return

    made = generate_program(editor.project, language).text
    for ours, theirs in zip(said(text), said(made), strict=True):
        assert not ours - theirs
    again = order(made)
    assert [one for one in order(text) if one in again] == [o for o in again if o in order(text)]
    assert_does_the_same(made, text, monkeypatch)
    loaded = Editor(from_bytes(to_bytes(editor.project), "x", language), language)
    assert generate_program(loaded.project, language).text == made
    after = to_bytes(loaded.project)
    for same in (made, text):
        update_from_python(loaded, same)
        assert to_bytes(loaded.project) == after


def test_there_are_enough_pieces():
    assert len(PROGRAMS) >= 150


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (f"{MAKE}\n\ndef remember(what):\n    pass\n\n\n{START}{RUN}", "another name"),
        (f"{MAKE}{START}{RUN}".replace("behavior", "mine"), "behavior"),
        (f"{MAKE}{START}{RUN}".replace('"NAO"', '["A", "B"]').replace("nao", "both"), "all_robots"),
        (f"{MAKE}{START}{RUN}".replace(" Behavior(", " nep.Behavior("), "as the program does"),
        (f"{MAKE}@behavior.when('touched_head')\n{START}{RUN}", "function of its own"),
        (f"{MAKE}@behavior.when_started\n{RUN}", "def"),
        (f"{MAKE}def greet():\n{RUN}", "pass"),
    ],
)
def test_what_no_block_says_is_told_with_what_fits_it(language, text, told):
    with pytest.raises(CodeUnread) as refused:
        update_from_python(Editor(Project("T"), language), text)

    assert told in str(refused.value.checklist[0])


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("if x = 0:", "=="),
        ("if x == 0", "colon"),
        ("else if x:", "elif"),
        ('print "x"', "print"),
        ("nao.say(\u201chi\u201d)", "quotes"),
        ('nao.say("hi)', "quote"),
        ('nao.say("hi"', "bracket"),
        ("class = 5", "another name"),
        ("let x = 5;", "language"),
        ("  wait(1)", "spaces"),
        ("\twait(1)", "spaces"),
        ("If x == 1:", "small letters"),
        ("for i = 1 to 3:", "range"),
        ("my name = 3", "one word"),
        ("2nd = 3", "one word"),
        ("my-name = 3", "one word"),
        ("break", "repeat"),
        ("x = 1\nglobal x", "first"),
    ],
)
def test_a_mistake_is_told_with_what_fits_it(language, line, told):
    editor = Editor(Project("T"), language)

    with pytest.raises(CodeUnread) as refused:
        update_from_python(editor, program(rule=f"wait(1)\n{line}"))

    assert told in str(refused.value.checklist[0])
