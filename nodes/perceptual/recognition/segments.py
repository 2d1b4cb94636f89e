"""Finds movements in a stream by themselves: each stretch between two rests is one.

How much the sensor moves is measured by its energy: what is left of the acceleration without its
slow part, and how fast it turns. A movement begins and ends where the energy is a little above
rest, counted from the strongest part of that movement.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .streams import Floats

Fault = Literal["", "short", "still", "long", "gap"]
"""Why a movement is no good example: too short, too weak, too long, samples are missing in it."""

SHORTEST_S, LONGEST_S = 0.25, 8.0
PAUSE_S = 0.3
"""A shorter rest is part of the movement."""
LONGEST_PAUSE_S = 0.7
"""So long a weak stretch parts two movements even if it is no rest."""
ENDLESS_S = 12.0
"""A movement without any rest is given up after so long."""
GAP_S = 0.3
WEAK = 0.35
"""A movement with less than this part of the usual energy is too weak."""
_EDGE, _CORE = 0.12, 0.35
"""How far above rest, as a part of the strongest energy, movement begins, and surely is one."""
_SLOW_S, _SMOOTH_S = 0.9, 0.15
_ACC_M_S2, _GYR_RAD_S = 1.0, 0.5
"""So much acceleration, or turning, is an energy of 1: what rest never reaches."""
_REST_QUANTILE = 0.2
_MOST_REST = 1.5
"""A hand that is still has less; whoever moved all the time has not rested at all."""
_REMEMBERED = 6000
_LEAST_EDGE, _LEAST_CORE = 0.6, 1.0
_CALM_TIMES, _CALM_ABOVE = 1.5, 0.15
"""With less than so many times the energy of rest, and a little, a hand is at rest."""

Span = tuple[int, int]
"""The first and the last of some samples, by their place."""


@dataclass(frozen=True)
class Movement:
    """A movement from ``start_s`` to ``end_s``, its strongest ``energy``, and what is wrong."""

    start_s: float
    end_s: float
    energy: float
    fault: Fault = ""

    @property
    def duration_s(self) -> float:
        """How long it lasts."""
        return self.end_s - self.start_s


def energy_of(t: Floats, acc: Floats, gyr: Floats | None) -> Floats:
    """How much the sensor moves at each of n samples; about 0 at rest, 1 is a slow movement."""
    rate_hz = _rate_hz(t)
    slow = _averaged(acc, _SLOW_S * rate_hz)
    power = (((acc - slow) / _ACC_M_S2) ** 2).sum(axis=1)
    if gyr is not None:
        power = power + ((gyr / _GYR_RAD_S) ** 2).sum(axis=1)
    return np.sqrt(np.maximum(_averaged(power[:, None], _SMOOTH_S * rate_hz)[:, 0], 0))


class MovementFinder:
    """Hears a stream and tells of each movement once it is over."""

    def __init__(self) -> None:
        self._t: Floats = np.empty(0)
        self._acc: Floats = np.empty((0, 3))
        self._gyr: Floats | None = None
        self._measured = 0
        """Of how many of these samples the energy is known."""
        self._energies: list[float] = []
        """The last of them: what rest is, is learned from them."""
        self._open_t: Floats = np.empty(0)
        self._open: Floats = np.empty(0)
        """Times and energies of what is not told of yet."""
        self._strengths: list[float] = []

    @property
    def is_moving(self) -> bool:
        """Whether a movement has begun that is not over yet."""
        return bool(len(self._open)) and bool(self._open[-1] > self._edge())

    def hear(self, t: Floats, acc: Floats, gyr: Floats | None) -> list[Movement]:
        """Take samples: ``t`` (n,) s, rising; ``acc`` (n, 3) m/s²; ``gyr`` (n, 3) rad/s or None.

        Gives the movements that are over now.
        """
        if (gyr is None) != (self._gyr is None) and len(self._t):
            self._gyr = gyr = None
        self._t = np.concatenate([self._t, t])
        self._acc = np.concatenate([self._acc, acc])
        if gyr is not None:
            self._gyr = gyr if self._gyr is None else np.concatenate([self._gyr, gyr])
        if len(self._t) < 3:
            return []
        self._measure(len(self._t) - round(_SLOW_S / 2 * _rate_hz(self._t)))
        # Take what is over from what is open
        t, energy = self._open_t, self._open
        found: list[Movement] = []
        for first, last in self._merged(t, energy, _spans(energy > self._edge())):
            is_endless = t[last] - t[first] > ENDLESS_S
            if not is_endless and not self._is_over(t[last:], energy[last:]):
                self._forget_before(float(t[first]))
                return found
            found += self._judged(t[first : last + 1], energy[first : last + 1])
        if len(t):
            self._forget_before(float(t[-1]))
        return found

    def finish(self) -> list[Movement]:
        """Give what is not over yet: the stream ends here."""
        if len(self._t) >= 3:
            self._measure(len(self._t))
        found = self._judged(self._open_t, self._open)
        self._open_t, self._open = np.empty(0), np.empty(0)
        return found

    def _measure(self, until: int) -> None:
        """Learn the energy of the samples up to one of them, and forget the oldest."""
        if until <= self._measured:
            return
        energy = energy_of(self._t, self._acc, self._gyr)[self._measured : until]
        self._energies = (self._energies + energy.tolist())[-_REMEMBERED:]
        self._open = np.concatenate([self._open, energy])
        self._open_t = np.concatenate([self._open_t, self._t[self._measured : until]])
        kept = max(0, until - round(_SLOW_S * _rate_hz(self._t)))
        self._t, self._acc = self._t[kept:], self._acc[kept:]
        self._gyr = None if self._gyr is None else self._gyr[kept:]
        self._measured = until - kept

    def _rest(self) -> float:
        if not self._energies:
            return 0.0
        return min(_MOST_REST, float(np.quantile(self._energies, _REST_QUANTILE)))

    def _usual(self) -> float:
        """How strong the movements so far were; 0 before the first."""
        return float(np.median(self._strengths)) if self._strengths else 0.0

    def _edge(self, strength: float = 0.0) -> float:
        """Above which energy a movement of this strength goes on; 0: of the usual strength."""
        strength, rest = max(strength, self._usual()), self._rest()
        if not strength:
            return max(_LEAST_EDGE, 1.5 * rest)
        return max(_LEAST_EDGE, rest + _EDGE * max(strength - rest, 0.0))

    def _is_over(self, t: Floats, energy: Floats) -> bool:
        """Whether nothing that follows can still be part of a movement that ended at ``t[0]``."""
        is_late = t[-1] - t[0] > LONGEST_PAUSE_S
        return bool(is_late or self._rested_s(t, energy) > PAUSE_S)

    def _forget_before(self, time_s: float) -> None:
        kept = int(np.searchsorted(self._open_t, time_s))
        self._open_t, self._open = self._open_t[kept:], self._open[kept:]

    def _judged(self, t: Floats, energy: Floats) -> list[Movement]:
        """The movements in a stretch without a rest: one, or more where one is much stronger."""
        strongest, usual, rest = float(energy.max(initial=0.0)), self._usual(), self._rest()
        core = max(_LEAST_CORE, rest + _CORE * (strongest - rest))
        found: list[Movement] = []
        for first, last in self._merged(t, energy, _spans(energy > self._edge(strongest))):
            peak = float(energy[first : last + 1].max())
            if peak < core:
                continue
            fault = _fault(t[first : last + 1], peak, usual)
            found.append(Movement(float(t[first]), float(t[last]), peak, fault))
            if not fault:
                self._strengths.append(peak)
        return found

    def _merged(self, t: Floats, energy: Floats, spans: list[Span]) -> list[Span]:
        """The spans, with those made one that no rest parts."""
        merged: list[Span] = []
        for first, last in spans:
            pause = slice(merged[-1][1], first + 1) if merged else slice(0)
            is_short = merged and t[first] - t[merged[-1][1]] < LONGEST_PAUSE_S
            if is_short and self._rested_s(t[pause], energy[pause]) < PAUSE_S:
                merged[-1] = (merged[-1][0], last)
            else:
                merged.append((first, last))
        return merged

    def _rested_s(self, t: Floats, energy: Floats) -> float:
        """The longest rest in a stretch, in s."""
        calm = _CALM_TIMES * self._rest() + _CALM_ABOVE
        return max((float(t[last] - t[first]) for first, last in _spans(energy < calm)), default=0)


def _fault(t: Floats, peak: float, usual: float) -> Fault:
    duration_s = float(t[-1] - t[0])
    if len(t) > 1 and float(np.diff(t).max()) > GAP_S:
        return "gap"
    if peak < WEAK * usual:
        return "still"
    if duration_s < SHORTEST_S:
        return "short"
    return "long" if duration_s > LONGEST_S else ""


def _rate_hz(t: Floats) -> float:
    steps = np.diff(t)
    usual = float(np.median(steps)) if len(steps) else 0.0
    return 1 / usual if usual > 0 else 50.0


def _averaged(values: Floats, samples: float) -> Floats:
    """The moving average (n, k) over so many samples, less at both ends."""
    half = max(0, round((samples - 1) / 2))
    if not half:
        return values
    sums = np.vstack([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
    at = np.arange(len(values))
    first, end = np.maximum(at - half, 0), np.minimum(at + half + 1, len(values))
    averaged: Floats = (sums[end] - sums[first]) / (end - first)[:, None]
    return averaged


def _spans(is_in: NDArray[np.bool_]) -> list[Span]:
    """First and last place of each run of True."""
    edges = np.diff(np.concatenate([[0], is_in.astype(int), [0]]))
    firsts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return [(int(first), int(end) - 1) for first, end in zip(firsts, ends, strict=True)]


# Finds performances in a stream: a hand that is raised, makes its gesture and goes back to rest.
#
# Where a hand is held still in another position than at rest, its gesture is not over: what leads
# there and back is not the gesture. Only a sensor that feels gravity tells how it is held; of
# others each movement is a performance.

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
        if len(self._t) and self._t[-1] - self._t[0] > 2 * _KEPT_S:
            first = int(np.searchsorted(self._t, self._t[-1] - _KEPT_S))
            self._t, self._acc = self._t[first:], self._acc[first:]
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
        return np.median(self._rests, axis=0)

    def _held(self, start_s: float, end_s: float) -> Floats | None:
        """The direction of gravity in a stretch; None when it is not felt."""
        first, last = np.searchsorted(self._t, [start_s, end_s])
        if last <= first:
            return None
        mean: Floats = self._acc[first:last].mean(axis=0)
        low, high = _GRAVITY_M_S2
        return mean if low < float(np.linalg.norm(mean)) < high else None


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
