"""Edited Python means the same among the blocks: its own variables, fields, pages, robots."""

# ruff: noqa: E501 - Python in Python is read more easily in one line

from __future__ import annotations

import pytest
from block_building import B, build

from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.project import AddPage
from nep_studio.blocks.files import to_bytes
from nep_studio.blocks.from_python.learning import CodeUnread
from nep_studio.blocks.from_python.updating import update_from_python
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import Project
from tests.blocks.from_python.python_traces import assert_does_the_same

HEAD = """from nep_core import Behavior, Robot, as_text, together, wait

nao = Robot("NAO")
behavior = Behavior("T")
"""
TOPS = ["x = 0\n", "\nx = 3\n", "\n"]
BODIES = {
    "set": "x = 5",
    "changed": "x = 5\nx += 2\nnao.say(as_text(x))",
    "of a list": "for x in [1, 2]:\n    nao.say(as_text(x))",
    "counted": "for x in range(1, 4):\n    nao.say(as_text(x))",
    "global": "global x\nx = 5",
    "inside": "def g():\n    x = 5\n    nao.say(as_text(x))\n\n\ng()",
    "read": "if x > 0:\n    nao.say('a')",
    "in branches": "x = 7\nif True:\n    x = 8\nelse:\n    x = 9\nnao.say(as_text(x))",
    "copied": "y = x\nnao.say(as_text(y))",
    "a list": "x = [1]\nx.append(3)\nnao.say(as_text(x))",
    "around parts": "x = 4\ndef left():\n    nao.say(as_text(x))\n\n\ndef right():\n    wait(0)\n\n\ntogether(left, right)",
    "in parts": "def left():\n    x = 5\n    nao.say(as_text(x))\n\n\ndef right():\n    wait(0)\n\n\ntogether(left, right)",
    "in a loop": "while True:\n    x = 3\n    break",
    "in a try": "try:\n    x = 5\nexcept ValueError:\n    pass",
    "two at once": "x, y = 1, 2\nnao.say(as_text(y))",
    "imported": "import math as x\nnao.say(as_text(x.floor(2.5)))",
    "comprehended": "y = [x for x in [1, 2]]\nnao.say(as_text(y))",
}  # fmt: skip
STARTED = "\n\n@behavior.when_started\ndef when_started():\n    global x\n    x = 1\n    {}\n    nao.say(as_text(x))\n\n\nbehavior.run()\n"


def indented(body: str) -> str:
    return "\n".join(f"    {line}" if line else "" for line in body.split("\n"))


@pytest.mark.parametrize("top", TOPS)
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_what_a_function_has_for_itself_stays_its_own(language, monkeypatch, body, top):
    text = f"{HEAD}{top}\n\ndef f():\n{indented(body)}\n{STARTED.format('f()')}"
    editor = Editor(Project("T"), language)

    update_from_python(editor, text)

    made = generate_program(editor.project, language).text
    assert_does_the_same(made, text, monkeypatch)


@pytest.mark.parametrize("top", TOPS)
@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_what_a_rule_has_for_itself_is_kept_or_refused(language, monkeypatch, body, top):
    rule = f"@behavior.when('touched_head')\ndef f():\n{indented(body)}\n"
    text = f"{HEAD}{top}\n\n{rule}{STARTED.format('wait(0)')}"
    editor = Editor(Project("T"), language)

    try:
        update_from_python(editor, text)
    except CodeUnread as refused:
        assert "variable of the whole program" in str(refused.sentence)
        assert editor.project.variables == []
        return

    made = generate_program(editor.project, language).text
    assert_does_the_same(made, text, monkeypatch)


def test_what_is_taken_out_of_the_text_is_as_in_a_new_block(language):
    editor = build(
        language,
        [
            B(
                "event.human_state",
                {"state": "touched_head", "again.1": "queue"},
                groups={"repeated": 1},
            ),
            B("robot.say", {"text": "hi", "gesture": "explain"}),
        ],
    )
    hat, say = editor.project.pages["behaviour"][0].body
    text = generate_program(editor.project, language).text

    update_from_python(
        editor, text.replace(', gesture="explain"', "").replace(', again="queue"', "")
    )

    assert editor.project.pages["behaviour"][0].body == [hat, say]
    assert editor.project.blocks[say].fields["gesture"] == "no_gesture"
    assert editor.project.blocks[hat].groups == {"repeated": 0}
    assert "again.1" not in editor.project.blocks[hat].fields


def test_rules_of_two_pages_stay_on_their_pages_in_whatever_order_they_are_written(language):
    editor = build(language, [B("event.started"), B("robot.say", {"text": "one"})])
    editor.apply(AddPage("second", "Second", 1))
    rule = [B("event.human_state"), B("robot.say", {"text": "two"})]
    build(language, rule, page="second", editor=editor)
    text = generate_program(editor.project, language).text
    before = to_bytes(editor.project)
    head, one, two, run = text.split("\n\n\n")

    update_from_python(editor, "\n\n\n".join([head, two, one, run]))

    assert to_bytes(editor.project) == before
    update_from_python(editor, "\n\n\n".join([head, two.replace("two", "2"), one, run]))
    again = generate_program(editor.project, language).text
    assert again == text.replace('"two"', '"2"')
    assert len(editor.project.pages["second"]) == len(editor.project.pages["behaviour"]) == 1


def with_robot(language, *blocks: B) -> Editor:
    editor = build(language, [B("event.started"), *blocks])
    robot = editor.create("robots.robot", editor.new_stack("robots", 0, 0))
    editor.apply(SetField(robot, "name", "NAO"))
    editor.apply(SetField(robot, "address", "192.168.1.10"))
    return editor


def test_a_robot_that_has_another_name_in_the_text_is_renamed(language):
    editor = with_robot(language, B("robot.say"), B("code.lines", {"code": "nao.go()"}))
    blocks = set(editor.project.blocks)
    text = generate_program(editor.project, language).text
    wanted = text.replace("nao", "otto").replace('"NAO"', '"Otto"')

    update_from_python(editor, wanted)

    assert generate_program(editor.project, language).text == wanted
    entries = robot_entries(editor.project, language)
    assert [(one.name, one.address) for one in entries] == [("Otto", "192.168.1.10")]
    assert set(editor.project.blocks) == blocks
    assert editor.history.undo() and generate_program(editor.project, language).text == text


def test_a_robot_that_is_renamed_in_one_place_alone_is_told(language):
    editor = with_robot(language, B("robot.say"))
    text = generate_program(editor.project, language).text
    before = to_bytes(editor.project)

    with pytest.raises(CodeUnread) as refused:
        update_from_python(editor, text.replace('"NAO"', '"Otto"'))

    assert "nao" in str(refused.value.sentence) and refused.value.checklist
    assert to_bytes(editor.project) == before


def test_a_second_robot_is_no_other_name_of_the_first(language):
    editor = with_robot(language, B("robot.say"))
    text = generate_program(editor.project, language).text
    more = text.replace("behavior = ", 'otto = Robot("Otto")\nbehavior = ', 1)

    update_from_python(
        editor, more.replace("\n\n\nbehavior.run", "\n    otto.say('a')\n\n\nbehavior.run")
    )

    names = [one.name for one in robot_entries(editor.project, language)]
    assert names == ["NAO", "Otto"]


def test_a_text_with_values_in_braces_is_a_value_among_blocks(language):
    editor = build(
        language,
        [B("event.started"), B("robot.say", {"text": "That is "})],
    )
    text = generate_program(editor.project, language).text
    said = "nao.say(f'{1 + 1:>4} of 3')"

    update_from_python(editor, text.replace('nao.say("That is ")', said))

    assert said in generate_program(editor.project, language).text
    assert any(block.type == "code.value" for block in editor.project.blocks.values())
    assert not any(block.type == "code.lines" for block in editor.project.blocks.values())


@pytest.mark.parametrize(
    "body",
    ["(n, m), k = [1, 2], 3", "with open('a') as n:\n    nao.say(n)", "import math as n"],
)
def test_a_variable_that_is_not_in_the_text_any_more_is_none(language, body):
    text = f"{HEAD}\n\n@behavior.when_started\ndef when_started():\n{indented(body)}\n\n\nbehavior.run()\n"
    new, editor = Editor(Project("T"), language), Editor(Project("T"), language)
    update_from_python(new, text)
    before = text.replace("\n\n\n@", "\nn = 0\n\n\n@").replace("():\n", "():\n    global n\n")
    update_from_python(editor, before)

    update_from_python(editor, text)

    made = generate_program(editor.project, language).text
    assert made == generate_program(new.project, language).text
    assert not editor.project.variables


def test_a_variable_of_a_loose_block_is_that_of_its_name_in_the_text(language):
    text = f"{HEAD}\n\n@behavior.when_started\ndef when_started():\n    {{}}\n\n\nbehavior.run()\n"
    editor = build(language, [B("variable.set", {"variable": "v1"})], variables=("n", "m"))

    update_from_python(editor, text.format("n = 1"))

    assert [variable.name for variable in editor.project.variables] == ["n", "m"]
    assert "    n = 1\n" in generate_program(editor.project, language).text
    with pytest.raises(CodeUnread, match="a variable of the whole program"):
        update_from_python(editor, text.format("n, *m = 1, 2"))
    assert [variable.name for variable in editor.project.variables] == ["n", "m"]
