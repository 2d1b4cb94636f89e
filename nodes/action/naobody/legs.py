"""The joint angles that put NAO's feet where they should be: inverse kinematics of its legs."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nodes.action.naobody.body import Angles, Body

HIP_TILT = math.sqrt(0.5)
"""The axis that turns the hips is tilted by 45 degrees: this part of it is about the vertical."""

Points = NDArray[np.float64]
JOINTS = ("HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")


@dataclass(frozen=True)
class LegSizes:
    """How long the parts of a leg are, and where the left hip is in the torso's frame (m).

    The right hip is its mirror image.
    """

    thigh: float
    shin: float
    hip_left: float
    hip_up: float


def leg_sizes(body: Body) -> LegSizes:
    """Return the sizes of a body's legs."""
    _, left, up = body.origin_m("LHipYawPitch")
    return LegSizes(-body.origin_m("LKneePitch")[2], -body.origin_m("LAnklePitch")[2], left, up)


def write_legs(
    body: Body, angles: Angles, ankles: dict[str, Points], up: Points, yaw_between: Angles
) -> None:
    """Write into ``angles`` (ticks, joints) how the legs put flat feet to places.

    ``ankles``: for "L" and "R" where the ankle is in the torso's frame (ticks, 3), m; ``up``: which
    way is up there, at right angles to the soles; ``yaw_between``: how far the left foot is turned
    against the right one (ticks,), rad, which one motor does for both.
    """
    sizes = leg_sizes(body)
    hip_turn = -yaw_between / 2.0 / HIP_TILT
    for side, sign in (("L", 1.0), ("R", -1.0)):
        angles[:, body.index[f"{side}HipYawPitch"]] = hip_turn
        hip = np.array([0.0, sign * sizes.hip_left, sizes.hip_up])
        place = _into_pelvis(ankles[side] - hip, hip_turn, sign)
        upwards = _into_pelvis(np.broadcast_to(up, place.shape), hip_turn, sign)
        columns = [body.index[f"{side}{joint}"] for joint in JOINTS]
        angles[:, columns] = _leg(place, upwards, sizes)


def _leg(ankle: Points, up: Points, sizes: LegSizes) -> Angles:
    """Return JOINTS (ticks, 5) for an ankle's place and the sole's upright, as the pelvis sees."""
    roll = np.arctan2(ankle[:, 1], -ankle[:, 2])
    down = np.hypot(ankle[:, 1], ankle[:, 2])
    hip, knee = _bent_leg(ankle[:, 0], down, sizes)
    x, y, z = up[:, 0], up[:, 1], up[:, 2]
    cosine, sine = np.cos(roll), np.sin(roll)
    across, along = y * cosine + z * sine, z * cosine - y * sine
    shin = hip + knee
    ahead = x * np.cos(shin) - along * np.sin(shin)
    above = x * np.sin(shin) + along * np.cos(shin)
    ankle_roll = -np.arcsin(np.clip(across, -1.0, 1.0))
    return np.column_stack([roll, hip, knee, np.arctan2(ahead, above), ankle_roll])


def _bent_leg(forward: Angles, down: Angles, sizes: LegSizes) -> tuple[Angles, Angles]:
    """Return hip and knee pitch that put the ankle so far in front of the hip and below it (m)."""
    thigh, shin = sizes.thigh, sizes.shin
    reach = np.minimum(np.hypot(forward, down), thigh + shin)
    cosine = (reach**2 - thigh**2 - shin**2) / (2.0 * thigh * shin)
    knee = np.arccos(np.clip(cosine, -1.0, 1.0))
    ahead_of_shin = np.arctan2(shin * np.sin(knee), thigh + shin * np.cos(knee))
    return -np.arctan2(forward, down) - ahead_of_shin, knee


def _into_pelvis(vectors: Points, turn: Angles, sign: float) -> Points:
    """Return vectors (ticks, 3) of the torso as a pelvis sees them that its motor has turned."""
    axis = np.array([0.0, HIP_TILT, -sign * HIP_TILT])
    cosine, sine = np.cos(turn)[:, None], np.sin(turn)[:, None]
    along = (vectors @ axis)[:, None] * axis
    # Rodrigues' formula, backwards
    turned: Points = cosine * vectors - sine * np.cross(axis, vectors) + (1.0 - cosine) * along
    return turned
