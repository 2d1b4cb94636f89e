"""How a robot on wheels drives: all at once, speeding up and slowing down evenly."""

from __future__ import annotations

import numpy as np

from nodes.action.naobody.body import Angles
from nodes.action.naobody.curves import MINIMUM_JERK_PEAK, minimum_jerk, ticks
from nodes.action.naobody.motion import TICK_S

FASTEST = np.array([0.35, 0.35, 1.0])
"""Forward and to the left, m/s, and turning, rad/s: what looks calm."""


def plan_roll(way: Angles) -> Angles:
    """Return the base (ticks, 3) on a way of m, m and rad, relative to where it starts."""
    duration_s = float(np.max(MINIMUM_JERK_PEAK * np.abs(way) / FASTEST))
    times_s = ticks(duration_s, TICK_S)
    path: Angles = minimum_jerk(times_s / times_s[-1])[:, None] * way
    return path
