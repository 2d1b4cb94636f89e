"""What a sample of the watch costs the recogniser: CPU time of Spotter.push, five gestures.

Simulated people, 50 samples a second, pushed one at a time; as one spotter for the set, and as
five spotters that each look for one gesture, as in the paper. The reference is the time that a
sample lasts: a ratio of 1 would fill a core.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from nodes.perceptual.recognition.model import METHODS
from nodes.perceptual.recognition.model_file import read_model
from nodes.perceptual.recognition.spotting import Spotter
from nodes.recordings import Recording
from nodes.resources import resource_folder
from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.simulate import simulate_session

_SAMPLES = 3000
_GOAL_US = 1000.0


def run() -> list[dict[str, Any]]:
    """Mean and 99th percentile for both methods, as a set and one by one."""
    model = read_model(resource_folder() / "gestures" / "paper.gestures")
    rows: list[dict[str, Any]] = []
    for method in METHODS:
        one_set = [Spotter(model, method=method)]
        one_each = [Spotter(model, method=method, gestures=[name]) for name in model.names]
        rows += _rows(f"{method}, one set of five gestures", one_set)
        rows += _rows(f"{method}, five spotters of one gesture", one_each)
    return rows


def _rows(name: str, spotters: Sequence[Spotter]) -> Iterator[dict[str, Any]]:
    recording = simulate_session(130, sorted(GESTURES), 3)
    each_us = np.array(list(_pushes_us(recording, spotters)))
    mean_us, sample_us = float(each_us.mean()), 1e6 / recording.rate_hz
    yield {
        "name": f"{name}: mean",
        "value": round(mean_us, 1),
        "unit": "µs a sample",
        "reference": round(sample_us),
        "ratio": round(mean_us / sample_us, 4),
        "goal": f"less than {_GOAL_US:.0f}",
        "ok": mean_us < _GOAL_US,
    }
    slow_us = float(np.percentile(each_us, 99))
    yield {"name": f"{name}: 99th percentile", "value": round(slow_us, 1), "unit": "µs a sample"}


def _pushes_us(recording: Recording, spotters: Sequence[Spotter]) -> Iterator[float]:
    assert recording.gyr is not None
    samples = zip(recording.t, recording.acc, recording.gyr, strict=True)
    for (t, acc, gyr), _ in zip(samples, range(_SAMPLES), strict=False):
        before_ns = time.thread_time_ns()
        for spotter in spotters:
            spotter.push(t, acc, gyr)
        yield (time.thread_time_ns() - before_ns) / 1e3
