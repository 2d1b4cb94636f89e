"""Unbroken passages of recordings at an even rate, and the gestures made in them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.stream import RATE_HZ, EvenStream, Floats
from nodes.recordings import Recording

SHORTEST_S, LONGEST_S = 0.2, 8.0
UNKNOWN = "?"
"""The label of what is neither a gesture nor its absence: nothing is learned from it."""
_LONGEST_NAME = 100
_SLOWEST_HZ = 10.0


@dataclass(frozen=True)
class Take:
    """One performance of a gesture, in s on the clock of its recording."""

    gesture: str
    start_s: float
    end_s: float

    @property
    def duration_s(self) -> float:
        """How long it lasts."""
        return self.end_s - self.start_s


@dataclass(frozen=True)
class Passage:
    """Even ``samples`` (m, 3 or 6) from ``start_s`` on, without a gap, and the takes in it.

    ``unknown`` are the spans (start, end) in s that are neither a gesture nor its absence.
    """

    source: str
    person: str
    start_s: float
    samples: Floats
    takes: tuple[Take, ...]
    unknown: tuple[tuple[float, float], ...] = ()

    @property
    def duration_s(self) -> float:
        """How long it lasts."""
        return len(self.samples) / RATE_HZ


def is_gesture_name(name: str) -> bool:
    """Whether a gesture may have this name: it can be shown on one line."""
    return bool(name.strip()) and len(name) <= _LONGEST_NAME and name.isprintable()


def passages_of(recordings: Sequence[Recording], gyroscope: bool) -> list[Passage]:
    """All passages of the recordings; RecordingError names the recording that cannot be used."""
    return [part for recording in recordings for part in _passages(recording, gyroscope)]


def takes_of(recording: Recording) -> list[Take]:
    """The gestures labelled in a recording; RecordingError names one that is too short or long."""
    takes = [
        Take(name, start_s, end_s) for name, start_s, end_s in _spans(recording) if name != UNKNOWN
    ]
    for take in takes:
        _check(recording, take)
    return takes


def unknown_spans(recording: Recording) -> list[tuple[float, float]]:
    """The spans (start, end) in s that are marked as neither a gesture nor its absence."""
    return [(start_s, end_s) for name, start_s, end_s in _spans(recording) if name == UNKNOWN]


def _spans(recording: Recording) -> Iterator[tuple[str, float, float]]:
    """Each run of equal labels that are not empty: label, start and end in s."""
    at = 0
    for name, run in groupby(recording.labels or ()):
        count = len(list(run))
        if name:
            yield name, float(recording.t[at]), float(recording.t[at + count - 1])
        at += count


def _passages(recording: Recording, gyroscope: bool) -> Iterator[Passage]:
    if recording.rate_hz < _SLOWEST_HZ:
        raise RecordingError(
            f"{recording.source} has {recording.rate_hz:.1f} samples a second, which is too few"
            " to tell gestures apart.",
            checklist=(f"Record at least {_SLOWEST_HZ:.0f} samples a second, better 50.",),
        )
    values = recording.acc
    if gyroscope and recording.gyr is not None:
        values = np.hstack([recording.acc, recording.gyr])
    takes = takes_of(recording)
    unknown = tuple(unknown_spans(recording))
    for stretch in EvenStream().push(recording.t, values):
        start_s, end_s = float(stretch.t[0]), float(stretch.t[-1])
        inside = (take for take in takes if start_s - 0.1 <= take.start_s <= end_s)
        whole = tuple(take for take in inside if take.end_s <= end_s + 0.1)
        yield Passage(recording.source, recording.person, start_s, stretch.values, whole, unknown)


def _check(recording: Recording, take: Take) -> None:
    if not is_gesture_name(take.gesture):
        raise RecordingError(
            f"{recording.source}: the gesture at {take.start_s:.2f} s has a name that is too long,"
            " or that cannot be shown.",
            checklist=(f"Name it with letters, digits and _, {_LONGEST_NAME} at most.",),
        )
    if SHORTEST_S <= take.duration_s <= LONGEST_S:
        return
    source, name = recording.source, take.gesture
    start_s, duration_s = f"{take.start_s:.2f}", f"{take.duration_s:.2f}"
    sentence = f'{source}: the gesture "{name}" at {start_s} s lasts {duration_s} s, too long.'
    if take.duration_s < SHORTEST_S:
        sentence = f'{source}: the gesture "{name}" at {start_s} s lasts {duration_s} s, too short.'
    raise RecordingError(
        sentence,
        checklist=(
            f"A gesture lasts {SHORTEST_S} to {LONGEST_S:.0f} seconds.",
            "Mark it anew in the recording, or leave it out.",
        ),
    )
