"""Find blocks, jump to definitions and uses, rename everywhere, compare two versions."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from block_building import B, build, karate
from operating import one_step, rule, say
from sound_programs import karate_node, sound

from nep_studio.blocks import checks
from nep_studio.blocks.checks import check
from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks, MoveBlocks
from nep_studio.blocks.edits.project import RenameVariable
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.files import from_bytes, to_bytes
from nep_studio.blocks.operations.copying import python_of
from nep_studio.blocks.operations.finding import (
    Subject,
    compare,
    definition_of,
    find,
    subjects_of,
    uses_of,
)
from nep_studio.blocks.operations.fixes import FIXES, apply_fix
from nep_studio.blocks.places import InStack


def test_blocks_are_found_by_words_without_case_and_accents(language):
    editor, (_, a, b, c) = rule(language, say("Olé, José"), say("hola"), B("variable.set"))
    editor.apply(SetField(c, "variable", "v1"))
    project = editor.project
    editor.apply(RenameVariable("v1", "Größe"))

    assert find(project, language, "ole JOSE") == (a,)
    assert find(project, language, "says") == (a, b)
    assert find(project, language, "grosse") == (c,)
    assert find(project, language, "GRÖßE set") == (c,)
    assert find(project, language, "  ") == ()


def test_a_comment_and_a_label_of_a_choice_are_found(language):
    editor, (_, block) = rule(language, B("robot.do", {"posture": "posture_lying_back"}))
    editor.project.blocks[block].comment = "Time to sleep"

    assert find(editor.project, language, "sleep") == (block,)
    assert find(editor.project, language, "lie on the back") == (block,)


def test_uses_and_definitions_of_what_blocks_name(language):
    editor = sound(
        language,
        [B("event.gesture"), B("variable.set", {"variable": "v1"}), say("a")],
        [B("event.human_state", {"state": "gesture_karate"}), say("b")],
    )
    project = editor.project
    gesture, setting, talk = project.pages["behaviour"][0].body
    state, _ = project.pages["behaviour"][1].body
    robot, node = (project.pages[page][0].body[0] for page in ("robots", "nodes"))

    assert subjects_of(project, language, talk) == (Subject("robot", "NAO"),)
    assert subjects_of(project, language, setting) == (Subject("variable", "v1"),)
    assert uses_of(project, language, Subject("gesture", "karate")) == (gesture, state, node)
    assert definition_of(project, language, Subject("gesture", "karate")) == node
    assert definition_of(project, language, Subject("robot", "NAO")) == robot
    assert definition_of(project, language, Subject("variable", "v1")) == setting
    assert definition_of(project, language, Subject("robot", "Pepper")) is None


def test_a_node_that_recognises_several_gestures_defines_each(language):
    editor = build(language, [karate_node(gesture="wave, karate")], page="nodes")
    project = editor.project
    (node,) = project.pages["nodes"][0].body

    assert subjects_of(project, language, node) == (
        Subject("gesture", "wave"),
        Subject("gesture", "karate"),
    )
    assert definition_of(project, language, Subject("gesture", "karate")) == node


def test_two_versions_are_compared_in_words(language):
    editor, (_, a, b, _, d) = rule(language, say("a"), say("b"), say("c"), say("d"))
    old = from_bytes(to_bytes(editor.project), "old.nep", language)
    editor.apply(SetField(a, "text", "new words"))
    editor.apply(DeleteBlocks(b))
    editor.apply(MoveBlocks(d, 1, InStack(editor.project.pages["behaviour"][0].id, 1)))
    new = editor.create("control.wait", editor.new_stack("behaviour", 0, 0))

    found = {(it.what, it.block) for it in compare(old, editor.project, language)}

    assert found == {("changed", a), ("removed", b), ("moved", d), ("added", new)}
    assert any("new words" in it.sentence for it in compare(old, editor.project, language))
    assert compare(old, old, language) == ()


def faulty(language):
    """Programs that make each fix an offer."""
    forever = B("control.forever", bodies={"do": [B("variable.change", {"variable": "v1"})]})
    inner = B("control.forever", bodies={"do": [B("control.forever")]})
    sit = B("robot.do", {"posture": "posture_sit"})
    return {
        "add_robot": sound(language, [B("event.started"), B("robot.say", {"robot": "Pepper"})]),
        "add_wait": sound(language, [B("event.started"), forever]),
        "add_wait inside": sound(language, [B("event.started"), inner]),
        "stand_first": sound(language, [B("event.started"), sit, B("robot.walk")]),
    }


def problem_of(editor, language, name) -> Diagnostic:
    return next(p for p in check(editor.project, language) if p.fix and p.fix.name == name)


@pytest.mark.parametrize("case", ["add_robot", "add_wait", "add_wait inside", "stand_first"])
def test_a_fix_makes_its_problem_go_away_in_one_step(language, case):
    editor = faulty(language)[case]
    problem = problem_of(editor, language, case.split()[0])

    with one_step(editor):
        block = apply_fix(editor, problem)

    assert block in editor.project.blocks
    assert editor.history.undo_label == problem.fix.label
    again = [(p.kind, p.block) for p in check(editor.project, language)]
    assert (problem.kind, problem.block) not in again


def test_every_fix_that_a_check_offers_can_be_carried_out():
    sources = Path(checks.__file__).parent.glob("*.py")
    offered = {
        name
        for path in sources
        for name in re.findall(r"\bFix\(\s*\"(\w+)\"", path.read_text(encoding="utf-8"))
    }

    assert offered
    assert offered <= FIXES.keys()


def test_a_problem_without_a_fix_is_refused(language):
    editor = karate(language)

    with pytest.raises(EditRefused, match="by itself"):
        apply_fix(editor, Diagnostic("error", "x", "behaviour", "", "Something."))


def test_selected_blocks_are_copied_as_python(language):
    editor, (hat, a, repeat) = rule(
        language, say("a"), B("control.repeat", bodies={"do": [say("b")]})
    )
    project = editor.project
    text = 'nao.say("a")\nfor _ in range(3):\n    nao.say("b")'

    assert python_of(project, language, [a, repeat]) == text
    assert python_of(project, language, [hat, a]).splitlines() == [
        '@behavior.when("gesture_karate")',
        "def when_gesture_karate():",
        '    nao.say("a")',
    ]


def test_a_selected_value_is_copied_as_an_expression(language):
    sum_of = B("math.arithmetic", {"a": 1}, {"b": B("variable.get", {"variable": "v1"})})
    editor = build(language, [sum_of], variables=("value",))
    block = editor.project.pages["behaviour"][0].body[0]

    assert python_of(editor.project, language, [block]) == "1 + program.value"
