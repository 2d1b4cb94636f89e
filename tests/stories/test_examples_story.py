"""Every example plays on the virtual robot, and does what its card promises when it is tried."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from nep_studio.run.local_network import LocalNetwork
from tests.stories.example_stage import EXAMPLES, Stage, staged

pytestmark = pytest.mark.long

SLOWER = 8.0
FINISHED = "the program ends by itself"

Step = str | int | tuple[str, dict[str, object]]
"""A sentence that is said, the number of something to try, or an action that a robot does."""


def walks(forward_m: float) -> Step:
    return "walk", {"forward_m": forward_m}


GREETING = "<greeting>"
"""Stands for what fits the hour at which the example plays."""


def greeting() -> str:
    hour = time.localtime().tm_hour
    return "Good morning" if hour < 12 else "Good afternoon" if hour < 18 else "Good evening"


PLAYS: dict[str, list[Step]] = {
    "own_gestures": [
        0,
        ("play", {"animation": "wave"}),
        "Hello! I saw you from far away.",
        1,
        "Who is there? Come in.",
    ],
    "karate_greeting": [
        "Show me a karate chop!",
        0,
        "Impressive!",
        ("play", {"animation": "karate"}),
        "Thank you for the lesson, master.",
        FINISHED,
    ],
    "two_robots_talk": [
        "I am NAO2. I came with the last parcel.",
        "Question number 1. Can you dance?",
        "Question number 2. Can you dance?",
        ("play", {"animation": "bow"}),
        FINISHED,
    ],
    "theatre_sequence": [
        "Is anybody there?",
        ("play", {"animation": "dance"}),
        "The end.",
        FINISHED,
    ],
    "emotions": [
        "Show me how you feel.",
        0,
        "You look happy. That makes me happy, too.",
        1,
        "You look sad. I am here.",
        2,
        "Something made you angry. Breathe in, breathe out.",
        3,
        "Oh! What was that?",
        4,
        "All is calm.",
    ],
    "dance": [
        ("play", {"animation": "dance"}),
        ("play", {"animation": "wave", "mirror": True}),
        "Thank you for the applause.",
        FINISHED,
    ],
    "five_gestures": [
        "Do you know five gestures? I will answer each of them.",
        0,
        "Impressive!",
        1,
        "Yes, please? You have a question.",
        2,
        "That feels good. I stretch, too.",
        3,
        "A samurai! I had better hide.",
        4,
        "What a hit! Home run!",
    ],
    "imitate_animals": [
        "Lift your hand, and I will be an animal.",
        0,
        ("imitate", {"animal": "cat"}),
        0,
        ("imitate", {"animal": "elephant"}),
        0,
        ("imitate", {"animal": "crow"}),
        0,
        ("imitate", {"animal": "frog"}),
        0,
        ("imitate", {"animal": "mouse"}),
        "That was fun. Good bye!",
        FINISHED,
    ],
    "animal_story": [
        "This is the story of the elephant and the mouse.",
        0,
        "I am the biggest of all. Boom, boom.",
        0,
        "Please, look where you walk.",
        0,
        "Caw! The small one is right.",
        0,
        "The end.",
        FINISHED,
    ],
    "theatre_cues": [
        "I am ready backstage.",
        0,
        "Good evening. I have come from far away.",
        1,
        "What a storm! Hold on to your hats!",
        3,
        ("do", {"posture": "posture_sit"}),
        2,
        "The storm is over, and so is our play.",
        FINISHED,
    ],
    "quiz": [
        "Touch my head when you are ready for my quiz.",
        0,
        "How many legs does a spider have?",
        1,
        "Eight is right.",
        2,
        "Yes, the cat.",
        3,
        "Yes, we are at home.",
        "All three right! You know more than I do.",
    ],
    "quiz_table": [
        "Touch my head to begin the quiz.",
        0,
        "What is the capital of France?",
        1,
        ("play", {"animation": "clap"}),
        "How many days are in a week?",
        2,
        ("play", {"animation": "clap"}),
        "What colour is a ripe banana?",
        3,
        ("play", {"animation": "clap"}),
        "You have 3 of 3 points.",
        "Nobody was better until now.",
    ],
    "reception": [
        ("do", {"posture": "posture_sit"}),
        0,
        "I am only resting.",
        ("do", {"posture": "posture_sit"}),
        1,
        "Welcome! Touch my head if you have a question.",
        ("leds", {"colour": "#30c060"}),
        0,
        "The rooms are upstairs, and we are open until six.",
        "Do you have another question?",
        ("leds", {"colour": "#30c060"}),
        0,
        "The rooms are upstairs, and we are open until six.",
    ],
    "follow_me": [
        "I will follow you. Touch my head to stop me.",
        0,
        walks(0.2),
        1,
        walks(-0.1),
        3,
        "I stay here now.",
        FINISHED,
    ],
    "museum_coach": [
        "I am the coach of this museum.",
        0,
        "Welcome! Shall we move a little? Stretch up, or lift your hand.",
        1,
        "That makes 1 of three.",
        2,
        "That makes 2 of three.",
        1,
        "Three exercises! You are fit for the whole museum.",
    ],
    "morning_greeter": [
        "I look out for people.",
        0,
        f"{GREETING}, anna. Have a good day.",
        1,
        0,
        "Nice to see you again, anna.",
        1,
        2,
        f"{GREETING}. I am NAO.",
    ],
    "interrupted_guide": [
        "I am your guide. Come in front of me to begin.",
        0,
        "On this side you see the oldest picture.",
        1,
        "Are you looking for the exit?",
        2,
        "It is over there.",
        "Where were we? I go on.",
        "On this side you see the oldest picture.",
        "And before you stands the most modern guide.",
        "That was my tour. Thank you.",
    ],
    "count_visitors": [
        "I count who comes.",
        0,
        "You are visitor number 1.",
        1,
        0,
        "You are visitor number 2.",
        2,
        "2 visitors came.",
        "The nearest was 100 centimetres away.",
    ],
    "own_blocks": [
        "Hello, Anna.",
        ("play", {"animation": "wave"}),
        "Hello, Ben.",
        "I am 36 months old.",
        FINISHED,
    ],
}


@pytest.fixture(scope="module")
def network(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LocalNetwork]:
    """One network for all examples."""
    made = LocalNetwork(logs=tmp_path_factory.mktemp("logs"))
    made.open()
    yield made
    made.close()


def take(step: Step, stage: Stage) -> None:
    if step == FINISHED:
        stage.sees_end()
    elif isinstance(step, str):
        stage.sees("say", text=step.replace(GREETING, greeting()))
    elif isinstance(step, int):
        stage.tries(step)
    else:
        stage.sees(step[0], **step[1])


@pytest.mark.parametrize("name", [name for name in PLAYS if name != "interrupted_guide"])
def test_an_example_plays(name: str, tmp_path: Path, network: LocalNetwork) -> None:
    with staged(name, tmp_path, network) as stage:
        for step in PLAYS[name]:
            take(step, stage)


def test_a_touch_interrupts_the_guide_who_then_goes_on_where_it_was(
    tmp_path: Path, network: LocalNetwork
) -> None:
    with staged("interrupted_guide", tmp_path, network, SLOWER) as stage:
        stage.may_interrupt = True
        for step in PLAYS["interrupted_guide"]:
            take(step, stage)


def test_the_touch_game_counts_what_is_touched_in_time(
    tmp_path: Path, network: LocalNetwork
) -> None:
    parts = {"Touch my head.": 0, "Touch my left hand.": 1, "Touch my right foot.": 2}

    with staged("touch_game", tmp_path, network) as stage:
        stage.sees("say", text="Be quick, and touch what I name.")
        for _ in range(3):
            asked = stage.sees("say")
            stage.tries(parts[asked.args["text"]])
            stage.sees("say", text="Yes!")

        stage.sees("say", text="You have 3 points.")
        stage.sees_end()


def test_all_examples_are_played() -> None:
    assert set(PLAYS) | {"touch_game"} == set(EXAMPLES)
