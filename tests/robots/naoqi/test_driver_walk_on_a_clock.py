"""A robot that walks freely stands soon when nothing more is heard, in its own time."""

from __future__ import annotations

import numpy as np
import pytest
from walk_on_a_clock import ClockedWalk


@pytest.mark.parametrize(
    ("latency_s", "speeds"), [(0.0005, {"forward": 1.0}), (0.02, {"forward": 0.3, "turn": -1.0})]
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
