"""Examples to learn from: windows that hold a gesture, and windows that hold none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nodes.perceptual.recognition.features import (
    Channels,
    Integers,
    Windows,
    cut_windows,
    describe,
)
from nodes.perceptual.recognition.passages import Passage, Take
from nodes.perceptual.recognition.scans import Gesture, Scan
from nodes.perceptual.recognition.stream import RATE_HZ

NEITHER = -1
_HOLDS = 0.7  # a window that shares so much with a take holds the gesture
_LACKS = 0.5  # one that shares less with every take does not
_COPIES = 4
_TRIMMED = 0.12
_NONE_EVERY_HOPS = 2


@dataclass(frozen=True)
class Examples:
    """n windows and what they hold.

    ``labels`` (n,): index of the gesture, len(gestures) for none, or NEITHER for a window
    between. ``folds`` (n,): the part of the recordings that the window is from, for
    cross-validation.
    """

    gestures: tuple[Gesture, ...]
    windows: Windows
    labels: Integers
    folds: Integers

    def where(self, chosen: np.ndarray) -> Examples:
        """The chosen examples only."""
        windows = self.windows
        return Examples(
            self.gestures,
            Windows(
                windows.signals[chosen], windows.features[chosen], windows.lengths[chosen]
            ),
            self.labels[chosen],
            self.folds[chosen],
        )


def label_scan(found: Scan, gestures: Sequence[Gesture]) -> Integers:
    """What each window of a scan holds."""
    names = [gesture.name for gesture in gestures]
    most = np.zeros(len(found.hop))
    labels = np.full(len(found.hop), len(names), np.intp)
    for take in found.passage.takes:
        overlaps = found.overlaps(take)
        labels[overlaps >= _HOLDS] = names.index(take.gesture)
        most = np.maximum(most, overlaps)
    labels[(most >= _LACKS) & (most < _HOLDS)] = NEITHER
    return labels


def to_learn_from(found: Scan, labels: Integers) -> np.ndarray:
    """Which windows of a scan to learn from: all gestures, and every second look at the rest."""
    thinned = (labels == labels.max(initial=0)) & (found.hop % _NONE_EVERY_HOPS != 0)
    return (labels != NEITHER) & ~thinned


def trimmed_takes(
    passage: Passage, take: Take, channels: Channels, seed: Sequence[int]
) -> Windows:
    """A take as it is, and with a little cut off at both ends."""
    chance = np.random.default_rng(seed)
    cut = chance.uniform(0, _TRIMMED, (_COPIES, 2)) * take.duration_s
    cut[0] = 0.0
    starts_s = take.start_s - passage.start_s + cut[:, 0]
    ends_s = take.end_s - passage.start_s - cut[:, 1]
    last = np.clip(np.rint(ends_s * RATE_HZ), 1, len(passage.samples) - 1).astype(np.intp)
    lengths = np.maximum(np.rint((ends_s - starts_s) * RATE_HZ), 2).astype(np.intp) + 1
    raw = cut_windows(passage.samples[:, : channels.columns], last, lengths)
    return describe(raw, lengths, channels)


def join_windows(parts: Sequence[Windows]) -> Windows:
    """Windows one after the other."""
    return Windows(
        np.concatenate([part.signals for part in parts]),
        np.concatenate([part.features for part in parts]),
        np.concatenate([part.lengths for part in parts]),
    )
