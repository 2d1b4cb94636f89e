"""What is remarkable about a take: too short, too still, or taken for another gesture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from statistics import median

import numpy as np

from nep_studio.blocks.own_gestures import OwnGesture, OwnTake
from nep_studio.ui.trainer.desk import TrainerDesk
from nep_studio.ui.trainer.results.findings import Findings, findings_of, id_of_take
from nep_studio.ui.words import tr

FEW_TAKES = 3
"""With fewer it is not known what is usual."""
_SHORT, _LONG, _STILL = 0.5, 2.0, 0.4
_METHODS = ("trees", "gmr")


class Badges:
    """The remarks on takes by id; measured once for each stretch."""

    def __init__(self, desk: TrainerDesk) -> None:
        self._desk = desk
        self._strengths: dict[OwnTake, float] = {}

    def all(self) -> dict[str, str]:
        """The remark on each take that has one."""
        found: dict[str, str] = {}
        for gesture in self._desk.gestures.values():
            found |= self._measured(gesture.takes)
        return {**self._learned(), **found}

    def _measured(self, takes: Sequence[OwnTake]) -> dict[str, str]:
        """What its own length and strength say, beside those of the others."""
        if len(takes) < FEW_TAKES:
            return {}
        usual_s = median(take.end_s - take.start_s for take in takes)
        usual = median(map(self._strength, takes))
        found = {}
        for take in takes:
            length = (take.end_s - take.start_s) / usual_s if usual_s else 1.0
            if length < _SHORT:
                found[take.id] = tr("too short")
            elif length > _LONG:
                found[take.id] = tr("too long")
            elif self._strength(take) < _STILL * usual:
                found[take.id] = tr("too still")
        return found

    def _strength(self, take: OwnTake) -> float:
        """How much the acceleration changes during a take, in m/s²."""
        if take not in self._strengths:
            acc = self._desk.take_samples(take).acc
            spread = acc.std(axis=0) if len(acc) else np.zeros(3)
            self._strengths[take] = float(np.sqrt((spread**2).sum()))
        return self._strengths[take]

    def _learned(self) -> dict[str, str]:
        """What the recogniser took a take for when it had not learned from it."""
        desk = self._desk
        if desk.recogniser is None or not desk.is_up_to_date:
            return {}
        by_method = findings_of(desk.recogniser.report)
        findings = next((by_method[name] for name in _METHODS if name in by_method), None)
        return _remarks(findings, desk.gestures) if findings is not None else {}


def _remarks(findings: Findings, gestures: Mapping[str, OwnGesture]) -> dict[str, str]:
    found = {}
    for one in findings.left_out:
        take = id_of_take(one, gestures)
        if not take or one.recognised == one.gesture:
            continue
        other = gestures.get(one.recognised)
        words = tr("looks like {gesture}", gesture=other.title) if other else tr("not recognised")
        found[take] = words
    return found
