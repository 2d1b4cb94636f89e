"""A movement beside the curve that the paper's recogniser expects, and the band around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nep_core.errors import RecordingError
from nep_studio.ui.panels.sensors.ring import Floats
from nep_studio.ui.trainer.live import Samples
from nep_studio.ui.words import tr
from nodes.perceptual.recognition.features import POINTS, Integers, Singles, cut_windows
from nodes.perceptual.recognition.gmr import Gmr
from nodes.perceptual.recognition.model import Model, Recogniser
from nodes.perceptual.recognition.stream import EvenStream

WIDE = 2.0
"""The band is so many standard deviations wide, to each side."""
KINDS = ("body", "rotation", "gravity")
_INSIDE, _MOSTLY = 0.9, 0.7
_PARTS = 3
_STEP = 2
"""Of so many samples, one is tried as the end of the movement."""
_LEAST_SAMPLES = 6


@dataclass(frozen=True)
class Band:
    """n signals over 32 points; ``mean`` and ``spread`` (32, n) are expected, ``live`` was made.

    ``names`` are such as "body x". ``live`` is None while nothing was made.
    """

    gesture: str
    names: tuple[str, ...]
    mean: Floats
    spread: Floats
    live: Floats | None

    @property
    def kinds(self) -> tuple[str, ...]:
        """Which kinds of signals there are."""
        return tuple(kind for kind in KINDS if any(name.startswith(kind) for name in self.names))

    def columns(self, kind: str) -> list[int]:
        """The signals of a kind along x, y and z."""
        wanted = [f"{kind} {axis}" for axis in "xyz"]
        return [self.names.index(name) for name in wanted if name in self.names]

    @property
    def is_inside(self) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
        """Where what was made is within the band; (32, n)."""
        if self.live is None:
            return np.ones(self.mean.shape, bool)
        inside: np.ndarray[tuple[int, int], np.dtype[np.bool_]] = (
            np.abs(self.live - self.mean) <= WIDE * self.spread
        )
        return inside

    @property
    def share_inside(self) -> float:
        """Which part of the movement is within the band."""
        return float(self.is_inside.mean())

    def worst(self) -> tuple[str, int]:
        """The kind of signal that leaves the band most, and the part of the movement (0 to 2)."""
        outside = ~self.is_inside
        parts = np.array_split(outside, _PARTS)
        amounts = {
            (kind, part): float(rows[:, self.columns(kind)].mean())
            for kind in self.kinds
            for part, rows in enumerate(parts)
        }
        return max(amounts, key=lambda key: amounts[key])


def band_of(
    model: Model, gesture: str, movement: Samples | None, *, gravity_included: bool
) -> Band | None:
    """What is expected of a gesture, and the movement in the same signals; None without a curve.

    Of the movement that part is taken that is most like the gesture.
    """
    has_rotation = movement is None or movement.gyr is not None
    try:
        recogniser = model.recogniser("gmr", gravity_included, has_rotation)
    except RecordingError:
        return None
    if gesture not in model.names or not isinstance(recogniser.scorer, Gmr):
        return None
    number, curves = model.names.index(gesture), recogniser.scorer.curves
    mean, spread = curves.expected(number)
    live = None
    if movement is not None:
        signals = _windows(movement, recogniser, model.lengths[model.fits[:, number]])
        if len(signals):
            live = signals[curves.distances(signals)[:, number].argmin()].astype(float)
    return Band(gesture, recogniser.channels.signal_names, mean, spread, live)


def _windows(movement: Samples, recogniser: Recogniser, lengths: Integers) -> Singles:
    """All windows of a movement as the recogniser sees them; (n, 32, signals)."""
    channels = recogniser.channels
    parts = [movement.acc] if movement.gyr is None else [movement.acc, movement.gyr]
    values = np.hstack(parts)[:, : channels.columns]
    stretches = list(EvenStream().push(movement.t, values))
    rows = max((one.values for one in stretches), key=len, default=values[:0])
    if len(rows) < _LEAST_SAMPLES:
        return np.empty((0, POINTS, channels.signals), np.float32)
    usable = lengths[lengths <= len(rows)]
    sizes = usable if len(usable) else np.array([len(rows)])
    pairs = [(last, size) for size in sizes.tolist() for last in range(size - 1, len(rows), _STEP)]
    last, length = np.array(pairs, np.intp).T
    return recogniser.windows(cut_windows(rows, last, length), length).signals


def kind_words(kind: str) -> str:
    """What the signals of a kind are called."""
    words = {
        "body": tr("Movement"),
        "rotation": tr("Rotation"),
        "gravity": tr("How the watch is held"),
    }
    return words[kind]


def in_words(band: Band, title: str) -> str:
    """What the picture shows."""
    if band.live is None:
        return tr(
            "The line is how “{gesture}” is expected, the band how far takes stray from it."
            " Make the gesture to see yours over it.",
            gesture=title,
        )
    share, percent = band.share_inside, round(band.share_inside * 100)
    if share >= _INSIDE:
        return tr(
            "Your movement follows “{gesture}”: {percent} % of it is within the band.",
            gesture=title,
            percent=percent,
        )
    kind, part = band.worst()
    where = (tr("at the beginning"), tr("in the middle"), tr("at the end"))[part]
    if share >= _MOSTLY:
        return tr(
            "Your movement is near “{gesture}”: {percent} % of it is within the band."
            " It strays most {where} ({signal}).",
            gesture=title,
            percent=percent,
            where=where,
            signal=kind_words(kind),
        )
    return tr(
        "Your movement is not “{gesture}”: only {percent} % of it is within the band."
        " It strays most {where} ({signal}).",
        gesture=title,
        percent=percent,
        where=where,
        signal=kind_words(kind),
    )
