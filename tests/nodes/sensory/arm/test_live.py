"""A simulated person in real time."""

import numpy as np
import pytest

from nodes.sensory.arm.gestures import gesture_named
from nodes.sensory.arm.people import MOST_WAITING, LivePerson

pytestmark = pytest.mark.long

KARATE, KATANA = gesture_named("karate"), gesture_named("katana")


def lived(person, seconds, batch=2):
    parts = [person.samples(batch) for _ in range(int(seconds * 50 / batch))]
    labels = [label for part in parts for label in part.labels]
    return np.concatenate([part.acc for part in parts]), labels


def test_a_gesture_that_is_asked_for_begins_within_two_seconds():
    person = LivePerson(103, 50, seed=0)
    lived(person, 5)

    person.ask(KARATE)
    _acc, labels = lived(person, 2)

    assert "karate" in labels


def test_everyday_movement_flows_into_the_gesture_without_a_spike():
    for seed in range(12):
        person = LivePerson(103, 50, seed=seed)
        before, _ = lived(person, 4 + seed / 3)
        person.ask(KARATE)
        after, _ = lived(person, 1.0)  # the way to the ready pose, no gesture yet

        acc = np.concatenate([before, after])
        assert np.abs(np.diff(acc, axis=0)).max() < 6


def test_a_second_gesture_waits_until_the_first_is_made():
    person = LivePerson(103, 50, seed=0)

    person.ask(KATANA)
    lived(person, 1.5)
    person.ask(KARATE)
    _acc, labels = lived(person, 10)

    made = [label for label, before in zip(labels[1:], labels, strict=False) if label != before]
    assert [label for label in made if label] == ["katana", "karate"]


def test_nobody_makes_gestures_that_were_not_asked_for():
    _acc, labels = lived(LivePerson(103, 50, seed=2), 60)

    assert set(labels) == {""}


def test_more_gestures_than_can_wait_are_refused():
    person = LivePerson(103, 50, seed=0)

    asked = [person.ask(KARATE) for _ in range(MOST_WAITING + 1)]

    assert asked == [True] * MOST_WAITING + [False]
