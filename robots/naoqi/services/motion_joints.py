"""The part of ALMotion that moves joints, and lets their motors hold or not."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.body.actions import Approach
from robots.body.body import Angles
from robots.body.inverse import Goal, Reach
from robots.body.keyframes import SHORTEST_STEP_S
from robots.body.kinematics import TORSO, pose_of, rotation, turned
from robots.body.motor_tasks import stiffness
from robots.body.pose import VirtualRobot
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import EVERYTHING, joints_of, lists, number, numbers, rows, texts, within
from .module import Module

SLOWEST = 0.01
"""A fraction of the top speed below this is taken as this: 0 would never arrive."""
SIDES = {"LHand": "left", "RHand": "right"}


class JointControl(Module):
    """Angles and stiffness."""

    @method("angleInterpolation::v(mmmb)")
    def angle_interpolation(
        self, names: Any, angle_lists: Any, time_lists: Any, is_absolute: bool
    ) -> Any:
        """Move joints through angles (rad) at times (s); wait until they are there."""
        joints = joints_of(self._robot.robot.body, names)
        angles = lists(angle_lists, len(joints), "lists of angles")
        times = lists(time_lists, len(joints), "lists of times")
        tracks = {
            joint: {"times": rising(joint, at, keys), "keys": keys}
            for joint, keys, at in zip(joints, angles, times, strict=True)
        }
        return self._do("move_through", tracks=tracks, relative=not is_absolute)

    @method("angleInterpolationBezier::v([s]mm)")
    def angle_interpolation_bezier(self, names: list[str], times: Any, control_points: Any) -> Any:
        """Move joints through keys with Bezier handles; wait until they are there."""
        joints = joints_of(self._robot.robot.body, names)
        all_times, all_points = rows(times, "The times"), rows(control_points, "The keys")
        if len(all_times) != len(joints) or len(all_points) != len(joints):
            raise CallFailed(
                "{count} joints need as many lists of times and of keys.", count=len(joints)
            )
        tracks = {}
        for joint, at, of_joint in zip(joints, all_times, all_points, strict=True):
            points = rows(of_joint, "The keys of a joint")
            keys = [_key(point) for point in points]
            tracks[joint] = {
                "times": rising(joint, [number(time) for time in rows(at, "The times")], keys),
                "keys": keys,
                "handles": [(*_handle(point, 1), *_handle(point, 2)) for point in points],
            }
        return self._do("move_through", tracks=tracks)

    @method("angleInterpolationWithSpeed::v(mmf)")
    def angle_interpolation_withspeed_of(self, names: Any, angles: Any, fraction: float) -> Any:
        """Move joints to angles at a part of their top speed; wait until they are there."""
        joints = joints_of(self._robot.robot.body, names)
        goals = dict(zip(joints, numbers(angles, len(joints), "angles"), strict=True))
        return self._do("reach_angles", angles=goals, speed=speed_of(fraction))

    @method("setAngles::v(mmf)")
    def set_angles(self, names: Any, angles: Any, fraction: float) -> None:
        """Let joints go to angles at a part of their top speed; nobody waits."""
        joints = joints_of(self._robot.robot.body, names)
        goals = dict(zip(joints, numbers(angles, len(joints), "angles"), strict=True))
        self._set("set_angles", angles=goals, speed=speed_of(fraction))

    @method("setAngles::v(mm[f])")
    def set_angles_each(self, names: Any, angles: Any, fractions: list[float]) -> None:
        """Let joints go to angles, each at a part of its top speed."""
        joints = joints_of(self._robot.robot.body, names)
        goals = numbers(angles, len(joints), "angles")
        speeds = numbers(fractions, len(joints), "fractions of the top speed")
        for joint, angle, fraction in zip(joints, goals, speeds, strict=True):
            self._set("set_angles", angles={joint: angle}, speed=speed_of(fraction))

    @method("changeAngles::v(mmf)")
    def change_angles(self, names: Any, changes: Any, fraction: float) -> None:
        """Let joints go further by some angles than where they were told to go."""
        joints = joints_of(self._robot.robot.body, names)
        by = numbers(changes, len(joints), "changes")
        goals = {
            name: self._commanded(name) + change for name, change in zip(joints, by, strict=True)
        }
        self._set("set_angles", angles=goals, speed=speed_of(fraction))

    @method("getAngles::[f](mb)")
    def angles(self, names: Any, use_sensors: bool) -> list[float]:
        """Return the angles (rad) of joints: where they are, or where they were told to go."""
        robot = self._robot.robot
        joints = joints_of(robot.body, names)
        if not use_sensors:
            return [self._commanded(joint) for joint in joints]
        with self._robot.lock:
            return [float(robot.angles[robot.body.index[joint]]) for joint in joints]

    @method("openHand::v(s)")
    def open_hand(self, hand: str) -> Any:
        """Open a hand; wait until it is open."""
        return self._do("hand", side=_side(hand), open=True)

    @method("closeHand::v(s)")
    def close_hand(self, hand: str) -> Any:
        """Close a hand; wait until it is closed."""
        return self._do("hand", side=_side(hand), open=False)

    @method("wakeUp::b()")
    def wake_up(self) -> Any:
        """Let all motors hold, and stand up."""
        return self._do("wake_up", True, stopped=False)

    @method("rest::v()")
    def rest(self) -> Any:
        """Go down, and let all motors loose."""
        return self._do("rest")

    @method("robotIsWakeUp::b()")
    def robot_is_wake_up(self) -> bool:
        """Return whether motors hold and it does not rest."""
        return bool(self._robot.state().settings["awake"])

    @method("setStiffnesses::v(mm)")
    def set_stiffnesses(self, names: Any, stiffnesses: Any) -> Any:
        """Let motors hold firmly (1), a little, or not at all (0)."""
        return self._do("set_stiffness", joints=self._firmness(names, stiffnesses))

    @method("stiffnessInterpolation::v(mmm)")
    def stiffness_interpolation(self, names: Any, stiffness_lists: Any, time_lists: Any) -> Any:
        """Let motors hold as the last value of each list says, after its last time (s)."""
        joints = joints_of(self._robot.robot.body, names)
        values = lists(stiffness_lists, len(joints), "lists of stiffnesses")
        times = lists(time_lists, len(joints), "lists of times")
        firmness = self._firmness(joints, [row[-1] for row in values])
        return self._do("set_stiffness", joints=firmness, seconds=max(row[-1] for row in times))

    @method("getStiffnesses::[f](m)")
    def stiffnesses(self, names: Any) -> list[float]:
        """Return how firmly motors hold, 0 to 1."""
        robot = self._robot.robot
        with self._robot.lock:
            return [stiffness(robot, joint) for joint in joints_of(robot.body, names)]

    def _firmness(self, names: Any, stiffnesses: Any) -> dict[str, float]:
        joints = joints_of(self._robot.robot.body, names)
        values = numbers(stiffnesses, len(joints), "stiffnesses")
        return {
            joint: within(value, 0.0, 1.0, "The stiffness")
            for joint, value in zip(joints, values, strict=True)
        }

    def _commanded(self, joint: str) -> float:
        """Return where a joint was told to go."""
        robot = self._robot.robot
        with self._robot.lock:
            for command in self._robot.commands():
                if isinstance(command.action, Approach) and joint in command.action.targets:
                    return command.action.targets[joint].angle
            return float(robot.angles[robot.body.index[joint]])


def speed_of(fraction: float) -> float:
    """Return a fraction of the top speed, never quite 0. Raises CallFailed."""
    return max(SLOWEST, within(fraction, 0.0, 1.0, "The fraction of the top speed"))


def _side(hand: str) -> str:
    if hand not in SIDES:
        raise CallFailed("There is no hand “{hand}”. Possible: LHand, RHand.", hand=hand)
    return SIDES[hand]


def rising(joint: str, times: list[float], keys: list[float]) -> list[float]:
    """Return the times of a joint. Raises CallFailed unless each is later than the one before."""
    if len(times) != len(keys):
        raise CallFailed(
            "{joint}: there are {count} angles for {count_2} times.",
            joint=joint,
            count=len(keys),
            count_2=len(times),
        )
    if any(late - early < SHORTEST_STEP_S for early, late in pairwise([0.0, *times])):
        raise CallFailed(
            "{joint}: times must be above 0, and each later than the one before.", joint=joint
        )
    return times


def _key(point: Any) -> float:
    return number(point[0] if isinstance(point, (list, tuple)) and point else point)


def _handle(point: Any, place: int) -> tuple[float, float]:
    """Return the time (s) and angle (rad) of one of a key's handles: [kind, time, angle]."""
    handles = point if isinstance(point, (list, tuple)) else []
    if len(handles) <= place:
        return 0.0, 0.0
    _, time, angle, *_ = [*rows(handles[place], "A handle"), 0.0, 0.0, 0.0]
    return number(time), number(angle)


# The part of ALMotion that tells where hands, feet and head are.

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


# The part of ALMotion that brings hands and head to places, by inverse kinematics.

REACHING = ("Head", "LArm", "RArm")
"""The ends that can be sent to places; the legs have to carry the body."""
TURN, ALL = 56, 63
"""Masks by NAOqi's numbers: bits for x, y, z and the turns about them."""


class Reaching(Module):
    """Places for hands and head: x, y, z m and turns about them rad, in a space."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._reach = Reach(robot.robot.stance.skeleton)

    @method("setPosition::v(si[f]fi)")
    def set_position(
        self, name: str, space: int, place: list[float], fraction: float, mask: int
    ) -> None:
        """Let an end go to a place at a part of the joints' top speed; nobody waits."""
        keys = self._keys(name, space, [_six(place)], mask, is_absolute=True)
        angles = {joint: row[0] for joint, row in keys.items()}
        self._set("set_angles", angles=angles, speed=speed_of(fraction))

    @method("setPositions::v(mmmfm)")
    def set_positions(
        self, names: Any, spaces: Any, places: Any, fraction: float, masks: Any
    ) -> None:
        """Let several ends go to places; nobody waits."""
        ends = texts(names)
        of_each = _for_each(places, len(ends))
        where = zip(ends, _whole(spaces, ends), of_each, _whole(masks, ends), strict=True)
        for name, space, place, mask in where:
            self.set_position(name, space, _six(place), fraction, mask)

    @method("changePosition::v(si[f]fi)")
    def change_position(
        self, name: str, space: int, change: list[float], fraction: float, mask: int
    ) -> None:
        """Let an end go further by a way from where it is; nobody waits."""
        keys = self._keys(name, space, [_six(change)], mask, is_absolute=False)
        angles = {joint: row[0] for joint, row in keys.items()}
        self._set("set_angles", angles=angles, speed=speed_of(fraction))

    @method("positionInterpolation::v(simimb)")
    def position_interpolation(
        self, name: str, space: int, path: Any, mask: int, times: Any, is_absolute: bool
    ) -> Any:
        """Move an end by places at times (s); wait until it is there."""
        tracks = self._tracks(name, space, path, mask, times, is_absolute=is_absolute)
        return self._do("move_through", tracks=tracks)

    @method("positionInterpolations::v([s]immmb)")
    def position_interpolations(
        self, names: list[str], space: int, paths: Any, masks: Any, times: Any, is_absolute: bool
    ) -> Any:
        """Move several ends by places at times; wait until they are there."""
        tracks: dict[str, Any] = {}
        of_each, at_each = _for_each(paths, len(names)), _for_each(times, len(names))
        for name, path, mask, at in zip(names, of_each, _whole(masks, names), at_each, strict=True):
            tracks |= self._tracks(name, space, path, mask, at, is_absolute=is_absolute)
        return self._do("move_through", tracks=tracks)

    @method("positionInterpolations::v(mmmmm)")
    def position_interpolations_in(
        self, names: Any, spaces: Any, paths: Any, masks: Any, times: Any
    ) -> Any:
        """Move several ends by places at times, each in a space of its own."""
        ends, tracks = texts(names), dict[str, Any]()
        of_each, at_each = _for_each(paths, len(ends)), _for_each(times, len(ends))
        where = zip(ends, _whole(spaces, ends), of_each, _whole(masks, ends), at_each, strict=True)
        for name, space, path, mask, at in where:
            tracks |= self._tracks(name, space, path, mask, at, is_absolute=True)
        return self._do("move_through", tracks=tracks)

    def _tracks(
        self, name: str, space: int, path: Any, mask: int, times: Any, *, is_absolute: bool
    ) -> dict[str, Any]:
        listed = rows(path, "The path")
        places = listed if listed and isinstance(listed[0], (list, tuple)) else [listed]
        keys = self._keys(name, space, [_six(one) for one in places], mask, is_absolute=is_absolute)
        ends = numbers(times, len(places), "times") if len(places) > 1 else [_single(times)]
        return {
            joint: {"times": rising(joint, ends, row), "keys": row} for joint, row in keys.items()
        }

    def _keys(
        self, name: str, space: int, places: list[list[float]], mask: int, *, is_absolute: bool
    ) -> dict[str, list[float]]:
        """Return the angles of the joints of an end at each place."""
        if name not in REACHING:
            raise CallFailed(
                "“{name}” cannot be sent to a place. Possible: {reaching}.",
                name=name,
                reaching=", ".join(REACHING),
            )
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


def _six(place: Any) -> list[float]:
    found = [number(one) for one in rows(place, "A place")]
    if len(found) != 6:
        raise CallFailed("A place is six numbers: x, y, z m and turns about them rad.")
    return found


def _single(times: Any) -> float:
    return numbers(times, 1, "times")[0]


def _whole(value: Any, names: list[str]) -> list[int]:
    """Return a whole number for each end; a single one stands for all of them."""
    return [int(one) for one in numbers(value, len(names), "numbers")]


def _for_each(value: Any, count: int) -> list[Any]:
    found = rows(value, "A list for each end")
    if len(found) != count:
        raise CallFailed(
            "There are {count} lists for {count_2} ends of the body.",
            count=len(found),
            count_2=count,
        )
    return found
