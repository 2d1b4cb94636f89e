"""The part of ALMotion that tells where hands, feet and head are."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.skeleton import TORSO, pose_of, turned
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.arguments import EVERYTHING
from nodes.action.naoqi.services.module import Module

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


class Places(Module):
    """Where parts of the body are, by NAOqi's names of ends and joints."""

    @method("getPosition::[f](sib)")
    def position(self, name: str, space: int, use_sensors: bool) -> list[float]:
        """Return where a part is: x, y, z m and turns about them, rad."""
        frame = self._in_space(name, space)
        x, y, z, roll, pitch, yaw = pose_of(frame[:3, :3], frame[:3, 3])
        return [x, y, z, roll, pitch, yaw]

    @method("getTransform::[f](sib)")
    def transform(self, name: str, space: int, use_sensors: bool) -> list[float]:
        """Return where a part is, as the 16 numbers of a frame, row by row."""
        return [float(number) for number in self._in_space(name, space).ravel()]

    @method("getCOM::[f](sib)")
    def centre_of_mass(self, name: str, space: int, use_sensors: bool) -> list[float]:
        """Return where the centre of mass of the whole body is, m."""
        if name not in EVERYTHING:
            raise CallFailed("Only the centre of mass of the whole Body is known here.")
        with self._robot.lock:
            centre = np.array([*self._robot.robot.stance.centre_of_mass, 1.0])
            seen = np.linalg.inv(origin_of(self._robot.robot, space)) @ centre
        return [float(number) for number in seen[:3]]

    def _in_space(self, name: str, space: int) -> Frame:
        with self._robot.lock:
            robot = self._robot.robot
            origin = origin_of(robot, space)
            seen: Frame = np.linalg.inv(origin) @ frame_in_room(robot, *end_of(robot, name))
        return seen


def end_of(robot: VirtualRobot, name: str) -> tuple[str, Point]:
    """Return the link of a part of the body, and the point of it. Raises CallFailed."""
    if name == "Torso":
        return TORSO, HERE
    joint, offset = EFFECTORS.get(name, (name, HERE))
    links = {one.name: one.child for one in robot.body.joints if one.child}
    if joint not in links:
        known = ", ".join((*EFFECTORS, "Torso"))
        raise CallFailed(f"There is no part “{name}” of the body. Possible: {known}, or a joint.")
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
        raise CallFailed(f"There is no space {space}: 0 is torso, 1 world, 2 robot.")
    if SPACES[space] == "torso":
        return frame_in_room(robot, TORSO, HERE)
    origin = np.eye(4)
    if SPACES[space] == "robot":
        x, y, theta = (float(number) for number in robot.base)
        origin[:3, :3] = turned(math.remainder(theta, 2.0 * math.pi))
        origin[:2, 3] = x, y
    return origin
