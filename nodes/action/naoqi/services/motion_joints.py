"""The part of ALMotion that moves joints, and lets their motors hold or not."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from nodes.action.naobody.keyframes import SHORTEST_STEP_S
from nodes.action.naobody.motor_actions import Approach
from nodes.action.naobody.motor_tasks import stiffness
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.arguments import joints_of, lists, number, numbers, rows, within
from nodes.action.naoqi.services.module import Module

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
            raise CallFailed(f"{len(joints)} joints need as many lists of times and of keys.")
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
        raise CallFailed(f"There is no hand “{hand}”. Possible: LHand, RHand.")
    return SIDES[hand]


def rising(joint: str, times: list[float], keys: list[float]) -> list[float]:
    """Return the times of a joint. Raises CallFailed unless each is later than the one before."""
    if len(times) != len(keys):
        raise CallFailed(f"{joint}: there are {len(keys)} angles for {len(times)} times.")
    if any(late - early < SHORTEST_STEP_S for early, late in pairwise([0.0, *times])):
        raise CallFailed(f"{joint}: times must be above 0, and each later than the one before.")
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
