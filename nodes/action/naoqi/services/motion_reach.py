"""The part of ALMotion that brings hands and head to places, by inverse kinematics."""

from __future__ import annotations

from typing import Any

import numpy as np

from nodes.action.naobody.body import Angles
from nodes.action.naobody.inverse import Goal, Reach
from nodes.action.naobody.skeleton import TORSO, pose_of, rotation
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.arguments import number, numbers, rows, texts, within
from nodes.action.naoqi.services.module import Module
from nodes.action.naoqi.services.motion_joints import rising, speed_of
from nodes.action.naoqi.services.motion_places import HERE, end_of, frame_in_room, origin_of
from nodes.action.naoqi.serving import ServedRobot

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
                f"“{name}” cannot be sent to a place. Possible: {', '.join(REACHING)}."
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
        raise CallFailed(f"There are {len(found)} lists for {count} ends of the body.")
    return found
