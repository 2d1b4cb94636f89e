"""What a sample of the watch costs the recogniser, what training costs, and memory over an hour.

Five gestures: simulated people, 50 samples a second, pushed one at a time; as one spotter for the
set, and as five spotters that each look for one gesture, as in the paper. Ten gestures: a real
person (../shared/data/uhh_gestures), 100 samples a second. The reference is the time that a
sample lasts: a ratio of 1 would fill a core. Training is timed in a process that has trained
before and holds the everyday movement already, as the studio's training process does.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from benchmarks._gesture_costs import at_rate, memory_rows, ten_gestures, training_rows
from nodes.perceptual.recognition.model import METHODS, read_model
from nodes.perceptual.recognition.spotting import Spotter
from nodes.recordings import Recording
from nodes.resources import resource_folder
from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.people import simulate_session

_SAMPLES = 3000
_FIVE_GOAL_US = 1000.0
_TEN_GOAL_US = 300.0
_FAST_HZ = 100.0
_SLOW_HZ = 50.0


def run() -> list[dict[str, Any]]:
    """Means and 99th percentiles for all methods, training and memory."""
    return [*_of_five(), *_of_ten()]


def _of_five() -> Iterator[dict[str, Any]]:
    model = read_model(resource_folder() / "gestures" / "paper.gestures")
    recording = simulate_session(130, sorted(GESTURES), 3)
    known = {one.method for one in model.recognisers}
    for method in (method for method in METHODS if method in known):
        one_set = [Spotter(model, method=method)]
        one_each = [Spotter(model, method=method, gestures=[name]) for name in model.names]
        five, each = "one set of five gestures", "five spotters of one gesture"
        yield from _rows(f"{method}, {five}", recording, one_set, _FIVE_GOAL_US)
        yield from _rows(f"{method}, {each}", recording, one_each, _FIVE_GOAL_US)


def _of_ten() -> Iterator[dict[str, Any]]:
    split = ten_gestures()
    if split is None:
        skipped = "ten gestures: skipped, there is no ../shared/data"
        yield {"name": skipped, "value": None, "unit": ""}
        return
    rows, model = training_rows(split)
    yield from rows
    stream = max(split.rest, key=lambda one: float(one.t[-1]))
    for method in METHODS:
        one_set = [Spotter(model, method=method, gravity_included=stream.gravity_included)]
        name = f"{method}, ten gestures at {_FAST_HZ:.0f} Hz"
        yield from _rows(name, at_rate(stream, _FAST_HZ), one_set, _TEN_GOAL_US)
    yield from memory_rows(model, at_rate(stream, _SLOW_HZ))


def _rows(
    name: str, recording: Recording, spotters: Sequence[Spotter], goal_us: float
) -> Iterator[dict[str, Any]]:
    each_us = np.array(list(_pushes_us(recording, spotters)))
    mean_us, sample_us = float(each_us.mean()), 1e6 / recording.rate_hz
    yield {
        "name": f"{name}: mean",
        "value": round(mean_us, 1),
        "unit": "µs a sample",
        "reference": round(sample_us),
        "ratio": round(mean_us / sample_us, 4),
        "goal": f"less than {goal_us:.0f}",
        "ok": mean_us < goal_us,
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
