"""A program whose variables say which robot does what: on both robots, with the words of people."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from typing import Any

import pytest

from nep_core.errors import NepError
from nep_core.program.values import speak
from nep_core.program.variables import variables_in
from nep_studio.blocks.edits.content import SetExtra
from nep_studio.blocks.edits.project import SetScope
from nep_studio.blocks.generate.program import generate_program
from nep_studio.blocks.program import LANGUAGE as LANGUAGE_OF
from nep_studio.blocks.program import SCOPE_PROGRAM
from tests.blocks.block_building import B, build
from tests.stories.robot_block_stage import DRIVERS, LANGUAGE, BlockStage, block_stage

STARTED = B("event.started")


def held(variable: str) -> B:
    return B("variable.get", {"variable": variable})


def put(variable: str, value: B | str) -> B:
    if isinstance(value, str):
        value = B("text.text", {"text": value})
    return B("variable.set", {"variable": variable}, {"value": value})


def play(*stack: B, language: str = "en") -> dict[str, Any]:
    """Run a rule, and return what its variables hold then."""
    editor = build(LANGUAGE, [STARTED, *stack], variables=("which", "what", "x"))
    for variable in list(editor.project.variables):
        editor.apply(SetScope(variable.id, SCOPE_PROGRAM))
    editor.apply(SetExtra(LANGUAGE_OF, language))
    names: dict[str, Any] = {"__name__": "__main__"}
    code = generate_program(editor.project, LANGUAGE).text
    exec(compile(code, "program.py", "exec"), names)
    return dict(variables_in(names["program"]))


@pytest.fixture(scope="module", params=DRIVERS)
def stage(request: pytest.FixtureRequest) -> Iterator[BlockStage]:
    with socket.socket() as chosen:
        chosen.bind(("127.0.0.1", 0))
        port = chosen.getsockname()[1]
    with block_stage(request.param, port) as made:
        yield made


@pytest.mark.parametrize("word", ["posture_sit", "sit", "Sit"])
def test_a_posture_is_called_as_in_python_or_as_in_blocks(stage: BlockStage, word: str) -> None:
    names = play(
        put("v1", B("robot.named")),
        put("v2", "stand"),
        B("robot.do", {}, {"robot": held("v1"), "posture": held("v2")}),
        put("v2", word),
        B("robot.do", {}, {"robot": held("v1"), "posture": held("v2")}),
        put("v3", B("robot_senses.is_in", {}, {"robot": held("v1"), "posture": held("v2")})),
    )

    assert names["x"] is True


def test_a_robot_is_found_by_its_name_and_told_by_it(stage: BlockStage) -> None:
    names = play(
        put("v3", B("robot.named")),
        put("v1", "nao"),
        put("v2", "clap"),
        B("robot.play", {}, {"robot": held("v1"), "animation": held("v2")}),
        put(
            "v3",
            B(
                "text.join",
                {"item.2": " claps"},
                {"item.1": B("robot.named", {}, {"robot": held("v1")})},
            ),
        ),
    )

    assert names["x"] == "NAO claps"


def test_an_answer_may_be_a_word_that_a_variable_holds(stage: BlockStage) -> None:
    stage._answer = "Blue"
    asked = B(
        "robot_speech.ask",
        {},
        {"word.1": held("v1"), "word.2": held("v2")},
        {"do.1": [put("v3", "first")], "do.2": [put("v3", "second")]},
        {"answer": 2},
    )

    names = play(put("v1", "red"), put("v2", "blue"), asked)

    stage._answer = ""
    assert names["x"] == "second"


def test_the_words_of_the_program_are_those_of_its_language(stage: BlockStage) -> None:
    try:
        play(put("v2", "sitzen"), B("robot.do", {}, {"posture": held("v2")}), language="de")
    finally:
        speak("en")

    stage._wait(lambda: stage.states_of["NAO"][-1].posture == "Sit")


@pytest.mark.parametrize(
    ("block", "place", "word", "sentence", "near"),
    [
        ("robot.play", "animation", "wafe", "no animation", "wave"),
        ("robot.do", "posture", "posture_sitt", "no posture", "posture_sit"),
        ("robot.leds", "group", "FaceLed", "no lights", "FaceLeds"),
        ("robot_moves.release", "part", "left_arms", "no part", "left_arm"),
        ("robot_moves.open_hand", "hand", "lefft", "not known here", "left"),
        ("robot.play", "robot", "NAOO", "no robot called", "NAO"),
    ],
)
def test_a_word_that_the_robot_does_not_know_is_told_at_once(
    stage: BlockStage, block: str, place: str, word: str, sentence: str, near: str
) -> None:
    with pytest.raises(NepError) as refused:
        play(put("v2", word), B(block, {}, {place: held("v2")}))

    assert sentence in str(refused.value.sentence)
    assert f"Did you mean “{near}”?" in [str(step) for step in refused.value.checklist]
