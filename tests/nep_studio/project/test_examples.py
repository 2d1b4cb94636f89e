"""What the gallery says of the examples, and how the examples are made."""

from __future__ import annotations

import re

import pytest

from nep_core.wire.messages import HUMAN_BEHAVIOR, SENSE_REQUEST
from nep_studio.blocks.checks import check
from nep_studio.blocks.deployment import robot_entries
from nep_studio.blocks.files import load
from nep_studio.project.examples import Example, Try, examples
from nep_studio.run.installation import studio_language
from nep_studio.run.plan import VIRTUAL_WATCH, Choices, plan

EXAMPLES = examples()
MOST_BLOCKS = 50
TOLD = re.compile(r"Change first: ")


@pytest.fixture(params=EXAMPLES, ids=lambda example: example.path.stem)
def example(request: pytest.FixtureRequest) -> Example:
    return request.param


def test_there_are_examples_enough_and_each_is_told_of() -> None:
    assert len(EXAMPLES) >= 14
    assert len({each.title for each in EXAMPLES}) == len(EXAMPLES)
    assert all(str(each.sentence).endswith(".") and each.tags for each in EXAMPLES)


def test_an_example_is_short_and_nothing_in_it_has_to_be_put_right(example: Example) -> None:
    language = studio_language()
    project = load(example.path, language)

    assert check(project, language) == []
    assert project.name == example.title
    assert len(project.blocks) <= MOST_BLOCKS


def test_a_note_says_what_it_shows_and_what_to_change_first(example: Example) -> None:
    project = load(example.path, studio_language())

    notes = [note for note in project.notes.values() if note.page == "behaviour"]
    assert len(notes) == 1 and TOLD.search(notes[0].text)


def test_an_example_needs_what_it_says(example: Example) -> None:
    language = studio_language()
    project = load(example.path, language)
    nodes = plan(project, language, Choices(), example.path.parent)
    robots = robot_entries(project, language)

    assert ("watch" in example.needs) == any(node.node == VIRTUAL_WATCH for node in nodes)
    assert ("two_robots" in example.needs) == (len(robots) == 2)
    assert all(robot.driver == "virtual" for robot in robots)
    assert {"touch"} <= set(example.needs) or not any(each.is_touch for each in example.tries)


def test_what_is_tried_is_a_state_or_something_that_a_robot_notices() -> None:
    chop = Try("Make a karate chop", state="gesture_karate")
    touch = Try("Touch its head", sense="head_middle")

    assert (chop.topic, chop.message().human_state) == (HUMAN_BEHAVIOR, "gesture_karate")
    assert (touch.topic, touch.message().sense, touch.message().value) == (
        SENSE_REQUEST,
        "head_middle",
        1.0,
    )
    assert touch.is_touch and touch.release().value == 0.0
    assert not chop.is_touch


def test_each_thing_to_try_can_be_sent(example: Example) -> None:
    for each in example.tries:
        assert bool(each.state) != bool(each.sense), each
        assert each.words
