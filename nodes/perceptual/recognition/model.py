"""A model: the gestures that it knows, and recognisers for what a sensor may offer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.features import Channels, Integers, Windows
from nodes.perceptual.recognition.scans import Gesture, fitting, window_lengths
from nodes.perceptual.recognition.stream import Floats

METHODS = ("trees", "gmr")
TRIGGER = 0.75
"""The certainty at which a gesture counts as made."""


class Scorer(Protocol):
    """What a method of recognition can do."""

    def scores(self, windows: Windows) -> Floats:
        """A number from 0 to 1 for each window and gesture; (n, gestures)."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""


@dataclass(frozen=True)
class Recogniser:
    """A scorer for certain channels; ``usual`` (gestures,) are the scores of left-out takes."""

    method: str
    channels: Channels
    scorer: Scorer
    usual: Floats

    def certainties(self, windows: Windows) -> Floats:
        """Certainties from 0 to 1; (n, gestures)."""
        return certainty_of(self.scorer.scores(windows), self.usual)


def certainty_of(scores: Floats, usual: Floats) -> Floats:
    """Scores (..., gestures) on a scale that means the same for every model.

    1 is a score as left-out takes usually have; half of that is at TRIGGER.
    """
    return np.interp(scores / usual, [0.0, 0.5, 1.0], [0.0, TRIGGER, 1.0])


@dataclass(frozen=True)
class Model:
    """Gestures, recognisers, ``trained_on`` in words, and the report of the training by method."""

    gestures: tuple[Gesture, ...]
    recognisers: tuple[Recogniser, ...]
    trained_on: str
    report: Mapping[str, Any]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the gestures."""
        return tuple(gesture.name for gesture in self.gestures)

    @property
    def lengths(self) -> Integers:
        """The lengths of window to look at, in samples."""
        return window_lengths(self.gestures)

    @property
    def fits(self) -> NDArray[np.bool_]:
        """Which lengths may hold which gesture; (lengths, gestures)."""
        return fitting(self.gestures, self.lengths)

    def recogniser(self, method: str, gravity_included: bool, gyroscope: bool) -> Recogniser:
        """The best recogniser for a sensor; RecordingError says what the sensor lacks."""
        of_method = [found for found in self.recognisers if found.method == method]
        if not of_method:
            known = " and ".join(sorted({found.method for found in self.recognisers}))
            raise RecordingError(
                f'This gesture model cannot recognise by "{method}": it was trained for {known}.',
                checklist=(f"Choose the method {known}.", "Or train the model again for both."),
            )
        usable = [
            found
            for found in of_method
            if found.channels.gravity <= gravity_included and found.channels.gyroscope <= gyroscope
        ]
        if not usable:
            least = min(of_method, key=lambda found: found.channels.signals)
            raise RecordingError(
                f"This gesture model needs {least.channels.in_words},"
                " and the sensor does not send that.",
                checklist=(
                    f"In the app of the watch or phone, switch on {least.channels.in_words}.",
                    "Or use the kind of watch or phone that the gestures were recorded with.",
                    "Or record the gestures with this sensor and train again.",
                ),
            )
        return max(usable, key=lambda found: found.channels.signals)
