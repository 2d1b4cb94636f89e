"""Examples to learn from: windows that hold a gesture, and windows that hold none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from .features import POINTS, Channels, Gesture, Integers, Scan, Windows, cut_windows, describe
from .streams import RATE_HZ, Floats, Passage, Take

# The same gesture as others would make it: stronger or weaker, turned, and with another rhythm.

_GAIN = 0.7  # a logarithm: half to twice as strong; people differ by four times
_TURN_RAD = np.deg2rad(12.0)  # the standard deviation of how a watch or phone sits
_RHYTHM = 0.12  # of a window: how much earlier or later its middle may come


def varied(raw: Floats, seed: Sequence[int]) -> Floats:
    """Raw windows (n, 32, 3 or 6), each changed by chance; the same seed, the same changes."""
    chance = np.random.default_rng(seed)
    n = len(raw)
    gain = np.exp(chance.uniform(-_GAIN, _GAIN, (n, 1, 1)))
    turns = _turns(chance, n)
    parts = [raw[..., at : at + 3] @ turns for at in range(0, raw.shape[2], 3)]
    turned = np.concatenate(parts, axis=2)
    # gravity is as strong for everyone: only what changes in the window is made stronger
    resting = turned[..., :3].mean(axis=1, keepdims=True)
    turned[..., :3] = resting + gain * (turned[..., :3] - resting)
    turned[..., 3:] *= gain
    # Windows whose middle comes earlier or later; both ends stay
    times = np.linspace(0.0, 1.0, POINTS)
    shift = chance.uniform(-_RHYTHM, _RHYTHM, n) * np.cos(chance.uniform(0, np.pi, n))
    at = np.clip(times + shift[:, None] * np.sin(np.pi * times), 0.0, 1.0) * (POINTS - 1)
    before = np.minimum(at.astype(np.intp), POINTS - 2)
    part = (at - before)[..., None]
    each = np.arange(n)[:, None]
    values: Floats = turned[each, before] * (1 - part) + turned[each, before + 1] * part
    return values


def _turns(chance: np.random.Generator, n: int) -> Floats:
    """Rotations about axes of every direction, by Rodrigues' formula; (n, 3, 3)."""
    axis = chance.normal(size=(n, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    angle = chance.normal(0.0, _TURN_RAD, n)[:, None, None]
    x, y, z = axis.T
    zero = np.zeros(n)
    cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    turns: Floats = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
    return turns


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

    ``gestures`` are those to be learned, ``channels`` the signals of which features are made,
    ``seed`` that of the chance.
    """
    idle, held = [], []
    for number, (found, fold, of_takes) in enumerate(zip(scans, folds, takes_folds, strict=True)):
        labels = label_scan(found, gestures)
        chosen = to_learn_from(found, labels, len(gestures))
        nothing = labels == len(gestures)
        idle.append(_part(found, chosen & nothing, labels, fold))
        held.append(_part(found, chosen & ~nothing, labels, fold))
        held += _marked(found.passage, gestures, of_takes, (seed, number))
    takes = _join(held)
    copies = [replace(takes, raw=varied(takes.raw, (seed, one))) for one in range(_VARIATIONS)]
    parts = [_join(idle), *copies]
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
