"""Spotting gestures in the stream of a sensor."""

from __future__ import annotations

from collections.abc import Collection
from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.features import cut_windows, describe
from nodes.perceptual.recognition.model import TRIGGER, Model, Recogniser
from nodes.perceptual.recognition.peaks import Detection, PeakPicker, best_lengths
from nodes.perceptual.recognition.scans import HOP
from nodes.perceptual.recognition.stream import RATE_HZ, EvenStream, Floats, Memory


class Spotter:
    """Tells, soon after its end, which gesture was made.

    ``gestures`` limits what it looks for (then it does less work); ``gravity_included`` says what
    the sensor's acceleration is. RecordingError when the model lacks the method or a gesture, or
    the sensor lacks what the model needs.
    """

    def __init__(
        self,
        model: Model,
        *,
        method: str = "trees",
        gestures: Collection[str] = (),
        trigger: float = TRIGGER,
        gravity_included: bool = True,
    ) -> None:
        self._model = model
        self._trigger = trigger
        self._recogniser_for = partial(model.recogniser, method, gravity_included)
        self._recogniser_for(True)
        wanted = _wanted(model, gestures)
        useful = model.fits[:, wanted].any(axis=1)
        self._lengths = model.lengths[useful]
        self._fits = model.fits[useful] & wanted
        self._memory = Memory(int(self._lengths[-1]))
        self._gyroscope: bool | None = None

    def listen(self, gyroscope: bool) -> None:
        """Begin with a sensor; RecordingError when it lacks what the model needs."""
        self._recogniser: Recogniser = self._recogniser_for(gyroscope)
        self._gyroscope = gyroscope
        self._stream = EvenStream()
        self._begin()

    def push(self, t: ArrayLike, acc: ArrayLike, gyr: ArrayLike | None = None) -> list[Detection]:
        """Take one sample or n: ``t`` s, ``acc`` (n, 3) m/s², ``gyr`` (n, 3) rad/s or None."""
        if self._gyroscope is not (gyr is not None):
            self.listen(gyr is not None)
        parts = [np.atleast_2d(np.asarray(part, float)) for part in (acc, gyr) if part is not None]
        values = np.hstack(parts)[:, : self._recogniser.channels.columns]
        found: list[Detection] = []
        for stretch in self._stream.push(t, values):
            if not stretch.follows:
                found += self.flush()
                self._begin()
            for end_s, row in zip(stretch.t, stretch.values, strict=True):
                found += self._take(float(end_s), row)
        return found

    def flush(self) -> list[Detection]:
        """The movement has ended: what still waits for something better fires now."""
        waiting = self._picker.flush() if self._gyroscope is not None else None
        return [waiting] if waiting else []

    def _begin(self) -> None:
        """A new movement: what was before it does not matter."""
        self._picker = PeakPicker(self._model.gestures, self._trigger)
        self._memory.clear()
        self._since_look = 0

    def _take(self, end_s: float, row: Floats) -> list[Detection]:
        self._memory.add(row)
        self._since_look += 1
        if self._since_look < HOP or len(self._memory) < self._lengths[0]:
            return []
        self._since_look = 0
        found = self._look(end_s)
        return [found] if found else []

    def _look(self, end_s: float) -> Detection | None:
        samples = self._memory.samples()
        full = self._lengths <= len(samples)
        lengths = self._lengths[full]
        raw = cut_windows(samples, np.full(len(lengths), len(samples) - 1), lengths)
        windows = describe(raw, lengths, self._recogniser.channels)
        certainties = self._recogniser.certainties(windows)
        best, which = best_lengths(certainties, self._fits[full])
        return self._picker.look(end_s, best, lengths[which] / RATE_HZ)


def _wanted(model: Model, gestures: Collection[str]) -> NDArray[np.bool_]:
    unknown = sorted(set(gestures) - set(model.names))
    if unknown:
        raise RecordingError(
            f'The gesture model does not know "{unknown[0]}".',
            checklist=(f"Choose one of: {', '.join(model.names)}.", "Or train it and try again."),
        )
    return np.array([not gestures or name in gestures for name in model.names])
