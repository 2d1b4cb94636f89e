"""A model: the gestures that it knows, and recognisers for what a sensor may offer."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from nep_core.errors import RecordingError
from nodes.perceptual.recognition.features import Channels, Integers, Windows, describe
from nodes.perceptual.recognition.features_1 import describe_1
from nodes.perceptual.recognition.scans import Gesture, fitting, window_lengths
from nodes.perceptual.recognition.stream import Floats

METHODS = ("trees", "gmr")
TRIGGER = 0.75
"""The certainty at which a gesture counts as made."""
LOWEST_TRIGGER, HIGHEST_TRIGGER = 0.05, 1.0
FEATURES = 2
"""How windows are described now; models of version 1 know the first way."""


class Scorer(Protocol):
    """What a method of recognition can do."""

    def scores(self, windows: Windows) -> Floats:
        """A number from 0 to 1 for each window and gesture; (n, gestures)."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""


@dataclass(frozen=True)
class Recogniser:
    """A scorer for certain channels; ``usual`` (gestures,) are the scores of left-out takes.

    ``features`` is the way in which windows are described for it: 1 or FEATURES.
    """

    method: str
    channels: Channels
    scorer: Scorer
    usual: Floats
    features: int = FEATURES

    def windows(self, raw: Floats, lengths: Integers) -> Windows:
        """Raw windows (n, 32, 3 or 6), described as this recogniser knows them."""
        return (describe_1 if self.features == 1 else describe)(raw, lengths, self.channels)

    def certainties(self, windows: Windows) -> Floats:
        """Certainties from 0 to 1; (n, gestures)."""
        return certainty_of(self.scorer.scores(windows), self.usual)


def certainty_of(scores: Floats, usual: Floats) -> Floats:
    """Scores (..., gestures) on a scale that means the same for every model.

    1 is a score as left-out takes usually have; half of that is at TRIGGER.
    """
    return np.interp(scores / usual, [0.0, 0.5, 1.0], [0.0, TRIGGER, 1.0])


@dataclass(frozen=True)
class Sensor:
    """What recordings were made with; ``device`` is "" when nobody said."""

    device: str
    rate_hz: float
    gravity_included: bool
    gyroscope: bool


@dataclass(frozen=True)
class Model:
    """Gestures, recognisers, ``trained_on`` in words, and the report of the training by method.

    ``triggers`` are the certainties at which each gesture counts as made, TRIGGER where none is
    given. ``wrist`` is where the ``sensors`` of the training were worn: left, right, hand, or ""
    when nobody said.
    """

    gestures: tuple[Gesture, ...]
    recognisers: tuple[Recogniser, ...]
    trained_on: str
    report: Mapping[str, Any]
    triggers: Mapping[str, float] = field(default_factory=dict)
    wrist: str = ""
    sensors: tuple[Sensor, ...] = ()

    def __post_init__(self) -> None:
        complete = {name: self.triggers.get(name, TRIGGER) for name in self.names}
        object.__setattr__(self, "triggers", complete)

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


def with_triggers(model: Model, triggers: Mapping[str, float]) -> Model:
    """The model with other triggers for some of its gestures.

    RecordingError for a gesture that it does not know, or a certainty that makes no sense.
    """
    for name, certainty in triggers.items():
        if name not in model.names:
            raise unknown_gesture(model, name)
        if not LOWEST_TRIGGER <= certainty <= HIGHEST_TRIGGER:
            raise RecordingError(
                f"The certainty of {name} is {certainty:g}, which is not possible.",
                checklist=(f"Choose one from {LOWEST_TRIGGER} to {HIGHEST_TRIGGER:.0f}.",),
            )
    return replace(model, triggers={**model.triggers, **triggers})


def unknown_gesture(model: Model, name: str) -> RecordingError:
    """The error of a gesture that a model was not trained for."""
    return RecordingError(
        f'The gesture model does not know "{name}".',
        checklist=(f"Choose one of: {', '.join(model.names)}.", "Or train it and try again."),
    )
