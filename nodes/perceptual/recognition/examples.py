"""Examples to learn from: windows that hold a gesture, and windows that hold none."""

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
from nodes.perceptual.recognition.passages import Passage, Take
from nodes.perceptual.recognition.scans import Gesture, Scan
from nodes.perceptual.recognition.stream import RATE_HZ

Flags = NDArray[np.bool_]

NEITHER = -1
_HOLDS = 0.7  # a window that shares so much with a take holds the gesture
_LACKS = 0.5  # one that shares less with every take does not
_COPIES = 4
_TRIMMED = 0.12
_NONE_EVERY_HOPS = 3


@dataclass(frozen=True)
class Examples:
    """n windows and what they hold.

    ``labels`` (n,): index of the gesture, len(gestures) for none, or NEITHER for a window
    between. ``folds`` (n,): the part of the recordings that the window is from, for
    cross-validation. ``marked`` (n,): whether the window was cut where a person marked a take.
    """

    gestures: tuple[Gesture, ...]
    windows: Windows
    labels: Integers
    folds: Integers
    marked: Flags

    def where(self, chosen: Flags) -> Examples:
        """The chosen examples only."""
        return Examples(
            self.gestures,
            self.windows.where(chosen),
            self.labels[chosen],
            self.folds[chosen],
            self.marked[chosen],
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
    for start_s, end_s in found.passage.unknown:
        labels[(found.starts_s < end_s) & (found.ends_s > start_s)] = NEITHER
    return labels


def to_learn_from(found: Scan, labels: Integers, none: int) -> Flags:
    """Which windows of a scan to learn from: all gestures, and every third look at the rest."""
    thinned = (labels == none) & (found.hop % _NONE_EVERY_HOPS != 0)
    chosen: Flags = (labels != NEITHER) & ~thinned
    return chosen


def trimmed_takes(passage: Passage, take: Take, channels: Channels, seed: Sequence[int]) -> Windows:
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


def collect(
    gestures: tuple[Gesture, ...],
    scans: Sequence[Scan],
    folds: Sequence[Integers],
    takes_folds: Sequence[Sequence[int]],
    channels: Channels,
    seed: int,
) -> Examples:
    """All examples of the scans, whose windows are in ``folds`` and takes in ``takes_folds``."""
    parts, labels, part_folds, marked = [], [], [], []
    for number, (found, fold, take_folds) in enumerate(zip(scans, folds, takes_folds, strict=True)):
        held = label_scan(found, gestures)
        chosen = to_learn_from(found, held, len(gestures))
        parts.append(found.windows.where(chosen))
        labels.append(held[chosen])
        part_folds.append(fold[chosen])
        marked.append(np.zeros(chosen.sum(), bool))
        for index, (take, take_fold) in enumerate(
            zip(found.passage.takes, take_folds, strict=True)
        ):
            copies = trimmed_takes(found.passage, take, channels, (seed, number, index))
            name = [gesture.name for gesture in gestures].index(take.gesture)
            parts.append(copies)
            labels.append(np.full(len(copies), name))
            part_folds.append(np.full(len(copies), take_fold))
            marked.append(np.ones(len(copies), bool))
    return Examples(
        gestures,
        join_windows(parts),
        np.concatenate(labels),
        np.concatenate(part_folds),
        np.concatenate(marked),
    )
