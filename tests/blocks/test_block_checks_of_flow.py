"""Problems of the order in which blocks run, and of how deep they are in each other."""

from __future__ import annotations

import pytest
from block_building import B
from sound_programs import WAIT, block_of, kinds, only, sound

from nep_studio.blocks.checks import check
from nep_studio.blocks.edits.content import SetFlag
from nep_studio.blocks.errors import CodeRefused
from nep_studio.blocks.generate.program import generate_program


@pytest.mark.parametrize("loop", ["control.forever", "control.while"])
def test_a_loop_without_a_pause_is_told_and_one_with_a_pause_deep_inside_is_not(language, loop):
    question = {"condition": B("logic.truth")} if loop == "control.while" else {}
    change = B("variable.change", {"variable": "v1"})
    fork = B("control.if", inputs={"condition": B("logic.truth")}, bodies={"do": [change]})
    editor = sound(language, [B("event.started"), B(loop, {}, question, {"do": [fork]})])

    problem = only(editor, language)
    assert problem.kind == "no_pause" and problem.fix.name == "add_wait"
    assert problem.fix.data == {"block": block_of(editor, loop), "slot": "do"}

    fork.bodies["do"].append(B("control.repeat", bodies={"do": [WAIT]}))
    editor = sound(language, [B("event.started"), B(loop, {}, question, {"do": [fork]})])
    assert kinds(editor, language) == []


def test_a_disabled_pause_is_no_pause(language):
    editor = sound(language, [B("event.started"), B("control.forever", bodies={"do": [WAIT]})])
    editor.apply(SetFlag(block_of(editor, "control.wait"), "disabled", True))

    assert kinds(editor, language) == ["no_pause"]


def test_walking_while_sitting_is_told_for_the_robot_that_sits(language):
    sit = B("robot.do", {"posture": "posture_sit"})
    walk = B("robot.walk")
    editor = sound(language, [B("event.started"), sit, walk, B("robot.do"), B("robot.turn")])

    problem = only(editor, language)

    assert str(problem.sentence) == "NAO cannot walk after the posture “sit”."
    assert problem.fix.data == {"block": block_of(editor, "robot.walk"), "robot": "NAO"}


def test_all_robots_that_sit_are_sitting_one_by_one(language):
    sit = B("robot.do", {"robot": "*", "posture": "posture_rest"})
    editor = sound(language, [B("event.started"), B("robot.do"), sit, B("robot.walk")])

    assert kinds(editor, language) == ["not_standing"]


def test_blocks_after_the_end_are_told(language):
    editor = sound(language, [B("event.started"), WAIT, B("robot.say")])
    chain = editor.project.pages["behaviour"][0].body
    editor.project.blocks[chain[1]].type = "control.stop_program"
    editor.project.blocks[chain[1]].fields = {}

    problem = only(editor, language)

    assert problem.kind == "never_reached" and problem.block == chain[2]


@pytest.mark.parametrize("depth", [19, 20, 21, 22])
def test_what_is_nested_too_deep_is_told_exactly_when_it_makes_no_code(language, depth):
    block = WAIT
    for _ in range(depth):
        block = B("control.forever", bodies={"do": [block]})
    editor = sound(language, [B("event.started"), block])

    assert ("too_deep" in kinds(editor, language)) == (depth > 20)
    assert refused_block(editor, language) == too_deep_block(editor, language)


@pytest.mark.parametrize("depth", [58, 59, 60, 61, 70])
def test_values_in_values_are_told_exactly_when_they_make_no_code(language, depth):
    value = B("logic.truth")
    for _ in range(depth):
        value = B("logic.not", inputs={"a": value})
    editor = sound(
        language, [B("event.started"), B("control.wait_until", inputs={"condition": value})]
    )

    assert refused_block(editor, language) == too_deep_block(editor, language)
    assert bool(refused_block(editor, language)) == (depth > 59)


def refused_block(editor, language):
    try:
        generate_program(editor.project, language)
    except CodeRefused as refused:
        return refused.block
    return None


def too_deep_block(editor, language):
    problems = check(editor.project, language)
    return next((p.block for p in problems if p.kind == "too_deep"), None)


def test_going_on_with_the_next_round_is_no_pause(language):
    again = B("control.if", bodies={"do": [B("control.next_round")]})
    editor = sound(language, [B("event.started"), B("control.forever", bodies={"do": [again]})])

    assert "no_pause" in kinds(editor, language)
