"""Finds performances in a stream: a hand that is raised, makes its gesture and goes back to rest.

Where a hand is held still in another position than at rest, its gesture is not over: what leads
there and back is not the gesture. Only a sensor that feels gravity tells how it is held; of others
each movement is a performance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nodes.perceptual.recognition.segments import LONGEST_S, Movement, MovementFinder
from nodes.perceptual.recognition.stream import Floats

HELD_S = 1.3
"""A hand that is held still for longer has ended its gesture, wherever it is."""
TURNED_DEG = 30.0
"""Held this differently, a hand is not at rest."""
_GRAVITY_M_S2 = (7.0, 13.0)
_NEAR_S, _FAR_S = 0.1, 0.4
"""How the hand is held is felt this long before or after a movement."""
_KEPT_S = 30.0
_FIRST = 1.25
"""So much more must be done in the second of two movements, for it to be the gesture."""


class PerformanceFinder:
    """Hears a stream and tells of each performance once it is over."""

    def __init__(self) -> None:
        self._movements = MovementFinder()
        self._t: Floats = np.empty(0)
        self._acc: Floats = np.empty((0, 3))
        self._parts: list[Movement] = []
        """The movements of the performance that is not over yet."""
        self._before: Floats | None = None
        """How the hand was held before them."""
        self._rests: list[Floats] = []

    @property
    def is_moving(self) -> bool:
        """Whether a movement has begun that is not over yet."""
        return self._movements.is_moving

    def hear(self, t: Floats, acc: Floats, gyr: Floats | None) -> list[Movement]:
        """Take samples, as MovementFinder does; gives the performances that are over now."""
        self._t, self._acc = np.concatenate([self._t, t]), np.concatenate([self._acc, acc])
        found: list[Movement] = []
        for movement in self._movements.hear(t, acc, gyr):
            found += self._add(movement)
        if self._parts and not self.is_moving and t.size:
            waited_s = float(t[-1]) - self._parts[-1].end_s
            found += self._close() if waited_s > HELD_S else []
        self._forget()
        return found

    def finish(self) -> list[Movement]:
        """Give what is not over yet: the stream ends here."""
        found: list[Movement] = []
        for movement in self._movements.finish():
            found += self._add(movement)
        return found + self._close()

    def _add(self, movement: Movement) -> list[Movement]:
        """Take one more movement; gives what is over by it."""
        found: list[Movement] = []
        if self._parts and movement.start_s - self._parts[-1].end_s > HELD_S:
            found += self._close()
        if not self._parts:
            self._before = self._held(movement.start_s - _FAR_S, movement.start_s - _NEAR_S)
        self._parts.append(movement)
        after = self._held(movement.end_s + _NEAR_S, movement.end_s + _FAR_S)
        if self._is_rest(after):
            found += self._close()
        return found

    def _close(self) -> list[Movement]:
        """Tell of the performance, unless it only led back to rest."""
        parts, before, self._parts = self._parts, self._before, []
        if not parts:
            return []
        end_s = parts[-1].end_s
        after = self._held(end_s + _NEAR_S, end_s + _FAR_S)
        if self._rests and _is_turned(before, self._rest()) and not _is_turned(after, self._rest()):
            return []
        if before is not None:
            self._rests.append(before)
        return [_gesture_in(parts)]

    def _is_rest(self, held: Floats | None) -> bool:
        """Whether the hand is held as before the performance, or as it usually rests."""
        if held is None or self._before is None:
            return True
        return not _is_turned(held, self._before) or (
            bool(self._rests) and not _is_turned(held, self._rest())
        )

    def _rest(self) -> Floats:
        rest: Floats = np.median(self._rests, axis=0)
        return rest

    def _held(self, start_s: float, end_s: float) -> Floats | None:
        """The direction of gravity in a stretch; None when it is not felt."""
        first, last = np.searchsorted(self._t, [start_s, end_s])
        if last <= first:
            return None
        mean: Floats = self._acc[first:last].mean(axis=0)
        low, high = _GRAVITY_M_S2
        return mean if low < float(np.linalg.norm(mean)) < high else None

    def _forget(self) -> None:
        if len(self._t) and self._t[-1] - self._t[0] > 2 * _KEPT_S:
            first = int(np.searchsorted(self._t, self._t[-1] - _KEPT_S))
            self._t, self._acc = self._t[first:], self._acc[first:]


def find_performances(t: Floats, acc: Floats, gyr: Floats | None) -> list[Movement]:
    """All performances of a recording, as they would be found while it is made."""
    finder = PerformanceFinder()
    found: list[Movement] = []
    for at in range(0, len(t), 5):
        part = slice(at, at + 5)
        found += finder.hear(t[part], acc[part], None if gyr is None else gyr[part])
    return found + finder.finish()


def _gesture_in(parts: list[Movement]) -> Movement:
    """Of what led to a position, the movements there and what led back: the gesture."""
    made = parts[1:-1] if len(parts) > 2 else [_main(parts)]
    good = [part for part in made if not part.fault]
    gaps = [part for part in made if part.fault == "gap"]
    whole = replace(
        max(made, key=lambda part: part.energy), start_s=made[0].start_s, end_s=made[-1].end_s
    )
    if gaps:
        return replace(whole, fault="gap")
    if whole.duration_s > LONGEST_S:
        return replace(whole, fault="long")
    return replace(whole, fault="" if good else made[0].fault)


def _main(parts: list[Movement]) -> Movement:
    """Of one or two movements the one in which most is done; the way back seldom is."""
    first, last = parts[0], parts[-1]
    if last.energy * last.duration_s > _FIRST * first.energy * first.duration_s:
        return last
    return first


def _is_turned(one: Floats | None, other: Floats | None) -> bool:
    """Whether a hand is held clearly differently; not when it is not known."""
    if one is None or other is None:
        return False
    cosine = float(one @ other) / float(np.linalg.norm(one) * np.linalg.norm(other))
    return bool(cosine < np.cos(np.radians(TURNED_DEG)))
