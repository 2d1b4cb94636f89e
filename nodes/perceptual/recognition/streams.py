"""A sensor's samples at an even rate, whatever the sensor's clock and connection do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import groupby
from typing import overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nep_core.errors import RecordingError
from nep_core.wire.messages import Wrist
from nodes.recordings import Recording

Floats = NDArray[np.float64]

RATE_HZ = 50.0
MAX_GAP_S = 0.5
"""A longer silence ends the movement: nothing is made up to fill it."""
_CLOCK_RESET_S = 1.0
_LATEST_S = 1e10  # later, two samples could have the same time; 1e10 s are 300 years
# m/s² and rad/s: twice what the sensors of watches and phones can measure
_LIMITS = np.array([320.0, 320.0, 320.0, 80.0, 80.0, 80.0])


@dataclass(frozen=True)
class Stretch:
    """m even samples: ``t`` (m,) s on the sensor's clock, ``values`` (m, 3 or 6) m/s² and rad/s.

    ``follows`` tells that it goes on where the stretch before it ended.
    """

    t: Floats
    values: Floats
    follows: bool


class EvenStream:
    """Turns samples as they come into samples at ``rate_hz``, by linear interpolation.

    Samples that are not numbers, come twice or come too late are left out; after a gap, or a
    clock that was set back, a new stretch begins.
    """

    def __init__(self, rate_hz: float = RATE_HZ) -> None:
        self.rate_hz = rate_hz
        self._seen_s = np.nan
        self._kept_s = np.nan
        self._kept = np.empty(0)
        self._origin_s = 0.0
        self._made = 0

    def push(self, t: ArrayLike, values: ArrayLike) -> Iterator[Stretch]:
        """Take n samples: ``t`` (n,) or one number, ``values`` (n, 3 or 6) or one row."""
        times_s = np.atleast_1d(np.asarray(t, float))
        rows = np.atleast_2d(np.asarray(values, float))
        usable = (np.abs(times_s) < _LATEST_S) & np.isfinite(rows).all(axis=1)
        times_s, rows = times_s[usable], _within_limits(rows[usable])
        if not len(times_s):
            return
        steps_s = times_s - np.concatenate([[self._seen_s], times_s[:-1]])
        self._seen_s = float(times_s[-1])
        breaks = np.flatnonzero(~((steps_s >= -_CLOCK_RESET_S) & (steps_s <= MAX_GAP_S)))
        begins = 0
        for ends in (*breaks.tolist(), len(times_s)):
            if ends > begins:
                part = slice(begins, ends)
                yield from self._resample(times_s[part], rows[part], begins in breaks)
            begins = ends

    def _resample(self, t: Floats, values: Floats, starts: bool) -> Iterator[Stretch]:
        if starts:
            self._origin_s, self._made = t[0], 0
        else:
            t, values = np.append(self._kept_s, t), np.vstack([self._kept, values])
        rises = np.ones(len(t), bool)
        rises[1:] = t[1:] > np.maximum.accumulate(t)[:-1]
        t, values = t[rises], values[rises]
        self._kept_s, self._kept = t[-1], values[-1]
        last = int(np.floor((t[-1] - self._origin_s) * self.rate_hz + 1e-9))
        even_s = self._origin_s + np.arange(self._made, last + 1) / self.rate_hz
        follows = self._made > 0
        self._made = max(self._made, last + 1)
        if len(even_s):
            yield Stretch(even_s, _interpolated(even_s, t, values), follows)


class Memory:
    """The last samples of a stream, in order, in one array that is seldom moved."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._rows = np.empty((0, 0))
        self._end = 0

    def __len__(self) -> int:
        return min(self._end, self._size)

    def clear(self) -> None:
        """Forget everything."""
        self._end = 0

    def add(self, row: Floats) -> None:
        """Remember one sample more, and forget the oldest when there are too many."""
        if self._rows.shape[1] != len(row):
            self._rows, self._end = np.empty((4 * self._size, len(row))), 0
        if self._end == len(self._rows):
            self._rows[: self._size] = self._rows[-self._size :]
            self._end = self._size
        self._rows[self._end] = row
        self._end += 1

    def samples(self) -> Floats:
        """The samples remembered, oldest first; (len, columns)."""
        return self._rows[self._end - len(self) : self._end]


def _interpolated(at: Floats, t: Floats, values: Floats) -> Floats:
    """Values (n, columns) at rising times ``t`` (n,) as values at other times between them."""
    if len(t) == 1:
        return np.repeat(values, len(at), axis=0)
    before = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    part = np.clip((at - t[before]) / (t[before + 1] - t[before]), 0.0, 1.0)[:, None]
    return values[before] * (1 - part) + values[before + 1] * part


def _within_limits(values: Floats) -> Floats:
    limits = _LIMITS[: values.shape[1]]
    within: Floats = np.minimum(np.maximum(values, -limits), limits)
    return within


# Unbroken passages of recordings at an even rate, and the gestures made in them.

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
            "{source} has {rate_hz} samples a second, which is too few to tell gestures apart.",
            checklist=("Record at least {slowest_hz} samples a second, better 50.",),
            source=recording.source,
            rate_hz=f"{recording.rate_hz:.1f}",
            slowest_hz=f"{_SLOWEST_HZ:.0f}",
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
            "{source}: the gesture at {start_s} s has a name that is too long, or that cannot be "
            "shown.",
            checklist=("Name it with letters, digits and _, {longest_name} at most.",),
            source=recording.source,
            start_s=f"{take.start_s:.2f}",
            longest_name=_LONGEST_NAME,
        )
    if SHORTEST_S <= take.duration_s <= LONGEST_S:
        return
    raise RecordingError(
        '{source}: the gesture "{name}" at {start_s} s lasts {duration_s} s, too short.'
        if take.duration_s < SHORTEST_S
        else '{source}: the gesture "{name}" at {start_s} s lasts {duration_s} s, too long.',
        checklist=(
            "A gesture lasts {shortest_s} to {longest_s} seconds.",
            "Mark it anew in the recording, or leave it out.",
        ),
        source=recording.source,
        name=take.gesture,
        start_s=f"{take.start_s:.2f}",
        duration_s=f"{take.duration_s:.2f}",
        shortest_s=SHORTEST_S,
        longest_s=f"{LONGEST_S:.0f}",
    )


# A movement as the same watch on the other wrist would have felt it.

# The arms are mirror images, the watch is not: on the right wrist the x of its screen points to
# the elbow, on the left one to the hand; and a mirror turns directions of rotation round.
_ACC = np.array([-1.0, 1.0, 1.0])
_GYR = np.array([1.0, -1.0, -1.0])


@overload
def mirrored(acc: Floats, gyr: Floats) -> tuple[Floats, Floats]: ...
@overload
def mirrored(acc: Floats, gyr: None) -> tuple[Floats, None]: ...
@overload
def mirrored(acc: Floats, gyr: Floats | None) -> tuple[Floats, Floats | None]: ...
def mirrored(acc: Floats, gyr: Floats | None) -> tuple[Floats, Floats | None]:
    """Acceleration (n, 3) and rotation (n, 3) of the mirror image of a movement.

    A watch lies on the back of the wrist: z leaves its screen, y points to the thumb's side on
    both wrists, and x to the hand on the left one, to the elbow on the right one. So between the
    two arms the sensor's frame is mirrored in x. Acceleration is a polar vector, an arrow in
    space, gravity in it too: its x turns round. Rotation is an axial vector, which a mirror turns
    round once more: its x stays, its y and z turn round. Mirrored twice, a movement is as it was.
    """
    return acc * _ACC, None if gyr is None else gyr * _GYR


def usual_wrist(recordings: Sequence[Recording]) -> Wrist:
    """Where most recordings were made; "" when nobody said of any."""
    counts = Counter(one.wrist for one in recordings if one.wrist)
    return counts.most_common(1)[0][0] if counts else ""


def worn_at(recording: Recording, wrist: Wrist) -> Recording:
    """A recording of the other wrist as its mirror image; another one as it is."""
    if {recording.wrist, wrist} != {"left", "right"}:
        return recording
    acc, gyr = mirrored(recording.acc, recording.gyr)
    return replace(recording, acc=acc, gyr=gyr, wrist=wrist)
