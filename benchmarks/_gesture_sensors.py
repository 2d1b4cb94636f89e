"""The same movement as worse sensors would have felt it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from nodes.recordings import Recording

Floats = NDArray[np.float64]

SLOW, LOSSY, TURNED, NO_GYROSCOPE = "25 Hz", "20 % lost", "turned 20°", "no gyroscope"
WORSE = (SLOW, LOSSY, TURNED, NO_GYROSCOPE)
_LONGEST_BURST = 5


def worse(recording: Recording, sensor: str) -> Recording:
    """The recording as a worse sensor would have made it."""
    if sensor == NO_GYROSCOPE:
        return replace(recording, gyr=None)
    if sensor == TURNED:
        turn = _turn_by(np.radians(20))
        gyr = None if recording.gyr is None else recording.gyr @ turn.T
        return replace(recording, acc=recording.acc @ turn.T, gyr=gyr)
    if sensor == SLOW:
        return _at_rate(recording, 25.0)
    return _with_losses(recording, 0.2)


def _turn_by(angle_rad: float) -> Floats:
    """A rotation about an axis that is none of the sensor's."""
    x, y, z = np.ones(3) / np.sqrt(3)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turn = np.eye(3) + np.sin(angle_rad) * cross + (1 - np.cos(angle_rad)) * cross @ cross
    return np.asarray(turn)


def _at_rate(one: Recording, rate_hz: float) -> Recording:
    t = np.arange(0.0, float(one.t[-1]), 1 / rate_hz)
    nearest = np.minimum(np.searchsorted(one.t, t), len(one.t) - 1)

    def resampled(values: Floats) -> Floats:
        return np.stack([np.interp(t, one.t, axis) for axis in values.T], axis=1)

    labels = [one.labels[at] for at in nearest] if one.labels else None
    gyr = None if one.gyr is None else resampled(one.gyr)
    return replace(one, t=t, acc=resampled(one.acc), gyr=gyr, labels=labels)


def _with_losses(one: Recording, share: float) -> Recording:
    """Samples are lost in bursts, as they are on the air; always the same ones."""
    chance = np.random.default_rng(0)
    kept = np.ones(len(one.t), bool)
    while kept.mean() > 1 - share:
        at = chance.integers(1, len(kept))
        kept[at : at + chance.integers(1, _LONGEST_BURST + 1)] = False
    labels = [label for label, is_kept in zip(one.labels or (), kept, strict=False) if is_kept]
    gyr = None if one.gyr is None else one.gyr[kept]
    return replace(one, t=one.t[kept], acc=one.acc[kept], gyr=gyr, labels=labels or None)
