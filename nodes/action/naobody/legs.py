"""The joint angles that put NAO's feet where they should be: inverse kinematics of its legs."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from nodes.action.naobody.body import Angles, Body

THIGH_M = 0.1
SHIN_M = 0.1029
HIP_LEFT_M, HIP_UP_M = 0.05, -0.085
"""Where the left hip is in the torso's frame; the right one is its mirror image."""
HIP_TILT = math.sqrt(0.5)
"""The axis that turns the hips is tilted by 45 degrees: this part of it is about the vertical."""

Points = NDArray[np.float64]
JOINTS = ("HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")


def write_legs(
    body: Body, angles: Angles, ankles: dict[str, Points], up: Points, yaw_between: Angles
) -> None:
    """Write into ``angles`` (ticks, joints) how the legs put flat feet to places.

    ``ankles``: for "L" and "R" where the ankle is in the torso's frame (ticks, 3), m; ``up``: which
    way is up there, at right angles to the soles; ``yaw_between``: how far the left foot is turned
    against the right one (ticks,), rad, which one motor does for both.
    """
    hip_turn = -yaw_between / 2.0 / HIP_TILT
    for side, sign in (("L", 1.0), ("R", -1.0)):
        angles[:, body.index[f"{side}HipYawPitch"]] = hip_turn
        hip = np.array([0.0, sign * HIP_LEFT_M, HIP_UP_M])
        place = _into_pelvis(ankles[side] - hip, hip_turn, sign)
        upwards = _into_pelvis(np.broadcast_to(up, place.shape), hip_turn, sign)
        columns = [body.index[f"{side}{joint}"] for joint in JOINTS]
        angles[:, columns] = _leg(place, upwards)


def _leg(ankle: Points, up: Points) -> Angles:
    """Return JOINTS (ticks, 5) for an ankle's place and the sole's upright, as the pelvis sees."""
    roll = np.arctan2(ankle[:, 1], -ankle[:, 2])
    down = np.hypot(ankle[:, 1], ankle[:, 2])
    hip, knee = _bent_leg(ankle[:, 0], down)
    x, y, z = up[:, 0], up[:, 1], up[:, 2]
    cosine, sine = np.cos(roll), np.sin(roll)
    across, along = y * cosine + z * sine, z * cosine - y * sine
    shin = hip + knee
    ahead = x * np.cos(shin) - along * np.sin(shin)
    above = x * np.sin(shin) + along * np.cos(shin)
    ankle_roll = -np.arcsin(np.clip(across, -1.0, 1.0))
    return np.column_stack([roll, hip, knee, np.arctan2(ahead, above), ankle_roll])


def _bent_leg(forward: Angles, down: Angles) -> tuple[Angles, Angles]:
    """Return hip and knee pitch that put the ankle so far in front of the hip and below it (m)."""
    reach = np.minimum(np.hypot(forward, down), THIGH_M + SHIN_M)
    cosine = (reach**2 - THIGH_M**2 - SHIN_M**2) / (2.0 * THIGH_M * SHIN_M)
    knee = np.arccos(np.clip(cosine, -1.0, 1.0))
    ahead_of_shin = np.arctan2(SHIN_M * np.sin(knee), THIGH_M + SHIN_M * np.cos(knee))
    return -np.arctan2(forward, down) - ahead_of_shin, knee


def _into_pelvis(vectors: Points, turn: Angles, sign: float) -> Points:
    """Return vectors (ticks, 3) of the torso as a pelvis sees them that its motor has turned."""
    axis = np.array([0.0, HIP_TILT, -sign * HIP_TILT])
    cosine, sine = np.cos(turn)[:, None], np.sin(turn)[:, None]
    along = (vectors @ axis)[:, None] * axis
    # Rodrigues' formula, backwards
    turned: Points = cosine * vectors - sine * np.cross(axis, vectors) + (1.0 - cosine) * along
    return turned
