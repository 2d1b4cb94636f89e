"""Gaussian mixtures over time and signals, and the curve that they expect at each time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nodes.perceptual.recognition.stream import Floats

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
    belongs = np.eye(components)[slices]
    mixture = _maximise(rows, belongs)
    for _ in range(_ROUNDS):
        mixture = _maximise(rows, _expect(rows, mixture))
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
    log_share = np.log(mixture.weight) - 0.5 * (away**2 / variance + np.log(variance))
    share = _normalised(log_share)
    slope = mixture.covariance[:, 1:, 0] / variance[:, None]
    middles = mixture.mean[:, 1:] + slope * away[..., None]
    mean = np.einsum("tk,tks->ts", share, middles)
    around = mixture.covariance[:, 1:, 1:] - np.einsum("ks,kr,k->ksr", slope, slope, variance)
    apart = middles - mean[:, None]
    covariance = np.einsum("tk,ksr->tsr", share, around)
    covariance += np.einsum("tk,tks,tkr->tsr", share, apart, apart)
    return mean, covariance


def _expect(rows: Floats, mixture: Mixture) -> Floats:
    """How much each row belongs to each Gaussian; (rows, k)."""
    lower = np.linalg.cholesky(mixture.covariance)
    whiten = np.linalg.inv(lower).transpose(0, 2, 1)
    away = rows @ whiten - (mixture.mean[:, None] @ whiten)
    log_det = np.log(np.einsum("kii->ki", lower)).sum(axis=1)
    squares = np.einsum("krs,krs->rk", away, away)
    return _normalised(np.log(mixture.weight) - log_det - 0.5 * squares)


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
