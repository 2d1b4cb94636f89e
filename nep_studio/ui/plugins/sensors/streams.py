"""What was measured by one sensor, or heard of one field: samples over the clock on the wall."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from nep_core.wire.messages import IMU, Imu
from nep_studio.ui.ring import Floats, Ring


@dataclass(frozen=True)
class StreamKey:
    """Which stream: what is heard under a topic of one sender; ``path`` of a field, else ""."""

    topic: str
    sender: str
    path: str = ""


@dataclass(frozen=True)
class Channel:
    """One number of a stream: its name, its unit, and the group whose axis it shares."""

    name: str
    unit: str
    group: str


@dataclass(frozen=True)
class Samples:
    """n samples: ``t`` (n,) s since 1970, rising; ``values`` (channels, n), NaN at a gap."""

    t: Floats
    values: Floats

    def between(self, start_s: float, end_s: float, *, more: int = 0) -> Samples:
        """The samples from a time to another, both included, and so many more on each side."""
        first = int(np.searchsorted(self.t, start_s, side="left"))
        last = int(np.searchsorted(self.t, end_s, side="right"))
        window = slice(max(0, first - more), last + more)
        return Samples(self.t[window], self.values[:, window])

    @staticmethod
    def none(channels: int = 0) -> Samples:
        """No samples."""
        return Samples(np.empty(0), np.empty((channels, 0)))

    def copied(self) -> Samples:
        """The same in memory of its own."""
        return Samples(self.t.copy(), self.values.copy())


class Stream:
    """A ring of samples; a gap is one sample of NaN in the middle of it."""

    def __init__(self, key: StreamKey, channels: tuple[Channel, ...], capacity: int) -> None:
        self.key, self.channels = key, channels
        self._ring = Ring(1 + len(channels), capacity)

    @property
    def total(self) -> int:
        """How many samples were ever added, gaps among them."""
        return self._ring.total

    @property
    def size_bytes(self) -> int:
        """The memory that its samples take."""
        return self._ring.size_bytes

    @property
    def last_s(self) -> float:
        """When the newest sample was measured; minus infinity when there is none."""
        return float(self._ring.newest(1)[0, 0]) if len(self._ring) else -np.inf

    @property
    def first_s(self) -> float:
        """When the oldest sample that is kept was measured; infinity when there is none."""
        return float(self._ring.newest()[0, 0]) if len(self._ring) else np.inf

    def samples(self, count: int | None = None) -> Samples:
        """The newest samples, or all; a view that lives until the next ones come."""
        table = self._ring.newest(count)
        return Samples(table[0], table[1:])

    def add(self, t: Floats, values: Floats, *, is_after_gap: bool = False) -> None:
        """Add samples: ``t`` (n,) rising, ``values`` (channels, n)."""
        if is_after_gap and len(self._ring):
            middle_s = (self.last_s + float(t[0])) / 2
            gap = np.full((1 + len(self.channels), 1), np.nan)
            gap[0] = middle_s
            self._ring.append(gap)
        self._ring.append(np.vstack([t[None], values]))


# Tells when samples were measured: from a sensor's own clock to the clock on the wall.

JUMP_S = 0.5
"""Clocks that disagree more than this about one step: one of them was set anew."""
_UNNOTICED_S = 0.03
"""Messages come at uneven times; a smaller disagreement is no reason to shift samples."""
_LOOKED_BACK_S = 1.5
_ENOUGH_S = 0.5
_REAL_TIME = 0.1
"""A clock within a tenth of the wall's runs like it; a recording may be played at any speed."""


class ClockMap:
    """Maps times of one sensor to s since 1970; what it gives always rises."""

    def __init__(self) -> None:
        self._last_t = 0.0
        self._last_s = -np.inf
        self._pace = 1.0
        self._arrivals: deque[tuple[float, float]] = deque(maxlen=64)

    def to_wall(self, t: Floats, arrived_s: float) -> tuple[Floats, bool]:
        """Times of samples ``t`` (n,), n > 0, that arrived together; whether a clock jumped."""
        if not self._arrivals or self._has_jumped(t, arrived_s):
            return self._start_anew(t, arrived_s), True
        self._arrivals.append((float(t[-1]), arrived_s))
        self._set_pace(arrived_s)
        steps = t - self._last_t
        ahead_s = self._last_s + float(steps[-1]) * self._pace - arrived_s
        times = self._last_s + steps * (self._pace * self._correction(ahead_s))
        self._last_t, self._last_s = float(t[-1]), float(times[-1])
        return times, False

    def _has_jumped(self, t: Floats, arrived_s: float) -> bool:
        if t[0] <= self._last_t:
            return True
        by_wall_s = arrived_s - self._arrivals[-1][1]
        return bool(abs((t[-1] - self._last_t) * self._pace - by_wall_s) > JUMP_S)

    def _start_anew(self, t: Floats, arrived_s: float) -> Floats:
        first_s = max(arrived_s - float(t[-1] - t[0]), self._last_s + 0.001)
        times: Floats = first_s + (t - t[0])
        self._arrivals.clear()
        self._arrivals.append((float(t[-1]), arrived_s))
        self._pace = 1.0
        self._last_t, self._last_s = float(t[-1]), float(times[-1])
        return times

    def _set_pace(self, now_s: float) -> None:
        """How many s pass on the wall in one of the sensor's."""
        while self._arrivals[0][1] < now_s - _LOOKED_BACK_S and len(self._arrivals) > 2:
            self._arrivals.popleft()
        t, arrived_s = self._arrivals[0]
        if now_s - arrived_s < _ENOUGH_S or self._arrivals[-1][0] <= t:
            return
        pace = (now_s - arrived_s) / (self._arrivals[-1][0] - t)
        self._pace = 1.0 if abs(pace - 1) < _REAL_TIME else pace

    def _correction(self, ahead_s: float) -> float:
        """How much faster or slower the time of samples passes, until both clocks agree."""
        if abs(ahead_s) < _UNNOTICED_S:
            return 1.0
        return float(np.clip(1 - ahead_s / _ENOUGH_S, 0.5, 2.0))


# The stream of one watch or phone, from the batches of ``/imu``.

KEPT = 100_000
"""The newest samples that are kept: 100 s at 1,000 a second, half an hour of a watch."""

ACCELERATION, ROTATION, MAGNITUDE = "acceleration", "rotation", "magnitude"
_GAP_STEPS = 2.5
"""A longer wait than so many usual steps is a gap."""
_NAMES = ("x", "y", "z", MAGNITUDE)
_CHANNELS = (
    *(Channel(name, "m/s²", ACCELERATION) for name in _NAMES),
    *(Channel(name, "rad/s", ROTATION) for name in _NAMES),
)


def imu_key(message: Imu, sender: str) -> StreamKey:
    """The stream that a batch belongs to."""
    return StreamKey(IMU, message.source or sender)


class ImuStream(Stream):
    """What one watch or phone measures; without a gyroscope its rotation is NaN."""

    def __init__(self, key: StreamKey, capacity: int = KEPT) -> None:
        super().__init__(key, _CHANNELS, capacity)
        self.has_rotation = False
        self.gravity_included = True
        self.simulated = False
        self.lost = 0
        """How many samples are missing, as far as their times tell."""
        self._clock = ClockMap()
        self._last_t: float | None = None
        self._step_s = 0.0

    @property
    def rate_hz(self) -> float:
        """Samples a second; 0 before the first ones."""
        return 1 / self._step_s if self._step_s else 0.0

    def hear(self, message: Imu, arrived_s: float) -> None:
        """Take a batch; samples whose times do not rise and rows that do not fit are left out."""
        t, values = _rising(message)
        if not len(t):
            return
        self.has_rotation |= message.gyr is not None
        self.gravity_included, self.simulated = message.gravity_included, message.simulated
        times, has_jumped = self._clock.to_wall(t, arrived_s)
        cuts = self._gaps(t, message.rate_hz, has_jumped)
        self._last_t = float(t[-1])
        for first, end in zip([0, *cuts], [*cuts, len(t)], strict=True):
            if end > first:
                is_after_gap = first in cuts
                self.add(times[first:end], values[:, first:end], is_after_gap=is_after_gap)

    def _gaps(self, t: Floats, told_hz: float, has_jumped: bool) -> list[int]:
        """Before which samples others are missing."""
        is_first = self._last_t is None
        before = t[0] if has_jumped or self._last_t is None else self._last_t
        steps = np.diff(t, prepend=before)
        self._learn_step(steps[steps > 0], told_hz)
        if not self._step_s:
            return []
        late = np.flatnonzero(steps > _GAP_STEPS * self._step_s).tolist()
        self.lost += sum(round(steps[at] / self._step_s) - 1 for at in late)
        return [0, *late] if has_jumped and not is_first else late

    def _learn_step(self, steps: Floats, told_hz: float) -> None:
        if not self._step_s and told_hz > 0:
            self._step_s = 1 / told_hz
        if len(steps):
            usual = float(np.median(steps))
            self._step_s = 0.95 * self._step_s + 0.05 * usual if self._step_s else usual


def _rising(message: Imu) -> tuple[Floats, Floats]:
    """Times (n,) and channels (8, n) of a batch."""
    t = np.asarray(message.t, dtype=float)
    acc = np.asarray(message.acc, dtype=float).reshape(-1, 3)
    gyr = np.full((len(t), 3), np.nan)
    if message.gyr is not None:
        gyr = np.asarray(message.gyr, dtype=float).reshape(-1, 3)
    if not len(acc) == len(gyr) == len(t):
        return np.empty(0), np.empty((8, 0))
    latest = np.concatenate([[-np.inf], np.maximum.accumulate(t)[:-1]])
    kept = np.isfinite(t) & (t > latest)
    values = np.vstack([acc.T, np.linalg.norm(acc, axis=1), gyr.T, np.linalg.norm(gyr, axis=1)])
    return t[kept], values[:, kept]
