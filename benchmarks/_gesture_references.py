"""References for spotting gestures, written plainly: nearest example by dynamic time warping.

What they share with each other, and not with the product: windows, distances, and the choice of
triggers. That choice looks at the whole stream at once, which favours them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from nodes.perceptual.recognition.features import Detection
from nodes.perceptual.recognition.streams import Take, takes_of
from nodes.recordings import Recording

Floats = NDArray[np.float64]
Array = NDArray[Any]
_Thing = TypeVar("_Thing")

HOP_S = 0.09
"""Between two decisions: three samples at 33 Hz."""
POINTS = 32
BAND = 6
"""How far a path of the warping may leave the diagonal, in points."""
_LENGTHS = 6
_MOST_IDLE = 60
_MOST_EXAMPLES = 60
_IDLE_SHARE = 0.35
_CHUNK = 1500


@dataclass(frozen=True)
class Looks:
    """n looks at a stream: when each ended, the scores (n, gestures), lengths in s (n, gestures).

    ``delay_s`` is how long before a look the movement that it judges was over.
    """

    ends_s: Floats
    scores: Floats
    lengths_s: Floats
    delay_s: float = 0.0


class Reference(Protocol):
    """Something that recognises gestures, to compare with."""

    names: tuple[str, ...]

    def classify(self, recording: Recording, take: Take) -> str:
        """The gesture that a marked take is most like."""

    def look(self, recording: Recording) -> Looks:
        """How much the stream is like each gesture, at every decision."""


def fire(looks: Looks, names: Sequence[str], threshold: float) -> list[Detection]:
    """The highest scores from a threshold on that are not in the way of a higher one."""
    found: list[Detection] = []
    best, which = looks.scores.max(axis=1), looks.scores.argmax(axis=1)
    for at in np.argsort(-best, kind="stable"):
        if best[at] < threshold:
            break
        end_s = float(looks.ends_s[at]) - looks.delay_s
        one = Detection(
            names[which[at]], float(best[at]), end_s - float(looks.lengths_s[at, which[at]]), end_s
        )
        if not any(_shares(one, other) for other in found):
            found.append(one)
    return sorted(found, key=lambda one: one.t_end)


def _shares(one: Detection, other: Detection) -> bool:
    shared = min(one.t_end, other.t_end) - max(one.t_start, other.t_start)
    return shared > 0.3 * min(one.t_end - one.t_start, other.t_end - other.t_start)


class NearestByWarping:
    """DTW 1-NN: how much nearer the nearest example of a gesture is than that of anything else.

    Anything else are the other gestures and pieces of the pauses and of everyday movement.
    """

    def __init__(self, training: Sequence[Recording], everyday: Sequence[Recording]) -> None:
        every = (*training, *everyday)
        self._with_gyr = all(one.gyr is not None for one in every)
        self._with_gravity = all(one.gravity_included for one in every)
        takes = [(one, take) for one in training for take in takes_of(one)]
        self.names = tuple(sorted({take.gesture for _, take in takes}))
        lasting = {
            name: [take.duration_s for _, take in takes if take.gesture == name]
            for name in self.names
        }
        shortest = 0.8 * min(min(one) for one in lasting.values())
        longest = 1.15 * max(max(one) for one in lasting.values())
        self._lengths_s = np.geomspace(shortest, longest, _LENGTHS)
        self._fits = np.stack([self._fitting(lasting[name]) for name in self.names], axis=1)
        self._examples, self._held = self._examples_of(takes)
        self._idle = self._idle_of(every)

    def classify(self, recording: Recording, take: Take) -> str:
        """The gesture of the nearest example."""
        window = self._windows(recording, np.array([take.start_s]), np.array([take.end_s]))
        nearest = int(warped_distances(window, self._examples)[0].argmin())
        return self.names[int(self._held[nearest])]

    def look(self, recording: Recording) -> Looks:
        """Distances of windows of several lengths at every decision, as scores from 0 to 1."""
        last_s = float(recording.t[-1])
        ends_s = np.arange(self._lengths_s[0], max(last_s, self._lengths_s[0] + HOP_S), HOP_S)
        scores = np.zeros((len(self._lengths_s), len(ends_s), len(self.names)))
        for number, length_s in enumerate(self._lengths_s):
            scores[number] = self._scores(recording, ends_s, length_s) * self._fits[number]
            scores[number, ends_s < length_s - 1e-9] = 0.0
        which = scores.argmax(axis=0)
        return Looks(ends_s, scores.max(axis=0), self._lengths_s[which])

    def _scores(self, recording: Recording, ends_s: Floats, length_s: float) -> Floats:
        windows = self._windows(recording, ends_s - length_s, ends_s)
        to_examples = warped_distances(windows, self._examples)
        own = np.stack(
            [to_examples[:, self._held == one].min(axis=1) for one in range(len(self.names))],
            axis=1,
        )
        idle = warped_distances(windows, self._idle).min(axis=1) if len(self._idle) else np.inf
        return _nearer(own, idle)

    def _fitting(self, lasting_s: Sequence[float]) -> Array:
        low, high = 0.75 * min(lasting_s), 1.2 * max(lasting_s)
        fits = (self._lengths_s >= low) & (self._lengths_s <= high)
        fits[np.abs(self._lengths_s - float(np.median(lasting_s))).argmin()] = True
        return fits

    def _examples_of(self, takes: Sequence[tuple[Recording, Take]]) -> tuple[Floats, Array]:
        chosen: list[Floats] = []
        held: list[int] = []
        for number, name in enumerate(self.names):
            own = [one for one in takes if one[1].gesture == name]
            for one, take in _spread(own, max(1, _MOST_EXAMPLES // len(self.names))):
                begin, end = np.array([take.start_s]), np.array([take.end_s])
                chosen.append(self._windows(one, begin, end)[0])
                held.append(number)
        return np.stack(chosen), np.array(held)

    def _idle_of(self, recordings: Sequence[Recording]) -> Floats:
        """Pieces of all recordings in which no gesture is made."""
        chance = np.random.default_rng(0)
        pieces = [piece for one in recordings for piece in self._idle_pieces(one, chance)]
        return np.stack(_spread(pieces, _MOST_IDLE)) if pieces else np.empty((0, POINTS, 0))

    def _idle_pieces(self, one: Recording, chance: np.random.Generator) -> Iterator[Floats]:
        takes = takes_of(one)
        for length_s in self._lengths_s:
            for start_s in np.arange(0.0, float(one.t[-1]) - length_s, length_s):
                begin = start_s + chance.uniform(0, 0.3 * length_s)
                shared = [_overlap(begin, begin + length_s, take) for take in takes]
                if max(shared, default=0.0) < _IDLE_SHARE:
                    yield self._windows(one, np.array([begin]), np.array([begin + length_s]))[0]

    def _windows(self, one: Recording, starts_s: Floats, ends_s: Floats) -> Floats:
        """Windows (n, 32, signals) between two times."""
        at = starts_s[:, None] + np.linspace(0, 1, POINTS) * (ends_s - starts_s)[:, None]
        acc = np.stack([np.interp(at, one.t, axis) for axis in one.acc.T], axis=2)
        slow = np.stack([_averaged(acc[..., axis]) for axis in range(3)], axis=2)
        parts = [_logarithmic(acc - slow)]
        if self._with_gyr and one.gyr is not None:
            gyr = np.stack([np.interp(at, one.t, axis) for axis in one.gyr.T], axis=2)
            parts.append(_logarithmic(2 * gyr))
        elif self._with_gyr:
            parts.append(np.zeros_like(acc))
        if self._with_gravity:
            parts.append(slow / 9.81)
        return np.concatenate(parts, axis=2)


def warped_distances(windows: Floats, examples: Floats) -> Floats:
    """Distances (n, m) by dynamic time warping, with a band, of n windows to m examples."""
    if len(windows) > _CHUNK:
        parts = np.array_split(windows, -(-len(windows) // _CHUNK))
        return np.concatenate([warped_distances(part, examples) for part in parts])
    a, b = windows.astype(np.float32), examples.astype(np.float32)
    a_square, b_square = (a**2).sum(axis=2), (b**2).sum(axis=2)
    far = np.full((len(a), len(b)), np.inf, np.float32)
    before = [far] * (POINTS + 1)
    before[0] = np.zeros_like(far)
    for i in range(POINTS):
        now = [far] * (POINTS + 1)
        for j in range(max(0, i - BAND), min(POINTS, i + BAND + 1)):
            cost = a_square[:, i, None] + b_square[None, :, j] - 2 * a[:, i] @ b[:, j].T
            now[j + 1] = cost + np.minimum(np.minimum(before[j], before[j + 1]), now[j])
        before = now
    return np.sqrt(np.maximum(before[POINTS], 0.0)).astype(float)


def _nearer(own: Floats, idle: Floats | float) -> Floats:
    """How much nearer each gesture (n, g) is than its nearest rival or idling: 0.5 is as near."""
    rivals = np.empty_like(own)
    for one in range(own.shape[1]):
        others = np.delete(own, one, axis=1)
        nearest = others.min(axis=1) if others.shape[1] else np.full(len(own), np.inf)
        rivals[:, one] = np.minimum(nearest, idle)
    return np.where(np.isinf(rivals), 1 / (1 + own), rivals / (own + rivals + 1e-9))


def _averaged(values: Floats) -> Floats:
    """The moving average over 13 of 32 points, less at both ends; (n, 32)."""
    points = np.arange(POINTS)
    near = np.abs(points[:, None] - points) <= 6
    averaged: Floats = values @ (near / near.sum(axis=1, keepdims=True)).T
    return averaged


def _logarithmic(values: Floats) -> Floats:
    return np.sign(values) * np.log1p(np.abs(values))


def _overlap(start_s: float, end_s: float, take: Take) -> float:
    shared = min(end_s, take.end_s) - max(start_s, take.start_s)
    return shared / (max(end_s, take.end_s) - min(start_s, take.start_s))


def _spread(things: Sequence[_Thing], most: int) -> list[_Thing]:
    """At most so many of them, from all over."""
    if len(things) <= most:
        return list(things)
    return [things[int(at)] for at in np.linspace(0, len(things) - 1, most)]
