"""Gestures that a simulated person knows: those of the paper, and recorded takes of any others."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from nep_core.errors import ParameterError
from nodes.perceptual.recognition.passages import Take, takes_of
from nodes.perceptual.recognition.wrist import usual_wrist, worn_at
from nodes.recordings import Recording, read_recordings
from nodes.sensory.arm.gestures import GESTURES, Gesture
from nodes.sensory.arm.sensor import GRAVITY_M_S2
from nodes.sensory.arm.skeleton import Floats

AROUND_S = 1.5
"""So much of a recording is kept before and after a take: the ways there and back."""
_MOST_TAKES = 200  # of each gesture
_LONGEST_GAP_S = 0.5
_SMOOTHED_S = 0.5
_FASTEST_RAD_S = 8.0  # what is taken for gravity is not always gravity


@dataclass(frozen=True)
class RecordedTake:
    """One performance with what was around it; times in s, of which 0 is where the take starts.

    ``up`` (n, 3) is the gravity in the acceleration in m/s², and ``moving`` (n, 3) the rest of it;
    ``up`` is None when the sensor took gravity out. ``gyr`` (n, 3) is rad/s.
    """

    t: Floats
    moving: Floats
    up: Floats | None
    gyr: Floats
    duration_s: float


@dataclass(frozen=True)
class OwnGesture:
    """A gesture that somebody recorded, and its takes."""

    name: str
    takes: tuple[RecordedTake, ...]


Movement = Gesture | OwnGesture


@dataclass(frozen=True)
class Repertoire:
    """The gestures that can be asked for; own ones go before the paper's of the same name."""

    own: dict[str, OwnGesture]

    def find(self, name: str) -> Movement:
        """The gesture of this name; ParameterError names the known ones."""
        found = self.own.get(name) or GESTURES.get(name)
        if found is None:
            known = dict.fromkeys((*self.own, *GESTURES))
            raise ParameterError(
                f'The simulated person knows no gesture "{name}".',
                checklist=(f"Choose one of: {', '.join(known)}.",),
            )
        return found


def read_repertoire(folder: str) -> Repertoire:
    """The paper's gestures, and those of the recordings in a folder ("" is none).

    What was recorded on the other wrist than most is mirrored, as training does. RecordingError
    says which recording cannot be read.
    """
    takes: dict[str, list[RecordedTake]] = {}
    found = read_recordings(Path(folder)) if folder else []
    wrist = usual_wrist(found)
    for recording in (worn_at(one, wrist) for one in found):
        for take in takes_of(recording):
            made = recorded_take(recording, take)
            if made is not None and len(takes.setdefault(take.gesture, [])) < _MOST_TAKES:
                takes[take.gesture].append(made)
    return Repertoire({name: OwnGesture(name, tuple(each)) for name, each in takes.items() if each})


def recorded_take(recording: Recording, take: Take) -> RecordedTake | None:
    """A take with what is around it and belongs to no other one; None when samples are missing."""
    t = recording.t
    first, last = (int(np.searchsorted(t, at)) for at in (take.start_s, take.end_s))
    begin, end = _free_before(recording, first), _free_after(recording, min(last, len(t) - 1))
    part = slice(begin, end + 1)
    if np.diff(t[first : last + 1]).max(initial=0.0) > _LONGEST_GAP_S or end - begin < 2:
        return None
    rises = np.concatenate([[True], np.diff(t[part]) > 0])
    times, acc = t[part][rises], recording.acc[part][rises]
    gyr = None if recording.gyr is None else recording.gyr[part][rises]
    up = _smoothed(times, acc) if recording.gravity_included else None
    return RecordedTake(
        t=times - take.start_s,
        moving=acc if up is None else acc - up,
        up=up,
        gyr=gyr if gyr is not None else _turning(times, up, len(times)),
        duration_s=take.duration_s,
    )


def _free_before(recording: Recording, first: int) -> int:
    """The first sample of what leads to a take without a gap or a mark."""
    t, labels, at = recording.t, recording.labels or (), first
    while at > 0 and not labels[at - 1] and t[first] - t[at - 1] <= AROUND_S:
        if t[at] - t[at - 1] > _LONGEST_GAP_S:
            break
        at -= 1
    return at


def _free_after(recording: Recording, last: int) -> int:
    """The last sample of what follows a take without a gap or a mark."""
    t, labels, at = recording.t, recording.labels or (), last
    while at + 1 < len(t) and not labels[at + 1] and t[at + 1] - t[last] <= AROUND_S:
        if t[at + 1] - t[at] > _LONGEST_GAP_S:
            break
        at += 1
    return at


def _smoothed(t: Floats, values: Floats) -> Floats:
    """The mean over half a second around each time; (n, 3)."""
    summed = np.vstack([np.zeros(3), np.cumsum(values, axis=0)])
    low = np.searchsorted(t, t - _SMOOTHED_S / 2)
    high = np.searchsorted(t, t + _SMOOTHED_S / 2, side="right")
    mean: Floats = (summed[high] - summed[low]) / (high - low)[:, None]
    return mean


def _turning(t: Floats, up: Floats | None, count: int) -> Floats:
    """The rotation that a turning gravity shows, of a sensor without a gyroscope; (n, 3) rad/s."""
    if up is None:
        return np.zeros((count, 3))
    unit = up / np.maximum(np.linalg.norm(up, axis=1, keepdims=True), 0.1 * GRAVITY_M_S2)
    turning: Floats = np.cross(np.gradient(unit, t, axis=0), unit)
    return np.clip(turning, -_FASTEST_RAD_S, _FASTEST_RAD_S)
