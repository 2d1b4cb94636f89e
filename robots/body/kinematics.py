"""Where a robot's parts are: forward kinematics in numpy, and inverse kinematics of NAO's legs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from .body import Angles, Body, Link, Vector
from .settling import tilt_for, tipped

Frames = NDArray[np.float64]
"""Homogeneous transforms (..., 4, 4) from a link's frame to the torso's."""
Points = NDArray[np.float64]
"""Places (..., 3), m."""
TorsoPose = tuple[float, float, float, float, float, float]
"""x, y, z m and roll, pitch, yaw rad over the floor, as RobotState.torso has it."""

TORSO = "torso"
UPRIGHT: Vector = (0.0, 0.0, -1.0)


class Skeleton:
    """The links of a body, by name: the torso and what each joint turns.

    Angles are in the body's joint order, one pose (joints,) or many (ticks, joints).
    """

    def __init__(self, body: Body) -> None:
        self.body = body
        turning = [(i, joint) for i, joint in enumerate(body.joints) if joint.child]
        self.links: tuple[str, ...] = (TORSO, *(joint.child for _, joint in turning))
        self.index = {link: i for i, link in enumerate(self.links)}
        self._columns = np.array([i for i, _ in turning], dtype=int)
        # How each link is placed at rest, and the cross product with the axis that turns it.
        count = len(turning)
        self._place, cross = np.tile(np.eye(4), (count, 1, 1)), np.zeros((count, 4, 4))
        for i, (_, joint) in enumerate(turning):
            self._place[i, :3, :3] = rotation(*joint.turn_rad)
            self._place[i, :3, 3] = joint.origin_m
            x, y, z = np.array(joint.axis) / np.linalg.norm(joint.axis)
            cross[i, :3, :3] = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
        self._cross = self._place @ cross
        self._square = self._cross @ cross
        # Links and their parents, grouped by how many joints lie between them and the torso
        parents = [self.index[joint.parent] for _, joint in turning]
        depth = {0: 0}
        while len(depth) <= len(parents):
            for link, parent in enumerate(parents, start=1):
                if parent in depth:
                    depth[link] = depth[parent] + 1
        deepest = max(depth.values())
        levels = []
        for level in range(1, deepest + 1):
            links = [link for link in depth if depth[link] == level]
            levels.append((np.array(links), np.array([parents[link - 1] for link in links])))
        self._levels = levels
        self._load_shape()

    def _load_shape(self) -> None:
        links = [self.body.links.get(name, Link()) for name in self.links]
        masses = np.array([link.mass_kg for link in links])
        self.mass_kg = float(masses.sum())
        self.masses_kg = masses
        self._mass_part = masses / self.mass_kg if self.mass_kg else masses
        self._centres = np.array([[*link.centre_m, 1.0] for link in links])
        outlines = [
            [*(np.array(at) + radius * way for *at, radius in link.hull_m for way in _CORNERS)]
            + [np.array(point) for point in link.sole_m]
            for link in links
        ]
        points = [point for outline in outlines for point in outline]
        self._points = np.array([[*point, 1.0] for point in points]).reshape(-1, 4)
        self.point_links = np.repeat(np.arange(len(links)), [len(one) for one in outlines])
        self.soles: dict[str, Points] = {
            name: np.array(link.sole_m)
            for name, link in zip(self.links, links, strict=True)
            if link.sole_m
        }

    def transforms(self, angles: Angles) -> Frames:
        """Return the frame of every link in the torso's: (..., links, 4, 4)."""
        turn = np.asarray(angles, dtype=np.float64)[..., self._columns, None, None]
        # Rodrigues' formula, for all joints at once
        local = self._place + np.sin(turn) * self._cross + (1.0 - np.cos(turn)) * self._square
        frames = np.empty((*local.shape[:-3], len(self.links), 4, 4))
        frames[..., 0, :, :] = np.eye(4)
        for children, parents in self._levels:
            frames[..., children, :, :] = (
                frames[..., parents, :, :] @ local[..., children - 1, :, :]
            )
        return frames

    def frames(self, angles: Angles) -> dict[str, Frames]:
        """Return the frame of every link in the torso's, by the name of the link."""
        frames = self.transforms(angles)
        return {name: frames[..., i, :, :] for i, name in enumerate(self.links)}

    def centre_of_mass(self, angles: Angles) -> Points:
        """Return the centre of mass in the torso's frame (m)."""
        return self.mass_centre(self.transforms(angles))

    def mass_centre(self, frames: Frames) -> Points:
        """Return the centre of mass of links that are where ``transforms`` says."""
        rows = frames[..., :3, :]
        centre: Points = np.einsum("...nij,nj,n->...i", rows, self._centres, self._mass_part)
        return centre

    def mass_centres(self, frames: Frames) -> Points:
        """Return where the mass of each link is in the torso's frame: (..., links, 3)."""
        centres: Points = (frames[..., :3, :] @ self._centres[:, :, None])[..., 0]
        return centres

    def outline(self, frames: Frames) -> Points:
        """Return the body's outermost points in the torso's frame: (..., points, 3)."""
        parts = frames.take(self.point_links, axis=-3)[..., :3, :]
        outline: Points = np.einsum("...nij,nj->...ni", parts, self._points)
        return outline

    def sole(self, frames: Frames, link: str) -> Points:
        """Return the outline of a foot's sole in the torso's frame."""
        frame = frames[..., self.index[link], :, :]
        points = self.soles[link] @ np.swapaxes(frame[..., :3, :3], -1, -2)
        return points + frame[..., None, :3, 3]

    def resting_turn(self, angles: Angles, down: Vector = UPRIGHT) -> Frames:
        """Return how the torso is turned (3, 3) when the body lies or stands still on a floor.

        ``down``: about which way is down, in the torso's frame.
        """
        frames = self.transforms(angles)
        if not len(self._points):
            return tilt_for(np.array(down))
        points = self.outline(frames) - self.mass_centre(frames)
        return tipped(points, tilt_for(np.array(down)), math.inf)[0]  # until it is steady

    def torso_over_floor(
        self, angles: Angles, base: Vector = (0.0, 0.0, 0.0), down: Vector = UPRIGHT
    ) -> TorsoPose:
        """Return where the torso is when the body has come to rest on the floor.

        ``base``: x m, y m, theta rad of the feet on the floor, or of the torso for one that lies.
        ``down``: about which way is down, in the torso's frame; body.postures[...].down.
        """
        frames = self.transforms(angles)
        turn = turned(base[2]) @ self.resting_turn(angles, down)
        lowest = float((self.outline(frames) @ turn[2]).min(initial=0.0))
        middle = turn @ self.feet_middle(frames) if down == UPRIGHT else np.zeros(3)
        x, y = base[0] - middle[0], base[1] - middle[1]
        return pose_of(turn, np.array([x, y, -lowest]))

    def feet_middle(self, frames: Frames) -> Points:
        """Return the place in the middle between the feet (m, torso's frame)."""
        if not self.soles:
            return np.zeros(3)
        ankles = frames[..., [self.index[link] for link in self.soles], :3, 3]
        middle: Points = ankles.mean(axis=-2)
        return middle


def pose_of(turn: Frames, place: Points) -> TorsoPose:
    """Return x, y, z and roll, pitch, yaw (turned about z, then y, then x)."""
    pitch = math.asin(min(max(-float(turn[2, 0]), -1.0), 1.0))
    roll = math.atan2(turn[2, 1], turn[2, 2])
    yaw = math.atan2(turn[1, 0], turn[0, 0])
    x, y, z = (float(value) for value in place)
    return x, y, z, roll, pitch, yaw


def turned(yaw: float) -> Frames:
    """Return the rotation (3, 3) about the vertical."""
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def rotation(roll: float, pitch: float, yaw: float) -> Frames:
    """Return the rotation (3, 3) of roll, pitch, yaw (turned about z, then y, then x)."""
    a, b = math.cos(pitch), math.sin(pitch)
    c, d = math.cos(roll), math.sin(roll)
    about_y = np.array([[a, 0.0, b], [0.0, 1.0, 0.0], [-b, 0.0, a]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, c, -d], [0.0, d, c]])
    whole: Frames = turned(yaw) @ about_y @ about_x
    return whole


_CORNERS = np.vstack(
    [np.eye(3), -np.eye(3), np.array(list(product((-1.0, 1.0), repeat=3))) / math.sqrt(3.0)]
)
"""Directions in which a round shape is taken to reach out."""


# The joint angles that put NAO's feet where they should be: inverse kinematics of its legs.

HIP_TILT = math.sqrt(0.5)
"""The axis that turns the hips is tilted by 45 degrees: this part of it is about the vertical."""

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

    ``body`` is whose legs they are.
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
