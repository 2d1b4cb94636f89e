"""The paper's recogniser: each gesture is an expected curve with a band around it.

Gaussian mixture modelling and regression after Bruno et al. (ICRA 2013) and Coronado et al.
(2017), corrected: the regression's covariance follows the law of total covariance, the distance
is a likelihood (its log-determinant keeps wide models from winning), and what is near enough
comes from recordings that the curve was not made from.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nodes.perceptual.recognition.examples import Examples
from nodes.perceptual.recognition.features import POINTS, Integers, Windows
from nodes.perceptual.recognition.mixture import expected_curve, fit_mixture
from nodes.perceptual.recognition.stream import Floats

_SHRINK = 0.3
_FLOOR = 0.05
_LEFT_OUT_PARTS = 3
_CALIBRATION_WINDOWS = 5000
_QUIETEST = -3.0
_NONE_WINDOWS = 150
_LEAST_SPREAD = 0.1
_EVIDENCE = 5


@dataclass(frozen=True)
class Curves:
    """The expected curve of each of g gestures: ``mean`` (g, 32, s) of signals over ``scale`` (s,).

    ``whiten`` (g, 32, s, s) makes the band a unit ball; ``log_det`` (g,) is its mean log volume.
    """

    scale: Floats
    mean: Floats
    whiten: Floats
    log_det: Floats

    def distances(self, signals: Floats) -> Floats:
        """Twice the negative log likelihood a point, less a constant; (n, g) for (n, 32, s)."""
        points = (signals / self.scale).transpose(1, 2, 0)
        away = self.whiten @ (points - self.mean[..., None])
        squares: Floats = np.einsum("gtsn,gtsn->ng", away, away) / POINTS
        return squares + self.log_det


@dataclass(frozen=True)
class Gmr:
    """Curves, and how near is near enough.

    ``usual`` and ``spread`` (g,) are the distance of left-out takes; ``power`` (g,) is that of
    the weakest take; ``weights`` (4,) of the logistic function of distance, margin to the next
    gesture, lack of power, and 1.
    """

    curves: Curves
    usual: Floats
    spread: Floats
    power: Floats
    weights: Floats

    def scores(self, windows: Windows) -> Floats:
        """How likely each window is each gesture; (n, g)."""
        evidence = self.evidence(windows.signals, self.curves.distances(windows.signals))
        return _logistic(evidence @ self.weights)

    def evidence(self, signals: Floats, distances: Floats) -> Floats:
        """Standard distance, margin to the nearest rival, lack of power, and 1; (n, g, 5)."""
        gestures, none = distances[:, :-1], distances[:, -1:]
        away = (gestures - self.usual) / self.spread
        closer = np.clip(none - gestures, -20.0, 20.0)
        margin = np.clip(_nearest_rival(away) - away, -10.0, 10.0)
        lack = np.clip(_power(signals)[:, None] - self.power, _QUIETEST, 0.0)
        return np.stack(
            [np.clip(away, -10.0, 30.0), margin, closer, lack, np.ones_like(away)], axis=2
        )

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""
        own = {name: value for name, value in vars(self).items() if name != "curves"}
        return own | vars(self.curves)

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]], gestures: int, signals: int) -> Gmr:
        """A recogniser from a model file; ValueError or KeyError when its parts do not fit."""
        shapes = {
            "scale": (signals,),
            "mean": (gestures + 1, POINTS, signals),
            "whiten": (gestures + 1, POINTS, signals, signals),
            "log_det": (gestures + 1,),
            "usual": (gestures,),
            "spread": (gestures,),
            "power": (gestures,),
            "weights": (_EVIDENCE,),
        }
        parts = {name: arrays[name].astype(float) for name in shapes}
        for name, shape in shapes.items():
            if parts[name].shape != shape or not np.isfinite(parts[name]).all():
                raise ValueError(f"the expected curves have a wrong {name}")
        curves = Curves(*(parts.pop(name) for name in ("scale", "mean", "whiten", "log_det")))
        return cls(curves, **parts)


def fit_gmr(examples: Examples, seed: int = 0) -> Gmr:
    """Make the curves, and calibrate them on takes and pauses that other curves were made from."""
    curves = _fit_curves(examples)
    seen, distances = _left_out(examples, seed)
    takes = [np.flatnonzero(seen.marked & (seen.labels == g)) for g in range(len(seen.gestures))]
    own = [distances[chosen, gesture] for gesture, chosen in enumerate(takes)]
    power = _power(seen.windows.signals)
    within = np.array([values.std() for values in own])
    ready = Gmr(
        curves=curves,
        usual=np.array([np.median(values) for values in own]),
        spread=(within + within.mean()) / 2 + _LEAST_SPREAD,
        power=np.array([power[chosen].min() for chosen in takes]),
        weights=np.zeros(_EVIDENCE),
    )
    evidence = ready.evidence(seen.windows.signals, distances)
    return replace(ready, weights=_fit_logistic(*_rows(evidence, seen.labels)))


def _fit_curves(examples: Examples) -> Curves:
    none = np.flatnonzero(examples.labels == len(examples.gestures))
    chosen = np.concatenate(
        [np.flatnonzero(examples.marked), none[:: 1 + len(none) // _NONE_WINDOWS]]
    )
    signals, labels = examples.windows.signals[chosen], examples.labels[chosen]
    scale = signals.std(axis=(0, 1)) + 1e-3
    means, whitens, log_dets = [], [], []
    for label in range(len(examples.gestures) + 1):
        mean, covariance = expected_curve(fit_mixture(signals[labels == label] / scale))
        spread = np.eye(len(scale)) * np.einsum("tii->ti", covariance).mean(axis=0)
        covariance = (1 - _SHRINK) * covariance + _SHRINK * spread + _FLOOR * np.eye(len(scale))
        lower = np.linalg.cholesky(covariance)
        means.append(mean)
        whitens.append(np.linalg.inv(lower))
        log_dets.append(2 * np.log(np.einsum("tii->ti", lower)).sum(axis=1).mean())
    return Curves(scale, np.array(means), np.array(whitens), np.array(log_dets))


def _left_out(examples: Examples, seed: int) -> tuple[Examples, Floats]:
    """Marked takes and some other windows, and their distances (n, g + 1) to curves of others."""
    others = np.flatnonzero(~examples.marked)
    some = np.random.default_rng(seed).permutation(others)[:_CALIBRATION_WINDOWS]
    seen = examples.where(np.sort(np.concatenate([np.flatnonzero(examples.marked), some])))
    parts = min(_LEFT_OUT_PARTS, int(examples.folds.max()) + 1)
    distances = np.empty((len(seen.labels), len(examples.gestures) + 1))
    for part in range(parts):
        rest = examples.where(examples.folds % parts != part)
        complete = len(np.unique(rest.labels[rest.marked])) == len(examples.gestures)
        curves = _fit_curves(rest if complete else examples)
        here = seen.folds % parts == part
        distances[here] = curves.distances(seen.windows.signals[here])
    return seen, distances


def _rows(evidence: Floats, labels: Integers) -> tuple[Floats, Floats]:
    """What the logistic function learns from: each window as itself and as its rival."""
    n, count, _ = evidence.shape
    holds = labels < count
    true = np.where(holds, labels, 0)
    away = evidence[..., 0].copy()
    away[np.flatnonzero(holds), true[holds]] = np.inf
    rival = away.argmin(axis=1)
    rows = np.concatenate([evidence[np.flatnonzero(holds), true[holds]], evidence[range(n), rival]])
    return rows, np.concatenate([np.ones(holds.sum()), np.zeros(n)])


def _fit_logistic(rows: Floats, truth: Floats) -> Floats:
    """Weights of a logistic function by Newton's method."""
    weights = np.zeros(rows.shape[1])
    ridge = 1e-3 * np.eye(rows.shape[1])
    for _ in range(30):
        expected = _logistic(rows @ weights)
        slope = rows.T @ (truth - expected) / len(truth) - ridge @ weights
        bend = (rows * (expected * (1 - expected))[:, None]).T @ rows / len(truth) + ridge
        weights = weights + np.linalg.solve(bend, slope)
    return weights


def _logistic(values: Floats) -> Floats:
    return 1.0 / (1.0 + np.exp(-np.clip(values, -50.0, 50.0)))


def _nearest_rival(away: Floats) -> Floats:
    """For each gesture the smallest value of the others; large where there is no other."""
    if away.shape[1] == 1:
        return np.full_like(away, 1e3)
    ordered = np.sort(away, axis=1)
    return np.where(away == ordered[:, :1], ordered[:, 1:2], ordered[:, :1])


def _power(signals: Floats) -> Floats:
    """Log of how much moves in a window; (n,)."""
    moving: Floats = signals.std(axis=1).mean(axis=1)
    return np.log(moving + 1e-3)
