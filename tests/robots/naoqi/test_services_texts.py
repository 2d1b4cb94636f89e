"""Text with tags and instructions, paths of animations, and arguments of every shape."""

from __future__ import annotations

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from naoqi_theatre import ANIMATIONS, BODY, NAO

from robots.body.pose import VirtualRobot
from robots.naoqi.services.animations import load_animation_names
from robots.naoqi.services.arguments import joints_of, lists, numbers
from robots.naoqi.services.speech import Instruction, Pause, Voice, Words, read_text
from robots.naoqi.wire.errors import CallFailed

USUAL = Voice()


def test_words_between_instructions_are_said_apart() -> None:
    parts = read_text(
        "Hello ^start(Gestures/Hey_1) you ^waitTag(hello) bye", USUAL, with_instructions=True
    )

    assert parts == [
        Words("Hello", USUAL),
        Instruction("start", "Gestures/Hey_1"),
        Words("you", USUAL),
        Instruction("wait", "hello", is_tag=True),
        Words("bye", USUAL),
    ]


def test_the_voice_changes_from_a_tag_on_and_is_reset() -> None:
    parts = read_text(
        r"\rspd=80\slow \vct=150\ high \rst\ usual", Voice(90.0, 100.0), with_instructions=True
    )

    assert parts == [
        Words("slow", Voice(80.0, 100.0)),
        Words("high", Voice(80.0, 150.0)),
        Words("usual", Voice(90.0, 100.0)),
    ]


def test_a_pause_is_a_silence_and_unknown_tags_are_left_out() -> None:
    parts = read_text(r"\\pau=500\\ Hello \style=joyful\ you", USUAL, with_instructions=False)

    assert parts == [Pause(0.5), Words("Hello", USUAL), Words("you", USUAL)]


def test_plain_speech_has_no_instructions() -> None:
    parts = read_text("2 ^run(3) is 8", USUAL, with_instructions=False)

    assert parts == [Words("2 ^run(3) is 8", USUAL)]


@given(st.text(max_size=200))
def test_any_text_can_be_read(text: str) -> None:
    for part in read_text(text, USUAL, with_instructions=True):
        if isinstance(part, Words):
            assert 50.0 <= part.voice.speed <= 200.0
            assert part.text.strip()


def test_every_animation_of_the_table_is_one_of_ours() -> None:
    names = load_animation_names(NAO)
    robot = VirtualRobot("NAO", BODY, ANIMATIONS)

    unknown = {
        path
        for path in [*names.paths(ANIMATIONS), *(p for tag in names.tags.values() for p in tag)]
        if names.name_of(path, robot) not in ANIMATIONS.names()
    }

    assert unknown == set()


def test_the_table_names_only_animations_that_there_are() -> None:
    names = load_animation_names(NAO)

    assert set(names.animations.values()) - set(ANIMATIONS.names()) == set()


def test_a_folder_without_a_table_knows_its_own_animations(tmp_path) -> None:
    names = load_animation_names(tmp_path)

    assert names.name_of("animations/Stand/NEP/wave", VirtualRobot("NAO", BODY, ANIMATIONS)) == (
        "wave"
    )


@pytest.mark.parametrize(
    ("value", "count", "expected"),
    [
        (1, 2, [[1.0], [1.0]]),
        ([1.0, 2.0], 1, [[1.0, 2.0]]),
        ([1.0, 2.0], 2, [[1.0], [2.0]]),
        ([[1.0, 2.0], [3.0]], 2, [[1.0, 2.0], [3.0]]),
        ([[1.0, 2.0]], 2, [[1.0, 2.0], [1.0, 2.0]]),
        ([1.0, [2.0, 3.0]], 2, [[1.0], [2.0, 3.0]]),
    ],
)
def test_numbers_become_a_list_for_each_joint(
    value: object, count: int, expected: list[list[float]]
) -> None:
    assert lists(value, count, "lists") == expected


def test_one_number_stands_for_all_joints() -> None:
    assert numbers(0.5, 3, "angles") == [0.5, 0.5, 0.5]
    assert numbers([0.5], 3, "angles") == [0.5, 0.5, 0.5]


def test_chains_and_groups_mean_their_joints() -> None:
    assert joints_of(BODY, "Head") == ["HeadYaw", "HeadPitch"]
    assert joints_of(BODY, ["LHand", "Head"]) == ["LHand", "HeadYaw", "HeadPitch"]
    assert joints_of(BODY, "Body") == list(BODY.names)
    assert len(joints_of(BODY, "LArm")) == 6


@given(st.recursive(st.none() | st.booleans() | st.floats() | st.text(), st.lists, max_leaves=8))
def test_any_value_is_read_or_refused_in_words(value: object) -> None:
    for read in (lambda: lists(value, 2, "lists"), lambda: joints_of(BODY, value)):
        try:
            read()
        except CallFailed as refused:
            assert str(refused.sentence).endswith(".")


@pytest.mark.parametrize("piece", ["\\", "^start(", "\\a=", "^mode("])
def test_a_text_of_nothing_but_beginnings_is_read_at_once(piece: str) -> None:
    text, began_s = piece * (60_000 // len(piece)), time.process_time()

    read_text(text, Voice(), with_instructions=True)

    assert time.process_time() - began_s < 0.5  # it took 10 s and more, with the robot held
