"""Movements as a few key angles and their times, as in Choregraphe and NAOqi."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .body import Angles

Handle = tuple[float, float, float, float]
"""A Bezier key's two handles: time (s) and angle (rad) before the key, time and angle after it."""

SHORTEST_STEP_S = 0.01
"""Keys of a joint are at least so far apart, and the first is so late."""
LARGEST = 1e12
"""Times (s) and angles (rad) beyond this are as good as infinite."""


@dataclass(frozen=True)
class Track:
    """One joint's keys: times (s, rising), angles (rad), and Bezier handles where there are any.

    Without handles the curve is smooth and never goes beyond its keys.
    """

    times: tuple[float, ...]
    keys: tuple[float, ...]
    handles: tuple[Handle, ...] | None = None

    def retimed(self, time: Callable[[float], float], factor: float = 1.0) -> Track:
        """Return this track with every time changed, and the handles' times multiplied."""
        handles = self.handles and tuple(
            (before * factor, angle_before, after * factor, angle_after)
            for before, angle_before, after, angle_after in self.handles
        )
        return Track(tuple(time(t) for t in self.times), self.keys, handles or None)

    def negated(self) -> Track:
        """Return this track turning the other way."""
        handles = self.handles and tuple((b, -db, a, -da) for b, db, a, da in self.handles)
        return Track(self.times, tuple(-key for key in self.keys), handles or None)

    def reversed(self, end_s: float) -> Track:
        """Return this track played from ``end_s`` back to 0."""
        handles = self.handles and tuple((-a, da, -b, db) for b, db, a, da in self.handles[::-1])
        times = tuple(end_s - t for t in self.times[::-1])
        return Track(times, self.keys[::-1], handles or None)

    def then(self, later: Track) -> Track:
        """Return this track followed by another one, which has handles if this one has."""
        handles = self.handles and later.handles and self.handles + later.handles
        return Track(self.times + later.times, self.keys + later.keys, handles or None)


def problem_of(track: Track) -> str:
    """Return why a joint cannot follow a track, or nothing."""
    if not track.keys or len(track.keys) != len(track.times):
        return f"{len(track.times)} times for {len(track.keys)} keys"
    if track.handles is not None and len(track.handles) != len(track.keys):
        return f"{len(track.handles)} handles for {len(track.keys)} keys"
    numbers = (*track.times, *track.keys, *(n for handle in track.handles or () for n in handle))
    if not all(abs(number) <= LARGEST for number in numbers):
        return "a number is infinite or not a number"
    if any(late - early < SHORTEST_STEP_S - 1e-9 for early, late in pairwise((0.0, *track.times))):
        return f"every time must be at least {SHORTEST_STEP_S} s after the one before it, or 0"
    return ""


@dataclass(frozen=True)
class Keyframes:
    """Tracks by joint name, all on one clock that starts at 0."""

    tracks: dict[str, Track]

    @property
    def duration_s(self) -> float:
        """When the last key is reached."""
        return max((track.times[-1] for track in self.tracks.values()), default=0.0)

    @property
    def first_key_s(self) -> float:
        """When the first key is reached."""
        return min((track.times[0] for track in self.tracks.values()), default=0.0)

    def mirrored(self) -> Keyframes:
        """Return the movement as seen in a mirror: left is right and right is left."""
        tracks = {}
        for name, track in self.tracks.items():
            other = {"L": "R", "R": "L"}.get(name[0], name[0]) + name[1:]
            tracks[other] = track.negated() if _turns_sideways(name) else track
        return Keyframes(tracks)

    def reversed(self) -> Keyframes:
        """Return the movement from its last key back to its first."""
        end_s = self.duration_s
        return Keyframes({name: track.reversed(end_s) for name, track in self.tracks.items()})

    def stretched(self, factor: float) -> Keyframes:
        """Return the movement ``factor`` times as long."""
        return self._changed(lambda track: track.retimed(lambda t: t * factor, factor))

    def delayed(self, seconds: float) -> Keyframes:
        """Return the movement with every key ``seconds`` later."""
        return self._changed(lambda track: track.retimed(lambda t: t + seconds))

    def repeated(self, times: int) -> Keyframes:
        """Return the movement several times in a row."""
        whole = self
        for turn in range(1, times):
            later = self.delayed(turn * self.duration_s)
            whole = Keyframes({n: t.then(later.tracks[n]) for n, t in whole.tracks.items()})
        return whole

    def _changed(self, change: Callable[[Track], Track]) -> Keyframes:
        return Keyframes({name: change(track) for name, track in self.tracks.items()})


def mirror_angle(name: str, angle: float) -> float:
    """Return the angle of the joint of this name on the other side, as seen in a mirror."""
    return -angle if _turns_sideways(name) else angle


def _turns_sideways(name: str) -> bool:
    return name.endswith(("Roll", "Yaw"))


# The curves that joints follow: minimum jerk between two poses, cubic Bezier through keys.

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
    return s * s * s * (10.0 - s * (15.0 - 6.0 * s))  # powers are slow


def ticks(duration_s: float, tick_s: float) -> Angles:
    """Return the times of the ticks after 0, up to and with ``duration_s``."""
    count = max(1, math.ceil(duration_s / tick_s - 1e-9))
    times_s: Angles = np.minimum(np.arange(1, count + 1) * tick_s, duration_s)
    return times_s


def track_angles(track: Track, start_rad: float, times_s: Angles, fastest: float) -> Angles:
    """Return a joint's angles at rising times, starting from ``start_rad`` at time 0.

    ``fastest``: the joint's top speed (rad/s), which handles are kept to; keys are not.

    The first key must be later than 0. Before and after the keys the joint holds still.

    ``track`` has the keys, ``times_s`` (n,) are when.
    """
    x, y = control_points(track, start_rad, fastest)
    piece = np.clip(np.searchsorted(x[0], times_s, side="right") - 1, 0, len(x[0]) - 1)
    t = np.clip(times_s, 0.0, track.times[-1])
    # Where on each Bezier piece (0 to 1) its time is ``t``, by bisection
    powers = _powers(x[:, piece])
    u, step = np.full_like(t, 0.5), 0.25
    for _ in range(BISECTIONS):
        u += np.where(_polynomial(powers, u) < t, step, -step)
        step /= 2.0
    return _bezier(y[:, piece], u)


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
