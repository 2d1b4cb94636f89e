"""Spotting gestures in the stream of a sensor."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from nodes.perceptual.recognition.features import cut_windows
from nodes.perceptual.recognition.model import TRIGGER, Model, Recogniser, unknown_gesture

from .features import HOP, Detection, PeakPicker, best_lengths
from .streams import RATE_HZ, EvenStream, Floats, Memory


class Spotter:
    """Tells, soon after its end, which gesture was made.

    ``gestures`` limits what it looks for (then it does less work); ``trigger`` is the certainty
    that it takes, one for all or by gesture; ``gravity_included`` says what the sensor's
    acceleration is. RecordingError when the model lacks the method or a gesture, or
    the sensor lacks what the model needs.
    """

    def __init__(
        self,
        model: Model,
        *,
        method: str = "trees",
        gestures: Collection[str] = (),
        trigger: float | Mapping[str, float] = TRIGGER,
        gravity_included: bool = True,
    ) -> None:
        self._model = model
        self._trigger = trigger
        self._recogniser_for = partial(model.recogniser, method, gravity_included)
        self._recogniser_for(True)
        unknown = sorted(set(gestures) - set(model.names))
        if unknown:
            raise unknown_gesture(model, unknown[0])
        wanted = np.array([not gestures or name in gestures for name in model.names])
        useful = model.fits[:, wanted].any(axis=1)
        self._lengths = model.lengths[useful]
        self._fits = model.fits[useful] & wanted
        self._memory = Memory(int(self._lengths[-1]))
        self._gyroscope: bool | None = None
        self._certainties = np.zeros(len(model.gestures))
        self.looked: Callable[[float, Floats, Floats], object] = lambda *_: None
        """Called at each look: its end in s, each gesture's certainty and length of window in s."""
        self._sought = [name for name in model.names if not gestures or name in gestures]

    @property
    def certainties(self) -> dict[str, float]:
        """How certain it was of each gesture that it looks for, when it looked last."""
        known = dict(zip(self._model.names, self._certainties.tolist(), strict=True))
        return {name: known[name] for name in self._sought}

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
        self._certainties = np.zeros(len(self._model.gestures))
        self._since_look = 0

    def _take(self, end_s: float, row: Floats) -> list[Detection]:
        self._memory.add(row)
        self._since_look += 1
        if self._since_look < HOP or len(self._memory) < self._lengths[0]:
            return []
        self._since_look = 0
        samples = self._memory.samples()
        full = self._lengths <= len(samples)
        lengths = self._lengths[full]
        raw = cut_windows(samples, np.full(len(lengths), len(samples) - 1), lengths)
        certainties = self._recogniser.certainties(self._recogniser.windows(raw, lengths))
        best, which = best_lengths(certainties, self._fits[full])
        self._certainties = best
        lengths_s = lengths[which] / RATE_HZ
        self.looked(end_s, best, lengths_s)
        found = self._picker.look(end_s, best, lengths_s)
        return [found] if found else []
