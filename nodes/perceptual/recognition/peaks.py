"""From certainties that rise and fall to one trigger for each gesture made."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nodes.perceptual.recognition.features import Integers
from nodes.perceptual.recognition.scans import Gesture
from nodes.perceptual.recognition.stream import Floats

HOLD_HOPS = 2
"""A trigger waits until the certainty has not risen for so many looks."""
_REFRACTORY = 0.6  # of the gesture's usual length: silence after a trigger
_SHARED = 0.3  # a window may share so much with the one that fired before


@dataclass(frozen=True)
class Detection:
    """A gesture that was made, between two times on the sensor's clock in s."""

    gesture: str
    certainty: float
    t_start: float
    t_end: float


class PeakPicker:
    """Fires once when the best certainty is over its peak.

    ``trigger`` is the certainty that it takes, one for all gestures or by their names.
    """

    def __init__(self, gestures: Sequence[Gesture], trigger: float | Mapping[str, float]) -> None:
        self._gestures = gestures
        self._triggers = [
            trigger[one.name] if isinstance(trigger, Mapping) else trigger for one in gestures
        ]
        self._best: Detection | None = None
        self._waited = 0
        self._silent_until_s = self._free_from_s = float("-inf")
        self._typical_s = {gesture.name: gesture.typical_s for gesture in gestures}

    def look(self, end_s: float, certainties: Floats, lengths_s: Floats) -> Detection | None:
        """Take the certainty of each gesture, in a window of its length that ends now."""
        column = int(certainties.argmax())
        certainty, start_s = float(certainties[column]), end_s - float(lengths_s[column])
        better = self._best is None or certainty > self._best.certainty
        may_fire = end_s >= self._silent_until_s and start_s >= self._free_from_s
        if certainty >= self._triggers[column] and better and may_fire:
            self._best = Detection(self._gestures[column].name, certainty, start_s, end_s)
            self._waited = 0
            return None
        self._waited += 1
        return self.flush() if self._best and self._waited >= HOLD_HOPS else None

    def flush(self) -> Detection | None:
        """Fire what is waiting: the stream has ended."""
        fired, self._best = self._best, None
        if fired is not None:
            self._silent_until_s = fired.t_end + _REFRACTORY * self._typical_s[fired.gesture]
            self._free_from_s = fired.t_end - _SHARED * (fired.t_end - fired.t_start)
        return fired


def best_lengths(certainties: Floats, fits: NDArray[np.bool_]) -> tuple[Floats, Integers]:
    """The highest certainty of each gesture over the windows (..., lengths, gestures) that fit.

    Returns certainties and indices of the lengths; both (..., gestures).
    """
    allowed = certainties * fits
    return allowed.max(axis=-2), allowed.argmax(axis=-2)
