"""The paper's recogniser: each gesture is an expected curve with a band around it.

Gaussian mixture modelling and regression after Bruno et al. (ICRA 2013) and Coronado et al.
(2017), corrected: the regression's covariance follows the law of total covariance, the distance
is a likelihood (its log-determinant keeps wide models from winning), and what is near enough
comes from recordings that the curve was not made from.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nodes.perceptual.recognition.examples import Examples
from nodes.perceptual.recognition.features import POINTS, Integers, Singles, Windows
from nodes.perceptual.recognition.mixture import expected_curve, fit_mixture
from nodes.perceptual.recognition.stream import Floats

_SHRINK = 0.3
_FLOOR = 0.05
_LEFT_OUT_PARTS = 3
_CALIBRATION_WINDOWS = 5000
_LIMITS = (-3.0, 12.0)
_MOST_CURVES = 80  # to make an expected curve from
_LEAST_SPREAD = 0.1
_EVIDENCE = 5


@dataclass(frozen=True)
class Curves:
    """Expected curves, one for each of the gestures and a last one for no gesture.

    ``mean`` (curves, 32, s) is in units of ``scale`` (s,); ``whiten`` (curves, 32, s, s) makes the
    band around it a unit ball; ``log_det`` (curves,) is its mean log volume.
    """

    scale: Floats
    mean: Floats
    whiten: Floats
    log_det: Floats

    def expected(self, gesture_index: int) -> tuple[Floats, Floats]:
        """The curve of a gesture and how far takes usually stray from it; both (32, s).

        In the units of ``signals_of``; ``signal_names`` tells what each column is.
        """
        inverse = np.linalg.inv(self.whiten[gesture_index])
        spread = np.sqrt(np.einsum("tij,tij->ti", inverse, inverse))
        return self.mean[gesture_index] * self.scale, spread * self.scale

    def distances(self, signals: Singles) -> Floats:
        """Twice the negative log likelihood a point, less a constant; (n, curves)."""
        points = (signals / self.scale).transpose(1, 2, 0)
        away = self.whiten @ (points - self.mean[..., None])
        squares: Floats = np.einsum("gtsn,gtsn->ng", away, away) / POINTS
        return squares + self.log_det


@dataclass(frozen=True)
class Gmr:
    """Curves, and how near is near enough.

    ``usual`` and ``spread`` (g,) are those of the distances of left-out takes, ``lead`` and
    ``lead_spread`` those of how much farther *no gesture* is; ``power`` (g,) is the weakest take's;
    ``weights`` (5,) make the evidence a probability.
    """

    curves: Curves
    usual: Floats
    spread: Floats
    lead: Floats
    lead_spread: Floats
    power: Floats
    weights: Floats

    def scores(self, windows: Windows) -> Floats:
        """How likely each window is each gesture; (n, g)."""
        evidence = self.evidence(windows.signals, self.curves.distances(windows.signals))
        return _logistic(evidence @ self.weights)

    def evidence(self, signals: Singles, distances: Floats) -> Floats:
        """What speaks against each gesture in each window, in usual spreads; (n, g, 5).

        It is far from the curve, a rival is nearer, *no gesture* is hardly farther, it has little
        power; and 1.
        """
        gestures, none = distances[:, :-1], distances[:, -1:]
        far = (gestures - self.usual) / self.spread
        rival = far - _nearest_rival(far)
        plain = (self.lead - (none - gestures)) / self.lead_spread
        weak = self.power - _power(signals)[:, None]
        return np.stack(
            [
                np.clip(far, *_LIMITS),
                np.clip(rival, *_LIMITS),
                np.clip(plain, *_LIMITS),
                np.clip(weak, 0.0, _LIMITS[1]),
                np.ones_like(far),
            ],
            axis=2,
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
            "lead": (gestures,),
            "lead_spread": (gestures,),
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
    leads = [distances[chosen, -1] - near for chosen, near in zip(takes, own, strict=True)]
    power = _power(seen.windows.signals)
    ready = Gmr(
        curves,
        *_usual_and_spread(own),
        *_usual_and_spread(leads),
        power=np.array([power[chosen].min() for chosen in takes]),
        weights=np.zeros(_EVIDENCE),
    )
    evidence = ready.evidence(seen.windows.signals, distances)
    return replace(ready, weights=_fit_logistic(*_rows(evidence, seen.labels)))


def _usual_and_spread(values: Sequence[Floats]) -> tuple[Floats, Floats]:
    """Median and spread of each gesture's values; few values borrow spread from the others."""
    within = np.array([of_gesture.std() for of_gesture in values])
    usual = np.array([np.median(of_gesture) for of_gesture in values])
    return usual, (within + within.mean()) / 2 + _LEAST_SPREAD


def _fit_curves(examples: Examples) -> Curves:
    """A curve for each gesture, and for no gesture."""
    signals = [
        examples.windows.signals[_curves_of(examples, label)]
        for label in range(len(examples.gestures) + 1)
    ]
    scale = np.concatenate(signals[:-1]).std(axis=(0, 1)) + 1e-3
    fitted = [_fit_curve(curves / scale) for curves in signals]
    return Curves(scale, *(np.array(parts) for parts in zip(*fitted, strict=True)))


def _curves_of(examples: Examples, label: int) -> Integers:
    """Which examples make a curve: takes as they were marked, or any that hold no gesture."""
    marked = examples.marked | (label == len(examples.gestures))
    chosen = np.flatnonzero(marked & (examples.labels == label))
    return chosen[:: 1 + len(chosen) // _MOST_CURVES]


def _fit_curve(curves: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean, whitening and log volume of curves (m, 32, s) in units of the scale."""
    mean, covariance = expected_curve(fit_mixture(curves), POINTS)
    size = np.eye(curves.shape[2])
    spread = size * np.einsum("tii->ti", covariance).mean(axis=0)
    covariance = (1 - _SHRINK) * covariance + _SHRINK * spread + _FLOOR * size
    lower = np.linalg.cholesky(covariance)
    log_det = 2 * np.log(np.einsum("tii->ti", lower)).sum(axis=1).mean()
    return mean, np.linalg.inv(lower), log_det


def _left_out(examples: Examples, seed: int) -> tuple[Examples, Floats]:
    """Takes as marked and windows of no gesture, and their distances to curves made without them.

    Distances (n, g + 1). Windows that hold a gesture only roughly are not among them: they would
    make distance from the curve look harmless.
    """
    others = np.flatnonzero(examples.labels == len(examples.gestures))
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


def _power(signals: Singles) -> Floats:
    """Log of how much moves in a window; (n,)."""
    moving: Floats = signals.std(axis=1, dtype=float).mean(axis=1)
    return np.log(moving + 1e-3)
