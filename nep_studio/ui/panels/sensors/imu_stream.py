"""The stream of one watch or phone, from the batches of ``/imu``."""

from __future__ import annotations

import numpy as np

from nep_core.messages import IMU, Imu
from nep_studio.ui.panels.sensors.clock import ClockMap
from nep_studio.ui.panels.sensors.ring import Floats
from nep_studio.ui.panels.sensors.streams import Channel, Stream, StreamKey

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
    magnitudes = [np.linalg.norm(acc, axis=1), np.linalg.norm(gyr, axis=1)]
    values = np.vstack([acc.T, magnitudes[0], gyr.T, magnitudes[1]])
    return t[kept], values[:, kept]
