"""How well gestures are told apart in recordings that the recogniser has not seen."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from nodes.perceptual.recognition.curves import CurvePoint, curves_of, is_unknown, rises
from nodes.perceptual.recognition.examples import Examples
from nodes.perceptual.recognition.features import Integers
from nodes.perceptual.recognition.matching import Tally, match, meets
from nodes.perceptual.recognition.model import TRIGGER, Scorer, certainty_of
from nodes.perceptual.recognition.passages import Passage, Take
from nodes.perceptual.recognition.peaks import Detection, PeakPicker, best_lengths
from nodes.perceptual.recognition.scans import Gesture, Scan, fitting, window_lengths
from nodes.perceptual.recognition.stream import RATE_HZ, Floats

Fit = Callable[[Examples], Mapping[str, Scorer]]
"""What makes a scorer of each method."""

USUAL_SCORE = 0.84
_OWN = 0.4  # how much a set's own scores count beside USUAL_SCORE
UNCHECKED_SCORE = 0.4
"""The usual score of a gesture that was recorded too seldom to leave a take out."""
_SAME = 0.5  # a window that shares so much with a take may be the one that finds it


@dataclass(frozen=True)
class LeftOutTake:
    """A take that the recogniser had not seen: how certain it was of the right gesture.

    ``recognised`` is the gesture that it was taken for, NOTHING for none.
    """

    gesture: str
    source: str
    start_s: float
    certainty: float
    recognised: str


@dataclass(frozen=True)
class Validation:
    """``usual`` scores of left-out takes (gestures,), and what was found in left-out stretches.

    ``tally`` and ``everyday_triggers`` are at TRIGGER, ``curves`` by gesture at every certainty;
    ``people`` are the tallies of each person where there are several.
    """

    usual: Floats
    tally: Tally
    everyday_triggers: int
    everyday_s: float
    curves: Mapping[str, tuple[CurvePoint, ...]] = field(default_factory=dict)
    takes: tuple[LeftOutTake, ...] = ()
    people: Mapping[str, Tally] = field(default_factory=dict)


def cross_validate(
    fit: Fit, examples: Examples, scans: Sequence[Scan], folds: Sequence[Integers]
) -> dict[str, Validation]:
    """Score every window of the scans by recognisers fitted without its fold, and spot in that."""
    every = _left_out_scores(fit, examples, scans, folds)
    return {method: _validate(examples.gestures, scans, scores) for method, scores in every.items()}


def unchecked(gestures: Sequence[Gesture], scans: Sequence[Scan]) -> Validation:
    """What is known where every gesture was made only once, and none can be left out."""
    return _validate(gestures, scans, _nothing(scans, len(gestures)))


def _validate(
    gestures: Sequence[Gesture], scans: Sequence[Scan], scores: Sequence[Floats]
) -> Validation:
    usual = _usual_scores(gestures, scans, scores)
    certainties = [certainty_of(score, usual) for score in scores]
    takes: list[LeftOutTake] = []
    people: dict[str, Tally] = {}
    tally, triggers, everyday_s = Tally(), 0, 0.0
    for found, certainty in zip(scans, certainties, strict=True):
        passage = found.passage
        detections = spot(found, gestures, certainty)
        if not passage.takes:
            triggers, everyday_s = triggers + len(detections), everyday_s + passage.duration_s
            continue
        here = _tally(passage, detections)
        tally, people[passage.person] = tally + here, people.get(passage.person, Tally()) + here
        takes += _left_out_takes(found, gestures, certainty, here)
    seen = [
        (found.passage, rises(found, gestures, certainty))
        for found, certainty in zip(scans, certainties, strict=True)
    ]
    return Validation(
        usual,
        tally,
        triggers,
        everyday_s,
        curves_of(gestures, seen),
        tuple(takes),
        people if len(people) > 1 else {},
    )


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


def _tally(passage: Passage, detections: Sequence[Detection]) -> Tally:
    """How triggers agree with the takes; those where nobody knows what was made do not count."""
    takes = passage.takes
    known = [
        found
        for found in detections
        if any(meets(take, found) for take in takes) or not is_unknown(passage, found)
    ]
    return match(takes, known)


def _left_out_takes(
    found: Scan, gestures: Sequence[Gesture], certainties: Floats, tally: Tally
) -> list[LeftOutTake]:
    names = [gesture.name for gesture in gestures]
    return [
        LeftOutTake(
            take.gesture,
            found.passage.source,
            take.start_s,
            _best_near(found, take, certainties[:, names.index(take.gesture)]),
            recognised,
        )
        for take, (_, recognised) in zip(found.passage.takes, tally.pairs, strict=False)
    ]


def _best_near(found: Scan, take: Take, values: Floats) -> float:
    """The highest value of the windows that may be the ones that find a take."""
    return float(values[found.overlaps(take) >= _SAME].max(initial=0.0))


def _left_out_scores(
    fit: Fit, examples: Examples, scans: Sequence[Scan], folds: Sequence[Integers]
) -> dict[str, list[Floats]]:
    """By method, the scores of all windows of each scan; 0 where nothing could be left out."""
    every: dict[str, list[Floats]] = {}
    for fold in np.unique(examples.folds):
        others = examples.where(examples.folds != fold)
        if len(np.unique(others.labels)) <= len(examples.gestures):
            continue
        scorers = fit(others)
        for method in scorers:
            every.setdefault(method, _nothing(scans, len(examples.gestures)))
        for number, (found, fold_of) in enumerate(zip(scans, folds, strict=True)):
            here = fold_of == fold
            if here.any():
                windows = found.windows(examples.channels, here)
                for method, scorer in scorers.items():
                    every[method][number][here] = scorer.scores(windows)
    return every


def _nothing(scans: Sequence[Scan], gestures: int) -> list[Floats]:
    return [np.zeros((len(found.hop), gestures)) for found in scans]


def _usual_scores(
    gestures: Sequence[Gesture], scans: Sequence[Scan], scores: Sequence[Floats]
) -> Floats:
    """The median over left-out takes of the best score, drawn towards what is usual everywhere.

    Few takes say little about how high their scores usually are, and what is usual differs little
    from set to set.
    """
    best: dict[str, list[float]] = {gesture.name: [] for gesture in gestures}
    for found, score in zip(scans, scores, strict=True):
        for take in found.passage.takes:
            column = score[:, list(best).index(take.gesture)]
            best[take.gesture].append(_best_near(found, take, column))
    every = [value for values in best.values() for value in values]
    middle = float(np.median(every)) or UNCHECKED_SCORE
    usual: Floats = np.full(len(gestures), middle**_OWN * USUAL_SCORE ** (1 - _OWN))
    return usual
