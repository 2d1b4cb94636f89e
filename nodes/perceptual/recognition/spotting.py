"""Spotting gestures in the stream of a sensor."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import ArrayLike

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
        self._method = method
        self._gravity_included = gravity_included
        self._trigger = trigger
        self._wanted = _wanted(model, gestures)
        useful = model.fits[:, self._wanted].any(axis=1)
        self._lengths = model.lengths[useful]
        self._fits = model.fits[useful] & self._wanted
        self._gyroscope: bool | None = None
        self._recogniser: Recogniser | None = None

    def push(self, t: ArrayLike, acc: ArrayLike, gyr: ArrayLike | None = None) -> list[Detection]:
        """Take one sample or n: ``t`` s, ``acc`` (n, 3) m/s², ``gyr`` (n, 3) rad/s or None."""
        acc = np.atleast_2d(np.asarray(acc, float))
        if self._gyroscope is not (gyr is not None):
            self._begin(gyr is not None)
        values = acc if gyr is None else np.hstack([acc, np.atleast_2d(np.asarray(gyr, float))])
        found = []
        for stretch in self._stream.push(t, values[:, : self._columns]):
            if not stretch.follows:
                found.append(self._restart())
            for end_s, row in zip(stretch.t, stretch.values, strict=True):
                found.append(self._take(float(end_s), row))
        return [one for one in found if one is not None]

    def flush(self) -> list[Detection]:
        """The stream has ended: what is still waiting fires now."""
        waiting = self._picker.flush() if self._recogniser else None
        return [waiting] if waiting else []

    def _begin(self, gyroscope: bool) -> None:
        """Listen to a sensor, or to one that has gained or lost its gyroscope."""
        self._recogniser = self._model.recogniser(self._method, self._gravity_included, gyroscope)
        self._gyroscope = gyroscope
        self._columns = self._recogniser.channels.columns
        self._stream = EvenStream()
        self._memory = Memory(int(self._lengths[-1]))
        self._restart()

    def _restart(self) -> Detection | None:
        """Forget the movement before a gap; tell what was still waiting."""
        waiting = self._picker.flush() if hasattr(self, "_picker") else None
        self._picker = PeakPicker(self._model.gestures, self._trigger)
        self._memory.clear()
        self._since_look = 0
        return waiting

    def _take(self, end_s: float, row: Floats) -> Detection | None:
        self._memory.add(row)
        self._since_look += 1
        if self._since_look < HOP or len(self._memory) < self._lengths[0]:
            return None
        self._since_look = 0
        return self._look(end_s)

    def _look(self, end_s: float) -> Detection | None:
        assert self._recogniser is not None
        samples = self._memory.samples()
        full = self._lengths <= len(samples)
        lengths = self._lengths[full]
        raw = cut_windows(samples, np.full(len(lengths), len(samples) - 1), lengths)
        windows = describe(raw, lengths, self._recogniser.channels)
        certainties = self._recogniser.certainties(windows)
        best, which = best_lengths(certainties, self._fits[full])
        return self._picker.look(end_s, best, lengths[which] / RATE_HZ)


def _wanted(model: Model, gestures: Collection[str]) -> np.ndarray:
    unknown = sorted(set(gestures) - set(model.names))
    if unknown:
        raise RecordingError(
            f'The gesture model does not know "{unknown[0]}".',
            checklist=(f"Choose one of: {', '.join(model.names)}.", "Or train it and try again."),
        )
    return np.array([not gestures or name in gestures for name in model.names])
