"""The paper's matching of gestures, as its code does it, to compare with.

After HMPy and WHARF (Bruno et al. 2013, Coronado et al. 2017): median filter, low-pass Chebyshev
filter for gravity, a Gaussian mixture over time and acceleration with its number of components by
the silhouette, regression with the squared shares in the covariance, mean squared Mahalanobis
distance, possibility max(0, 1 - distance / limit). Faults included; none of it is in the product.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from benchmarks._gesture_references import Looks
from nodes.perceptual.recognition.streams import Take, takes_of
from nodes.recordings import Recording

Floats = NDArray[np.float64]

RATE_HZ = 32.0
DELAY = 64
"""Samples that the filter is late."""
_HOP = 3
_HELD = 2
"""Decisions in a row that must agree: the paper asks for 6 samples."""
_LEAST_SILHOUETTE = 0.69
_MOST_COMPONENTS = 50
_LIMIT_SPREADS = 1.5


@dataclass(frozen=True)
class Curve:
    """The regression of one component: means (m, 3) and inverted covariances (m, 3, 3)."""

    mean: Floats
    covariance: Floats

    def distances(self, parts: Floats) -> Floats:
        """Mean squared Mahalanobis distances (n,) of n pieces (n, m, 3)."""
        away = parts - self.mean
        inverse = np.linalg.inv(self.covariance)
        squares: Floats = np.einsum("nmi,mij,nmj->n", away, inverse, away) / len(self.mean)
        return squares


@dataclass(frozen=True)
class PaperGesture:
    """One gesture: curves of gravity and body, their weights, and the limit of the distance."""

    name: str
    gravity: Curve
    body: Curve
    weights: tuple[float, float]
    limit: float

    @property
    def length(self) -> int:
        """Samples of the model."""
        return len(self.gravity.mean)

    def distances(self, raw: Floats) -> Floats:
        """Distances (n,) of n windows (n, length + 64, 3) of raw acceleration."""
        gravity, body = split(raw)
        first, second = self.weights
        total: Floats = first * self.gravity.distances(gravity)
        return total + second * self.body.distances(body)


class PaperMatching:
    """The gestures of some recordings, each with its own model; ``limits`` set by hand, or none.

    Without ``limits`` the limit of a gesture is by WHARF's rule: the distance of the curve 1.5
    variances away.
    """

    def __init__(self, training: Sequence[Recording], limits: dict[str, float] | None = None):
        examples: dict[str, list[Floats]] = {}
        lengths: dict[str, list[int]] = {}
        for one in training:
            even = evened(one)
            for take in takes_of(one):
                start = round(take.start_s * RATE_HZ)
                examples.setdefault(take.gesture, []).append(even[start:])
                lengths.setdefault(take.gesture, []).append(round(take.duration_s * RATE_HZ))
        self.names = tuple(sorted(examples))
        with _one_thread():  # the matrices are small: threads would wait for each other
            self.gestures = tuple(
                learn(name, examples[name], int(np.median(lengths[name])), limits)
                for name in self.names
            )

    def classify(self, recording: Recording, take: Take) -> str:
        """The gesture of the highest possibility; without the cut at 0, which favours it."""
        even = evened(recording)[round(take.start_s * RATE_HZ) :]
        ratios = [
            float(one.distances(_filled(even, one.length + DELAY)[None])[0]) / one.limit
            for one in self.gestures
        ]
        return self.names[int(np.argmin(ratios))]

    def look(self, recording: Recording) -> Looks:
        """Possibilities at every third sample, each the least of six samples' time."""
        even = evened(recording)
        lengths = np.array([one.length for one in self.gestures])
        ends = np.arange(int(lengths.min()) + DELAY, len(even) + 1, _HOP)
        scores = np.zeros((len(ends), len(self.names)))
        for number, one in enumerate(self.gestures):
            size = one.length + DELAY
            late = ends >= size
            if late.any():
                windows = sliding_window_view(even, size, axis=0)[ends[late] - size]
                distances = one.distances(windows.transpose(0, 2, 1))
                scores[late, number] = np.maximum(0.0, 1 - distances / one.limit)
        held = scores.copy()
        for before in range(1, _HELD):
            held[before:] = np.minimum(held[before:], scores[:-before])
        lengths_s = np.broadcast_to(lengths / RATE_HZ, scores.shape)
        return Looks(ends / RATE_HZ, held, lengths_s, delay_s=DELAY / RATE_HZ)


def evened(one: Recording) -> Floats:
    """Acceleration (n, 3) at 32 samples a second, with 64 samples more: the movement's echo."""
    at = np.arange(0.0, float(one.t[-1]) + DELAY / RATE_HZ, 1 / RATE_HZ)
    return np.stack([np.interp(at, one.t, axis) for axis in one.acc.T], axis=1)


def split(raw: Floats) -> tuple[Floats, Floats]:
    """Gravity and body (n, m, 3) of raw windows (n, m + 64, 3)."""
    smooth = _median_of_three(raw)
    gravity = np.einsum("ij,njk->nik", _low_pass(smooth.shape[1]), smooth)
    return gravity, smooth[:, : gravity.shape[1]] - gravity


def learn(
    name: str, examples: Sequence[Floats], length: int, limits: dict[str, float] | None
) -> PaperGesture:
    """A gesture from streams that begin with it."""
    raw = np.stack([_filled(one, length + DELAY) for one in examples])
    curves = [_regressed(part) for part in split(raw)]
    means = [
        float(curve.distances(part).mean()) for curve, part in zip(curves, split(raw), strict=True)
    ]
    weights = (means[0] / sum(means), means[1] / sum(means))
    limit = (limits or {}).get(name) or _limit(curves, weights)
    return PaperGesture(name, curves[0], curves[1], weights, limit)


def _limit(curves: Sequence[Curve], weights: tuple[float, float]) -> float:
    """WHARF's: how far the curve is that is 1.5 variances (not deviations) away everywhere."""
    far = 0.0
    for curve, weight in zip(curves, weights, strict=True):
        away = curve.mean + _LIMIT_SPREADS * np.einsum("mii->mi", curve.covariance)
        far += weight * float(curve.distances(away[None])[0])
    return max(far, 1e-9)


def _regressed(parts: Floats) -> Curve:
    """Gaussian mixture regression of examples (n, m, 3) on time, with squared shares."""
    from sklearn.mixture import GaussianMixture

    count, length, _ = parts.shape
    times = np.tile(np.arange(length, dtype=float), count)[:, None]
    rows = np.hstack([times, parts.reshape(-1, 3)])
    centres = _centres(rows)
    mixture = GaussianMixture(len(centres), means_init=centres, reg_covar=1e-5, random_state=0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        mixture.fit(rows)
    return _expected(mixture.weights_, mixture.means_, mixture.covariances_, length)


def _expected(weights: Floats, means: Floats, covariances: Floats, length: int) -> Curve:
    away = np.arange(length, dtype=float)[:, None] - means[:, 0]
    variance = covariances[:, 0, 0]
    logs = np.log(weights) - 0.5 * (away**2 / variance + np.log(variance))
    share = np.exp(logs - logs.max(axis=1, keepdims=True))
    share /= share.sum(axis=1, keepdims=True)
    slope = covariances[:, 1:, 0] / variance[:, None]
    mean = np.einsum("tk,tki->ti", share, means[:, 1:] + slope * away[..., None])
    around = covariances[:, 1:, 1:] - np.einsum("ki,kj,k->kij", slope, slope, variance)
    covariance = np.einsum("tk,kij->tij", share**2, around) + 1e-5 * np.eye(3)
    return Curve(mean, covariance)


def _centres(rows: Floats) -> Floats:
    """The centres of k-means, k rising from 2 until the mean silhouette falls below 0.69."""
    from sklearn.cluster import KMeans
    from sklearn.metrics import silhouette_score

    chosen: Floats = rows[:1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for k in range(2, min(_MOST_COMPONENTS, len(rows) // 2) + 1):
            found = KMeans(k, n_init=1, random_state=0).fit(rows)
            chosen = found.cluster_centers_
            if len(set(found.labels_)) < 2:
                break
            if silhouette_score(rows, found.labels_, metric="sqeuclidean") < _LEAST_SILHOUETTE:
                break
    return chosen


def _one_thread() -> AbstractContextManager[Any]:
    limits: AbstractContextManager[Any] = import_module("threadpoolctl").threadpool_limits(1)
    return limits


def _median_of_three(values: Floats) -> Floats:
    """The median of each sample and its neighbours, zeros outside; (n, m, 3)."""
    padded = np.pad(values, ((0, 0), (1, 1), (0, 0)))
    return np.median(np.stack([padded[:, :-2], padded[:, 1:-1], padded[:, 2:]]), axis=0)


def _low_pass(size: int) -> Floats:
    """The filter as a matrix (size - 64, size): what it gives 64 samples later, started at 0."""
    signal: Any = import_module("scipy.signal")  # it comes with scikit-learn, without types
    order, cut = signal.cheb1ord(0.25, 2.0, 0.001, 100.0, fs=RATE_HZ)
    sections = signal.cheby1(order, 0.001, cut, output="sos", fs=RATE_HZ)
    response = signal.sosfilt(sections, np.eye(size)[0])
    later = np.arange(size - DELAY)[:, None] + DELAY - np.arange(size)
    matrix: Floats = np.where(later >= 0, response[np.maximum(later, 0)], 0.0)
    return matrix


def _filled(values: Floats, size: int) -> Floats:
    """The first so many samples; the last again where there are too few."""
    short = size - len(values)
    return values[:size] if short <= 0 else np.vstack([values, np.repeat(values[-1:], short, 0)])
