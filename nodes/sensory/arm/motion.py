"""How poses follow each other: minimum-jerk strokes and swings, added up.

Strokes that overlap are added, as in people (Flash and Henis 1991), so that a new movement may
begin before the old one has ended: position, speed and acceleration stay continuous.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nodes.sensory.arm.skeleton import LENGTHS, Floats, Joint, Pose

_SWING_RAMP_S = 0.5


@dataclass(frozen=True)
class Stroke:
    """A change of pose (11,) from ``start_s`` on, over ``duration_s``."""

    start_s: float
    duration_s: float
    change: Floats


@dataclass(frozen=True)
class Swing:
    """An oscillation of the pose with an amplitude (11,), which grows and fades smoothly."""

    start_s: float
    end_s: float
    frequency_hz: float
    phase: float
    amplitude: Floats

    def at(self, t: Floats) -> Floats:
        """The pose's deviation (n, 11) at n times."""
        fade = minimum_jerk((t - self.start_s) / _SWING_RAMP_S)
        fade = fade * minimum_jerk((self.end_s - t) / _SWING_RAMP_S)
        wave = fade * np.sin(2 * np.pi * self.frequency_hz * t + self.phase)
        return wave[:, None] * self.amplitude


class Motion:
    """All poses of one person over time; strokes are planned ahead of the times asked for."""

    def __init__(self, pose: Floats) -> None:
        self._settled = pose.copy()
        self._strokes: list[Stroke] = []
        self._swings: list[Swing] = []

    @property
    def goal(self) -> Floats:
        """The pose (11,) that is reached when every planned stroke has ended."""
        return self._settled + sum((s.change for s in self._strokes), np.zeros(len(Joint)))

    def move(self, pose: Pose, start_s: float, duration_s: float) -> None:
        """Bring the joints that ``pose`` names there; the others stay as they are planned."""
        goal, change = self.goal, np.zeros(len(Joint))
        for joint, value in pose.items():
            change[joint] = (value if joint in LENGTHS else np.radians(value)) - goal[joint]
        self._strokes.append(Stroke(start_s, duration_s, change))

    def swing(self, swing: Swing) -> None:
        """Add an oscillation."""
        self._swings.append(swing)

    def give_up_plans(self, now_s: float) -> None:
        """Begin no planned stroke after now, and let the oscillations that would end, end now."""
        self._strokes = [stroke for stroke in self._strokes if stroke.start_s < now_s]
        last_s = now_s + _SWING_RAMP_S
        self._swings = [
            replace(swing, end_s=min(swing.end_s, last_s)) if np.isfinite(swing.end_s) else swing
            for swing in self._swings
            if swing.start_s < now_s or np.isinf(swing.end_s)
        ]

    def poses(self, t: Floats) -> Floats:
        """The poses (n, 11) at n times."""
        poses = np.tile(self._settled, (len(t), 1))
        for stroke in self._strokes:
            poses += minimum_jerk((t - stroke.start_s) / stroke.duration_s)[:, None] * stroke.change
        for swing in self._swings:
            poses += swing.at(t)
        return poses

    def forget_before(self, t_s: float) -> None:
        """Settle what has ended by ``t_s``; no earlier time may be asked for again."""
        for stroke in self._strokes:
            if stroke.start_s + stroke.duration_s <= t_s:
                self._settled += stroke.change
        self._strokes = [s for s in self._strokes if s.start_s + s.duration_s > t_s]
        self._swings = [swing for swing in self._swings if swing.end_s > t_s]


def minimum_jerk(part: Floats) -> Floats:
    """From 0 to 1 as people move: no speed and no acceleration at either end (Hogan 1984)."""
    part = np.clip(part, 0.0, 1.0)
    smooth: Floats = part**3 * (10 - 15 * part + 6 * part**2)
    return smooth
