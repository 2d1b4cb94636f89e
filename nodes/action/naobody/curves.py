"""The curves that joints follow: minimum jerk between two poses, cubic Bezier through keys."""

from __future__ import annotations

import math

import numpy as np

from nodes.action.naobody.body import Angles
from nodes.action.naobody.keyframes import Handle, Track

MINIMUM_JERK_PEAK = 1.875
"""Peak speed of a minimum-jerk movement, as a multiple of its mean speed (15/8)."""

BISECTIONS = 40
LONGEST_HANDLE = 0.5
"""As a part of the time between two keys."""


def minimum_jerk(s: Angles) -> Angles:
    """Return how far a smooth movement is, 0 to 1, at the part ``s`` (0 to 1) of its time.

    Source: T. Flash and N. Hogan, The coordination of arm movements, J. Neurosci. 5, 1985.
    """
    progress: Angles = s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    return progress


def ticks(duration_s: float, tick_s: float) -> Angles:
    """Return the times of the ticks after 0, up to and with ``duration_s``."""
    count = max(1, math.ceil(duration_s / tick_s - 1e-9))
    times_s: Angles = np.minimum(np.arange(1, count + 1) * tick_s, duration_s)
    return times_s


def track_angles(track: Track, start_rad: float, times_s: Angles) -> Angles:
    """Return a joint's angles at rising times, starting from ``start_rad`` at time 0.

    The first key must be later than 0. Before and after the keys the joint holds still.
    """
    knots = np.array([0.0, *track.times])
    values = np.array([start_rad, *track.keys])
    before, after = _handles(knots, values, track.handles)
    piece = np.clip(np.searchsorted(knots, times_s, side="right") - 1, 0, len(knots) - 2)
    t = np.clip(times_s, knots[0], knots[-1])
    x = (knots[piece], (knots + after[0])[piece], (knots + before[0])[piece + 1], knots[piece + 1])
    y = (
        values[piece],
        (values + after[1])[piece],
        (values + before[1])[piece + 1],
        values[piece + 1],
    )
    return _bezier(y, _parameter(x, t))


def smooth_slopes(knots: Angles, values: Angles) -> Angles:
    """Return the slope at each key for a smooth curve that stays between neighbouring keys.

    Zero at both ends and at turning points. Source: F. N. Fritsch and J. Butland, A method for
    constructing local monotone piecewise cubic interpolants, SIAM J. Sci. Stat. Comput. 5, 1984.
    """
    steps = np.diff(knots)
    rises = np.diff(values) / steps
    slopes = np.zeros(len(knots))
    left, right = rises[:-1], rises[1:]
    same_way = left * right > 0.0
    left_weight = (2.0 * steps[1:] + steps[:-1])[same_way]
    right_weight = (steps[1:] + 2.0 * steps[:-1])[same_way]
    slopes[1:-1][same_way] = (left_weight + right_weight) / (
        left_weight / left[same_way] + right_weight / right[same_way]
    )
    return slopes


def _handles(
    knots: Angles, values: Angles, chosen: tuple[Handle, ...] | None
) -> tuple[Angles, Angles]:
    """Return the (time, angle) offsets of the handles before and after each key: (2, keys) each."""
    steps = np.diff(knots)
    slopes = smooth_slopes(knots, values)
    before = np.vstack([np.append(0.0, -steps / 3.0)] * 2)
    after = np.vstack([np.append(steps / 3.0, 0.0)] * 2)
    before[1] *= slopes
    after[1] *= slopes
    if chosen is not None:
        offsets = np.array(chosen).T
        before[:, 1:] = _shortened(offsets[0:2] * [[-1.0], [1.0]], steps) * [[-1.0], [1.0]]
        after[:, 1:] = _shortened(offsets[2:4], np.append(steps[1:], 0.0))
    return before, after


def _shortened(handles: Angles, steps: Angles) -> Angles:
    """Return handles (time and angle) that last from 0 to half of the step to the next key.

    Longer ones would make the curve nearly jump, or go back in time. The slope stays.
    """
    longest = np.clip(handles[0], 0.0, LONGEST_HANDLE * steps)
    part = np.divide(longest, handles[0], out=np.zeros_like(longest), where=handles[0] != 0.0)
    flat = (handles[0] == 0.0) & (steps > 0.0)
    return np.vstack([longest, handles[1] * np.where(flat, 1.0, part)])


def _parameter(x: tuple[Angles, Angles, Angles, Angles], t: Angles) -> Angles:
    """Return where on each Bezier piece (0 to 1) its time is ``t``, by bisection."""
    low, high = np.zeros_like(t), np.ones_like(t)
    for _ in range(BISECTIONS):
        middle = (low + high) / 2.0
        early = _bezier(x, middle) < t
        low, high = np.where(early, middle, low), np.where(early, high, middle)
    return (low + high) / 2.0


def _bezier(points: tuple[Angles, Angles, Angles, Angles], u: Angles) -> Angles:
    a, b, c, d = points
    v = 1.0 - u
    return v**3 * a + 3.0 * v**2 * u * b + 3.0 * v * u**2 * c + u**3 * d
