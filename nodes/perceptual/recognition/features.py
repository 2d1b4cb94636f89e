"""Numbers that describe the movement inside a time window."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nodes.perceptual.recognition.stream import RATE_HZ, Floats

Integers = NDArray[np.intp]
Singles = NDArray[np.float32]  # half the memory: an hour of recordings is 400,000 windows

POINTS = 32
"""Every window is resampled to so many points."""
_SEGMENTS = 8
_GRAVITY_SPAN = 13  # points: the moving average over 40 % of a window is taken for gravity
_EARTH_M_S2 = 9.81


IN_WORDS = {
    (False, False): "acceleration",
    (True, False): "acceleration with gravity",
    (False, True): "acceleration and rotation",
    (True, True): "acceleration with gravity and rotation",
}
"""What a sensor must have: gravity in its acceleration, a gyroscope."""


@dataclass(frozen=True)
class Channels:
    """What a model listens to besides the acceleration of the body."""

    gravity: bool
    gyroscope: bool

    @property
    def columns(self) -> int:
        """Columns of a sample: acceleration, and angular velocity if there is a gyroscope."""
        return 6 if self.gyroscope else 3

    @property
    def signals(self) -> int:
        """How many signals ``signals_of`` gives."""
        return 4 * (1 + self.gyroscope) + 3 * self.gravity

    @property
    def signal_names(self) -> tuple[str, ...]:
        """What each signal of ``signals_of`` is: the body's movement, its size, rotation, gravity.

        ``body x`` and ``rotation x`` are on a logarithmic scale, ``gravity x`` in parts of g.
        """
        kinds = ["body", *(["rotation"] if self.gyroscope else [])]
        names = [f"{kind} {axis}" for kind in kinds for axis in ("x", "y", "z", "size")]
        return (*names, *(f"gravity {axis}" for axis in "xyz" if self.gravity))

    @property
    def in_words(self) -> str:
        """For people: what the sensor must have."""
        return IN_WORDS[self.gravity, self.gyroscope]


@dataclass(frozen=True)
class Windows:
    """n time windows: ``signals`` (n, 32, s), ``features`` (n, f), ``lengths`` (n,) samples."""

    signals: Singles
    features: Singles
    lengths: Integers

    def __len__(self) -> int:
        return len(self.lengths)

    def where(self, chosen: NDArray[Any]) -> Windows:
        """The chosen windows only."""
        return Windows(self.signals[chosen], self.features[chosen], self.lengths[chosen])


def cut_windows(samples: Floats, last: Integers, lengths: Integers) -> Floats:
    """The windows of ``lengths`` (n,) samples that end with sample ``last`` (n,); (n, 32, columns).

    Positions before the first sample take the first.
    """
    steps = np.linspace(-1.0, 0.0, POINTS)
    positions = np.maximum(last[:, None] + steps * (lengths[:, None] - 1), 0.0)
    before = np.minimum(positions.astype(np.intp), len(samples) - 2)
    part = (positions - before)[..., None]
    windows: Floats = samples[before] * (1 - part) + samples[before + 1] * part
    return windows


def describe(raw: Floats, lengths: Integers, channels: Channels) -> Windows:
    """Signals and features of raw windows (n, 32, 3 or 6)."""
    signals = signals_of(raw, channels)
    features = features_of(signals, lengths)
    return Windows(signals.astype(np.float32), features.astype(np.float32), lengths)


def signals_of(raw: Floats, channels: Channels) -> Floats:
    """Raw windows (n, 32, 3 or 6) as signals of about the same size; (n, 32, channels.signals).

    Gravity is a moving average, the rest is the body's; the logarithm makes strong and weak
    performances alike. Each vector is followed by its length, which does not depend on how the
    watch sits.
    """
    acceleration = raw[..., :3]
    gravity = _SMOOTHING @ acceleration
    parts = _logarithmic(acceleration - gravity, 1.0)
    if channels.gyroscope:
        parts += _logarithmic(raw[..., 3:6], 2.0)
    if channels.gravity:
        parts.append(gravity / _EARTH_M_S2)
    return np.concatenate(parts, axis=2)


def features_of(signals: Floats, lengths: Integers) -> Floats:
    """Statistics of each signal, of its eighths, of each pair, and how long the window is."""
    n, _, count = signals.shape
    mean = signals.mean(axis=1)
    square = np.matmul(signals.transpose(0, 2, 1), signals) / POINTS
    power = np.sqrt(np.einsum("nii->ni", square))
    first, second = np.triu_indices(count, 1)
    together = square[:, first, second] / (power[:, first] * power[:, second] + 1e-6)
    positive = signals > 0
    return np.concatenate(
        [
            signals.max(axis=1),
            mean,
            signals.min(axis=1),
            np.sqrt(np.maximum(power**2 - mean**2, 0.0)),
            np.abs(signals).mean(axis=1),
            (positive[:, 1:] != positive[:, :-1]).mean(axis=1),
            power,
            signals.reshape(n, _SEGMENTS, -1, count).mean(axis=2).reshape(n, -1),
            together,
            np.log(lengths / RATE_HZ)[:, None],
        ],
        axis=1,
    )


def feature_count(channels: Channels) -> int:
    """How many features ``features_of`` gives."""
    count = channels.signals
    return (7 + _SEGMENTS) * count + count * (count - 1) // 2 + 1


def _logarithmic(vectors: Floats, gain: float) -> list[Floats]:
    length = np.linalg.norm(vectors, axis=2, keepdims=True)
    return [np.sign(vectors) * np.log1p(gain * np.abs(vectors)), np.log1p(gain * length)]


def _smoothing() -> Floats:
    """The moving average as a matrix; (32, 32)."""
    points = np.arange(POINTS)
    near = np.abs(points[:, None] - points) <= _GRAVITY_SPAN // 2
    matrix: Floats = near / near.sum(axis=1, keepdims=True)
    return matrix


_SMOOTHING = _smoothing()
