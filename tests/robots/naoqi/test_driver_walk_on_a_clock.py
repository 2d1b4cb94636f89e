"""A robot that walks freely stands soon when nothing more is heard, in its own time."""

from __future__ import annotations

import numpy as np
import pytest
from walk_on_a_clock import ClockedWalk

pytestmark = pytest.mark.long


@pytest.mark.parametrize(
    ("latency_s", "speeds"),
    [
        (0.0005, {"forward": 1.0}),
        (0.02, {"forward": 0.3, "turn": -1.0}),
        (0.1, {"forward": 1.0}),
    ],
)
def test_a_free_walk_ends_within_a_second_of_the_worst_moment(
    monkeypatch: pytest.MonkeyPatch, latency_s: float, speeds: dict[str, float]
) -> None:
    walk = ClockedWalk(monkeypatch, latency_s)
    asked_s = walk.line.asked_s["moveTo"]
    walk.begin(**speeds)
    walk.until(lambda: len(asked_s) > 4)

    walk.line.is_frozen = True  # all of a leg is still to be gone, and what was asked before it
    walks_s, gets_on_s, moves_s = walk.rests_after()
    walk.end_driver()

    pauses_s = np.diff(asked_s[1:])
    assert pauses_s == pytest.approx([0.42] * 3, abs=0.06)  # once in each step: it never stood
    assert max(walks_s, gets_on_s) < 1.0
    assert moves_s < 1.6  # until its weight is back between both feet, which stand
    assert not walk.robot.fallen


@pytest.mark.parametrize("held_up_s", np.arange(0.2, 0.6, 0.02).round(2))
def test_a_driver_that_was_held_up_asks_for_no_leg_that_comes_too_late(
    monkeypatch: pytest.MonkeyPatch, held_up_s: float
) -> None:
    walk = ClockedWalk(monkeypatch, 0.02)
    asked_s = walk.line.asked_s["moveTo"]
    walk.begin(forward=1.0)
    walk.until(lambda: len(asked_s) > 4)

    asked = len(asked_s)
    walk.hold_up_driver(walk.now_s + held_up_s)
    walk.until(lambda: len(asked_s) > asked or not walk.motion.move_is_active())
    walk.line.is_frozen = True
    walks_s, gets_on_s, _ = walk.rests_after()
    walk.end_driver()

    assert max(walks_s, gets_on_s) < 1.0
