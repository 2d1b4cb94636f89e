"""Passages seen as a spotter sees them: windows of several lengths that end at every hop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nodes.perceptual.recognition.features import (
    Channels,
    Integers,
    Windows,
    cut_windows,
    describe,
)
from nodes.perceptual.recognition.passages import LONGEST_S, SHORTEST_S, Passage, Take
from nodes.perceptual.recognition.stream import RATE_HZ, Floats

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
