"""What one watch or phone measured in the last half minute, and samples as a project keeps them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from nep_core.wire.messages import Imu
from nep_studio.blocks.own_gestures import OwnRecording, Wrist, packed_samples, unpacked_samples
from nep_studio.ui.ring import Floats, Ring

KEPT_S = 30.0
MOST_HZ = 1000
"""Of a sensor that measures more often, less than half a minute is kept."""
_LEAST_STEP_S = 1e-4
_FALLBACK_HZ = 50.0
_LEARNING = 0.05


@dataclass(frozen=True)
class Samples:
    """n samples: ``t`` (n,) s, rising; ``acc`` (n, 3) m/s²; ``gyr`` (n, 3) rad/s or None."""

    t: Floats
    acc: Floats
    gyr: Floats | None

    def __len__(self) -> int:
        return len(self.t)

    @property
    def seconds(self) -> float:
        """From the first sample to the last."""
        return float(self.t[-1] - self.t[0]) if len(self.t) else 0.0

    @property
    def rate_hz(self) -> float:
        """How many samples come in a second, gaps left out; 0 of fewer than two."""
        steps = np.diff(self.t)
        usual = float(np.median(steps)) if len(steps) else 0.0
        return 1 / usual if usual > 0 else 0.0

    def between(self, start_s: float, end_s: float) -> Samples:
        """Those from a time to another, both included."""
        first = int(np.searchsorted(self.t, start_s, side="left"))
        last = int(np.searchsorted(self.t, end_s, side="right"))
        gyr = None if self.gyr is None else self.gyr[first:last]
        return Samples(self.t[first:last], self.acc[first:last], gyr)

    @staticmethod
    def none() -> Samples:
        """No samples."""
        return Samples(np.empty(0), np.empty((0, 3)), None)


def joined(parts: list[Samples]) -> Samples:
    """Samples one after the other; rotation stays where every part has it."""
    parts = [part for part in parts if len(part)]
    if not parts:
        return Samples.none()
    rotations = [part.gyr for part in parts if part.gyr is not None]
    gyr = np.concatenate(rotations) if len(rotations) == len(parts) else None
    t = np.concatenate([part.t for part in parts])
    return Samples(t, np.concatenate([part.acc for part in parts]), gyr)


class LiveStream:
    """The last samples of one sensor. A clock that is set back goes on where it was."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.rate_hz = 0.0
        self.has_rotation = False
        self.gravity_included = True
        self.simulated = False
        self.wrist: Wrist | None = None
        self.heard_s = -np.inf
        """When it was heard last, by the computer's clock."""
        self._ring = Ring(7, round(KEPT_S * MOST_HZ))
        self._shift_s = 0.0
        self.last_t = -np.inf
        """The time of the newest sample; minus infinity before the first."""

    def hear(self, message: Imu, now_s: float) -> Samples:
        """Take a batch; gives those of its samples that are whole, and later than all before."""
        t, values = _whole(message)
        self.gravity_included, self.simulated = message.gravity_included, message.simulated
        self.wrist = message.wrist or self.wrist
        if not len(t):
            return Samples.none()
        self._go_on(t, now_s)
        t = t + self._shift_s
        latest = np.concatenate([[self.last_t], np.maximum.accumulate(t)[:-1]])
        is_later = t > latest
        t, values = t[is_later], values[:, is_later]
        if len(t):
            steps = np.diff(t)
            if not self.rate_hz:
                self.rate_hz = message.rate_hz if message.rate_hz > 0 else _FALLBACK_HZ
            if len(steps):
                measured_hz = 1 / max(float(np.median(steps)), _LEAST_STEP_S)
                self.rate_hz += _LEARNING * (measured_hz - self.rate_hz)
            self._ring.append(np.vstack([t[None], values]))
            self.last_t = float(t[-1])
            self.has_rotation = message.gyr is not None
            self.heard_s = now_s
        return _samples(np.vstack([t[None], values]))

    def last(self, seconds: float = KEPT_S) -> Samples:
        """The newest samples, in memory of their own."""
        table = self._ring.newest()
        first = int(np.searchsorted(table[0], self.last_t - seconds, side="left"))
        return _samples(table[:, first:].copy())

    def between(self, start_s: float, end_s: float) -> Samples:
        """What was measured from a time to another, as far as it is still known."""
        return self.last().between(start_s, end_s)

    def _go_on(self, t: Floats, now_s: float) -> None:
        """Follow a clock that was set back by more than samples that come late explain."""
        behind_s = self.last_t - (float(t[-1]) + self._shift_s)
        if not np.isfinite(self.last_t):
            self._shift_s = -float(t[0])
        elif behind_s > 0.5:
            waited_s = min(max(now_s - self.heard_s, 1 / (self.rate_hz or _FALLBACK_HZ)), KEPT_S)
            self._shift_s = self.last_t + waited_s - float(t[0])


def _whole(message: Imu) -> tuple[Floats, Floats]:
    """Times (n,) and values (6, n) of the samples in which each number is finite."""
    t = np.asarray(message.t, dtype=float)
    acc = np.asarray(message.acc, dtype=float).reshape(-1, 3)
    gyr = np.full((len(t), 3), np.nan)
    if message.gyr is not None:
        gyr = np.asarray(message.gyr, dtype=float).reshape(-1, 3)
    if not len(acc) == len(gyr) == len(t):
        return np.empty(0), np.empty((6, 0))
    values = np.hstack([acc, gyr])
    measured = values if message.gyr is not None else acc
    is_whole = np.isfinite(t) & np.isfinite(measured).all(axis=1)
    return t[is_whole], values[is_whole].T


def _samples(table: Floats) -> Samples:
    """A table (7, n) as samples; rotation that is missing anywhere is no rotation."""
    gyr = table[4:7].T
    has_rotation = bool(table.shape[1]) and bool(np.isfinite(gyr).all())
    return Samples(table[0], table[1:4].T, gyr if has_rotation else None)


# Samples between the arrays of a computation and the text in a project's file.

MOST_KEPT_HZ = 200.0
"""More often no hand moves: of a faster sensor every second sample is kept, or every third."""
MOST_CACHED = 200
"""So many recordings are unpacked once only."""


def packed(samples: Samples) -> str:
    """The text that a project keeps; times begin at 0 there."""
    parts = [samples.t[:, None] - samples.t[0], samples.acc]
    rows = np.hstack(parts if samples.gyr is None else [*parts, samples.gyr])
    return packed_samples(rows.astype("<f4").tobytes())


def unpacked(recording: OwnRecording) -> Samples:
    """The samples of a recording; none when its text cannot be read."""
    columns = 7 if recording.has_rotation else 4
    try:
        numbers = np.frombuffer(unpacked_samples(recording.samples), dtype="<f4")
        rows = numbers.reshape(-1, columns).astype(float)
    except ValueError:
        return Samples.none()
    return Samples(rows[:, 0], rows[:, 1:4], rows[:, 4:7] if recording.has_rotation else None)


def thinned(samples: Samples) -> Samples:
    """The same at no more than MOST_KEPT_HZ."""
    step = max(1, int(np.ceil(samples.rate_hz / MOST_KEPT_HZ - 0.2)))
    gyr = None if samples.gyr is None else samples.gyr[::step]
    return Samples(samples.t[::step], samples.acc[::step], gyr)


def as_recording(samples: Samples, **about: Any) -> OwnRecording:
    """Samples as a project keeps them; ``about`` is the rest that it knows of the recording."""
    return OwnRecording(
        seconds=round(samples.seconds, 4),
        rate_hz=round(samples.rate_hz, 2),
        samples=packed(samples),
        has_rotation=samples.gyr is not None,
        **about,
    )
