"""What everyday movements are made of: going to a pose, small shifts, oscillations, jolts."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nodes.sensory.arm.motion import Motion, Swing
from nodes.sensory.arm.skeleton import LENGTHS, Joint, Pose, joint_values

Activity = Callable[[Motion, float, np.random.Generator], float]
"""Plans something from a time on; tells until when."""

_JOLT_S = 0.05


def settle(
    motion: Motion, start_s: float, pose: Pose, rng: np.random.Generator, haste: float = 1.0
) -> float:
    """Go to about this pose, slower where it is farther; tells when it is reached."""
    goal = {
        joint: value if joint in LENGTHS else value + rng.normal(0.0, 4.0)
        for joint, value in pose.items()
    }
    now = motion.goal
    ways_rad = [
        abs(np.radians(value) - now[joint]) for joint, value in goal.items() if joint not in LENGTHS
    ]
    duration_s = (rng.uniform(0.6, 0.9) + 0.35 * max(ways_rad, default=0.0)) / haste
    motion.move(goal, start_s, duration_s)
    return start_s + duration_s


def shift(
    motion: Motion,
    start_s: float,
    pose: Pose,
    wide_deg: float,
    rng: np.random.Generator,
    lasting_s: tuple[float, float] = (0.35, 0.9),
) -> float:
    """A free movement about a pose; tells when it ends."""
    duration_s = rng.uniform(*lasting_s)
    around = {joint: value + rng.normal(0.0, wide_deg) for joint, value in pose.items()}
    motion.move(around, start_s, duration_s)
    return start_s + duration_s


def sway(
    motion: Motion,
    start_s: float,
    end_s: float,
    frequency_hz: float,
    pose: Pose,
    rng: np.random.Generator,
) -> None:
    """An oscillation; ``pose`` holds how far, in degrees (hips in m)."""
    phase = float(rng.uniform(0, 2 * np.pi))
    motion.swing(Swing(start_s, end_s, frequency_hz, phase, joint_values(pose)))


def jolt(motion: Motion, at_s: float, size_m: float) -> None:
    """A knock that goes through the arm: heels on the floor, a hand on a door, clapping hands."""
    up = float(motion.goal[Joint.UP])
    motion.move({Joint.UP: up + size_m}, at_s, _JOLT_S)
    motion.move({Joint.UP: up}, at_s + 0.6 * _JOLT_S, _JOLT_S)
