"""How well gestures are told apart in recordings that the recogniser has not seen."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from nodes.perceptual.recognition.examples import Examples
from nodes.perceptual.recognition.features import Integers
from nodes.perceptual.recognition.matching import Tally, match
from nodes.perceptual.recognition.model import TRIGGER, Scorer, certainty_of
from nodes.perceptual.recognition.peaks import Detection, PeakPicker, best_lengths
from nodes.perceptual.recognition.scans import Gesture, Scan, fitting, window_lengths
from nodes.perceptual.recognition.stream import RATE_HZ, Floats

Fit = Callable[[Examples], Scorer]

UNCHECKED_SCORE = 0.4
"""The usual score of a gesture that was recorded too seldom to leave a take out."""
_SAME = 0.5  # a window that shares so much with a take may be the one that finds it


@dataclass(frozen=True)
class Validation:
    """``usual`` scores of left-out takes (gestures,), and what was found in left-out stretches."""

    usual: Floats
    tally: Tally
    everyday_triggers: int
    everyday_s: float


def cross_validate(
    fit: Fit, examples: Examples, scans: Sequence[Scan], folds: Sequence[Integers]
) -> Validation:
    """Score every window of the scans by a recogniser fitted without its fold, and spot in that."""
    gestures = examples.gestures
    scores = _left_out_scores(fit, examples, scans, folds)
    usual = _usual_scores(gestures, scans, scores)
    tally, triggers, everyday_s = Tally(), 0, 0.0
    for found, score in zip(scans, scores, strict=True):
        detections = spot(found, gestures, certainty_of(score, usual))
        if found.passage.takes:
            tally += match(found.passage.takes, detections)
        else:
            triggers, everyday_s = triggers + len(detections), everyday_s + found.passage.duration_s
    return Validation(usual, tally, triggers, everyday_s)


def spot(
    found: Scan, gestures: Sequence[Gesture], certainties: Floats, trigger: float = TRIGGER
) -> list[Detection]:
    """What a spotter finds in a scanned passage; certainties (windows, gestures)."""
    lengths = window_lengths(gestures)
    looks = np.zeros((found.hop[-1] + 1, len(lengths), len(gestures)))
    looks[found.hop, found.which] = certainties
    best, which = best_lengths(looks, fitting(gestures, lengths))
    ends_s = np.zeros(len(looks))
    ends_s[found.hop] = found.ends_s
    picker = PeakPicker(gestures, trigger)
    detections = [
        picker.look(float(ends_s[hop]), best[hop], lengths[which[hop]] / RATE_HZ)
        for hop in range(len(looks))
    ]
    return [one for one in (*detections, picker.flush()) if one is not None]


def _left_out_scores(
    fit: Fit, examples: Examples, scans: Sequence[Scan], folds: Sequence[Integers]
) -> list[Floats]:
    scores = [np.zeros((len(found.hop), len(examples.gestures))) for found in scans]
    for fold in np.unique(examples.folds):
        others = examples.where(examples.folds != fold)
        if len(np.unique(others.labels)) <= len(examples.gestures):
            continue
        scorer = fit(others)
        for found, fold_of, score in zip(scans, folds, scores, strict=True):
            here = fold_of == fold
            if here.any():
                score[here] = scorer.scores(found.windows.where(here))
    return scores


def _usual_scores(
    gestures: Sequence[Gesture], scans: Sequence[Scan], scores: Sequence[Floats]
) -> Floats:
    """The median over left-out takes of the best score, drawn towards that of all gestures."""
    best: dict[str, list[float]] = {gesture.name: [] for gesture in gestures}
    for found, score in zip(scans, scores, strict=True):
        for take in found.passage.takes:
            near = found.overlaps(take) >= _SAME
            column = list(best).index(take.gesture)
            best[take.gesture].append(float(score[near, column].max(initial=0.0)))
    every = [value for values in best.values() for value in values]
    middle = float(np.median(every)) or UNCHECKED_SCORE
    own = np.array([np.median(values) if values else middle for values in best.values()])
    usual: Floats = np.sqrt(np.maximum(own, middle / 4) * middle)
    return usual
