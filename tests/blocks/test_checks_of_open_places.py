"""Checks and uses of blocks in whose places other blocks stand: what these give is not known."""

from __future__ import annotations

import pytest
from block_building import B, build

from nep_studio.blocks.checks import check
from nep_studio.blocks.deployment import names_used
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.language import Language
from nep_studio.blocks.operations.finding import Subject, uses_of
from nep_studio.blocks.program import ROBOT_BLOCK
from nep_studio.project.triggers import Occurrence, occurrences_of

STARTED, WALK = B("event.started"), B("robot.walk")
SIT = {"posture": "posture_sit"}


def held() -> B:
    return B("variable.get", {"variable": "v1"})


def kinds_of(editor: Editor) -> list[str]:
    return [one.kind for one in check(editor.project, editor.language)]


def program(language: Language, *stack: B) -> Editor:
    editor = build(language, [STARTED, *stack], variables=("held",))
    return build(language, [B(ROBOT_BLOCK)], page="robots", editor=editor)


@pytest.mark.parametrize(
    ("stack", "is_told"),
    [
        ([B("robot.do", SIT), WALK], True),
        ([B("robot.do", SIT, {"posture": held()}), WALK], False),
        ([B("robot.do", SIT), B("robot.do", {}, {"posture": held()}), WALK], False),
        ([B("robot.do", SIT, {"robot": held()}), WALK], False),
        ([B("robot.do", SIT), B("robot.do", {}, {"robot": held()}), WALK], False),
        ([B("robot.do", SIT), B("robot.walk", {}, {"robot": held()})], False),
    ],
)
def test_a_posture_or_a_robot_that_a_block_gives_is_none_that_is_known(
    language: Language, stack: list[B], is_told: bool
) -> None:
    assert ("not_standing" in kinds_of(program(language, *stack))) is is_told


@pytest.mark.parametrize(("inputs", "is_told"), [({}, True), ({"robot": held()}, False)])
def test_a_robot_that_a_block_gives_is_not_missing(
    language: Language, inputs: dict[str, B], is_told: bool
) -> None:
    editor = program(language, B("robot.say", {"robot": "Nobody"}, inputs))

    assert ("robot_missing" in kinds_of(editor)) is is_told
    assert ("Nobody" in names_used(editor.project, editor.language, "robot")) is is_told
    found = uses_of(editor.project, editor.language, Subject("robot", "Nobody"))
    assert bool(found) is is_told


def test_a_disabled_block_in_a_place_leaves_the_field_in_force(language: Language) -> None:
    editor = program(language, B("robot.say", {"robot": "Nobody"}, {"robot": held()}))
    plugged = next(b for b in editor.project.blocks.values() if b.type == "variable.get")

    plugged.disabled = True

    assert "robot_missing" in kinds_of(editor)


def test_two_rules_for_sensors_of_variables_are_not_for_the_same(language: Language) -> None:
    rules = [[B("robot_events.sensor", {}, {"sensor": held()}), WALK] for _ in range(2)]
    same = [[B("robot_events.sensor"), WALK] for _ in range(2)]

    assert "same_trigger" not in kinds_of(build(language, *rules, variables=("held",)))
    assert "same_trigger" in kinds_of(build(language, *same))


@pytest.mark.parametrize(("text", "is_used"), [("gesture_wave", True), ("gesture_of_love", False)])
def test_a_gesture_that_a_variable_may_hold_is_recognised(
    language: Language, text: str, is_used: bool
) -> None:
    put = B("variable.set", {"variable": "v1"}, {"value": B("text.text", {"text": text})})
    asks = B("control.if", {}, {"condition": B("sensing.human_state_is", {}, {"state": held()})})
    editor = program(language, put, asks)

    used = names_used(editor.project, editor.language, "gesture")

    assert used.keys() == ({text.removeprefix("gesture_")} if is_used else set())


@pytest.mark.parametrize(
    ("block", "place"),
    [
        ("robot_senses.is_touched", "part"),
        ("robot_senses.person_is", "distance"),
        ("robot_senses.is_doing", "doing"),
        ("robot_senses.is_in", "posture"),
        ("sensing.emotion", "emotion"),
    ],
)
def test_what_only_the_running_program_asks_about_is_offered_to_nobody(
    language: Language, block: str, place: str
) -> None:
    def asked(inputs: dict[str, B]) -> list[Occurrence]:
        fork = B("control.if", {}, {"condition": B(block, {}, inputs)})
        editor = program(language, fork)
        return occurrences_of(editor.project, editor.language)

    assert len(asked({})) == 1
    assert asked({place: held()}) == []
