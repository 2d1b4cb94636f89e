"""Windows of a movement, as a spotter sees it, and the numbers that describe each of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from faults import Text

from .streams import LONGEST_S, RATE_HZ, SHORTEST_S, Floats, Passage, Take

Integers = NDArray[np.intp]
Singles = NDArray[np.float32]  # half the memory: an hour of recordings is 400,000 windows

POINTS = 32
"""Every window is resampled to so many points."""
_SEGMENTS = 8
_GRAVITY_SPAN = 13  # points: the moving average over 40 % of a window is taken for gravity
_EARTH_M_S2 = 9.81
_ROTATION_M_S2 = 3.0  # so much acceleration counts as much as 1 rad/s
_STILL_M_S2 = 0.5  # movement as weak as a sensor's noise is not blown up to full size
_COMPRESSION = 2.0
_LEAST_POWER = 0.1


IN_WORDS = {
    (False, False): "acceleration",
    (True, False): "acceleration with gravity",
    (False, True): "acceleration and rotation",
    (True, True): "acceleration with gravity and rotation",
}
"""What a sensor must have: gravity in its acceleration, a gyroscope."""


@dataclass(frozen=True)
class Channels:
    """What a model listens to besides the acceleration of the body."""

    gravity: bool
    gyroscope: bool

    @property
    def columns(self) -> int:
        """Columns of a sample: acceleration, and angular velocity if there is a gyroscope."""
        return 6 if self.gyroscope else 3

    @property
    def signals(self) -> int:
        """How many signals ``signals_of`` gives."""
        return 4 * (1 + self.gyroscope) + 3 * self.gravity

    @property
    def signal_names(self) -> tuple[str, ...]:
        """What each signal of ``signals_of`` is: the body's movement, its size, rotation, gravity.

        ``body x`` and ``rotation x`` are on a logarithmic scale, ``gravity x`` in parts of g.
        """
        kinds = ["body", *(["rotation"] if self.gyroscope else [])]
        names = [f"{kind} {axis}" for kind in kinds for axis in ("x", "y", "z", "size")]
        return (*names, *(f"gravity {axis}" for axis in "xyz" if self.gravity))

    @property
    def in_words(self) -> Text:
        """For people: what the sensor must have."""
        return Text(IN_WORDS[self.gravity, self.gyroscope])


@dataclass(frozen=True)
class Windows:
    """n time windows: ``signals`` (n, 32, s), ``features`` (n, f), ``lengths`` (n,) samples."""

    signals: Singles
    features: Singles
    lengths: Integers

    def __len__(self) -> int:
        return len(self.lengths)

    def where(self, chosen: NDArray[Any]) -> Windows:
        """The chosen windows only."""
        return Windows(self.signals[chosen], self.features[chosen], self.lengths[chosen])


def cut_windows(samples: Floats, last: Integers, lengths: Integers) -> Floats:
    """The windows of ``lengths`` (n,) samples that end with sample ``last`` (n,); (n, 32, columns).

    Positions before the first sample take the first.
    """
    steps = np.linspace(-1.0, 0.0, POINTS)
    positions = np.maximum(last[:, None] + steps * (lengths[:, None] - 1), 0.0)
    before = np.minimum(positions.astype(np.intp), len(samples) - 2)
    part = (positions - before)[..., None]
    windows: Floats = samples[before] * (1 - part) + samples[before + 1] * part
    return windows


def describe(raw: Floats, lengths: Integers, channels: Channels) -> Windows:
    """Signals and features of raw windows (n, 32, 3 or 6)."""
    raw = raw.astype(np.float32)
    signals = signals_of(raw, channels)
    features = np.concatenate([features_of(signals), _powers(raw, channels)], axis=1)
    return Windows(signals.astype(np.float32), features.astype(np.float32), lengths)


def signals_of(raw: Floats, channels: Channels) -> Floats:
    """Raw windows (n, 32, 3 or 6) as signals of the same size; (n, 32, channels.signals).

    People make the same gesture up to four times as strongly as others: each window is divided by
    the power of its whole movement, acceleration and rotation together. A gesture begins and ends
    at rest, so its acceleration has no mean; what has one is gravity, or the sensor's error. Each
    vector is followed by its length, which does not depend on how the watch sits.
    """
    parts = _movement(raw, channels)
    whole = np.sqrt(sum(_squares(part) for part in parts))[:, None, None] + _STILL_M_S2
    signals = []
    for part in parts:
        relative = part / whole
        length = np.linalg.norm(relative, axis=2, keepdims=True)
        signals += [np.sign(relative) * _logarithm(np.abs(relative)), _logarithm(length)]
    if channels.gravity:
        signals.append(_SMOOTHING @ raw[..., :3] / _EARTH_M_S2)
    return np.concatenate(signals, axis=2)


def features_of(signals: Floats) -> Floats:
    """Statistics of each signal, of its eighths, and of each pair."""
    n, _, count = signals.shape
    points = np.ascontiguousarray(signals.transpose(1, 0, 2))  # time first: sums are much faster
    mean = points.mean(axis=0)
    square = np.matmul(signals.transpose(0, 2, 1), signals) / POINTS
    power = np.sqrt(np.einsum("nii->ni", square))
    first, second = np.triu_indices(count, 1)
    together = square[:, first, second] / (power[:, first] * power[:, second] + 1e-6)
    positive = points > 0
    eighths = points.reshape(_SEGMENTS, -1, n, count).mean(axis=1)
    return np.concatenate(
        [
            points.max(axis=0),
            mean,
            points.min(axis=0),
            np.sqrt(np.maximum(power**2 - mean**2, 0.0)),
            np.abs(points).mean(axis=0),
            (positive[1:] != positive[:-1]).mean(axis=0, dtype=np.float32),
            power,
            eighths.transpose(1, 0, 2).reshape(n, -1),
            together,
        ],
        axis=1,
    )


def feature_count(channels: Channels) -> int:
    """How many features ``features_of`` gives."""
    count = channels.signals
    powers = 3 if channels.gyroscope else 1
    return (7 + _SEGMENTS) * count + count * (count - 1) // 2 + powers


def _movement(raw: Floats, channels: Channels) -> list[Floats]:
    """The body's acceleration, and its rotation on the same scale; (n, 32, 3) each."""
    acceleration = raw[..., :3]
    parts = [acceleration - acceleration.mean(axis=1, keepdims=True)]
    return parts + ([raw[..., 3:6] * _ROTATION_M_S2] if channels.gyroscope else [])


def _squares(part: Floats) -> Floats:
    squares: Floats = np.einsum("nps,nps->n", part, part) / POINTS
    return squares


def _powers(raw: Floats, channels: Channels) -> Floats:
    """How strong the movement is: in all, and with a gyroscope of each kind; logarithms (n, p)."""
    squares = [_squares(part) for part in _movement(raw, channels)]
    parts = [sum(squares), *squares] if channels.gyroscope else squares
    powers: Floats = np.log(np.sqrt(np.stack(parts, axis=1)) + _LEAST_POWER)
    return powers


def _logarithm(sizes: Floats) -> Floats:
    return np.log1p(_COMPRESSION * sizes)


_NEAR = np.abs(np.arange(POINTS)[:, None] - np.arange(POINTS)) <= _GRAVITY_SPAN // 2
_SMOOTHING: Floats = _NEAR / _NEAR.sum(axis=1, keepdims=True)
"""The moving average as a matrix; (32, 32)."""


# Passages seen as a spotter sees them: windows of several lengths that end at every hop.

HOP = 4
"""Samples between two looks at the stream: 80 ms."""
WINDOW_LENGTHS = 8
_SHORTER, _LONGER = 0.7, 1.2
_FASTER, _SLOWER = 0.85, 1.25  # the takes of people who have not been recorded


@dataclass(frozen=True)
class Gesture:
    """A gesture that a model knows, and how long its takes last."""

    name: str
    shortest_s: float
    typical_s: float
    longest_s: float
    takes: int


@dataclass(frozen=True)
class Scan:
    """A passage's windows: ``last`` (n,) their last samples, ``lengths`` (n,) how many they have.

    ``hop`` (n,) is which look it was, ``which`` (n,) the index of the length; ``starts_s`` and
    ``ends_s`` (n,) are on the recording's clock.
    """

    passage: Passage
    hop: Integers
    which: Integers
    last: Integers
    lengths: Integers
    starts_s: Floats
    ends_s: Floats

    def raw(self, chosen: NDArray[np.bool_]) -> Floats:
        """The chosen windows as they were measured; (n, 32, 3 or 6)."""
        return cut_windows(self.passage.samples, self.last[chosen], self.lengths[chosen])

    def windows(self, channels: Channels, chosen: NDArray[np.bool_]) -> Windows:
        """The chosen windows, described for certain channels."""
        return describe(self.raw(chosen)[..., : channels.columns], self.lengths[chosen], channels)

    def overlaps(self, take: Take) -> Floats:
        """Shared time over spanned time of each window and a take; (n,) from 0 to 1."""
        shared = np.minimum(self.ends_s, take.end_s) - np.maximum(self.starts_s, take.start_s)
        spanned = np.maximum(self.ends_s, take.end_s) - np.minimum(self.starts_s, take.start_s)
        overlap: Floats = np.maximum(shared, 0.0) / spanned
        return overlap


def gestures_in(takes: Sequence[Take], people: int = 1) -> tuple[Gesture, ...]:
    """The gestures of the takes, by name.

    Who taught together with others teaches for others: these may be slower or faster than any.
    """
    slower, faster = (_SLOWER, _FASTER) if people > 1 else (1.0, 1.0)

    def described(name: str) -> Gesture:
        durations = [take.duration_s for take in takes if take.gesture == name]
        low = max(min(durations) * faster, SHORTEST_S)
        high = min(max(durations) * slower, LONGEST_S)
        return Gesture(name, low, float(np.median(durations)), high, len(durations))

    return tuple(described(name) for name in sorted({take.gesture for take in takes}))


def window_lengths(gestures: Sequence[Gesture]) -> Integers:
    """The lengths of window that find these gestures, in samples, rising."""
    shortest = _SHORTER * min(gesture.shortest_s for gesture in gestures) * RATE_HZ
    longest = _LONGER * max(gesture.longest_s for gesture in gestures) * RATE_HZ
    lengths = np.geomspace(max(shortest, 6), max(longest, 7), WINDOW_LENGTHS)
    return np.unique(np.rint(lengths).astype(np.intp))


def fitting(gestures: Sequence[Gesture], lengths: Integers) -> NDArray[np.bool_]:
    """Which lengths of window may hold which gesture; (lengths, gestures)."""
    seconds = lengths / RATE_HZ
    fits = np.empty((len(lengths), len(gestures)), bool)
    for column, gesture in enumerate(gestures):
        low, high = _SHORTER * gesture.shortest_s, _LONGER * gesture.longest_s
        fits[:, column] = (seconds >= low - 1e-9) & (seconds <= high + 1e-9)
        fits[np.argmin(np.abs(seconds - gesture.typical_s)), column] = True
    return fits


def scan(passage: Passage, lengths: Integers) -> Scan:
    """All windows of a passage that is long enough."""
    hops = np.arange(lengths[0] - 1, len(passage.samples), HOP)
    hop, which = (grid.ravel() for grid in np.indices((len(hops), len(lengths))))
    inside = hops[hop] >= lengths[which] - 1
    hop, which = hop[inside], which[inside]
    last, length = hops[hop], lengths[which]
    return Scan(
        passage,
        hop,
        which,
        last,
        length,
        passage.start_s + (last - length + 1) / RATE_HZ,
        passage.start_s + last / RATE_HZ,
    )


# From certainties that rise and fall to one trigger for each gesture made.

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
