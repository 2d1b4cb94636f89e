"""What each certainty would catch, and what it would let through."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nodes.perceptual.recognition.matching import meets
from nodes.perceptual.recognition.passages import Passage
from nodes.perceptual.recognition.peaks import Detection, best_lengths
from nodes.perceptual.recognition.scans import Gesture, Scan, fitting, window_lengths
from nodes.perceptual.recognition.stream import RATE_HZ, Floats

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
    caught: list[float] = []
    everyday: list[float] = []
    others: list[float] = []
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
            _share(caught, certainty),
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


def _share(values: Sequence[float], least: float) -> float:
    return _count(values, least) / len(values) if values else 0.0


def _count(values: Sequence[float], least: float) -> int:
    return sum(value >= least for value in values)
