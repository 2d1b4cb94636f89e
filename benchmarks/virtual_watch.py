"""Does the virtual watch move as people do? Its mean curves beside those of the paper's authors.

The authors published the mean acceleration of their five gestures (NEP, 2018: a watch, 32 Hz,
gravity included). Measured on simulated people who are used for nothing else:
the correlation of the curves after alignment in time (dynamic time warping, a band of 15 %), the
angle between the directions of gravity at five phases, and whether the extremes of the three
axes come in the same order (rank correlation of their six instants). The key poses were made after
these same curves: the figures say how closely the model follows them, not that it foretells people.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from nodes.sensory.arm.gestures import GESTURES
from nodes.sensory.arm.people import perform

MODELS = Path(__file__).resolve().parents[2] / "shared" / "data" / "nep_models"
_RATE_HZ = 32.0
_PEOPLE = [number for number in range(200, 216) if number % 10 != 9]  # right-handed, as theirs
_TAKES = 3
_PHASES = (0.02, 0.25, 0.5, 0.75, 0.98)
_GOALS = {"correlation": 0.9, "gravity angle": 20.0, "order of peaks": 0.6}


def run() -> list[dict[str, Any]]:
    """A row for every gesture and measure; one that says so where the models are not there."""
    if not MODELS.is_dir():
        skipped = "virtual watch: skipped, there is no ../shared/data/nep_models"
        return [{"name": skipped, "value": None, "unit": ""}]
    return [row for gesture in GESTURES for row in _rows(gesture)]


def _rows(gesture: str) -> list[dict[str, Any]]:
    theirs = np.loadtxt(MODELS / f"{gesture}_Mu.txt")
    ours = mean_curve(gesture, len(theirs))
    correlation = aligned_correlation(ours, theirs)
    angles = gravity_angles_deg(ours, theirs)
    angle = float(np.median(angles))
    order = peak_order(ours, theirs)
    return [
        _row(gesture, "correlation", correlation, "", 1.0, correlation >= _GOALS["correlation"]),
        _row(gesture, "gravity angle", angle, "degrees", 0.0, angle <= _GOALS["gravity angle"]),
        _row(gesture, "order of peaks", order, "", 1.0, order >= _GOALS["order of peaks"]),
        {
            "name": f"simulated {gesture}: gravity angle, worst of five phases",
            "value": round(max(angles), 1),
            "unit": "degrees",
        },
    ]


def _row(
    gesture: str, measure: str, value: float, unit: str, reference: float, ok: bool
) -> dict[str, Any]:
    limit = "at most" if measure == "gravity angle" else "at least"
    return {
        "name": f"simulated {gesture}: {measure} with the authors'",
        "value": round(value, 3),
        "unit": unit,
        "reference": reference,
        "ratio": round(value / reference, 3) if reference else None,
        "goal": f"{limit} {_GOALS[measure]}",
        "ok": bool(ok),
    }


def mean_curve(gesture: str, length: int) -> np.ndarray:
    """Mean acceleration (length, 3) of many performances, each brought to the same length."""
    curves = []
    for person in _PEOPLE:
        for take in range(_TAKES):
            recording = perform(gesture, person, take, _RATE_HZ)
            made = np.array([label == gesture for label in recording.labels or []])
            curves.append(resampled(recording.acc[made], length))
    return np.asarray(np.mean(curves, axis=0))


def resampled(curve: np.ndarray, length: int) -> np.ndarray:
    """The same curve with another number of samples."""
    at = np.linspace(0, len(curve) - 1, length)
    return np.stack([np.interp(at, np.arange(len(curve)), axis) for axis in curve.T], axis=1)


def aligned_correlation(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Pearson correlation of all three axes, after dynamic time warping."""
    path = np.array(_warping_path(ours, theirs, band=round(0.15 * len(theirs))))
    return float(np.corrcoef(ours[path[:, 0]].ravel(), theirs[path[:, 1]].ravel())[0, 1])


def _warping_path(a: np.ndarray, b: np.ndarray, band: int) -> list[tuple[int, int]]:
    n = len(a)
    cost = np.full((n + 1, n + 1), np.inf)
    cost[0, 0] = 0.0
    for i in range(1, n + 1):
        for j in range(max(1, i - band), min(n, i + band) + 1):
            step = min(cost[i - 1, j - 1], cost[i - 1, j], cost[i, j - 1])
            cost[i, j] = step + float(np.sum((a[i - 1] - b[j - 1]) ** 2))
    path, i, j = [], n, n
    while i and j:
        path.append((i - 1, j - 1))
        i, j = min(((i - 1, j - 1), (i - 1, j), (i, j - 1)), key=lambda at: cost[at])
    return path[::-1]


def gravity_angles_deg(ours: np.ndarray, theirs: np.ndarray) -> list[float]:
    """Angles between the slow parts (mean over 0.4 s) of both curves at five phases."""
    angles = []
    for phase in _PHASES:
        middle, half = round(phase * (len(theirs) - 1)), round(0.2 * _RATE_HZ)
        near = slice(max(0, middle - half), middle + half + 1)
        a, b = ours[near].mean(axis=0), theirs[near].mean(axis=0)
        cosine = float(a @ b / (np.linalg.norm(a) * np.linalg.norm(b)))
        angles.append(float(np.degrees(np.arccos(np.clip(cosine, -1, 1)))))
    return angles


def peak_order(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Rank correlation of the instants at which each axis is highest and lowest."""
    ranks = [
        np.argsort(np.argsort([*curve.argmax(axis=0), *curve.argmin(axis=0)]))
        for curve in (ours, theirs)
    ]
    return float(np.corrcoef(ranks[0], ranks[1])[0, 1])
