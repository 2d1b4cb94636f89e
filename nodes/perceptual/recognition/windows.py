"""Passages seen as a spotter sees them: windows of several lengths that end at every hop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .features import Channels, Integers, Windows, cut_windows, describe
from .streams import LONGEST_S, RATE_HZ, SHORTEST_S, Floats, Passage, Take

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


def is_long_enough(passage: Passage, lengths: Integers) -> bool:
    """Whether the shortest window fits into a passage."""
    return len(passage.samples) >= int(lengths[0])


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
