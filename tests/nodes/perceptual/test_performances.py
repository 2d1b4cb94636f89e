"""Performances found by themselves: of real people, and of simulated ones who go back to rest."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from nodes.perceptual.recognition.segments import Movement, PerformanceFinder
from nodes.recordings import read_recording
from nodes.sensory.arm.people import perform
from tests.nodes.perceptual.test_segments import found_by, marked, overlap, signal

pytestmark = pytest.mark.long

RATE_HZ = 50.0


def session(gesture: str, person: int, count: int) -> tuple[np.ndarray, ...]:
    """A simulated person makes a gesture so many times, with the arm hanging in between."""
    parts = [perform(gesture, person, take) for take in range(count)]
    acc, gyr = (np.concatenate([getattr(one, name) for one in parts]) for name in ("acc", "gyr"))
    made = np.concatenate([[bool(label) for label in one.labels] for one in parts])
    return np.arange(len(acc)) / RATE_HZ, acc, gyr, made


def good(movements: list[Movement]) -> list[Movement]:
    return [one for one in movements if not one.fault]


@pytest.mark.parametrize("gesture", ["karate", "katana", "batting"])
def test_raising_the_arm_and_lowering_it_are_part_of_one_performance(gesture: str) -> None:
    t, acc, gyr, made = session(gesture, person=1, count=4)

    found = good(found_by(PerformanceFinder(), t, acc, gyr))

    assert len(found) == 4
    middles = [(one.start_s + one.end_s) / 2 for one in found]
    edges = np.flatnonzero(np.diff(np.concatenate([[0], made.astype(int), [0]]))) / RATE_HZ
    spans = list(zip(edges[::2], edges[1::2], strict=True))
    near = [any(a - 1.5 < middle < b + 1.5 for a, b in spans) for middle in middles]
    assert all(near)


@pytest.mark.parametrize("person", ["j", "l", "na"])
def test_without_gravity_each_movement_is_a_performance(person: str, shared_data: Path) -> None:
    made, found, others = 0, 0, 0
    for path in sorted((shared_data / "uhh_gestures").glob(f"{person}_*.csv"))[::3]:
        recording = read_recording(path)
        movements = good(found_by(PerformanceFinder(), recording.t, recording.acc, recording.gyr))
        spans = marked(recording)
        made += len(spans)
        found += sum(max(overlap(span, one) for one in movements) >= 0.5 for span in spans)
        others += sum(max(overlap(span, one) for span in spans) < 0.2 for one in movements)

    assert found >= 0.95 * made
    assert others <= 2


def test_a_hand_that_stays_up_has_made_its_gesture_and_lowering_it_is_none() -> None:
    t, acc, gyr = signal((2, 0), (0.8, 9), (2.5, 0), (0.8, 9), (2, 0))
    is_up = (t > 2.8) & (t < 5.4)
    acc[is_up] = acc[is_up][:, [2, 1, 0]]  # held another way: gravity is felt along x
    moves = signal((2, 0), (0.8, 9), (2, 0))
    again = [np.concatenate(parts) for parts in zip(moves[1:], (acc, gyr), strict=True)]
    whole_t = np.arange(len(again[0])) / RATE_HZ

    found = good(found_by(PerformanceFinder(), whole_t, *again))

    assert len(found) == 2
    assert found[1].end_s < 4.8 + 3.2


def test_an_hour_of_rest_takes_no_more_memory_than_a_minute() -> None:
    finder, rest = PerformanceFinder(), np.tile([0.0, 0.0, 9.81], (500, 1))

    for second in range(0, 400, 10):
        assert not finder.hear(second + np.arange(500) / RATE_HZ, rest, rest / 100)

    assert len(finder._t) < 4000
