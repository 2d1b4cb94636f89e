"""Examples to learn from: windows that hold a gesture, and windows that hold none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

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
from nodes.perceptual.recognition.stream import RATE_HZ, Floats
from nodes.perceptual.recognition.variation import varied

Flags = NDArray[np.bool_]

NEITHER = -1
_HOLDS = 0.7  # a window that shares so much with a take holds the gesture
_LACKS = 0.5  # one that shares less with every take does not
_COPIES = 4
_TRIMMED = 0.12
_VARIATIONS = 3
_NONE_EVERY_HOPS = 3
_EVERYDAY_EVERY_HOPS = 8


@dataclass(frozen=True)
class Examples:
    """n windows and what they hold.

    ``labels`` (n,): index of the gesture, len(gestures) for none, or NEITHER for a window
    between. ``folds`` (n,): the part of the recordings that the window is from, for
    cross-validation. ``marked`` (n,): whether the window was cut where a person marked a take.
    """

    gestures: tuple[Gesture, ...]
    channels: Channels
    windows: Windows
    labels: Integers
    folds: Integers
    marked: Flags

    def where(self, chosen: Flags) -> Examples:
        """The chosen examples only."""
        return Examples(
            self.gestures,
            self.channels,
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
    """Which windows of a scan to learn from: all gestures, and some of the looks at the rest."""
    every = _NONE_EVERY_HOPS if found.passage.takes else _EVERYDAY_EVERY_HOPS
    thinned = (labels == none) & (found.hop % every != 0)
    chosen: Flags = (labels != NEITHER) & ~thinned
    return chosen


def trimmed_takes(passage: Passage, take: Take, seed: Sequence[int]) -> tuple[Floats, Integers]:
    """A take as it is, and with a little cut off at both ends: raw windows and their lengths."""
    chance = np.random.default_rng(seed)
    cut = chance.uniform(0, _TRIMMED, (_COPIES, 2)) * take.duration_s
    cut[0] = 0.0
    starts_s = take.start_s - passage.start_s + cut[:, 0]
    ends_s = take.end_s - passage.start_s - cut[:, 1]
    last = np.clip(np.rint(ends_s * RATE_HZ), 1, len(passage.samples) - 1).astype(np.intp)
    lengths = np.maximum(np.rint((ends_s - starts_s) * RATE_HZ), 2).astype(np.intp) + 1
    return cut_windows(passage.samples, last, lengths), lengths


def join_windows(parts: Sequence[Windows]) -> Windows:
    """Windows one after the other."""
    return Windows(
        np.concatenate([part.signals for part in parts]),
        np.concatenate([part.features for part in parts]),
        np.concatenate([part.lengths for part in parts]),
    )


@dataclass(frozen=True)
class _Part:
    """Some windows as they were measured, and what they hold."""

    raw: Floats
    lengths: Integers
    labels: Integers
    folds: Integers
    marked: Flags


def collect(
    gestures: tuple[Gesture, ...],
    scans: Sequence[Scan],
    folds: Sequence[Integers],
    takes_folds: Sequence[Sequence[int]],
    channels: Channels,
    seed: int,
) -> Examples:
    """All examples of the scans, whose windows are in ``folds`` and takes in ``takes_folds``.

    What holds a gesture is there three times, each time as others would make it.
    """
    idle, held = [], []
    for number, (found, fold, of_takes) in enumerate(zip(scans, folds, takes_folds, strict=True)):
        labels = label_scan(found, gestures)
        chosen = to_learn_from(found, labels, len(gestures))
        nothing = labels == len(gestures)
        idle.append(_part(found, chosen & nothing, labels, fold))
        held.append(_part(found, chosen & ~nothing, labels, fold))
        held += _marked(found.passage, gestures, of_takes, (seed, number))
    parts = [_join(idle)]
    takes = _join(held)
    parts += [replace(takes, raw=varied(takes.raw, (seed, which))) for which in range(_VARIATIONS)]
    windows = [describe(one.raw[..., : channels.columns], one.lengths, channels) for one in parts]
    return Examples(
        gestures,
        channels,
        join_windows(windows),
        np.concatenate([part.labels for part in parts]),
        np.concatenate([part.folds for part in parts]),
        np.concatenate([part.marked for part in parts]),
    )


def _part(found: Scan, chosen: Flags, labels: Integers, folds: Integers) -> _Part:
    unmarked = np.zeros(int(chosen.sum()), bool)
    return _Part(found.raw(chosen), found.lengths[chosen], labels[chosen], folds[chosen], unmarked)


def _marked(
    passage: Passage, gestures: Sequence[Gesture], folds: Sequence[int], seed: Sequence[int]
) -> list[_Part]:
    """The takes of a passage as they were marked."""
    names = [gesture.name for gesture in gestures]
    parts = []
    for index, (take, fold) in enumerate(zip(passage.takes, folds, strict=True)):
        raw, lengths = trimmed_takes(passage, take, (*seed, index))
        labels = np.full(len(raw), names.index(take.gesture))
        marks = np.ones(len(raw), bool)
        parts.append(_Part(raw, lengths, labels, np.full(len(raw), fold), marks))
    return parts


def _join(parts: Sequence[_Part]) -> _Part:
    columns = [[getattr(part, one.name) for part in parts] for one in fields(_Part)]
    return _Part(*(np.concatenate(column) for column in columns))
