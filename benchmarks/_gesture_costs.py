"""What recognising ten gestures costs: training, time a sample, memory over an hour of stream."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import psutil

from benchmarks._gesture_folder import DATA, Split, read_gesture_folder, split_sessions
from nodes.perceptual.recognition.dataset import simulated_everyday
from nodes.perceptual.recognition.model import METHODS, Model
from nodes.perceptual.recognition.spotting import Spotter
from nodes.perceptual.recognition.training import train
from nodes.recordings import Recording

Row = dict[str, Any]

EXAMPLES = 5
MOST_TRAINING_S = 3.0
MOST_GROWTH_MB = 2.0
_HOUR_S = 3600.0
_WARM_UP_S = 300.0
_BATCH = 50


def ten_gestures() -> Split | None:
    """Five examples of ten gestures of a real person and the rest; None without the real data."""
    folder = DATA / "uhh_gestures"
    if not folder.is_dir():
        return None
    people = read_gesture_folder(folder).people
    return split_sessions(next(iter(people.values())), EXAMPLES)


def training_rows(split: Split) -> tuple[list[Row], Model]:
    """Training in a process that has trained before, as the studio's has; the better of two."""
    everyday = simulated_everyday()
    train(split.training[:2], everyday[:1])
    walls_s, cpus_s = [], []
    for _ in range(2):
        wall_s, cpu_s = time.perf_counter(), time.process_time()
        model = train(split.training, everyday)
        walls_s.append(time.perf_counter() - wall_s)
        cpus_s.append(time.process_time() - cpu_s)
    name = f"training {len(model.names)} gestures of {EXAMPLES} examples"
    wall_s = min(walls_s)
    goal = f"less than {MOST_TRAINING_S:g}"
    is_met = wall_s < MOST_TRAINING_S
    row = {"name": name, "value": round(wall_s, 2), "unit": "s", "goal": goal, "ok": is_met}
    return [row, {"name": f"{name}: CPU", "value": round(min(cpus_s), 2), "unit": "s"}], model


def memory_rows(model: Model, stream: Recording, seconds: float = _HOUR_S) -> list[Row]:
    """How much more memory an hour of stream takes than its first five minutes, sped up."""
    spotter = Spotter(model, method=METHODS[0], gravity_included=stream.gravity_included)
    warm_mb, heard = 0.0, 0
    for number, batch in enumerate(_batches(stream, seconds)):
        heard += len(spotter.push(batch.t, batch.acc, batch.gyr))
        if float(batch.t[-1]) <= _WARM_UP_S or number == 0:
            warm_mb = _memory_mb()
    grown_mb = _memory_mb() - warm_mb
    name = f"{METHODS[0]}, {seconds / 3600:g} h of stream, {heard} gestures: memory grows by"
    goal = f"at most {MOST_GROWTH_MB:g}"
    return [
        {
            "name": name,
            "value": round(grown_mb, 2),
            "unit": "MB",
            "goal": goal,
            "ok": grown_mb <= MOST_GROWTH_MB,
        }
    ]


def at_rate(stream: Recording, rate_hz: float) -> Recording:
    """The stream with another number of samples a second."""
    t = np.arange(0.0, float(stream.t[-1]), 1 / rate_hz)
    acc = np.stack([np.interp(t, stream.t, axis) for axis in stream.acc.T], axis=1)
    assert stream.gyr is not None
    gyr = np.stack([np.interp(t, stream.t, axis) for axis in stream.gyr.T], axis=1)
    return replace(stream, t=t, acc=acc, gyr=gyr, labels=None)


def _batches(stream: Recording, seconds: float) -> Iterator[Recording]:
    """The stream again and again, in batches, on a clock that goes on."""
    step_s = 1 / stream.rate_hz
    lasts_s = float(stream.t[-1]) + step_s
    begun_s = 0.0
    while begun_s < seconds:
        for at in range(0, len(stream.t), _BATCH):
            part = slice(at, at + _BATCH)
            gyr = None if stream.gyr is None else stream.gyr[part]
            yield replace(
                stream, t=stream.t[part] + begun_s, acc=stream.acc[part], gyr=gyr, labels=None
            )
        begun_s += lasts_s


def _memory_mb() -> float:
    """What this process holds in memory now."""
    return float(psutil.Process().memory_info().rss) / 1e6
