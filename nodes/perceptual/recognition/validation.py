"""How well gestures are told apart in recordings that the recogniser has not seen."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from .examples import Examples
from .features import (
    Detection,
    Gesture,
    Integers,
    PeakPicker,
    Scan,
    best_lengths,
    fitting,
    window_lengths,
)
from .model import TRIGGER, Scorer, certainty_of
from .streams import RATE_HZ, Floats, Passage, Take

# How the gestures that were found agree with the gestures that were made.

NOTHING = ""
_SHARED = 0.25  # of the shorter of the two


@dataclass(frozen=True)
class Totals:
    """Pairs (made, recognised), NOTHING standing for none: one for each take and each extra."""

    pairs: tuple[tuple[str, str], ...] = ()

    def __add__(self, other: Totals) -> Totals:
        return Totals(self.pairs + other.pairs)

    @property
    def made(self) -> int:
        """Gestures that were made."""
        return sum(made != NOTHING for made, _ in self.pairs)

    @property
    def right(self) -> int:
        """Gestures made that were recognised as what they were."""
        return sum(made == found != NOTHING for made, found in self.pairs)

    @property
    def fired(self) -> int:
        """Triggers, right and wrong."""
        return sum(found != NOTHING for _, found in self.pairs)

    @property
    def recall(self) -> float:
        """The part of the gestures made that were recognised."""
        return self.right / self.made if self.made else 0.0

    @property
    def precision(self) -> float:
        """The part of the triggers that were right."""
        return self.right / self.fired if self.fired else 0.0

    @property
    def f1(self) -> float:
        """The harmonic mean of recall and precision."""
        return 2 * self.right / (self.made + self.fired) if self.made + self.fired else 0.0


def match(takes: Sequence[Take], detections: Sequence[Detection]) -> Totals:
    """Pair each take with the trigger it caused, the right one if there are several.

    A trigger that no take caused, and one more than the first for the same take, counts as made
    from nothing.
    """
    left = list(detections)
    pairs = []
    for take in takes:
        caused = [found for found in left if meets(take, found)]
        caused.sort(key=lambda found: found.gesture != take.gesture)
        pairs.append((take.gesture, caused[0].gesture if caused else NOTHING))
        if caused:
            left.remove(caused[0])
    return Totals((*pairs, *((NOTHING, found.gesture) for found in left)))


def meets(take: Take, found: Detection) -> bool:
    """Whether a trigger may have been caused by a take."""
    shared = min(take.end_s, found.t_end) - max(take.start_s, found.t_start)
    return shared > _SHARED * min(take.duration_s, found.t_end - found.t_start)


# What each certainty would catch, and what it would let through.

CERTAINTIES = tuple(round(0.05 * step, 2) for step in range(1, 20))


@dataclass(frozen=True)
class CurvePoint:
    """At this ``certainty``: the share of left-out takes caught, and false triggers.

    ``false_in_others`` counts those in recordings of gestures: at another gesture or at none.
    """

    certainty: float
    caught: float
    false_everyday_per_hour: float
    false_in_others: int


def rises(found: Scan, gestures: Sequence[Gesture], certainties: Floats) -> list[Detection]:
    """Every rise of the highest certainty (windows, gestures), the highest first.

    Rises do not depend on a trigger: what one lets through, a lower one does too.
    """
    lengths = window_lengths(gestures)
    looks = np.zeros((found.hop[-1] + 1, len(lengths), len(gestures)))
    looks[found.hop, found.which] = certainties
    best, which = best_lengths(looks, fitting(gestures, lengths))
    ends_s = np.full(len(looks), np.inf)
    ends_s[found.hop] = found.ends_s
    column = best.argmax(axis=1)
    height = best.max(axis=1)
    length_s = lengths[np.take_along_axis(which, column[:, None], axis=1)[:, 0]] / RATE_HZ
    free = height >= CERTAINTIES[0]
    peaks = []
    for look in np.argsort(-height, kind="stable")[: int(free.sum())]:
        if free[look]:
            one, end_s = gestures[int(column[look])], float(ends_s[look])
            peaks.append(Detection(one.name, float(height[look]), end_s - length_s[look], end_s))
            free &= np.abs(ends_s - end_s) > one.typical_s
    return peaks


def curves_of(
    gestures: Sequence[Gesture], seen: Sequence[tuple[Passage, Sequence[Detection]]]
) -> dict[str, tuple[CurvePoint, ...]]:
    """The curve of each gesture over the rises of left-out passages."""
    hours = sum(one.duration_s for one, _ in seen if not one.takes) / 3600
    return {gesture.name: _curve(gesture, seen, hours) for gesture in gestures}


def _curve(
    gesture: Gesture, seen: Sequence[tuple[Passage, Sequence[Detection]]], hours: float
) -> tuple[CurvePoint, ...]:
    caught, everyday, others = list[float](), list[float](), list[float]()
    for passage, found in seen:
        own = [one for one in found if one.gesture == gesture.name]
        for take in passage.takes:
            at_take = [one for one in own if meets(take, one)]
            own = [one for one in own if one not in at_take]
            if take.gesture == gesture.name:
                caught.append(max((one.certainty for one in at_take), default=0.0))
            else:
                others += [one.certainty for one in at_take]
        false = others if passage.takes else everyday
        false += [one.certainty for one in own if not is_unknown(passage, one)]
    return tuple(
        CurvePoint(
            certainty,
            _count(caught, certainty) / len(caught) if caught else 0.0,
            _count(everyday, certainty) / hours if hours else 0.0,
            _count(others, certainty),
        )
        for certainty in CERTAINTIES
    )


def is_unknown(passage: Passage, found: Detection) -> bool:
    """Whether it is where a recording is marked as neither a gesture nor its absence."""
    return any(
        found.t_start < end_s and start_s < found.t_end for start_s, end_s in passage.unknown
    )


def _count(values: Sequence[float], least: float) -> int:
    return sum(value >= least for value in values)


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

    ``totals`` and ``everyday_triggers`` are at TRIGGER, ``curves`` by gesture at every certainty;
    ``people`` are the tallies of each person where there are several.
    """

    usual: Floats
    totals: Totals
    everyday_triggers: int
    everyday_s: float
    curves: Mapping[str, tuple[CurvePoint, ...]] = field(default_factory=dict)
    takes: tuple[LeftOutTake, ...] = ()
    people: Mapping[str, Totals] = field(default_factory=dict)


def cross_validate(
    fit: Fit, examples: Examples, scans: Sequence[Scan], folds: Sequence[Integers]
) -> dict[str, Validation]:
    """Score every window of the scans by recognisers fitted without its fold, and spot in that.

    ``fit`` makes a recogniser of ``examples`` without those of one fold; ``folds`` has, by
    scan, the fold of each window.
    """
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
    people: dict[str, Totals] = {}
    totals, triggers, everyday_s = Totals(), 0, 0.0
    for found, certainty in zip(scans, certainties, strict=True):
        passage = found.passage
        detections = spot(found, gestures, certainty)
        if not passage.takes:
            triggers, everyday_s = triggers + len(detections), everyday_s + passage.duration_s
            continue
        here = _counted(passage, detections)
        totals, people[passage.person] = totals + here, people.get(passage.person, Totals()) + here
        takes += _left_out_takes(found, gestures, certainty, here)
    seen = [
        (found.passage, rises(found, gestures, certainty))
        for found, certainty in zip(scans, certainties, strict=True)
    ]
    return Validation(
        usual,
        totals,
        triggers,
        everyday_s,
        curves_of(gestures, seen),
        tuple(takes),
        people if len(people) > 1 else {},
    )


def spot(
    found: Scan, gestures: Sequence[Gesture], certainties: Floats, trigger: float = TRIGGER
) -> list[Detection]:
    """What a spotter finds in a scanned passage; certainties (windows, gestures).

    ``found`` is the passage, ``gestures`` are the columns of the certainties, ``trigger`` is
    the certainty from which one counts.
    """
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


def _counted(passage: Passage, detections: Sequence[Detection]) -> Totals:
    """How triggers agree with the takes; those where nobody knows what was made do not count."""
    takes = passage.takes
    known = [
        found
        for found in detections
        if any(meets(take, found) for take in takes) or not is_unknown(passage, found)
    ]
    return match(takes, known)


def _left_out_takes(
    found: Scan, gestures: Sequence[Gesture], certainties: Floats, totals: Totals
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
        for take, (_, recognised) in zip(found.passage.takes, totals.pairs, strict=False)
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
    return np.full(len(gestures), middle**_OWN * USUAL_SCORE ** (1 - _OWN))
