"""How the arm that wears a watch is held: raised, level or lowered, from the direction of gravity.

An accelerometer at rest feels 9.81 m/s² upward (Android's sign), so that while the arm is held
still its axes tell how the forearm slants; an inclinometer does the same. Of the upper arm a watch
knows nothing: a forearm is level on a desk as well as stretched out, and raised where the elbow is
bent and the hand beside the head.

The x axis of a watch lies along the forearm (Android: to the right of the screen). Worn as usual
it points to the hand on the left wrist and to the elbow on the right one; put on turned round, the
other way. Which of its ends is at the hand is found out from which of them is usually below.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

ArmPosture = Literal["raised", "level", "lowered"]

GRAVITY_M_S2 = 9.81

SMOOTHED_S = 0.2
"""Time constant of what is taken for gravity: it follows an arm soon, and shaking hardly."""
BESIDE_S = 0.1
"""Time constant of how much is felt beside gravity: a movement that has ended is soon forgotten."""
STILL_M_S2 = 2.0
"""Held still: what is felt beside gravity (RMS over BESIDE_S) is less than this.

A held arm with its tremor feels some tenths, one that swings or works several m/s². With 2.0 an arm
that hangs is told of in most walks; with 3.0 half as many arms again seem raised in everyday life
(WISDM, UCI 507, CC BY 4.0: 3.6 an hour with 2.0, 5.1 with 3.0).
"""
NEAR_GRAVITY_M_S2 = 1.5
"""So far from 9.81 m/s² may the size of what is taken for gravity be."""
HELD_S = 0.5
"""A posture counts once it was held for so long."""
LEFT_S = 0.3
"""It is over once the arm was outside of its zone for so long, however it moved there."""
LONGEST_GAP_S = 0.5
"""After a longer gap in the samples nothing is known any more."""


@dataclass(frozen=True)
class _Zone:
    """The elevations of a forearm, in degrees, 90 is straight up, that make a posture.

    One enters within the narrow ``low`` to ``high``, and leaves ``margin_deg`` outside of them, so
    that an arm at the edge is not told again and again.
    """

    posture: ArmPosture
    low_deg: float
    high_deg: float
    margin_deg: float = 15.0

    def has(self, elevation_deg: float, *, is_in: bool) -> bool:
        """Whether an arm is in it; ``is_in``: it was so before."""
        margin_deg = self.margin_deg if is_in else 0.0
        return self.low_deg - margin_deg <= elevation_deg <= self.high_deg + margin_deg


ZONES = (
    _Zone("raised", 50.0, 90.0),
    _Zone("level", -25.0, 25.0),
    _Zone("lowered", -90.0, -50.0),
)
"""Zones with gaps of 25° between them, of which 15° belong to who is in a zone already."""

_UPRIGHT = math.sin(math.radians(50.0))
"""The part of gravity along the forearm from which on it counts as upright, either way up."""
_SOON_S = 2.0
"""Where nothing is known of how the watch is worn, an arm that is upright so long is hanging."""
_SURE_S = 15.0
"""By so much longer must the other end be below before it is taken for the hand's end.

People keep an arm up for some seconds, and let it hang for minutes.
"""
_MOST_S = 60.0


class _HandEnd:
    """Which way along the x axis of a watch the hand is: 1 or -1, 0 while it is not known.

    ``hand`` is what is expected, by the wrist on which it is worn, ``is_fixed`` whether that is
    so whatever is felt.
    """

    def __init__(self, hand: int = 0, *, is_fixed: bool = False) -> None:
        self.hand = hand
        self._is_fixed = is_fixed
        self._lead_s = 0.0  # by how much longer the end at +x was below than the other one

    def note(self, upward: float, lasting_s: float) -> None:
        """Take in that the x axis points so much upward, from -1 to 1, for some time."""
        if self._is_fixed or abs(upward) < _UPRIGHT:
            return
        self._lead_s += -math.copysign(lasting_s, upward)
        self._lead_s = min(max(self._lead_s, -_MOST_S), _MOST_S)
        below = int(math.copysign(1, self._lead_s))
        needed_s = _SURE_S if self.hand else _SOON_S
        if below != self.hand and abs(self._lead_s) >= needed_s:
            self.hand = below


class ArmPostures:
    """Follows the arm that wears one watch, sample by sample.

    ``hand`` is 1 where the x axis points to the hand as far as is known, -1 where it points to
    the elbow, 0 where nobody knows; ``is_fixed`` whether it is so whatever is felt.
    """

    def __init__(self, hand: int = 0, *, is_fixed: bool = False) -> None:
        self._end = _HandEnd(hand, is_fixed=is_fixed)
        self.elevation_deg = math.nan
        """How the forearm slants: 90 is straight up, 0 level, -90 hanging; NaN: not known."""
        self._last_s = math.nan
        self._forget()

    @property
    def hand(self) -> int:
        """Which way along the watch's x axis the hand is, 0 while it is not known."""
        return self._end.hand

    def push(self, t: Floats, acc: Floats) -> list[tuple[float, ArmPosture]]:
        """The postures that begin in n samples, each with its time in s.

        ``t`` (n,) is s on the watch's clock, ``acc`` (n, 3) is m/s² with gravity; samples that
        are no numbers are left out.
        """
        told: list[tuple[float, ArmPosture]] = []
        is_good = np.isfinite(t) & np.isfinite(acc).all(axis=1)
        for at_s, sample in zip(t[is_good].tolist(), acc[is_good], strict=True):
            step_s = at_s - self._last_s
            self._last_s = at_s
            if not 0.0 <= step_s <= LONGEST_GAP_S:  # the first one, too: NaN
                self._forget()
                self._gravity = sample.copy()
                continue
            if (posture := self._follow(sample, step_s)) is not None:
                told.append((at_s, posture))
        return told

    def _forget(self) -> None:
        self._gravity = np.zeros(3)
        self._beside = STILL_M_S2**2  # not still until it was seen to be
        self._now: _Zone | None = None
        self._next: _Zone | None = None
        self._held_s = self._out_s = 0.0
        self.elevation_deg = math.nan

    def _follow(self, sample: Floats, step_s: float) -> ArmPosture | None:
        """Take in a sample; the posture that has been held long enough now, once."""
        part = 1.0 - math.exp(-step_s / SMOOTHED_S)
        self._gravity += part * (sample - self._gravity)
        beside = sample - self._gravity
        self._beside += (1.0 - math.exp(-step_s / BESIDE_S)) * (
            float(beside @ beside) - self._beside
        )
        size = max(float(np.linalg.norm(self._gravity)), 1e-9)
        is_near = abs(size - GRAVITY_M_S2) < NEAR_GRAVITY_M_S2
        upward = float(self._gravity[0]) / size
        hand = self._end.hand
        if is_near:
            self._end.note(upward, step_s)
        if self._end.hand != hand:  # what was told before was told of the wrong end
            self._now = self._next = None
        if not self._end.hand:
            return None
        self.elevation_deg = math.degrees(math.asin(min(max(self._end.hand * upward, -1.0), 1.0)))
        is_still = is_near and self._beside < STILL_M_S2**2
        self._leave(step_s)
        return self._enter(step_s, is_still=is_still)

    def _leave(self, step_s: float) -> None:
        """The posture is over once the arm was out of its zone for long enough."""
        if self._now is None or self._now.has(self.elevation_deg, is_in=True):
            self._out_s = 0.0
            return
        self._out_s += step_s
        if self._out_s >= LEFT_S:
            self._now = None

    def _enter(self, step_s: float, *, is_still: bool) -> ArmPosture | None:
        """Another posture begins once it was held still for long enough."""
        zone = next((one for one in ZONES if one.has(self.elevation_deg, is_in=False)), None)
        if zone is None or zone is self._now or not is_still:
            self._next = None
            return None
        self._held_s = self._held_s + step_s if zone is self._next else step_s
        self._next = zone
        if self._held_s < HELD_S:
            return None
        self._now, self._next, self._out_s = zone, None, 0.0
        return zone.posture
