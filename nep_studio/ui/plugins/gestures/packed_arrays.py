"""Samples between the arrays of a computation and the text in a project's file."""

from __future__ import annotations

import numpy as np

from nep_studio.blocks.own_gestures import OwnRecording, OwnTake, packed_samples, unpacked_samples

from .live import Samples

MOST_KEPT_HZ = 200.0
"""More often no hand moves: of a faster sensor every second sample is kept, or every third."""
_MOST_CACHED = 200


def packed(samples: Samples) -> str:
    """The text that a project keeps; times begin at 0 there."""
    parts = [samples.t[:, None] - samples.t[0], samples.acc]
    rows = np.hstack(parts if samples.gyr is None else [*parts, samples.gyr])
    return packed_samples(rows.astype("<f4").tobytes())


def unpacked(recording: OwnRecording) -> Samples:
    """The samples of a recording; none when its text cannot be read."""
    columns = 7 if recording.has_rotation else 4
    try:
        numbers = np.frombuffer(unpacked_samples(recording.samples), dtype="<f4")
        rows = numbers.reshape(-1, columns).astype(float)
    except ValueError:
        return Samples.none()
    return Samples(rows[:, 0], rows[:, 1:4], rows[:, 4:7] if recording.has_rotation else None)


def thinned(samples: Samples) -> Samples:
    """The same at no more than MOST_KEPT_HZ."""
    step = max(1, int(np.ceil(samples.rate_hz / MOST_KEPT_HZ - 0.2)))
    gyr = None if samples.gyr is None else samples.gyr[::step]
    return Samples(samples.t[::step], samples.acc[::step], gyr)


class SampleShelf:
    """The samples of the recordings that were asked for; unpacked once."""

    def __init__(self) -> None:
        self._known: dict[str, Samples] = {}

    def samples(self, recording: OwnRecording) -> Samples:
        """All samples of a recording."""
        known = self._known.get(recording.samples)
        if known is None:
            if len(self._known) >= _MOST_CACHED:
                del self._known[next(iter(self._known))]
            known = self._known[recording.samples] = unpacked(recording)
        return known

    def take(self, recording: OwnRecording | None, take: OwnTake) -> Samples:
        """The samples of one take; none when its recording is not there."""
        if recording is None:
            return Samples.none()
        return self.samples(recording).between(take.start_s, take.end_s)
