"""Where the ends of a robot's body are, and which angles bring them to places.

NAOqi names the ends, the joints and the spaces; the angles come from inverse kinematics.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.body.body import Angles
from robots.body.inverse import Goal, Reach
from robots.body.kinematics import TORSO, pose_of, rotation, turned
from robots.body.pose import VirtualRobot
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed

from .arguments import EVERYTHING, number, one_of, rows, within

Frame = NDArray[np.float64]
Point = tuple[float, float, float]
SPACES = ("torso", "world", "robot")
"""By NAOqi's numbers."""
HAND, SOLE, HERE = (0.05775, 0.0, -0.01231), (0.0, 0.0, -0.04519), (0.0, 0.0, 0.0)
EFFECTORS = {
    "Head": ("HeadPitch", HERE),
    "LArm": ("LWristYaw", HAND),
    "RArm": ("RWristYaw", HAND),
    "LLeg": ("LAnkleRoll", SOLE),
    "RLeg": ("RAnkleRoll", SOLE),
}
"""The joint before each end of the body, and where the end is from there, m."""

REACHING = ("Head", "LArm", "RArm")
"""The ends that can be sent to places; the legs have to carry the body."""
TURN, ALL = 56, 63
"""Masks by NAOqi's numbers: bits for x, y, z and the turns about them."""


class Ends:
    """The ends of one robot's body: x, y, z m and turns about them rad, in a space."""

    def __init__(self, robot: ServedRobot) -> None:
        self._robot = robot
        self._reach = Reach(robot.robot.stance.skeleton)

    def frame(self, name: str, space: int) -> Frame:
        """Return the frame of a part of the body, seen in a space. Raises CallFailed."""
        with self._robot.lock:
            robot = self._robot.robot
            origin = origin_of(robot, space)
            seen: Frame = np.linalg.inv(origin) @ frame_in_room(robot, *end_of(robot, name))
        return seen

    def centre_of_mass(self, name: str, space: int) -> list[float]:
        """Return where the centre of mass of the whole body is, m. Raises CallFailed."""
        if name not in EVERYTHING:
            raise CallFailed("Only the centre of mass of the whole Body is known here.")
        with self._robot.lock:
            centre = np.array([*self._robot.robot.stance.centre_of_mass, 1.0])
            seen = np.linalg.inv(origin_of(self._robot.robot, space)) @ centre
        return [float(number) for number in seen[:3]]

    def keys(
        self,
        name: str,
        space: int,
        places: list[list[float]],
        mask: int,
        *,
        is_absolute: bool = True,
    ) -> dict[str, list[float]]:
        """Return the angles (rad) of the joints of an end at each place, by joint.

        ``name`` is the end, ``space`` from where ``places`` are seen: x, y, z m and turns rad, from
        where it is unless ``is_absolute``; ``mask`` says by NAOqi's bits which of these count.
        """
        one_of(name, REACHING, "“{name}” cannot be sent to a place. Possible: {reaching}.")
        within(mask, 1, ALL, "The mask")
        with self._robot.lock:
            body, angles = self._robot.robot.body, self._robot.robot.angles.copy()
            start = np.zeros(6) if is_absolute else self._pose(name, space, angles)
            columns = self._reach.columns(end_of(self._robot.robot, name)[0])
            keys: dict[str, list[float]] = {body.names[column]: [] for column in columns}
            for place in places:
                goal = self._goal(name, space, np.array(place) + start, mask, angles)
                angles = self._reach.reached(angles, goal)
                for column in columns:
                    keys[body.names[column]].append(float(angles[column]))
        return keys

    def _goal(self, name: str, space: int, place: Angles, mask: int, angles: Angles) -> Goal:
        """Return where an end is to come; what the mask leaves out stays as it is."""
        robot = self._robot.robot
        link, point = end_of(robot, name)
        wanted = [bool(mask >> bit & 1) for bit in range(6)]
        pose = np.where(wanted, place, self._pose(name, space, angles))
        torso = frame_in_room(robot, TORSO, HERE)
        seen = np.linalg.inv(torso) @ origin_of(robot, space)
        turn = seen[:3, :3] @ rotation(*pose[3:].tolist()) if mask & TURN else None
        return Goal(link, point, seen[:3, :3] @ pose[:3] + seen[:3, 3], turn)

    def _pose(self, name: str, space: int, angles: Angles) -> Angles:
        """Return where an end would be with some angles: x, y, z and turns, in a space."""
        robot = self._robot.robot
        link, point = end_of(robot, name)
        frame = robot.stance.skeleton.frames(angles)[link].copy()
        frame[:3, 3] += frame[:3, :3] @ np.array(point)
        torso = frame_in_room(robot, TORSO, HERE)
        seen = np.linalg.inv(origin_of(robot, space)) @ torso @ frame
        return np.array(pose_of(seen[:3, :3], seen[:3, 3]))


def end_of(robot: VirtualRobot, name: str) -> tuple[str, Point]:
    """Return the link of a part of the body, and the point of it. Raises CallFailed."""
    if name == "Torso":
        return TORSO, HERE
    joint, offset = EFFECTORS.get(name, (name, HERE))
    links = {one.name: one.child for one in robot.body.joints if one.child}
    if joint not in links:
        known = ", ".join((*EFFECTORS, "Torso"))
        raise CallFailed(
            "There is no part “{name}” of the body. Possible: {known}, or a joint.",
            name=name,
            known=known,
        )
    return links[joint], offset


def frame_in_room(robot: VirtualRobot, link: str, offset: Point) -> Frame:
    """Return the frame at a point of a link, in the room."""
    frame = np.eye(4)
    frame[:3, :3] = robot.stance.link_turn(link)
    frame[:3, 3] = robot.stance.link_place(link, offset)
    return frame


def origin_of(robot: VirtualRobot, space: int) -> Frame:
    """Return the frame in the room from which places are told."""
    if not 0 <= space < len(SPACES):
        raise CallFailed("There is no space {space}: 0 is torso, 1 world, 2 robot.", space=space)
    if SPACES[space] == "torso":
        return frame_in_room(robot, TORSO, HERE)
    origin = np.eye(4)
    if SPACES[space] == "robot":
        x, y, theta = (float(number) for number in robot.base)
        origin[:3, :3] = turned(math.remainder(theta, 2.0 * math.pi))
        origin[:2, 3] = x, y
    return origin


def six_numbers(place: Any) -> list[float]:
    """Return a place as NAOqi tells it: x, y, z and turns. Raises CallFailed."""
    found = [number(one) for one in rows(place, "A place")]
    if len(found) != 6:
        raise CallFailed("A place is six numbers: x, y, z m and turns about them rad.")
    return found
