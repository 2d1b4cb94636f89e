"""Comments, texts of several lines and refused lines of edited Python: nothing gets lost."""

from __future__ import annotations

import ast
import textwrap

import pytest
from block_building import B, build

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.from_python.learning import CodeUnread
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program


def updated(language, body: str):
    """A program whose only rule has got this body."""
    editor = build(language, [B("event.started"), B("control.wait")], variables=("x",))
    text = generate_program(editor.project, language).text
    update_from_python(editor, text.replace("    wait(1)", textwrap.indent(body, "    ")))
    return editor


def body_of(editor) -> str:
    text = generate_program(editor.project, editor.language).text
    body = text.partition("def when_started():\n")[2].partition("\n\n\nbehavior.run()")[0]
    return textwrap.dedent(body)


def assert_same_again(editor) -> None:
    """The program that has been made becomes no other one by its own text."""
    before = to_bytes(editor.project)

    update_from_python(editor, generate_program(editor.project, editor.language).text)

    assert to_bytes(editor.project) == before


@pytest.mark.parametrize(
    ("written", "made"),
    [
        ("# later\npass", "# later\npass"),
        ("pass\n# later", "# later\npass"),
        ("wait(1)\n\n\n# the end", "wait(1)\n# the end"),
        ("# above\n\nwait(1)", "# above\nwait(1)"),
        ("if True:\n    # nothing\n    pass", "if True:\n    # nothing\n    pass"),
        ("if True:\n    wait(1)\n\n    # end", "if True:\n    wait(1)\n    # end"),
        ("wait(1)\n# one\n# two", "wait(1)\n# one\n# two"),
        ("wait(1)\n# one\n\n# two", "wait(1)\n# one\n# two"),
        ("pass\n# one\n# two", "# one\n# two\npass"),
        ("try:\n    wait(1)\nexcept ValueError:\n    wait(2)\n    # end", None),
        ("try:\n    wait(1)\nfinally:\n    wait(2)\n    # end\n# below\nwait(3)", None),
        ("with open('a'):\n    if program.x:\n        wait(2)\n        # in\n    # end", None),
        ("while program.x:\n    wait(1)\nelse:\n    wait(2)\n    # one\n    # two", None),
        ("while program.x:\n    for i in range(2):\n        print(i)\n        # end", None),
        ("def inner():\n    return 1\n    # end\n\ninner()", None),
        ("wait(1)\n    # further in", None),
        ("for _ in range(2):\n    wait(1)\n    # one\n    # two", None),
        ("if True:\n    wait(1)\nelse:\n    wait(2)\n    # one\n    # two\n# three", None),
        ("wait(1)\n# one\ttwo", "wait(1)\n# one two"),
        ("wait(1)\n# one\n#\n# two\nwait(2)", None),
        ("#\n# one\n#\nwait(2)", "# one\nwait(2)"),
        ("#\nwait(2)\n#", "wait(2)"),
        ("#one\n#  two\nwait(2)", "# one\n#  two\nwait(2)"),
    ],
)
def test_a_comment_stays_wherever_it_stands(language, written, made):
    editor = updated(language, written)

    assert body_of(editor) == (made or written)
    assert_same_again(editor)


@pytest.mark.parametrize(
    "lines",
    [
        "    if 1 < 2:\n# zero\n        wait(1)",
        "    if 1 < 2:\n        wait(1)\n  # zero\n        wait(2)",
        "    if program.x:\n        wait(1)\n    else:\n# zero\n        wait(2)",
        "    for _ in range(2):\n# zero\n        wait(1)",
        "    for i, y in enumerate([1]):\n# zero\n        print(y)",
        "    for i, y in enumerate([1]):\n        print(y)\n# zero\n        print(i)",
        "    try:\n# zero\n        print(1)\n    finally:\n        print(2)",
        "    def inner():\n# zero\n        print(1)\n    inner()",
        "    with open('a'):\n        poem = '''\na\n  b'''\n# zero\n        print(poem)",
        "    y = sorted([\n# zero\n        1])",
        "    y = sorted([\n1,\n# zero\n        2])",
        "    wait(\n# zero\n1\n)",
    ],
)
def test_a_comment_less_far_in_than_what_is_around_it_is_kept(language, lines):
    editor = build(language, [B("event.started"), B("control.wait")], variables=("x",))
    text = generate_program(editor.project, language).text.replace("    wait(1)", lines)

    update_from_python(editor, text)

    again = generate_program(editor.project, language).text
    assert "# zero" in again
    assert ast.dump(ast.parse(again).body[-2]) == ast.dump(ast.parse(text).body[-2])
    assert_same_again(editor)


COMMENTS = [
    "# for i in range(3):\n#     nao.say(i)\n#         deep",
    "###########\n# a title #\n###########",
    "## a heading",
    "# # commented out twice",
    "# -----",
    "# 👩\u200d👩\u200d👧 and \u0645\u06cc\u200c\u062e",
]


@pytest.mark.parametrize("comment", COMMENTS)
@pytest.mark.parametrize("above", ["wait(1)\n", "print('a')\n", "if program.x:\n    wait(1)\n    "])
@pytest.mark.parametrize("below", ["", "\nwait(2)", "\nprint('b')"])
def test_a_comment_is_kept_to_the_letter(language, above, comment, below):
    margin = above.rpartition("\n")[2]
    written = above + comment.replace("\n", f"\n{margin}") + below

    editor = updated(language, written)

    assert body_of(editor) == written
    assert_same_again(editor)


@pytest.mark.parametrize("comment", [*COMMENTS, "# one\n#\n# two"])
def test_a_comment_above_a_rule_is_kept_to_the_letter(language, comment):
    editor = updated(language, "wait(1)")
    text = generate_program(editor.project, language).text.replace("\n@", f"\n{comment}\n@")

    update_from_python(editor, text)

    assert generate_program(editor.project, language).text == text
    assert_same_again(editor)


@pytest.mark.parametrize(
    "written",
    [
        "if True:\n    global x  # all\n    x = 1",
        "if True:\n    global x  # all\n    x = 1\nelse:\n    print(x)",
        "try:\n    global x\n    x = 1\nexcept ValueError:\n    wait(1)",
        "try:\n    wait(1)\nexcept ValueError:\n    # all\n    global x\n    x = 1  # one",
        "with open('a'):\n    global x  # all\n    global y\n    x = y = 2",
        "while True:\n    wait(1)\nelse:\n    global x\n    x = 1",
        "match 1:\n    case 1:\n        global x\n        x = 1",
        "if True:\n    global x",
        "try:\n    global x\nfinally:\n    wait(1)\nx = 1",
        "global x",
        "def inner():\n    global x\n    x = 1\ninner()",
    ],
)
def test_a_global_line_may_stand_wherever_there_are_statements(language, written):
    editor = updated(language, written)

    kept = [line for line in written.splitlines() if "= " in line or "wait" in line]
    assert all(line.strip().partition("  #")[0] in body_of(editor) for line in kept)
    assert all(f"# {word}" in body_of(editor) for word in ("all", "one") if f"# {word}" in written)
    is_shared = any(said in body_of(editor) for said in ("global x", "program.x"))
    assert is_shared or "x =" not in written
    assert_same_again(editor)


@pytest.mark.parametrize(
    ("written", "line", "sentence", "step"),
    [
        ("with open('a'):\n    global x; x = 1", 2, "writes “global” by itself", "first in"),
        ("global x\n\nfor i in [1]:\n    # all\n    print(x)\n    yield i", 6, "yield", "Correct"),
        ("global x\nwith open('a'):\n    x = '\u202e'", 3, "cannot be seen", "Correct"),
    ],
)
def test_what_no_block_may_hold_is_told_once_with_its_line(language, written, line, sentence, step):
    with pytest.raises(CodeUnread, match=sentence) as raised:
        updated(language, written)

    assert raised.value.line == line + 8
    assert str(raised.value.sentence).count("Line") == 1
    assert step in str(raised.value.checklist[0])


@pytest.mark.parametrize(
    "written",
    [
        "x: int = 0   ",
        "def f(a=1): \n    return a\t\n  \n    # end  ",
        "class A:\n\n    n = 1   # one  \n   \n    m = 2 ",
        "poem = '''  \na   \n'''  ",
        "def f(a=1):\n    global n   \n    n = '''a  \n  b  '''  \n    return a",
        "a = 1 ; b = [  \n    2,\n]  ",
    ],
)
def test_spaces_at_the_ends_of_lines_are_in_no_own_python(language, written):
    editor = updated(language, f"wait(1)  \n{written}  \nwait(2)")
    text = generate_program(editor.project, language).text
    text = text.replace("\n\n\n@", f"\n\n{written}\n\n\n@")

    update_from_python(editor, text)

    made = generate_program(editor.project, language).text
    assert [ast.dump(n) for n in ast.parse(made).body] == [
        ast.dump(n) for n in ast.parse(text).body
    ]
    again = Editor(from_bytes(to_bytes(editor.project), "project", language), language)
    assert to_bytes(again.project) == to_bytes(editor.project)
    assert_same_again(again)
    assert_same_again(editor)


OUTSIDE = [
    "def f(a=1):\n    return a\n    # one\n\n    # two",
    "class A:\n    def f(self):\n        return 1\n\n    # def g(self):\n    #     return 2",
    "if 1 > 0:\n    MODE = 1\n    # MODE = 2\nelse:\n    MODE = 3\n    # MODE = 4",
    "for i in [1]:\n    if i:\n        print(i)\n        # in\n    # end\n\n# below\nprint(2)",
]


@pytest.mark.parametrize("value", ['""', '"it"', "[1]", "None"])
def test_a_variable_begins_as_it_did_when_a_line_that_changes_it_is_kept(language, value):
    editor = updated(language, "global x\nx += 1\nwait(x)")
    text = generate_program(editor.project, language).text.replace("x += 1", f"x += {value}")

    update_from_python(editor, text)

    assert generate_program(editor.project, language).text == text
    assert_same_again(editor)


@pytest.mark.parametrize("above", ["", "# one\n", "# one\n# two\n\n"])
@pytest.mark.parametrize("behind", ["", "  # three"])
@pytest.mark.parametrize("more", ["", "x = 0\n", "LIMIT = 2.5\n", "# four\nx = 0\n"])
def test_comments_of_a_robot_stay_above_all_rules(language, above, behind, more):
    editor = build(language, [B("event.started"), B("robot.say")])
    text = generate_program(editor.project, language).text
    text = text.replace('nao = Robot("NAO")', f'{above}nao = Robot("NAO"){behind}')
    text = text.replace("\n\n\n@", f"\n{more}\n\n@")

    update_from_python(editor, text)

    made = generate_program(editor.project, language).text
    begin = made.index("nao =")
    said = [word for word in ("one", "two", "three") if f"# {word}" in above + behind]
    assert [word for word in ("one", "two", "three") if f"# {word}\n" in made[:begin]] == said
    assert made.count("#") == text.count("#")
    assert_same_again(editor)


@pytest.mark.parametrize(
    "top",
    [
        "# score\nx = 0\ny = 0",
        "x = 0\n# second\ny = 0",
        "# first\nx = 0\n# second\ny = 0",
        "# all of them\n\nx = 0\ny = 0",
        "# one\n# two\nx = 0\ny = 0",
        "# unused\nw = 0\nx = 0\ny = 0",
        "# kept\nw = 2.5\nx = 0\ny = 0",
    ],
)
def test_a_comment_above_a_variable_stays_there(language, top):
    editor = updated(language, "global x, y\nx += 1\ny += 1\nwait(x + y)")
    text = generate_program(editor.project, language).text
    text = text.replace("x = 0\ny = 0\n", f"{top}\n")

    update_from_python(editor, text)

    made = generate_program(editor.project, language).text
    assert made.replace("\n\n#", "\n#") == text
    assert_same_again(editor)


@pytest.mark.parametrize("outside", OUTSIDE)
def test_a_comment_last_in_own_python_stays_in_it(language, outside):
    editor = updated(language, "wait(1)")
    text = generate_program(editor.project, language).text
    text = text.replace("\n\n\n@", f"\n\n{outside}\n\n\n@")

    update_from_python(editor, text)

    assert f"\n\n{outside}\n\n\n" in generate_program(editor.project, language).text
    assert_same_again(editor)


@pytest.mark.parametrize(
    ("written", "made"),
    [
        ("a = 1; b = 2  # two", "a = 1\nb = 2  # two"),
        ("a = 1; b = 2; c = [  # three\n    3,\n]  # end", None),
        ("a = [\n    1,  # one\n]; b = 2  # two", "a = [\n    1,  # one\n]\nb = 2  # two"),
        ("import time; import random  # both", "import random  # both"),
        ("a = 0; b = 0  # two", "b = 0  # two"),
        ("a = f = 1; nao = 0  # two\nprint(a)", "a = f = 1\nnao = 0  # two\nprint(a)"),
    ],
)
def test_a_comment_behind_several_statements_stays_behind_the_last(language, written, made):
    editor = updated(language, "wait(1)")
    text = generate_program(editor.project, language).text
    text = text.replace("\n\n\n@", f"\n\n{written}\n\n\n@")

    update_from_python(editor, text)

    made = made or written.replace("; ", "\n")
    assert f"\n{made}\n\n\n" in generate_program(editor.project, language).text
    assert_same_again(editor)


def test_a_comment_last_below_the_end_stays_there(language):
    editor = updated(language, "wait(1)")
    text = generate_program(editor.project, language).text
    end = 'if __name__ == "__main__":\n    behavior.run()\n    # print("end")\n'

    update_from_python(editor, text.replace("behavior.run()\n", end))

    assert generate_program(editor.project, language).text.endswith(end)
    assert_same_again(editor)


def test_what_the_program_cannot_hold_is_told_with_its_rule(language):
    with pytest.raises(CodeUnread, match="too long") as raised:
        updated(language, "wait(1)\n# " + "x" * 100_001)

    assert raised.value.line == 8
    assert raised.value.checklist


def test_a_comment_at_the_top_of_the_text_is_in_no_body(language):
    editor = build(language, [B("event.started"), B("control.wait")])
    text = generate_program(editor.project, language).text
    text = "# mine\n" + text.replace("wait(1)", "if True:\n        pass")

    update_from_python(editor, text)

    assert body_of(editor) == "if True:\n    pass"


def test_a_text_of_several_lines_keeps_its_margin(language):
    editor = build(language, [B("event.started"), B("control.wait")])
    text = generate_program(editor.project, language).text
    written = "poem: str = '''\n  roses\nviolets\n'''"

    update_from_python(editor, text.replace("wait(1)", written))

    assert f"    {written}" in generate_program(editor.project, language).text


def test_what_no_rule_can_do_becomes_code_and_what_none_may_is_told_with_its_line(language):
    assert body_of(updated(language, "return 5")) == "return 5"

    with pytest.raises(CodeUnread) as raised:
        updated(language, "yield 5")
    assert raised.value.line > 1


@pytest.mark.parametrize(
    "code",
    [
        "import math as x",
        "def x():\n    pass",
        "class x:\n    pass",
        "try:\n    pass\nexcept ValueError as x:\n    pass",
        "match 1:\n    case x:\n        pass",
    ],
)
def test_code_that_makes_a_variable_in_any_way_makes_the_one_of_the_program(language, code):
    editor = build(
        language, [B("event.started"), B("code.lines", {"code": code})], variables=("x",)
    )

    assert body_of(editor).startswith("global x\n")


def test_an_update_inside_another_step_is_taken_back_alone(language):
    editor = build(language, [B("event.started"), B("control.wait")])
    text = generate_program(editor.project, language).text

    with editor.transaction("more"):
        editor.create("control.wait", editor.new_stack("behaviour", 900, 0))
        before = to_bytes(editor.project)
        with pytest.raises(CodeUnread):
            update_from_python(editor, text.replace("wait(1)", "wait(1)\n    yield"))

        assert to_bytes(editor.project) == before

    assert to_bytes(editor.project) == before


@pytest.mark.parametrize("name", ["launcher", "wait", "nao"])
def test_a_name_of_the_program_cannot_become_a_variable(language, name):
    editor = build(language, [B("event.started"), B("robot.say")])
    text = generate_program(editor.project, language).text
    before = to_bytes(editor.project)

    with pytest.raises(CodeUnread, match=name) as raised:
        rule = f"@behavior.when_started\ndef b():\n    global {name}\n\n\nbehavior.run()"
        update_from_python(editor, text.replace("behavior.run()", rule))

    assert raised.value.line > 10
    assert to_bytes(editor.project) == before
