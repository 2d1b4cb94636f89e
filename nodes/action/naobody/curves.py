"""The curves that joints follow: minimum jerk between two poses, cubic Bezier through keys."""

from __future__ import annotations

import math

import numpy as np

from nodes.action.naobody.body import Angles
from nodes.action.naobody.keyframes import Handle, Track

MINIMUM_JERK_PEAK = 1.875
"""Peak speed of a minimum-jerk movement, as a multiple of its mean speed (15/8)."""

BISECTIONS = 32
SPEED_SAMPLES = 65
"""At so many points of each piece its speed is looked at."""
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


def track_angles(track: Track, start_rad: float, times_s: Angles, fastest: float) -> Angles:
    """Return a joint's angles at rising times, starting from ``start_rad`` at time 0.

    ``fastest``: the joint's top speed (rad/s), which handles are kept to; keys are not.

    The first key must be later than 0. Before and after the keys the joint holds still.
    """
    x, y = control_points(track, start_rad, fastest)
    piece = np.clip(np.searchsorted(x[0], times_s, side="right") - 1, 0, len(x[0]) - 1)
    t = np.clip(times_s, 0.0, track.times[-1])
    return _bezier(y[:, piece], _parameter(x[:, piece], t))


def peak_speed(track: Track, start_rad: float, fastest: float) -> float:
    """Return how fast (rad/s) a joint has to move to follow ``track_angles``, nearly exactly."""
    x, y = control_points(track, start_rad, fastest)
    u = np.linspace(0.0, 1.0, SPEED_SAMPLES)[:, None]
    steps_s = np.diff(_bezier(x[:, None, :], u), axis=0)
    ways = np.abs(np.diff(_bezier(y[:, None, :], u), axis=0))
    return float(np.max(ways / steps_s))


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
    left_weight, right_weight = 2.0 * steps[1:] + steps[:-1], steps[1:] + 2.0 * steps[:-1]
    above = (left_weight + right_weight) * left * right
    below = left_weight * right + right_weight * left
    slopes[1:-1] = np.divide(above, below, out=np.zeros_like(above), where=same_way)
    return slopes


def control_points(track: Track, start_rad: float, fastest: float) -> tuple[Angles, Angles]:
    """Return times and angles of the 4 control points of each Bezier piece: (4, pieces) each.

    The first piece goes from ``start_rad`` at time 0 to the first key.
    """
    knots = np.array([0.0, *track.times])
    values = np.array([start_rad, *track.keys])
    before, after = _handles(knots, values, track.handles, fastest)
    x = np.vstack([knots[:-1], (knots + after[0])[:-1], (knots + before[0])[1:], knots[1:]])
    y = np.vstack([values[:-1], (values + after[1])[:-1], (values + before[1])[1:], values[1:]])
    return x, y


def _handles(
    knots: Angles, values: Angles, chosen: tuple[Handle, ...] | None, fastest: float
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
        flip = np.array([[-1.0], [1.0]])
        before[:, 1:] = _possible(flip * offsets[0:2], steps, fastest) * flip
        after[:, 1:] = _possible(offsets[2:4], np.append(steps[1:], 0.0), fastest)
    return before, after


def _possible(handles: Angles, steps: Angles, fastest: float) -> Angles:
    """Return handles (time and angle) whose curve a joint with a top speed can nearly follow.

    They last from 0 to half of the step to the next key: longer ones would make the curve jump,
    or go back in time.
    """
    times = np.maximum(handles[0], 0.0)
    shorter = np.minimum(times, LONGEST_HANDLE * steps)
    part = np.divide(shorter, times, out=np.zeros_like(times), where=times > 0.0)
    angles = np.clip(handles[1], -fastest * times, fastest * times)
    return np.vstack([shorter, part * angles])


def _parameter(x: Angles, t: Angles) -> Angles:
    """Return where on each Bezier piece (0 to 1) its time is ``t``, by bisection."""
    powers = _powers(x)
    u, step = np.full_like(t, 0.5), 0.25
    for _ in range(BISECTIONS):
        u += np.where(_polynomial(powers, u) < t, step, -step)
        step /= 2.0
    return u


def _bezier(points: Angles, u: Angles) -> Angles:
    return _polynomial(_powers(points), u)


def _powers(points: Angles) -> Angles:
    """Return the factors of 1, u, u² and u³ in Bezier curves; (4, ...) as their points."""
    a, b, c, d = points
    return np.array([a, 3.0 * (b - a), 3.0 * (a - 2.0 * b + c), d - a + 3.0 * (b - c)])


def _polynomial(powers: Angles, u: Angles) -> Angles:
    a, b, c, d = powers
    curve: Angles = ((d * u + c) * u + b) * u + a
    return curve
