"""The same gesture as others would make it: stronger or weaker, turned, and with another rhythm."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from nodes.perceptual.recognition.features import POINTS
from nodes.perceptual.recognition.stream import Floats

_GAIN = 0.7  # a logarithm: half to twice as strong; people differ by four times
_TURN_RAD = np.deg2rad(12.0)  # the standard deviation of how a watch or phone sits
_RHYTHM = 0.12  # of a window: how much earlier or later its middle may come


def varied(raw: Floats, seed: Sequence[int]) -> Floats:
    """Raw windows (n, 32, 3 or 6), each changed by chance; the same seed, the same changes."""
    chance = np.random.default_rng(seed)
    n = len(raw)
    gain = np.exp(chance.uniform(-_GAIN, _GAIN, (n, 1, 1)))
    turned = _turned(raw, _turns(chance, n))
    # gravity is as strong for everyone: only what changes in the window is made stronger
    resting = turned[..., :3].mean(axis=1, keepdims=True)
    turned[..., :3] = resting + gain * (turned[..., :3] - resting)
    turned[..., 3:] *= gain
    return _with_rhythm(turned, chance)


def _turned(raw: Floats, turns: Floats) -> Floats:
    parts = [raw[..., at : at + 3] @ turns for at in range(0, raw.shape[2], 3)]
    return np.concatenate(parts, axis=2)


def _turns(chance: np.random.Generator, n: int) -> Floats:
    """Rotations about axes of every direction, by Rodrigues' formula; (n, 3, 3)."""
    axis = chance.normal(size=(n, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    angle = chance.normal(0.0, _TURN_RAD, n)[:, None, None]
    x, y, z = axis.T
    zero = np.zeros(n)
    cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    turns: Floats = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
    return turns


def _with_rhythm(raw: Floats, chance: np.random.Generator) -> Floats:
    """Windows whose middle comes earlier or later; both ends stay."""
    n = len(raw)
    times = np.linspace(0.0, 1.0, POINTS)
    shift = chance.uniform(-_RHYTHM, _RHYTHM, n) * np.cos(chance.uniform(0, np.pi, n))
    at = np.clip(times + shift[:, None] * np.sin(np.pi * times), 0.0, 1.0) * (POINTS - 1)
    before = np.minimum(at.astype(np.intp), POINTS - 2)
    part = (at - before)[..., None]
    each = np.arange(n)[:, None]
    values: Floats = raw[each, before] * (1 - part) + raw[each, before + 1] * part
    return values
