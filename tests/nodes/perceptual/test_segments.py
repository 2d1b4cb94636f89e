"""Movements found by themselves in streams: of real people, of simulated ones, and made up."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nodes.perceptual.recognition.segments import (
    LONGEST_S,
    Movement,
    MovementFinder,
    PerformanceFinder,
    energy_of,
)
from nodes.recordings import Recording, read_recording

pytestmark = pytest.mark.long

RATE_HZ = 50.0


def found_by(
    finder: MovementFinder | PerformanceFinder,
    t: np.ndarray,
    acc: np.ndarray,
    gyr: np.ndarray | None,
) -> list[Movement]:
    """What is found in a recording, as it would be while it is made."""
    found: list[Movement] = []
    step = max(1, round(0.1 / np.median(np.diff(t)))) if len(t) > 1 else 1
    for at in range(0, len(t), step):
        part = slice(at, at + step)
        found += finder.hear(t[part], acc[part], None if gyr is None else gyr[part])
    return found + finder.finish()


def signal(*parts: tuple[float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Stretches of (seconds, strength): at 0 the hand is still, else it goes to and fro."""
    chance, acc = np.random.default_rng(0), []
    for seconds, strength in parts:
        t = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
        wave = strength * np.sin(2 * np.pi * 2.5 * t)
        acc.append(np.stack([wave, wave / 2, 9.81 + 0 * t], axis=1))
    whole = np.concatenate(acc) + chance.normal(0, 0.03, (sum(map(len, acc)), 3))
    return np.arange(len(whole)) / RATE_HZ, whole, np.abs(whole - np.array([0, 0, 9.81])) / 4


def marked(recording: Recording) -> list[tuple[float, float]]:
    """From when to when the file says that a gesture is made."""
    is_made = np.array([bool(label) for label in recording.labels or []], dtype=int)
    edges = np.diff(np.concatenate([[0], is_made, [0]]))
    firsts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1) - 1
    return [(recording.t[a], recording.t[b]) for a, b in zip(firsts, ends, strict=True)]


def overlap(made: tuple[float, float], found: Movement) -> float:
    """How much of both together is in both."""
    both = min(made[1], found.end_s) - max(made[0], found.start_s)
    return max(0.0, both) / (max(made[1], found.end_s) - min(made[0], found.start_s))


@pytest.mark.parametrize("person", ["j", "l", "na"])
def test_the_gestures_of_real_people_are_found_with_sensible_borders(
    person: str, shared_data: Path
) -> None:
    made, found, others = 0, 0, 0
    for path in sorted((shared_data / "uhh_gestures").glob(f"{person}_*.csv")):
        recording = read_recording(path)
        movements = found_by(MovementFinder(), recording.t, recording.acc, recording.gyr)
        good = [one for one in movements if not one.fault]
        spans = marked(recording)
        made += len(spans)
        found += sum(max((overlap(span, one) for one in good), default=0) >= 0.5 for span in spans)
        others += sum(max(overlap(span, one) for span in spans) < 0.2 for one in good)

    assert found >= 0.95 * made
    assert others <= 2


def test_each_movement_is_told_once_it_is_over() -> None:
    t, acc, gyr = signal((1.5, 0), (0.8, 8), (1.5, 0), (0.8, 8), (1.5, 0))
    finder, told = MovementFinder(), []

    step = max(1, round(0.1 / np.median(np.diff(t)))) if len(t) > 1 else 1
    for at in range(0, len(t), step):
        part = slice(at, at + step)
        told += [(t[at], one) for one in finder.hear(t[part], acc[part], gyr[part])]

    assert len(told) == 2
    assert [one.fault for _, one in told] == ["", ""]
    assert all(one.end_s < when < one.end_s + 1.2 for when, one in told)


def test_a_short_pause_is_part_of_a_movement() -> None:
    movements = found_by(
        MovementFinder(), *signal((1.5, 0), (0.6, 8), (0.2, 0), (0.6, 8), (1.5, 0))
    )

    assert [round(one.duration_s, 1) for one in movements] == [pytest.approx(1.4, abs=0.4)]


def test_what_is_wrong_with_a_movement_is_said() -> None:
    normal = [(0.8, 9.0), (1.5, 0.0)] * 3
    weak = found_by(MovementFinder(), *signal((1.5, 0), *normal, (0.8, 2.2), (1.5, 0)))
    endless = found_by(MovementFinder(), *signal((1.5, 0), (LONGEST_S + 1, 9), (1.5, 0)))
    t, acc, gyr = signal((1.5, 0), (1.0, 9), (1.5, 0))
    kept = (t < 1.8) | (t > 2.3)
    cut = found_by(MovementFinder(), t[kept], acc[kept], gyr[kept])

    assert [one.fault for one in weak] == ["", "", "", "still"]
    assert [one.fault for one in endless] == ["long"]
    assert [one.fault for one in cut] == ["gap"]


def test_rest_is_no_movement_and_nothing_is_no_stream() -> None:
    t, acc, gyr = signal((20, 0))

    assert found_by(MovementFinder(), t, acc, gyr) == []
    assert found_by(MovementFinder(), t[:0], acc[:0], gyr[:0]) == []
    assert found_by(MovementFinder(), t[:1], acc[:1], None) == []


def test_without_rotation_movements_are_found_too() -> None:
    t, acc, _ = signal((1.5, 0), (0.8, 8), (1.5, 0), (0.8, 8), (1.5, 0))

    assert len(found_by(MovementFinder(), t, acc, None)) == 2


@settings(max_examples=25)
@given(
    sizes=st.lists(st.integers(1, 40), min_size=3, max_size=12),
    seed=st.integers(0, 1000),
    scale=st.sampled_from([0.0, 0.1, 5.0, 1e6]),
)
def test_any_stream_gives_movements_within_it_in_order(
    sizes: list[int], seed: int, scale: float
) -> None:
    chance, count = np.random.default_rng(seed), sum(sizes)
    t = np.cumsum(chance.uniform(0.001, 0.05, count))
    acc, gyr = chance.normal(0, scale, (count, 3)), chance.normal(0, scale, (count, 3))
    finder, found, at = MovementFinder(), [], 0

    for size in sizes:
        part = slice(at, at + size)
        found += finder.hear(t[part], acc[part], gyr[part])
        at += size
    found += finder.finish()

    assert all(t[0] <= one.start_s <= one.end_s <= t[-1] for one in found)
    assert all(a.end_s <= b.start_s for a, b in pairwise(found))
    assert np.isfinite(energy_of(t, acc, gyr)).all()
