"""Movements that tests let a sensor make: bursts with rest between them, and real recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from nodes.recordings import read_recording

GRAVITY = 9.81


def rest(seconds: float, rate_hz: float = 50.0) -> tuple[np.ndarray, np.ndarray]:
    """A hand that is still."""
    count = round(seconds * rate_hz)
    noise = np.random.default_rng(1).normal(0, 0.02, (count, 3))
    return noise + np.array([0, 0, GRAVITY]), noise / 2


def stroke(
    seconds: float = 0.8, strength: float = 8.0, rate_hz: float = 50.0
) -> tuple[np.ndarray, np.ndarray]:
    """A hand that goes to and fro once."""
    part = np.linspace(0, 2 * np.pi, round(seconds * rate_hz))
    wave = np.sin(part) * (1 - np.cos(part)) / 1.3
    acc = np.stack([strength * wave, 0.4 * strength * wave, GRAVITY + 0 * wave], axis=1)
    gyr = np.stack([0 * wave, 0.2 * strength * wave, 0.1 * strength * wave], axis=1)
    return acc, gyr


def takes(
    count: int, pause_s: float = 1.2, rate_hz: float = 50.0, **more: float
) -> tuple[np.ndarray, np.ndarray]:
    """Strokes, each with a rest before and after it."""
    parts = [rest(pause_s, rate_hz)]
    for _ in range(count):
        parts += [stroke(rate_hz=rate_hz, **more), rest(pause_s, rate_hz)]
    return joined(*parts)


def joined(*parts: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Movements one after the other."""
    return np.concatenate([acc for acc, _ in parts]), np.concatenate([gyr for _, gyr in parts])


def real(folder: Path, name: str) -> tuple[np.ndarray, np.ndarray, float]:
    """A session of a real person: acceleration, rotation, samples a second."""
    recording = read_recording(folder / "uhh_gestures" / f"{name}.csv")
    return recording.acc, recording.gyr, recording.rate_hz
