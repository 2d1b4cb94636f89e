"""The paper's recogniser: each gesture is an expected curve with a band around it.

Gaussian mixture modelling and regression after Bruno et al. (ICRA 2013) and Coronado et al.
(2017), corrected: the regression's covariance follows the law of total covariance, the distance
is a likelihood (its log-determinant keeps wide models from winning), and a movement may be early
or late on its curve. Which gesture it is, the curves tell; whether it is any gesture at all is
asked of some decision trees, since a curve cannot know what else there is in a day.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from .examples import Examples
from .features import POINTS, Channels, Singles, Windows, feature_count
from .streams import Floats
from .trees import Trees, fit_trees

# Gaussian mixtures over time and signals, and the curve that they expect at each time.

COMPONENTS = 6
_ROUNDS = 8
_NOISE = 1e-3


@dataclass(frozen=True)
class Mixture:
    """k Gaussians over (time, signals): ``weight`` (k,), ``mean`` (k, 1+s), ``covariance``."""

    weight: Floats
    mean: Floats
    covariance: Floats


def fit_mixture(curves: Floats, components: int = COMPONENTS) -> Mixture:
    """Fit by expectation maximisation to m curves (m, points, s), starting from slices of time."""
    m, points, _ = curves.shape
    times = np.broadcast_to(np.linspace(0.0, 1.0, points)[None, :, None], (m, points, 1))
    rows = np.concatenate([times, curves], axis=2).reshape(m * points, -1)
    slices = np.minimum((rows[:, 0] * components).astype(int), components - 1)
    mixture = _maximise(rows, np.eye(components)[slices])
    for _ in range(_ROUNDS):
        # How much each row belongs to each Gaussian; (rows, k)
        lower = np.linalg.cholesky(mixture.covariance)
        whiten = np.linalg.inv(lower).transpose(0, 2, 1)
        away = rows @ whiten - (mixture.mean[:, None] @ whiten)
        log_det = np.log(np.einsum("kii->ki", lower)).sum(axis=1)
        squares = np.einsum("krs,krs->rk", away, away)
        mixture = _maximise(rows, _normalised(np.log(mixture.weight) - log_det - 0.5 * squares))
    return mixture


def expected_curve(mixture: Mixture, points: int = 32) -> tuple[Floats, Floats]:
    """Gaussian mixture regression on time: mean (points, s) and covariance (points, s, s).

    mean(t) = Σ h_k(t) m_k(t) with m_k(t) = μ_k + Σ_k^xt (Σ_k^tt)^-1 (t - μ_k^t); the covariance
    follows the law of total covariance: Σ h_k(t) (Σ_k^xx - Σ_k^xt (Σ_k^tt)^-1 Σ_k^tx + m_k m_kᵀ)
    less the outer product of the mean.
    """
    times = np.linspace(0.0, 1.0, points)
    variance = mixture.covariance[:, 0, 0]
    away = times[:, None] - mixture.mean[:, 0]
    share = _normalised(np.log(mixture.weight) - 0.5 * (away**2 / variance + np.log(variance)))
    slope = mixture.covariance[:, 1:, 0] / variance[:, None]
    middles = mixture.mean[:, 1:] + slope * away[..., None]
    mean = np.einsum("tk,tks->ts", share, middles)
    around = mixture.covariance[:, 1:, 1:] - np.einsum("ks,kr,k->ksr", slope, slope, variance)
    apart = middles - mean[:, None]
    covariance = np.einsum("tk,ksr->tsr", share, around)
    covariance += np.einsum("tk,tks,tkr->tsr", share, apart, apart)
    return mean, covariance


def _maximise(rows: Floats, belongs: Floats) -> Mixture:
    total = belongs.sum(axis=0) + 1e-9
    mean = belongs.T @ rows / total[:, None]
    squares = np.stack([(rows * share[:, None]).T @ rows for share in belongs.T])
    covariance = squares / total[:, None, None] - mean[:, :, None] * mean[:, None, :]
    return Mixture(total / total.sum(), mean, covariance + _NOISE * np.eye(rows.shape[1]))


def _normalised(logarithms: Floats) -> Floats:
    parts = np.exp(logarithms - logarithms.max(axis=-1, keepdims=True))
    shares: Floats = parts / parts.sum(axis=-1, keepdims=True)
    return shares


GATE_TREES = 40
_SHRINK = 0.3
_FLOOR = 0.05
_MOST_CURVES = 40  # to make an expected curve from
_SLACK = 5  # points that a movement may be ahead of its curve, or behind
_BATCH = 64  # windows at once: what is worked on stays small
_WORTH_A_LOOK = 0.3  # how likely any gesture must be for the curves to be asked
_SHARPNESS = 4.0  # shared by the signals: these, and neighbouring points, tell nearly the same
_TREES_SHARE = 0.3  # of the score of both together
_NO_WAY = np.float32(1e9)


@dataclass(frozen=True)
class Curves:
    """Expected curves, one for each of the gestures.

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

    def scores(self, windows: Windows, moving: Floats) -> Floats:
        """How likely each window is each gesture, when it is any with ``moving`` (n,); (n, g)."""
        scores = np.zeros((len(windows), len(self.mean)))
        asked = moving >= _WORTH_A_LOOK
        distances = self.aligned_distances(windows.signals[asked])
        sharpness = _SHARPNESS / windows.signals.shape[2]
        scores[asked] = moving[asked, None] * _normalised(-sharpness * distances)
        return scores

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""
        return dict(vars(self))

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]], gestures: int, signals: int) -> Curves:
        """Curves from a model file; ValueError or KeyError when their parts do not fit."""
        shapes = {
            "scale": (signals,),
            "mean": (gestures, POINTS, signals),
            "whiten": (gestures, POINTS, signals, signals),
            "log_det": (gestures,),
        }
        parts = {name: arrays[name].astype(float) for name in shapes}
        for name, shape in shapes.items():
            if parts[name].shape != shape or not np.isfinite(parts[name]).all():
                raise ValueError(f"the expected curves have a wrong {name}")
        if not (parts["scale"] > 0).all():
            raise ValueError("the expected curves have a wrong scale")
        return cls(**parts)

    def aligned_distances(self, signals: Singles) -> Floats:
        """As ``distances``, of the best way of following each curve; (n, curves).

        Each point of a curve meets a point of the window at most ``_SLACK`` away, and from one
        point of the curve to the next the window goes on by none, one or two points.
        """
        parts = [self._aligned(signals[at : at + _BATCH]) for at in range(0, len(signals), _BATCH)]
        return np.concatenate(parts) if parts else np.empty((0, len(self.mean)))

    def _aligned(self, signals: Singles) -> Floats:
        costs = self._costs(signals)
        way = np.full((_BAND + 2, *costs.shape[2:]), _NO_WAY)
        now = way[1:-1]
        now[_AT_AN_END] = costs[0, _AT_AN_END]
        for cost in costs[1:]:
            before = np.minimum(way[:-2], now)
            np.minimum(before, way[2:], out=before)
            np.add(cost, before, out=now)
        squares: Floats = now[_AT_AN_END].min(axis=0) / POINTS
        return squares + self.log_det

    def _costs(self, signals: Singles) -> Singles:
        """How far each point of each curve is from the window's points around it.

        (32, band, n, curves); where the window has no point, there is no way.
        """
        points = np.repeat((signals / self.scale).astype(np.float32), _WITH_ENDS, axis=1)
        near = sliding_window_view(points, _BAND, axis=1).transpose(1, 3, 0, 2)
        curves, _, size = self.mean.shape
        whiten = self.whiten.astype(np.float32)
        middle = np.einsum("ctij,ctj->tci", whiten, self.mean).astype(np.float32)
        all_curves = whiten.transpose(1, 3, 0, 2).reshape(POINTS, size, -1)
        away = near.reshape(POINTS, -1, size) @ all_curves
        away -= middle.reshape(POINTS, 1, -1)
        away = away.reshape(POINTS, _BAND, len(signals), curves, size)
        costs: Singles = np.einsum("tbncs,tbncs->tbnc", away, away)
        costs[~_INSIDE] = _NO_WAY
        return costs


def with_prefix(arrays: Mapping[str, NDArray[Any]], prefix: str) -> dict[str, NDArray[Any]]:
    """The arrays whose names begin so, without that beginning."""
    return {
        name.removeprefix(prefix): array
        for name, array in arrays.items()
        if name.startswith(prefix)
    }


@dataclass(frozen=True)
class Gmr:
    """Curves that tell which gesture it is, and trees that tell whether it is one."""

    curves: Curves
    gate: Trees

    def scores(self, windows: Windows) -> Floats:
        """How likely each window is each gesture; (n, g)."""
        moving = 1.0 - self.gate.probabilities(windows.features)[:, -1]
        return self.curves.scores(windows, moving)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""
        gate = {f"gate.{name}": array for name, array in self.gate.arrays().items()}
        return self.curves.arrays() | gate

    @classmethod
    def from_arrays(
        cls, arrays: Mapping[str, NDArray[Any]], gestures: int, channels: Channels
    ) -> Gmr:
        """A recogniser from a model file; ValueError or KeyError when its parts do not fit."""
        gate = with_prefix(arrays, "gate.")
        curves = Curves.from_arrays(arrays, gestures, channels.signals)
        return cls(curves, Trees.from_arrays(gate, 1, feature_count(channels)))


@dataclass(frozen=True)
class Both:
    """Trees that ask the curves, too: what several people have in common shows in both."""

    trees: Trees
    curves: Curves

    def scores(self, windows: Windows) -> Floats:
        """How likely each window is each gesture; (n, g)."""
        votes = self.trees.probabilities(windows.features)
        followed = self.curves.scores(windows, 1.0 - votes[:, -1])
        return _TREES_SHARE * votes[:, :-1] + (1.0 - _TREES_SHARE) * followed

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a model file keeps."""
        return self.trees.arrays() | self.curves.arrays()

    @classmethod
    def from_arrays(
        cls, arrays: Mapping[str, NDArray[Any]], gestures: int, channels: Channels
    ) -> Both:
        """A recogniser from a model file; ValueError or KeyError when its parts do not fit."""
        trees = Trees.from_arrays(arrays, gestures, feature_count(channels))
        return cls(trees, Curves.from_arrays(arrays, gestures, channels.signals))


def fit_gmr(examples: Examples, seed: int = 0, trees: Trees | None = None) -> Gmr:
    """Make the curves; the gate is made of ``trees`` where there are some already."""
    grown = trees if trees is not None else fit_trees(examples, seed, GATE_TREES)
    return Gmr(_fit_curves(examples), grown.gate(GATE_TREES))


def _fit_curves(examples: Examples) -> Curves:
    """A curve for each gesture."""
    signals = []
    for label in range(len(examples.gestures)):
        # takes as they were marked, and no more than enough
        chosen = np.flatnonzero(examples.marked & (examples.labels == label))
        signals.append(examples.windows.signals[chosen[:: 1 + len(chosen) // _MOST_CURVES]])
    scale = np.concatenate(signals).std(axis=(0, 1)) + 1e-3
    fitted = [_fit_curve(curves / scale) for curves in signals]
    return Curves(scale, *(np.array(parts) for parts in zip(*fitted, strict=True)))


def _fit_curve(curves: Floats) -> tuple[Floats, Floats, Floats]:
    """Mean, whitening and log volume of curves (m, 32, s) in units of the scale."""
    mean, covariance = expected_curve(fit_mixture(curves), POINTS)
    size = np.eye(curves.shape[2])
    spread = size * np.einsum("tii->ti", covariance).mean(axis=0)
    covariance = (1 - _SHRINK) * covariance + _SHRINK * spread + _FLOOR * size
    lower = np.linalg.cholesky(covariance)
    log_det = 2 * np.log(np.einsum("tii->ti", lower)).sum(axis=1).mean()
    return mean, np.linalg.inv(lower), log_det


_BAND = 2 * _SLACK + 1
_OFFSETS = np.arange(-_SLACK, _SLACK + 1)
_AT_AN_END = np.abs(_OFFSETS) <= 1
_MET = np.arange(POINTS)[:, None] + _OFFSETS
_INSIDE = (_MET >= 0) & (_MET < POINTS)
_WITH_ENDS = np.array([_SLACK + 1, *[1] * (POINTS - 2), _SLACK + 1])
"""How often each point of a window is taken, so that there are points beyond its ends."""
