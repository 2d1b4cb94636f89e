"""A simulated person who also makes recorded gestures, led over to and back without a jump."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from nodes.sensory.arm.gestures import Gesture
from nodes.sensory.arm.live import MOST_WAITING, LivePerson
from nodes.sensory.arm.motion import minimum_jerk
from nodes.sensory.arm.performer import Samples
from nodes.sensory.arm.sensor import GRAVITY_M_S2
from nodes.sensory.arm.skeleton import Floats
from nodes.sensory.own_takes import Movement, OwnGesture, RecordedTake

LEAD_S = 0.9
"""How long the watch takes from what it felt before to a recorded take, and back."""
_PACE, _REACH = 0.06, 0.08  # how much performances of the same take differ
_WARP = 0.15  # how much faster one half of a take may go, the other slower
_RAMP_S = 0.25  # what the recording lacks before and after a take fades out so quickly
_GRAVITY_S = 0.4


class Wearer:
    """Somebody who wears the watch: makes one gesture after the other, else something calm.

    The same person, rate, seed and requests give the same samples.
    """

    def __init__(self, person: int, rate_hz: float, seed: int, start_s: float = 0.0) -> None:
        self._person = LivePerson(person, rate_hz, seed, start_s)
        self._rate_hz = rate_hz
        self._chance = np.random.default_rng([6, person, seed])
        self._waiting: deque[Movement] = deque()
        self._left: dict[str, list[int]] = {}
        self._up = _Gravity(rate_hz)
        self._playing: _Performance | None = None

    @property
    def number(self) -> int:
        """Which person it is."""
        return self._person.number

    @property
    def now_s(self) -> float:
        """The time of the next sample, by the watch's clock."""
        return self._person.now_s

    @property
    def is_busy(self) -> bool:
        """Whether a gesture is under way (or the way to it) or waits."""
        return bool(self._waiting) or self._playing is not None or self._person.is_busy

    def ask(self, gesture: Movement) -> bool:
        """Make this gesture at once, or after those under way; False when too many wait."""
        if isinstance(gesture, Gesture) and not self._waiting and self._playing is None:
            return self._person.ask(gesture)
        if len(self._waiting) >= MOST_WAITING:
            return False
        self._waiting.append(gesture)
        self._begin_next()
        return True

    def samples(self, count: int) -> Samples:
        """The next samples, 1 or more."""
        self._begin_next()
        felt = self._person.samples(count)
        up = self._up.follow(felt.acc)
        if self._playing is None:
            return felt
        made = self._playing.over(felt, up)
        if self._playing.is_over:
            self._playing = None
        return made

    def _begin_next(self) -> None:
        """Begin what waits, when nothing is under way."""
        while self._waiting and self._playing is None and not self._person.is_busy:
            gesture = self._waiting.popleft()
            if isinstance(gesture, Gesture):
                self._person.ask(gesture)
            else:
                take = gesture.takes[self._choose(gesture)]
                self._playing = _Performance(
                    gesture.name, take, self._rate_hz, self._up.now, self._chance
                )

    def _choose(self, gesture: OwnGesture) -> int:
        """A take that was not made since all others were."""
        if not self._left.get(gesture.name):
            self._left[gesture.name] = self._chance.permutation(len(gesture.takes)).tolist()
        return self._left[gesture.name].pop()


class _Gravity:
    """Which part of what the watch feels is gravity, followed sample by sample."""

    def __init__(self, rate_hz: float) -> None:
        self.now = np.array([0.0, 0.0, GRAVITY_M_S2])
        self._is_new = True
        self._part = 1 - np.exp(-1 / (_GRAVITY_S * rate_hz))

    def follow(self, acc: Floats) -> Floats:
        """The gravity in n samples (n, 3); (n, 3)."""
        if self._is_new:
            self.now, self._is_new = acc[0].copy(), False
        up = np.empty_like(acc)
        for at, sample in enumerate(acc):
            self.now = self.now + self._part * (sample - self.now)
            up[at] = self.now
        return up


@dataclass
class _Made:
    """What a recorded take makes the watch feel, n samples from the lead-in to the lead-out."""

    moving: Floats
    up: Floats
    gyr: Floats
    weight: Floats  # 0 is all simulated, 1 all recorded
    change_hz: Floats  # of the weight


class _Performance:
    """A recorded take as it is made this once: a little faster or slower, larger or smaller."""

    def __init__(
        self, name: str, take: RecordedTake, rate_hz: float, up: Floats, chance: np.random.Generator
    ) -> None:
        self._name = name
        self._at = 0
        pace = float(np.clip(chance.normal(1.0, _PACE), 0.85, 1.18))
        reach = float(np.clip(chance.normal(1.0, _REACH), 0.8, 1.25))
        warp = float(chance.uniform(-_WARP, _WARP))
        lasts_s = take.duration_s / pace
        count = int((lasts_s + 2 * LEAD_S) * rate_hz)
        t = np.arange(count) / rate_hz - LEAD_S
        self._is_made = (t >= 0) & (t < lasts_s)
        self._made = _perform(take, t, pace, reach, warp, up)
        self._made.weight = minimum_jerk((t + LEAD_S) / LEAD_S)
        self._made.weight *= minimum_jerk((lasts_s + LEAD_S - t) / LEAD_S)
        self._made.change_hz = np.gradient(self._made.weight, 1 / rate_hz)

    @property
    def is_over(self) -> bool:
        """Whether the watch feels only what is simulated again."""
        return self._at >= len(self._made.weight)

    def over(self, felt: Samples, up: Floats) -> Samples:
        """The next samples: what is simulated, and its gravity (n, 3), led over to the take."""
        count = min(len(felt.t), len(self._made.weight) - self._at)
        part, here = slice(self._at, self._at + count), slice(0, count)
        self._at += count
        acc, gyr = felt.acc.copy(), felt.gyr.copy()
        weight, made = self._made.weight[part, None], self._made
        gravity, turn = _led_over(up[here], made.up[part], made.weight[part], made.change_hz[part])
        moving = (felt.acc - up)[here] * (1 - weight) + made.moving[part] * weight
        acc[here] = moving + gravity
        gyr[here] = felt.gyr[here] * (1 - weight) + made.gyr[part] * weight + turn
        is_made = self._is_made[part]
        labels = [self._name if one else "" for one in is_made.tolist()] + felt.labels[count:]
        return Samples(felt.t, acc, gyr, labels)


def _perform(
    take: RecordedTake, t: Floats, pace: float, reach: float, warp: float, up: Floats
) -> _Made:
    """A take at times of its performance (n,), at a pace, with a reach, its middle shifted."""
    duration_s = take.duration_s
    within = np.clip(t * pace / duration_s, 0.0, 1.0)
    recorded_s = t * pace + warp * duration_s * (1 - np.cos(2 * np.pi * within)) / (2 * np.pi)
    speed = pace * (1 + warp * np.sin(2 * np.pi * within))
    there = _fading(recorded_s, take.t[0], take.t[-1])
    moving = _at(recorded_s, take.t, take.moving) * (reach * speed**2 * there)[:, None]
    gyr = _at(recorded_s, take.t, take.gyr) * (speed * there)[:, None]
    if take.up is None:
        gravity = _turned_along(up, gyr, float(t[1] - t[0]))
    else:
        gravity = _at(recorded_s, take.t, take.up)
    return _Made(moving, gravity, gyr, np.empty(0), np.empty(0))


def _at(times_s: Floats, t: Floats, values: Floats) -> Floats:
    return np.column_stack([np.interp(times_s, t, column) for column in values.T])


def _fading(times_s: Floats, first_s: float, last_s: float) -> Floats:
    """1 where there is a recording, and smoothly 0 before and after it; (n,)."""
    outside_s = np.maximum(np.maximum(first_s - times_s, times_s - last_s), 0.0)
    fading: Floats = 1 - minimum_jerk(outside_s / _RAMP_S)
    return fading


def _turned_along(up: Floats, gyr: Floats, step_s: float) -> Floats:
    """Where gravity goes from ``up`` (3,) on while the watch turns at ``gyr`` (n, 3); (n, 3)."""
    size = float(np.linalg.norm(up))
    path = np.empty_like(gyr)
    now = up.copy()
    for at, turning in enumerate(gyr):
        now = now + step_s * np.cross(now, turning)
        now *= size / max(float(np.linalg.norm(now)), 1e-9)
        path[at] = now
    return path


def _led_over(
    start: Floats, goal: Floats, weight: Floats, change_hz: Floats
) -> tuple[Floats, Floats]:
    """Gravity on the way from one (n, 3) to another (n, 3), and the turning that this takes.

    The watch turns about the axis between them; where ``weight`` (n,) is 0 or 1, nothing is added.
    """
    sizes = [np.maximum(np.linalg.norm(one, axis=1), 1e-9) for one in (start, goal)]
    one, other = start / sizes[0][:, None], goal / sizes[1][:, None]
    axis = np.cross(one, other)
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, np.einsum("ni,ni->n", one, other))
    axis = np.where(sine[:, None] > 1e-6, axis / np.maximum(sine, 1e-6)[:, None], _across(one))
    part = (angle * weight)[:, None]
    unit = one * np.cos(part) + np.cross(axis, one) * np.sin(part)
    size = sizes[0] * (1 - weight) + sizes[1] * weight
    turning = -axis * (angle * change_hz)[:, None]
    return unit * size[:, None], turning


def _across(unit: Floats) -> Floats:
    """A direction at a right angle to each (n, 3)."""
    least = np.eye(3)[np.abs(unit).argmin(axis=1)]
    across = np.cross(unit, least)
    normal: Floats = across / np.linalg.norm(across, axis=1, keepdims=True)
    return normal
