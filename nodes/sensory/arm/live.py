"""A simulated person who lives in real time: makes gestures on request, else something calm."""

from __future__ import annotations

from collections import deque

import numpy as np

from nodes.sensory.arm.everyday import CALM
from nodes.sensory.arm.gestures import Gesture
from nodes.sensory.arm.people import person_numbered
from nodes.sensory.arm.performer import Performer, Samples

MOST_WAITING = 20


class LivePerson:
    """Somebody who wears the watch: gestures wait for each other, everyday movement gives way."""

    def __init__(self, person: int, rate_hz: float, seed: int, start_s: float = 0.0) -> None:
        self.number = person
        self._performer = Performer(person_numbered(person), rate_hz, seed, start_s)
        self._chance = np.random.default_rng([5, person, seed])
        self._waiting: deque[Gesture] = deque()
        self._gesture_until_s = start_s

    @property
    def now_s(self) -> float:
        """The time of the next sample, by the watch's clock."""
        return self._performer.now_s

    @property
    def is_busy(self) -> bool:
        """Whether a gesture is under way (or the way to it) or waits."""
        return bool(self._waiting) or self.now_s < self._gesture_until_s

    @property
    def making(self) -> str:
        """The gesture that is being made now, or ""."""
        return self._performer.gesture_at(self.now_s)

    def ask(self, gesture: Gesture) -> bool:
        """Make this gesture at once, or after those under way; False when too many wait."""
        if len(self._waiting) >= MOST_WAITING:
            return False
        self._waiting.append(gesture)
        if self.now_s >= self._gesture_until_s:
            self._performer.interrupt()
        return True

    def samples(self, count: int) -> Samples:
        """The next samples, 1 or more."""
        while not self._performer.has_planned(count):
            self._plan()
        return self._performer.samples(count)

    def _plan(self) -> None:
        if self._waiting:
            self._performer.make(self._waiting.popleft())
            self._gesture_until_s = self._performer.planned_until_s
        else:
            self._performer.live(CALM[self._chance.integers(len(CALM))])
