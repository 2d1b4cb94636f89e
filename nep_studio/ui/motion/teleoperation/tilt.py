"""A watch that is tilted drives a robot: forward and back to walk, to the sides to turn."""

from __future__ import annotations

import math
from collections.abc import Sequence

from nep_core.messages import Imu
from nep_studio.ui.motion.teleoperation.drive import STILL, Drive

SMOOTHING_S = 0.15
SETTLING_S = 0.6
"""So long the watch is held still at first: that is the middle from then on."""
DEAD_RAD = math.radians(12)
FULL_RAD = math.radians(45)
SILENT_S = 0.5
"""A watch that says nothing for so long is gone."""

Vector = Sequence[float]


class Tilt:
    """How far a watch is tilted from how it was held first."""

    def __init__(self) -> None:
        self.forward_rad = 0.0
        self.aside_rad = 0.0
        self._gravity: list[float] = []
        self._middle: tuple[float, float] | None = None
        self._heard_s = 0.0

    @property
    def is_settled(self) -> bool:
        """Whether it is known how it is held."""
        return self._middle is not None

    def hear(self, imu: Imu) -> None:
        """Take in a batch of samples."""
        step_s = 1.0 / max(imu.rate_hz, 1.0)
        part = step_s / (SMOOTHING_S + step_s)
        for sample in imu.acc:
            if not self._gravity:
                self._gravity = list(sample)
            else:
                self._gravity = [
                    old + part * (new - old) for old, new in zip(self._gravity, sample, strict=True)
                ]
        self._heard_s += step_s * len(imu.acc)
        if self._gravity:
            self._follow()

    def drive(self) -> Drive:
        """What the tilt asks for."""
        forward, aside = _share(self.forward_rad), _share(self.aside_rad)
        return Drive(forward=forward, turn=-aside) if forward or aside else STILL

    def arm(self) -> dict[str, float]:
        """The angles of the right shoulder that follow the tilt, rad."""
        return {
            "RShoulderPitch": min(max(1.4 - 1.6 * self.forward_rad, -2.0), 2.0),
            "RShoulderRoll": min(max(-0.15 - 1.2 * self.aside_rad, -1.3), 0.3),
        }

    def _follow(self) -> None:
        x, y, z = self._gravity
        forward, aside = math.atan2(y, math.hypot(x, z)), math.atan2(x, math.hypot(y, z))
        if self._middle is None:
            if self._heard_s >= SETTLING_S:
                self._middle = forward, aside
            return
        self.forward_rad = forward - self._middle[0]
        self.aside_rad = aside - self._middle[1]


def _share(angle: float) -> float:
    """A part of full speed for a tilt; a little tilt is none."""
    beyond = max(0.0, abs(angle) - DEAD_RAD) / (FULL_RAD - DEAD_RAD)
    return math.copysign(min(1.0, beyond), angle) if beyond else 0.0
