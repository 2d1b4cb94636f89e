"""Where the wrist is and how it is turned: forward kinematics of trunk, shoulder, elbow, forearm.

World axes: x forward, y left, z up. The arm is a right one; a left one is its mirror image
(see sensor.py). With every angle at 0 the person stands upright, the arm hangs, the thumb points
forward.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

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
        @ _about_x(-poses[:, Joint.ABDUCTION])
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


def _about_x(angles: Floats) -> Floats:
    return _rotations(angles, 1, 2)


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
