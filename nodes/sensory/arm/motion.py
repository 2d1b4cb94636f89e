"""How poses follow each other: minimum-jerk strokes and swings, added up.

Strokes that overlap are added, as in people (Flash and Henis 1991), so that a new movement may
begin before the old one has ended: position, speed and acceleration stay continuous.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

# Where the wrist is and how it is turned: forward kinematics of trunk, shoulder, elbow, forearm.
#
# World axes: x forward, y left, z up. The arm is a right one; a left one is its mirror image
# (see sensor.py). With every angle at 0 the person stands upright, the arm hangs, the thumb points
# forward.

Floats = NDArray[np.float64]


class Joint(IntEnum):
    """What a pose is made of: its place in an array of 11 numbers (m for the first three, rad)."""

    FORWARD = 0  # of the hips
    LEFT = 1
    UP = 2
    HEADING = 3  # where the feet point, positive to the left
    TWIST = 4  # of the trunk on the feet, positive to the left
    LEAN = 5  # of the trunk, forward
    FLEXION = 6  # upper arm forward and up; pi is overhead
    ABDUCTION = 7  # upper arm outward
    ROTATION = 8  # upper arm on its own axis, positive turns the bent forearm inward
    ELBOW = 9  # 0 is straight
    PRONATION = 10  # forearm on its own axis, positive turns the palm down or back


LENGTHS = frozenset({Joint.FORWARD, Joint.LEFT, Joint.UP})
Pose = Mapping[Joint, float]
"""Some joints and where they are, in degrees (hips in m): the form in which poses are written."""


@dataclass(frozen=True)
class Body:
    """The lengths of a person, in m; the watch sits ``watch_to_wrist_m`` above the wrist joint."""

    shoulder_height_m: float = 0.48  # above the hips
    shoulder_width_m: float = 0.18  # from the spine
    upper_arm_m: float = 0.30
    forearm_m: float = 0.25
    watch_to_wrist_m: float = 0.03


def joint_values(pose: Pose) -> Floats:
    """A written pose as an array (11,) in rad and m; joints that it does not name are 0."""
    values = np.zeros(len(Joint))
    for joint, value in pose.items():
        values[joint] = value if joint in LENGTHS else np.radians(value)
    return values


def watch_frames(poses: Floats, body: Body) -> tuple[Floats, Floats]:
    """Positions (n, 3) in m and rotations (n, 3, 3) of a watch on the right wrist.

    ``poses`` is (n, 11). A rotation's columns are the watch's axes in the world, as Android has
    them: x to the right of the screen (on the right wrist: to the elbow), y to its top (to the
    little finger), z out of the screen (out of the back of the hand).
    """
    trunk = _about_z(poses[:, Joint.HEADING] + poses[:, Joint.TWIST]) @ _about_y(
        poses[:, Joint.LEAN]
    )
    upper_arm = (
        trunk
        @ _about_y(-poses[:, Joint.FLEXION])
        @ _rotations(-poses[:, Joint.ABDUCTION], 1, 2)
        @ _about_z(poses[:, Joint.ROTATION])
    )
    forearm = upper_arm @ _about_y(-poses[:, Joint.ELBOW]) @ _about_z(poses[:, Joint.PRONATION])
    positions = (
        poses[:, :3]
        + trunk @ np.array([0.0, -body.shoulder_width_m, body.shoulder_height_m])
        + upper_arm @ np.array([0.0, 0.0, -body.upper_arm_m])
        + forearm @ np.array([0.0, -_SKIN_TO_BONE_M, body.watch_to_wrist_m - body.forearm_m])
    )
    return positions, forearm @ _WATCH_ON_FOREARM


_SKIN_TO_BONE_M = 0.03
_WATCH_ON_FOREARM = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]])


def _about_y(angles: Floats) -> Floats:
    return _rotations(angles, 2, 0)


def _about_z(angles: Floats) -> Floats:
    return _rotations(angles, 0, 1)


def _rotations(angles: Floats, from_axis: int, to_axis: int) -> Floats:
    """Rotation matrices (n, 3, 3) that turn one axis towards another."""
    rotations = np.tile(np.eye(3), (len(angles), 1, 1))
    cos, sin = np.cos(angles), np.sin(angles)
    rotations[:, from_axis, from_axis] = rotations[:, to_axis, to_axis] = cos
    rotations[:, to_axis, from_axis] = sin
    rotations[:, from_axis, to_axis] = -sin
    return rotations


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
    return part**3 * (10 - 15 * part + 6 * part**2)


# What an accelerometer and a gyroscope feel on a moving wrist.

GRAVITY_M_S2 = 9.81
_STEP_S = 1e-3  # between the poses that are compared; errors of the method are below 1e-3 m/s²
_LEFT_ACC = np.array([-1.0, 1.0, 1.0])  # of a mirrored arm: a watch's x points to the hand there,
_LEFT_GYR = np.array([1.0, -1.0, -1.0])  # and turning directions change with the mirror


@dataclass(frozen=True)
class Sensor:
    """How a watch sits on a wrist, and its errors.

    ``turned`` (3, 3) is the watch's attitude on the wrist; ``scale`` (3,) is what each axis of the
    accelerometer makes of 1 m/s²; biases (3,) and noise (standard deviations) in m/s² and rad/s.
    """

    turned: Floats
    scale: Floats
    acc_bias: Floats
    gyr_bias: Floats
    acc_noise: float
    gyr_noise: float
    left_wrist: bool

    def feel(
        self, motion: Motion, body: Body, t: Floats, rng: np.random.Generator
    ) -> tuple[Floats, Floats]:
        """Acceleration (n, 3) with gravity and rotation rate (n, 3), with the sensor's errors.

        ``motion`` is what the arm of ``body`` does, ``t`` (n,) the times in s, ``rng`` the
        chance.
        """
        acc, gyr = felt_exactly(motion, body, t)
        if self.left_wrist:
            acc, gyr = acc * _LEFT_ACC, gyr * _LEFT_GYR
        acc, gyr = acc @ self.turned, gyr @ self.turned
        acc *= self.scale
        acc += self.acc_bias + rng.normal(0.0, self.acc_noise, acc.shape)
        gyr += self.gyr_bias + rng.normal(0.0, self.gyr_noise, gyr.shape)
        return acc, gyr


def felt_exactly(motion: Motion, body: Body, t: Floats) -> tuple[Floats, Floats]:
    """What a perfect sensor feels on the right wrist at n times: (n, 3) m/s², (n, 3) rad/s.

    At rest the acceleration is 9.81 m/s² upward (Android's sign). The poses are smooth functions
    of time, so that differences over a short step have no noise to amplify.
    """
    stencil = (t[:, None] + np.array([-_STEP_S, 0.0, _STEP_S])).ravel()
    positions, rotations = watch_frames(motion.poses(stencil), body)
    positions = positions.reshape(-1, 3, 3)
    before, now, after = rotations.reshape(-1, 3, 3, 3).transpose(1, 0, 2, 3)
    moving = (positions[:, 0] - 2 * positions[:, 1] + positions[:, 2]) / _STEP_S**2
    force = moving + np.array([0.0, 0.0, GRAVITY_M_S2])
    acc = np.einsum("nij,ni->nj", now, force)
    turn = np.einsum("nij,nik->njk", before, after)
    # Axis times angle (n, 3) of small rotations (n, 3, 3), below a quarter turn
    twice_sine = np.stack(
        [
            turn[:, 2, 1] - turn[:, 1, 2],
            turn[:, 0, 2] - turn[:, 2, 0],
            turn[:, 1, 0] - turn[:, 0, 1],
        ],
        axis=1,
    )
    sine = np.linalg.norm(twice_sine, axis=1, keepdims=True) / 2
    angle_by_sine = np.ones_like(sine)
    np.divide(np.arcsin(np.minimum(sine, 1.0)), sine, out=angle_by_sine, where=sine > 1e-12)
    vectors: Floats = twice_sine / 2 * angle_by_sine
    return acc, vectors / (2 * _STEP_S)
