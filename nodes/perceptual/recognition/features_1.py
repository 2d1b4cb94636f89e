"""How gesture models of version 1 see a window: kept as it was, so that they are still read."""

from __future__ import annotations

import numpy as np

from nodes.perceptual.recognition.features import POINTS, Channels, Integers, Windows
from nodes.perceptual.recognition.stream import RATE_HZ, Floats

_SEGMENTS = 8
_GRAVITY_SPAN = 13  # points: the moving average over 40 % of a window is taken for gravity
_EARTH_M_S2 = 9.81


def describe_1(raw: Floats, lengths: Integers, channels: Channels) -> Windows:
    """Signals and features of raw windows (n, 32, 3 or 6)."""
    signals = _signals(raw, channels)
    features = _features(signals, lengths)
    return Windows(signals.astype(np.float32), features.astype(np.float32), lengths)


def feature_count_1(channels: Channels) -> int:
    """How many features there are."""
    count = channels.signals
    return (7 + _SEGMENTS) * count + count * (count - 1) // 2 + 1


def _signals(raw: Floats, channels: Channels) -> Floats:
    """Gravity is a moving average, the rest the body's; a logarithm makes strong and weak alike."""
    acceleration = raw[..., :3]
    gravity = _SMOOTHING @ acceleration
    parts = _logarithmic(acceleration - gravity, 1.0)
    if channels.gyroscope:
        parts += _logarithmic(raw[..., 3:6], 2.0)
    if channels.gravity:
        parts.append(gravity / _EARTH_M_S2)
    return np.concatenate(parts, axis=2)


def _features(signals: Floats, lengths: Integers) -> Floats:
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
