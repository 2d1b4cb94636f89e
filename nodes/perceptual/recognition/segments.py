"""Finds movements in a stream by themselves: each stretch between two rests is one.

How much the sensor moves is measured by its energy: what is left of the acceleration without its
slow part, and how fast it turns. A movement begins and ends where the energy is a little above
rest, counted from the strongest part of that movement.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from nodes.perceptual.recognition.stream import Floats

Fault = Literal["", "short", "still", "long", "gap"]
"""Why a movement is no good example: too short, too weak, too long, samples are missing in it."""

SHORTEST_S, LONGEST_S = 0.25, 5.0
PAUSE_S = 0.25
"""A shorter rest is part of the movement."""
CALM_F, CALM_C = 1.5, .15
LONGEST_PAUSE_S=0.8
SETTLED_S = 0.35
"""After so long a rest a movement is over."""
ENDLESS_S = 12.0
"""A movement without any rest is given up after so long."""
GAP_S = 0.3
WEAK = 0.35
"""A movement with less than this part of the usual energy is too weak."""
_EDGE, _CORE = 0.18, 0.35
"""How far above rest, as a part of the strongest energy, movement begins, and surely is one."""
_SLOW_S, _SMOOTH_S = 0.9, 0.15
_ACC_M_S2, _GYR_RAD_S = 1.0, 0.5
"""So much acceleration, or turning, is an energy of 1: what rest never reaches."""
_REST_QUANTILE = 0.2


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
    energy: Floats = np.sqrt(np.maximum(_averaged(power[:, None], _SMOOTH_S * rate_hz)[:, 0], 0))
    return energy


class MovementFinder:
    """Hears a stream and tells of each movement once it is over."""

    def __init__(self) -> None:
        self._t: Floats = np.empty(0)
        self._acc: Floats = np.empty((0, 3))
        self._gyr: Floats | None = None
        self._measured = 0
        """Of how many of these samples the energy is known."""
        self._energies: list[float] = []
        """All energies there ever were: what rest is, is learned from them."""
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
        return self._take_over()

    def finish(self) -> list[Movement]:
        """Give what is not over yet: the stream ends here."""
        if len(self._t) >= 3:
            self._measure(len(self._t))
        if not len(self._open):
            return []
        found = self._judged(self._open_t, self._open)
        self._drop(len(self._open))
        return found

    def _measure(self, until: int) -> None:
        """Learn the energy of the samples up to one of them, and forget the oldest."""
        if until <= self._measured:
            return
        energy = energy_of(self._t, self._acc, self._gyr)[self._measured : until]
        self._energies += energy.tolist()
        self._open = np.concatenate([self._open, energy])
        self._open_t = np.concatenate([self._open_t, self._t[self._measured : until]])
        kept = max(0, until - round(_SLOW_S * _rate_hz(self._t)))
        self._t, self._acc = self._t[kept:], self._acc[kept:]
        self._gyr = None if self._gyr is None else self._gyr[kept:]
        self._measured = until - kept

    def _rest(self) -> float:
        return float(np.quantile(self._energies, _REST_QUANTILE)) if self._energies else 0.0

    def _usual(self) -> float:
        """How strong the movements so far were; 0 before the first."""
        return float(np.median(self._strengths)) if self._strengths else 0.0

    def _edge(self, strength: float = 0.0) -> float:
        """Above which energy a movement of this strength goes on."""
        rest = min(self._rest(), strength or self._usual() or np.inf)
        return max(
            0.6, rest + _EDGE * (max(strength, self._usual()) - rest), 1.5 * rest * (not strength)
        )

    def _take_over(self) -> list[Movement]:
        """Take what is over from what is open."""
        t, is_moving = self._open_t, self._open > self._edge()
        found: list[Movement] = []
        for first, last in self._merged(t, self._open, _spans(is_moving)):
            is_endless = t[last] - t[first] > ENDLESS_S
            if t[-1] - t[last] < SETTLED_S and not is_endless:
                self._drop(int(np.searchsorted(self._open_t, t[first])))
                return found
            window = (self._open_t >= t[first]) & (self._open_t <= t[last])
            found += self._judged(self._open_t[window], self._open[window])
            self._drop(int(np.searchsorted(self._open_t, t[last], side="right")))
        self._drop(len(self._open) - 1)
        return found

    def _drop(self, count: int) -> None:
        self._open_t, self._open = self._open_t[count:], self._open[count:]

    def _judged(self, t: Floats, energy: Floats) -> list[Movement]:
        """The movements in a stretch without a rest: one, or more where one is much stronger."""
        if not len(energy):
            return []
        strongest = float(energy.max())
        usual = self._usual()
        edge = self._edge(strongest)
        core = max(1.0, self._rest() + _CORE * (strongest - self._rest()))
        found: list[Movement] = []
        for first, last in self._merged(t, energy, _spans(energy > edge)):
            peak = float(energy[first : last + 1].max())
            if peak < core:
                continue
            fault = _fault(t[first : last + 1], peak, usual)
            found.append(Movement(float(t[first]), float(t[last]), peak, fault))
            if not fault:
                self._strengths.append(peak)
        return found

    def _merged(self, t: Floats, energy: Floats, spans: list[tuple[int, int]]) -> list[tuple[int, int]]:
        """The spans with those made one that no rest parts."""
        calm = CALM_F * self._rest() + CALM_C
        merged: list[tuple[int, int]] = []
        for first, last in spans:
            before = merged[-1][1] if merged else 0
            if merged and t[first] - t[before] < LONGEST_PAUSE_S and self._rested(t[before:first+1], energy[before:first+1] < calm) < PAUSE_S:
                merged[-1] = (merged[-1][0], last)
            else:
                merged.append((first, last))
        return merged

    def _rested(self, t, is_calm):
        return max((float(t[b]-t[a]) for a,b in _spans(is_calm)), default=0.0)


def find_movements(t: Floats, acc: Floats, gyr: Floats | None) -> list[Movement]:
    """All movements of a recording, as they would be found while it is made."""
    finder = MovementFinder()
    found: list[Movement] = []
    step = max(1, round(_rate_hz(t) / 10))
    for at in range(0, len(t), step):
        part = slice(at, at + step)
        found += finder.hear(t[part], acc[part], None if gyr is None else gyr[part])
    return found + finder.finish()


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


def _spans(is_in: np.ndarray) -> list[tuple[int, int]]:
    """First and last place of each run of True."""
    edges = np.diff(np.concatenate([[0], is_in.astype(int), [0]]))
    firsts, ends = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return [(int(first), int(end) - 1) for first, end in zip(firsts, ends, strict=True)]
