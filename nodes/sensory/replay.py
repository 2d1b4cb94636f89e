"""Plays recordings as if a person moved now."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import cycle
from pathlib import Path

import numpy as np

from nep_core.errors import ParameterError
from nep_core.processes.node import Node
from nep_core.wire.messages import IMU, Imu
from nodes.recordings import Floats, Recording, read_recording, read_recordings

from .reading import rows

_BATCH_S = 0.03
_MOST_LATE_S = 0.2  # a longer hold-up delays the rest: samples come late, but none is left out
_PAUSE_S = 1.0  # by the sensor's clock, between two recordings


def run(
    node: Node, *, recording: str, loop: bool, speed: float, start_s: float, quit_at_end: bool
) -> None:
    """Publish ``/imu`` at the recordings' own rate times ``speed``; raises RecordingError.

    Times in the messages are those of the recordings, one recording after the other.

    ``node`` is this node, ``recording`` a file or a folder; ``loop``: again and again;
    ``start_s``: from so far into it; ``quit_at_end``: the node ends with it.
    """
    recordings = _read(Path(recording), start_s)
    publisher = node.publisher(IMU)
    duration_s = sum(float(played.t[-1]) for played in recordings)
    node.ready("{duration_s} seconds to play", duration_s=f"{duration_s:.0f}")
    clock_s = 0.0
    for played in cycle(recordings) if loop else recordings:
        if node.stopping:
            return
        node.state(
            "running", "plays {source} ({t} seconds)", source=played.source, t=f"{played.t[-1]:.0f}"
        )
        for part in _parts_in_time(node, played.t, speed):
            publisher.send(_message(played, part, clock_s))
        clock_s += float(played.t[-1]) + _PAUSE_S
    node.state("running", "the recording has ended")
    while not quit_at_end and not node.wait(1.0):
        pass


def _read(path: Path, start_s: float) -> list[Recording]:
    recordings = read_recordings(path) if path.is_dir() else [read_recording(path)]
    first = recordings[0]
    kept = first.t >= start_s
    if not kept.any():
        raise ParameterError(
            "{source} cannot start at second {start_s}: it lasts {t} s.",
            checklist=("Choose an earlier start_s.",),
            source=first.source,
            start_s=f"{start_s:g}",
            t=f"{first.t[-1]:.1f}",
        )
    recordings[0] = replace(
        first,
        t=first.t[kept] - first.t[kept][0],
        acc=first.acc[kept],
        gyr=None if first.gyr is None else first.gyr[kept],
        labels=None,
    )
    return recordings


def _parts_in_time(node: Node, t: Floats, speed: float) -> Iterator[slice]:
    """The parts of a recording, each when its time has come; ends early when the node stops."""
    played, played_s, last_s = 0, 0.0, time.monotonic()
    while played < len(t) and not node.wait(_BATCH_S):
        now_s = time.monotonic()
        played_s += min(now_s - last_s, _MOST_LATE_S) * speed
        last_s = now_s
        due = int(np.searchsorted(t, played_s, side="right"))
        if due > played:
            yield slice(played, due)
        played = due


def _message(recording: Recording, part: slice, clock_s: float) -> Imu:
    return Imu(
        source=recording.source,
        rate_hz=recording.rate_hz,
        t=(recording.t[part] + clock_s).tolist(),
        acc=rows(recording.acc[part]),
        gyr=None if recording.gyr is None else rows(recording.gyr[part]),
        gravity_included=recording.gravity_included,
        simulated=recording.simulated,
        wrist=recording.wrist,
    )
