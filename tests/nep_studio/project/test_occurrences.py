"""What a program waits for is read from its blocks: every hat and every question has something."""

from __future__ import annotations

from pathlib import Path

import pytest

from nep_studio import paths
from nep_studio.blocks.files import load
from nep_studio.project.triggers import Occurrence, cues_of, occurrences_of, of_state
from nep_studio.run.installation import studio_language
from tests.blocks.block_building import B, build

LANGUAGE = studio_language()
EXAMPLES = sorted(paths.examples().glob("*.nep"))


def occurrences(*stacks: list[B]) -> list[Occurrence]:
    editor = build(LANGUAGE, *stacks, variables=("x",))
    return occurrences_of(editor.project, editor.language)


def test_what_rules_begin_with_comes_before_what_they_ask() -> None:
    asked = B("control.if", inputs={"condition": B("robot_senses.sees", {"thing": "ball"})})

    found = occurrences([B("event.started"), asked], [B("robot_events.heard", {"word": "Hello!"})])

    assert [(one.kind, one.value) for one in found] == [("word", "Hello!"), ("ball", "")]


def test_the_same_thing_is_offered_once() -> None:
    hat = [B("robot_events.touched"), B("robot.say")]

    assert len(occurrences(hat, hat, [B("event.human_state")])) == 2  # one robot, or whichever


@pytest.mark.parametrize(("side", "is_past"), [("under", False), ("over", True)])
def test_a_sensor_is_to_measure_a_little_more_than_is_waited_for(side: str, is_past: bool) -> None:
    [one] = occurrences([B("robot_events.sensor", {"side": side, "value": 30})])

    assert (one.kind, one.value, one.robot) == ("sensor", "sonar_left", "NAO")
    assert one.amount is not None
    assert (one.amount > 30) == is_past


@pytest.mark.parametrize(
    ("state", "kind", "value"),
    [
        ("gesture_karate", "gesture", "karate"),
        ("touched_head_front", "touch", "head_front"),
        ("heard_good_morning", "word", "good morning"),
        ("heard_sound", "sound", ""),
        ("seen_face_anna", "face", "anna"),
        ("seen_face", "face", ""),
        ("seen_mark_64", "mark", "64"),
        ("emotion_sad", "emotion", "sad"),
        ("person_close", "distance", "close"),
        ("arm_raised", "arm", "raised"),
        ("arm_lowered", "arm", "lowered"),
        ("arm_of_mine", "state", "arm_of_mine"),
        ("cue_storm", "state", "cue_storm"),
    ],
)
def test_a_human_state_tells_what_must_happen(state: str, kind: str, value: str) -> None:
    found = of_state(state, LANGUAGE)

    assert (found.kind, found.value) == (kind, value)


def test_what_is_only_known_while_it_runs_is_anything() -> None:
    value = B("variable.get", {"variable": "v1"})

    [one] = occurrences([B("robot_events.sensor", {}, {"value": value})])

    assert one.amount is None


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_cue_of_an_example_has_a_happening(path: Path) -> None:
    project = load(path, LANGUAGE)

    assert len(occurrences_of(project, LANGUAGE)) >= len(cues_of(project, LANGUAGE))


def test_every_hat_and_question_of_the_language_has_a_happening() -> None:
    # Run, the goal that it is about, what is no rule, what another rule tells, the clock
    own = {"event.started", "goal.when_goal", "code.program", "goal.goal_when", "goal.goal_asked"}
    own |= {"event.told", "time.every", "time.at", "state.begins", "state.after", "state.done"}
    own |= {"state.told", "tree.tree"}
    without = []
    for definition in LANGUAGE.definitions.values():
        is_question = definition.is_value and definition.category.id in ("sensing", "robot_senses")
        if definition.id in ("event.true", "state.when"):
            stack = [B(definition.id, {}, {"condition": B("robot_senses.is_touched")})]
        elif definition.shape == "hat" and definition.id not in own:
            fields = {"state": "please"} if definition.id == "goal.goal" else {}
            stack = [B(definition.id, fields)]
        elif is_question:
            setting = B("variable.set", {"variable": "v1"}, {"value": B(definition.id)})
            stack = [B("event.started"), setting]
        else:
            continue
        if not occurrences(stack):
            without.append(definition.id)

    assert without == []
