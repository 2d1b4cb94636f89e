"""How certain a recogniser was in the last half minute, and what it would have recognised."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from nep_studio.ui.panels.sensors.ring import Floats
from nodes.perceptual.recognition.model import TRIGGER
from nodes.perceptual.recognition.peaks import Detection, PeakPicker
from nodes.perceptual.recognition.scans import Gesture

KEPT_S = 30.0
_GAP_S = 0.5
"""After so long without a look the movement has ended."""


@dataclass(frozen=True)
class LookedAt:
    """One look: when it was, and for each gesture the certainty and the length of its window."""

    end_s: float
    certainties: Floats
    lengths_s: Floats


class Looks:
    """The looks of the last half minute of one stream, and the triggers among them.

    ``triggers`` are what would have been recognised with the ``points``, the oldest first.
    """

    def __init__(self, gestures: Sequence[Gesture] = ()) -> None:
        self.gestures = tuple(gestures)
        self.kept: deque[LookedAt] = deque()
        self.triggers: list[Detection] = []
        self._points: dict[str, float] = {}
        self._picker = self._new_picker()
        self._last_s = -np.inf

    @property
    def names(self) -> tuple[str, ...]:
        """The gestures that are looked for."""
        return tuple(gesture.name for gesture in self.gestures)

    @property
    def now_s(self) -> float:
        """When the last look was; 0 before the first."""
        return self.kept[-1].end_s if self.kept else 0.0

    def set_points(self, points: Mapping[str, float]) -> None:
        """Look again at what is kept, with these recognition points."""
        self._points = dict(points)
        self._begin()
        for look in self.kept:
            self._pick(look)

    def add(self, look: LookedAt) -> None:
        """Keep a look, and forget those that are too old."""
        if self.kept and look.end_s < self.kept[-1].end_s:
            self.kept.clear()  # another stream, or a clock that begins anew
            self._begin()
        self.kept.append(look)
        self._pick(look)
        oldest_s = look.end_s - KEPT_S
        while self.kept[0].end_s < oldest_s:
            self.kept.popleft()
        while self.triggers and self.triggers[0].t_end < oldest_s:
            del self.triggers[0]

    def certainties(self) -> dict[str, float]:
        """How certain it is of each gesture now."""
        if not self.kept:
            return {}
        return dict(zip(self.names, self.kept[-1].certainties.tolist(), strict=True))

    def _begin(self) -> None:
        self._picker, self._last_s = self._new_picker(), -np.inf
        self.triggers = []

    def _new_picker(self) -> PeakPicker:
        wanted = {name: self._points.get(name, TRIGGER) for name in self.names}
        return PeakPicker(self.gestures, wanted)

    def _pick(self, look: LookedAt) -> None:
        found = []
        if look.end_s - self._last_s > _GAP_S:
            found.append(self._picker.flush())
        found.append(self._picker.look(look.end_s, look.certainties, look.lengths_s))
        self._last_s = look.end_s
        self.triggers += [one for one in found if one is not None]

    def best(self, name: str, since_s: float) -> Detection | None:
        """Where a gesture was most certain since a time; None when it was not looked for."""
        if name not in self.names:
            return None
        column = self.names.index(name)
        recent = [look for look in self.kept if look.end_s >= since_s]
        if not recent:
            return None
        look = max(recent, key=lambda one: float(one.certainties[column]))
        length_s = float(look.lengths_s[column])
        certainty = float(look.certainties[column])
        return Detection(name, certainty, look.end_s - length_s, look.end_s)

    def most_certain(self, since_s: float) -> Detection | None:
        """The gesture that was most certain since a time."""
        found = [one for name in self.names if (one := self.best(name, since_s)) is not None]
        return max(found, key=lambda one: one.certainty, default=None)
