"""ALMotion: joints, stiffness, walking, places of hands, and what there is to know of the body."""

from __future__ import annotations

import math
import time
import zlib
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from robots.body.actions import Approach, Turn, Walk, WalkFreely
from robots.body.gait import STEP_FORWARD_M, STEP_LEFT_M, STEP_S, STEP_TURN_RAD
from robots.body.keyframes import SHORTEST_STEP_S
from robots.body.kinematics import pose_of
from robots.body.limbs import MOVING, Limb
from robots.body.motor_tasks import stiffness
from robots.body.schedule import Command
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.promise import Pending, Promise
from robots.naoqi.wire.service import method

from .arguments import (
    EVERYTHING,
    chains_of,
    joint_names,
    joints_of,
    lists,
    number,
    numbers,
    one_of,
    rows,
    texts,
    within,
    words,
)
from .ends import Ends, six_numbers
from .module import Module, kept, kept_each, one_by_one, play_script

CYCLE_MS = 10
TORQUE = 0.0
"""What ALMotion tells for a torque that it does not know."""
CHAIN_NAMES = ["Head", "LArm", "LLeg", "RLeg", "Leg", "RArm"]
SENSORS = [
    *(f"{sensor}{axis}" for sensor in ("Accelerometer", "Gyroscope") for axis in "XYZ"),
    *("CameraTop", "CameraBottom", "HeadTouchFront", "HeadTouchMiddle", "HeadTouchRear"),
    *("SonarLeft", "SonarRight"),
]

MOVE_CONFIG = {
    "MaxStepX": 0.04,
    "MaxStepY": 0.14,
    "MaxStepTheta": 0.349,
    "MaxStepFrequency": 1.0,
    "StepHeight": 0.02,
    "TorsoWx": 0.0,
    "TorsoWy": 0.0,
}
"""How a NAO walks by default, by NAOqi's names."""
SAME = 0.05
"""Speeds that differ by less than this part of the highest ones are the same."""
SHORTEST_WALK_S = 2.5
"""It walks for so long at least before it changes its speeds: each change costs it a step."""
FASTEST = (STEP_FORWARD_M / STEP_S, STEP_LEFT_M / STEP_S, STEP_TURN_RAD / STEP_S)
"""m/s forward, m/s to the left, rad/s."""

SLOWEST = 0.01
"""A fraction of the top speed below this is taken as this: 0 would never arrive."""
SIDES = {"LHand": "left", "RHand": "right"}


class ALMotion(Module):
    """All that moves; NAOqi's older names for the same are there too."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._ends = Ends(robot)
        self._next_change_s = self._next_way_s = 0.0
        self._end_waiting: Callable[[], bool] = lambda: False
        self._along: Pending | None = None
        """A walk by several places, which is walked to its end."""

    # Names, limits, tasks, and what it only remembers

    fall = kept("getFallManagerEnabled::b()", True)
    push = kept("getPushRecoveryEnabled::b()", True)
    smart = kept("getSmartStiffnessEnabled::b()", True)
    diagnosis = kept("getDiagnosisEffectEnabled::b()", True)
    orthogonal = kept("getOrthogonalSecurityDistance::f()", 0.4)
    tangential = kept("getTangentialSecurityDistance::f()", 0.1)
    notifications = kept(
        "areNotificationsEnabled::b()", True, setter="setEnableNotifications::v(b)"
    )
    breath_config = kept("getBreathConfig::m()", [["Bpm", 12.0], ["Amplitude", 0.5]])

    @method("getBodyNames::[s](s)", "getJointNames::[s](s)")
    def body_names(self, name: str) -> list[str]:
        """Return the joints of a chain or group; “Chains” are the names of the chains."""
        if name == "Chains":
            return [name for name in CHAIN_NAMES if name in chains_of(self._robot.robot.body)]
        return joint_names(self._robot.robot.body, name)

    sensor_names = method("getSensorNames::[s]()")(lambda self: list(SENSORS))

    @method("getLimits::m(s)")
    def limits(self, name: str) -> list[list[float]]:
        """Return lowest and highest angle (rad), top speed (rad/s) and torque of each joint."""
        body = self._robot.robot.body
        joints = [body.joints[body.index[joint]] for joint in joint_names(body, name)]
        return [[one.min_rad, one.max_rad, one.max_speed_rad_s, TORQUE] for one in joints]

    @method("getRobotConfig::m()")
    def robot_config(self) -> list[list[Any]]:
        """Return what kind of robot it is: names, then values."""
        config = {"Model Type": "naoH25", "Head Version": "VERSION_60", "Arms": True, "Legs": True}
        return [list(config), list(config.values())]

    # How long a step of the movement lasts, in milliseconds
    cycle_time = method("getMotionCycleTime::i()")(lambda self: CYCLE_MS)

    @method("getMass::f(s)")
    def mass(self, name: str) -> float:
        """Return the mass of the body, kg."""
        if name not in EVERYTHING:
            raise CallFailed("Only the mass of the whole Body is known here.")
        return self._robot.robot.stance.skeleton.mass_kg

    @method("setBreathEnabled::v(sb)")
    def set_breath(self, chain: str, is_on: bool) -> Any:
        """Let it move a little as if it breathed."""
        joint_names(self._robot.robot.body, chain)
        self._kept[f"breath {chain}"] = is_on
        return self._do("breathing", on=is_on)

    @method("getBreathEnabled::b(s)")
    def breath(self, chain: str) -> bool:
        """Return whether a chain breathes."""
        return bool(self._kept.get(f"breath {chain}", self._kept.get("breath Body", False)))

    idle_posture = kept_each(
        "getIdlePostureEnabled::b(s)",
        False,
        known=lambda self, chain: joint_names(self._robot.robot.body, chain),
    )
    collision_protection = kept_each(
        "getCollisionProtectionEnabled::b(s)", True, setter="setCollisionProtectionEnabled::b(sb)"
    )
    external_collision_protection = kept_each(
        "getExternalCollisionProtectionEnabled::b(s)", True, of_all="All"
    )

    @method("getTaskList::m()")
    def task_list(self) -> list[list[Any]]:
        """Return what moves it: name, number, who asked, priority, joints."""
        return [self._task(command) for command in self._moving()]

    are_resources_available = method("areResourcesAvailable::b([s])")(
        lambda self, names: not self._limbs(names) & self._robot.busy_limbs()
    )

    @method("killTask::b(i)")
    def kill_task(self, number: int) -> bool:
        """End one of the tasks; a robot whose walk it is falls."""
        known = [command.id for command in self._moving() if _number(command) == number]
        self._kill(lambda command: command.id in known)
        return bool(known)

    @method("killTasksUsingResources::v([s])")
    def kill_tasks_using_resources(self, names: list[str]) -> None:
        """End what uses some joints or chains; a robot that walks falls when legs are named."""
        limbs = self._limbs(names)
        self._kill(lambda command: bool(command.limbs & limbs), legs=Limb.LEGS in limbs)

    @method("killAll::v()")
    def kill_all(self) -> None:
        """End all that moves joints; a robot that walks falls."""
        self._kill(lambda command: bool(command.limbs & MOVING), legs=True)

    def _kill(self, which: Callable[[Command], bool], *, legs: bool = False) -> None:
        """End tasks as NAOqi does, "brutally, without attempting to return to a balanced state"."""
        if any(_is_walk(command) and which(command) for command in self._robot.commands()):
            self._end_waiting()
        self._robot.kill(which, legs=legs)

    def _moving(self) -> list[Command]:
        return [command for command in self._robot.commands() if command.limbs & MOVING]

    def _limbs(self, names: list[str]) -> frozenset[Any]:
        body = self._robot.robot.body
        return body.limbs_of(joint for name in names for joint in joint_names(body, name))

    def _task(self, command: Command) -> list[Any]:
        body = self._robot.robot.body
        joints = [joint.name for joint in body.joints if joint.limb in command.limbs]
        name = type(command.action).__name__
        return [name, _number(command), self.name, command.priority, joints]

    @method("getSummary::s()")
    def summary(self) -> str:
        """Return a table of the joints: stiffness, and angle as told and as felt."""
        lines = [f"{'JointName':>16} {'Stiffness':>10} {'Command':>10} {'Sensor':>10}"]
        for joint in self._robot.robot.body.names:
            numbers = self.stiffnesses(joint) + self.angles(joint, False) + self.angles(joint, True)
            lines.append(f"{joint:>16} " + " ".join(f"{number:>10.6f}" for number in numbers))
        return "\n".join(lines)

    # Walking

    move_init = method("moveInit::v()", "walkInit::v()")(
        lambda self: self._do("do", posture="posture_stand_init")
    )

    @method("moveTo::b(fff)", "moveTo::b(fffm)", "walkTo::b(fff)", "walkTo::b(fffm)")
    def move_to(self, x: float, y: float, theta: float, config: Any = ()) -> Any:
        """Walk ``x`` m forward, ``y`` m to the left, turning ``theta`` rad; wait for the end.

        ``config`` are settings of steps by name; they change nothing here.
        """
        return self.move_along([[x, y, theta]], config)

    @method("moveTo::b(ffff)", "moveTo::b(ffffm)")
    def move_to_in(self, x: float, y: float, theta: float, seconds: float, config: Any = ()) -> Any:
        """Walk by ``x``, ``y``, ``theta`` with ``config``, as ``move_to``.

        This robot walks at the pace that it has, however many ``seconds`` are asked for.
        """
        return self.move_along([[x, y, theta]], config)

    @method("moveTo::b(m)", "moveTo::b(mm)", "walkTo::b(m)")
    def move_along(self, points: Any, config: Any = ()) -> Any:
        """Walk by one or several places, each x m, y m, theta rad from where it starts.

        A place that is asked for in a walk to another one takes that one's place: the robot goes
        there from where the step under way ends, without standing in between.
        """
        _check_config(config)
        places = [(0.0, 0.0, 0.0), *_places(points)]
        if len(places) == 2 and self._goes_elsewhere(places[1]):
            promise = Promise(lambda: self._robot.stop(_is_walk))
            self._robot.when(self._has_come_to_rest, lambda: _settle(promise))
            return promise.future
        self._robot.stop(lambda command: self._is_own_walk(command) and command in self._waiting())
        ways = [("walk", _way(here, there)) for here, there in pairwise(places)]
        walking = play_script(self._robot, one_by_one(ways), True, stopped=False)
        if len(ways) > 1:
            self._along = walking
        return walking

    def _waiting(self) -> tuple[Command, ...]:
        return self._robot.actor.schedule.waiting

    def _is_own_walk(self, command: Command) -> bool:
        return isinstance(command.action, Walk) and self._robot.is_asked_here(command)

    def _goes_elsewhere(self, place: Sequence[float]) -> bool:
        """Let a walk to a place go to another one; False when there is none that can."""
        with self._robot.lock:
            going = self._robot.robot.going
            is_going = any(map(self._is_own_walk, self._robot.actor.schedule.running))
            if not is_going or self._has_more_places or going is None:
                return False
            if time.monotonic() < self._next_way_s:  # of those in between the last one is gone
                self._end_waiting()
                self._end_waiting = self._robot.when(
                    lambda: time.monotonic() >= self._next_way_s, lambda: self._go_there(place)
                )
                return True
            begun_s = time.monotonic()
            is_changed = going.replace(np.array(place, dtype=float))
            # Who asks again and again makes others wait half of the time at most
            self._next_way_s = 2.0 * time.monotonic() - begun_s
            return is_changed

    def _go_there(self, place: Sequence[float]) -> None:
        if not self._goes_elsewhere(place):  # it stands by now
            self.move_along([place])

    @method("move::v(fff)", "move::v(fffm)")
    def move(self, x: float, y: float, theta: float, config: Any = ()) -> None:
        """Walk on at ``x``, ``y`` m/s, ``theta`` rad/s; nobody waits. ``config``: as move_to."""
        _check_config(config)
        speeds = [number(speed) for speed in (x, y, theta)]
        parts = [speed / most for speed, most in zip(speeds, FASTEST, strict=True)]
        self._walk_on([min(max(part, -1.0), 1.0) for part in parts])

    @method("moveToward::v(fff)", "moveToward::v(fffm)")
    def move_toward(self, x: float, y: float, theta: float, config: Any = ()) -> None:
        """Walk on at parts ``x``, ``y``, ``theta`` (-1 to 1) of the highest speeds, as ``move``.

        ``config`` is as there.
        """
        _check_config(config)
        self._walk_on([within(part, -1.0, 1.0, "A speed") for part in (x, y, theta)])

    @method("setWalkTargetVelocity::v(ffff)", "setWalkTargetVelocity::v(ffffm)")
    def set_walk_target_velocity(
        self, x: float, y: float, theta: float, frequency: float, config: Any = ()
    ) -> None:
        """Walk on by ``x``, ``y``, ``theta``, ``config`` as ``move_toward``.

        ``frequency`` (0 to 1) changes nothing: this robot has one frequency of steps.
        """
        within(frequency, 0.0, 1.0, "The frequency")
        self.move_toward(x, y, theta, config)

    @method("waitUntilMoveIsFinished::v()", "waitUntilWalkIsFinished::v()")
    def wait_until_move_is_finished(self) -> Any:
        """Wait until it does not walk any more."""
        promise = Promise()
        stop = self._robot.when(self._has_come_to_rest, lambda: promise.set(None))
        promise.on_cancel = lambda: promise.cancelled() if stop() else None
        return promise.future

    @method("moveIsActive::b()", "walkIsActive::b()")
    def move_is_active(self) -> bool:
        """Return whether it walks: until both feet stand where they stay.

        While the weight then goes back between them a walk may be ended in any way: NAOqi's own
        stopMove ends one "at next double support".
        """
        with self._robot.lock:
            walks = [command for command in self._robot.commands() if _is_walk(command)]
            is_last = len(walks) == 1 and isinstance(walks[0].action, (Walk, Turn))
            if is_last and self._robot.is_coming_to_rest and not self._has_more_places:
                return False
            return bool(walks) or self._robot.is_stepping

    @property
    def _has_more_places(self) -> bool:
        return self._along is not None and not self._along.done

    def _has_come_to_rest(self) -> bool:
        """Whether a walk is over altogether: also the weight is back between both feet."""
        with self._robot.lock:
            if any(map(_is_walk, self._robot.commands())):
                return False
            return not (self._robot.is_stepping or self._robot.is_coming_to_rest)

    @method("stopMove::b()", "stopWalk::b()")
    def stop_move(self) -> bool:
        """Stop walking after the step under way."""
        self._end_waiting()
        self._robot.stop(_is_walk)
        return True

    @method("killMove::v()", "killWalk::v()")
    def kill_move(self) -> None:
        """Stop walking in the middle of a step: the robot falls."""
        self._end_waiting()
        self._kill(_is_walk, legs=True)

    @method("getRobotPosition::[f](b)")
    def robot_position(self, use_sensors: bool) -> list[float]:
        """Return where it is on the floor: x m, y m, theta rad from where it was switched on."""
        return list(self._robot.state().base)

    @method("getNextRobotPosition::[f]()")
    def next_robot_position(self) -> list[float]:
        """Return where it will be after the step under way, which it cannot change any more.

        From there a ``moveTo`` in a walk is seen; a robot that does not walk is there already.
        """
        with self._robot.lock:
            robot = self._robot.robot
            next_base = robot.base if robot.going is None else robot.going.next_base
            return [float(number) for number in next_base]

    @method("getRobotVelocity::[f]()")
    def robot_velocity(self) -> list[float]:
        """Return how fast it was told to walk: m/s forward, m/s to the left, rad/s."""
        parts = self._free_walk() or (0.0, 0.0, 0.0)
        return [part * most for part, most in zip(parts, FASTEST, strict=True)]

    @method("getMoveConfig::m(s)")
    def move_config(self, config: str) -> list[list[Any]]:
        """Return how it walks, as pairs of name and value."""
        return [[name, value] for name, value in MOVE_CONFIG.items()]

    @method("setMoveArmsEnabled::v(bb)")
    def set_move_arms_enabled(self, left: bool, right: bool) -> None:
        """Remember which arms may swing while it walks."""
        self._kept["arms"] = {"LArm": left, "RArm": right, "Arms": left and right}

    @method("getMoveArmsEnabled::b(s)")
    def move_arms_enabled(self, chain: str) -> bool:
        """Return whether an arm may swing while it walks; “Arms” are both."""
        arms = self._kept.get("arms", dict.fromkeys(("LArm", "RArm", "Arms"), True))
        one_of(chain, arms, "There is no arm “{chain}”. Possible: LArm, RArm, Arms.")
        return bool(arms[chain])

    def _walk_on(self, parts: list[float]) -> None:
        """Walk on at other speeds; a robot that has just begun a step is let go on for a while."""
        self._end_waiting()
        if not any(parts):
            self._robot.stop(_is_walk)
            return
        now = self._free_walk()
        if now is not None and all(abs(a - b) <= SAME for a, b in zip(now, parts, strict=True)):
            return
        if now is not None and time.monotonic() < self._next_change_s:
            self._end_waiting = self._robot.when(
                lambda: time.monotonic() >= self._next_change_s, lambda: self._walk_on(parts)
            )
            return
        self._next_change_s = time.monotonic() + SHORTEST_WALK_S
        self._set("walk_freely", forward=parts[0], left=parts[1], turn=parts[2])

    def _free_walk(self) -> tuple[float, float, float] | None:
        """Return the parts of the highest speeds at which it walks on, None when it does not."""
        actions = [command.action for command in self._robot.commands()]
        free = next((one for one in actions if isinstance(one, WalkFreely)), None)
        return None if free is None else (free.forward, free.left, free.turn)

    # Angles and stiffness

    @method("angleInterpolation::v(mmmb)")
    def angle_interpolation(
        self, names: Any, angle_lists: Any, time_lists: Any, is_absolute: bool
    ) -> Any:
        """Move joints through angles (rad) at times (s), a list for each of ``names``; wait for it.

        ``angle_lists`` are counted from where joints are unless ``is_absolute``; ``time_lists``
        rise.
        """
        joints = joints_of(self._robot.robot.body, names)
        angles = lists(angle_lists, len(joints), "lists of angles")
        times = lists(time_lists, len(joints), "lists of times")
        tracks = {
            joint: {"times": _rising(joint, at, keys), "keys": keys}
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
                "times": _rising(joint, [number(time) for time in rows(at, "The times")], keys),
                "keys": keys,
                "handles": [(*_handle(point, 1), *_handle(point, 2)) for point in points],
            }
        return self._do("move_through", tracks=tracks)

    @method("angleInterpolationWithSpeed::v(mmf)")
    def angle_interpolation_withspeed_of(self, names: Any, angles: Any, fraction: float) -> Any:
        """Move joints to angles at a part of their top speed; wait until they are there."""
        goals = self._for_each_joint(names, angles, "angles")
        return self._do("reach_angles", angles=goals, speed=_speed_of(fraction))

    @method("setAngles::v(mmf)")
    def set_angles(self, names: Any, angles: Any, fraction: float) -> None:
        """Let joints go to angles at a part of their top speed; nobody waits."""
        goals = self._for_each_joint(names, angles, "angles")
        self._set("set_angles", angles=goals, speed=_speed_of(fraction))

    @method("setAngles::v(mm[f])")
    def set_angles_each(self, names: Any, angles: Any, fractions: list[float]) -> None:
        """Let joints go to angles, each at a part of its top speed."""
        goals = self._for_each_joint(names, angles, "angles")
        speeds = self._for_each_joint(names, fractions, "fractions of the top speed")
        for joint, angle in goals.items():
            self._set("set_angles", angles={joint: angle}, speed=_speed_of(speeds[joint]))

    @method("changeAngles::v(mmf)")
    def change_angles(self, names: Any, changes: Any, fraction: float) -> None:
        """Let joints go further by some angles than where they were told to go."""
        by = self._for_each_joint(names, changes, "changes")
        goals = {joint: self._commanded(joint) + change for joint, change in by.items()}
        self._set("set_angles", angles=goals, speed=_speed_of(fraction))

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

    # Let all motors hold, and stand up
    wake_up = method("wakeUp::b()")(lambda self: self._do("wake_up", True, stopped=False))
    rest = method("rest::v()")(lambda self: self._do("rest"))  # Go down, and let all motors loose

    robot_is_wake_up = method("robotIsWakeUp::b()")(
        lambda self: bool(self._robot.state().settings["awake"])
    )

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
        return self._do(
            "set_stiffness", joints=firmness, seconds=max((row[-1] for row in times), default=0.0)
        )

    @method("getStiffnesses::[f](m)")
    def stiffnesses(self, names: Any) -> list[float]:
        """Return how firmly motors hold, 0 to 1."""
        robot = self._robot.robot
        with self._robot.lock:
            return [stiffness(robot, joint) for joint in joints_of(robot.body, names)]

    def _firmness(self, names: Any, stiffnesses: Any) -> dict[str, float]:
        values = self._for_each_joint(names, stiffnesses, "stiffnesses")
        return {joint: within(values[joint], 0.0, 1.0, "The stiffness") for joint in values}

    def _for_each_joint(self, names: Any, values: Any, what: str) -> dict[str, float]:
        joints = joints_of(self._robot.robot.body, names)
        return dict(zip(joints, numbers(values, len(joints), what), strict=True))

    def _commanded(self, joint: str) -> float:
        """Return where a joint was told to go."""
        robot = self._robot.robot
        with self._robot.lock:
            for command in self._robot.commands():
                if isinstance(command.action, Approach) and joint in command.action.targets:
                    return command.action.targets[joint].angle
            return float(robot.angles[robot.body.index[joint]])

    # Places of the parts of the body, and hands and head that go to places

    @method("getPosition::[f](sib)")
    def position(self, name: str, space: int, use_sensors: bool) -> list[float]:
        """Return where a part is: x, y, z m and turns about them, rad."""
        frame = self._ends.frame(name, space)
        return list(pose_of(frame[:3, :3], frame[:3, 3]))

    @method("getTransform::[f](sib)")
    def transform(self, name: str, space: int, use_sensors: bool) -> list[float]:
        """Return where a part is, as the 16 numbers of a frame, row by row."""
        return [float(number) for number in self._ends.frame(name, space).ravel()]

    @method("getCOM::[f](sib)")
    def centre_of_mass(self, name: str, space: int, use_sensors: bool) -> list[float]:
        """Return where the centre of mass of the whole body is, m."""
        return self._ends.centre_of_mass(name, space)

    @method("setPosition::v(si[f]fi)")
    def set_position(
        self, name: str, space: int, place: list[float], fraction: float, mask: int
    ) -> None:
        """Let the end ``name`` go to a ``place`` (x, y, z m and turns rad) in a ``space``.

        Nobody waits. ``space`` and ``mask`` are NAOqi's numbers: of the frame, and of what of the
        six counts; ``fraction`` (0 to 1) is of the joints' top speeds.
        """
        self._go(self._ends.keys(name, space, [six_numbers(place)], mask), fraction)

    @method("setPositions::v(mmmfm)")
    def set_positions(
        self, names: Any, spaces: Any, places: Any, fraction: float, masks: Any
    ) -> None:
        """Let several ends go to places: ``names``, ``spaces``, ``places``, ``masks`` of each.

        The ``fraction`` is for all; each is as for ``set_position``.
        """
        ends = texts(names)
        of_each = _for_each(places, len(ends))
        where = zip(ends, _whole(spaces, ends), of_each, _whole(masks, ends), strict=True)
        for name, space, place, mask in where:
            self.set_position(name, space, six_numbers(place), fraction, mask)

    @method("changePosition::v(si[f]fi)")
    def change_position(
        self, name: str, space: int, change: list[float], fraction: float, mask: int
    ) -> None:
        """Let the end ``name`` go further by a ``change`` from where it is, as ``set_position``.

        ``space``, ``fraction`` and ``mask`` are as there.
        """
        further = self._ends.keys(name, space, [six_numbers(change)], mask, is_absolute=False)
        self._go(further, fraction)

    def _go(self, keys: dict[str, list[float]], fraction: float) -> None:
        angles = {joint: row[0] for joint, row in keys.items()}
        self._set("set_angles", angles=angles, speed=_speed_of(fraction))

    @method("positionInterpolation::v(simimb)")
    def position_interpolation(
        self, name: str, space: int, path: Any, mask: int, times: Any, is_absolute: bool
    ) -> Any:
        """Move the end ``name`` by the places of a ``path`` at ``times`` (s); wait for it.

        ``space`` and ``mask`` are as for ``set_position``; places are from where it is unless
        ``is_absolute``.
        """
        tracks = self._tracks(name, space, path, mask, times, is_absolute=is_absolute)
        return self._do("move_through", tracks=tracks)

    @method("positionInterpolations::v([s]immmb)", "positionInterpolations::v(mmmmm)")
    def position_interpolations(
        self, names: Any, spaces: Any, paths: Any, masks: Any, times: Any, is_absolute: bool = True
    ) -> Any:
        """Move several ends by places at times: an element of each list for each of ``names``.

        ``spaces``, ``paths``, ``masks``, ``times`` and ``is_absolute`` are as for
        ``position_interpolation``; wait until they are there.
        """
        ends, tracks = texts(names), dict[str, Any]()
        of_each, at_each = _for_each(paths, len(ends)), _for_each(times, len(ends))
        where = zip(ends, _whole(spaces, ends), of_each, _whole(masks, ends), at_each, strict=True)
        for name, space, path, mask, at in where:
            tracks |= self._tracks(name, space, path, mask, at, is_absolute=is_absolute)
        return self._do("move_through", tracks=tracks)

    def _tracks(
        self, name: str, space: int, path: Any, mask: int, times: Any, *, is_absolute: bool
    ) -> dict[str, Any]:
        listed = rows(path, "The path")
        places = listed if listed and isinstance(listed[0], (list, tuple)) else [listed]
        keys = self._ends.keys(
            name, space, [six_numbers(one) for one in places], mask, is_absolute=is_absolute
        )
        ends = numbers(times, len(places), "times")
        return {
            joint: {"times": _rising(joint, ends, row), "keys": row} for joint, row in keys.items()
        }


def _number(command: Command) -> int:
    return zlib.crc32(command.id.encode()) & 0x7FFFFFFF


def _is_walk(command: Command) -> bool:
    return isinstance(command.action, (Walk, Turn, WalkFreely))


def _settle(promise: Promise) -> None:
    """Answer who walked: the robot stands, there or where it was stopped."""
    if promise.is_cancelled:
        promise.cancelled()
    else:
        promise.set(True)


def _way(here: Sequence[float], there: Sequence[float]) -> dict[str, float]:
    """Return the walk from one place to another, both seen from the same start."""
    x, y, turn = (number(b) - a for a, b in zip(here, there, strict=True))
    cosine, sine = math.cos(here[2]), math.sin(here[2])
    return {
        "forward_m": x * cosine + y * sine,
        "left_m": y * cosine - x * sine,
        "turn_deg": math.degrees(turn),
    }


def _places(points: Any) -> list[list[float]]:
    is_list = isinstance(points, (list, tuple)) and bool(points)
    rows = points if is_list and isinstance(points[0], (list, tuple)) else [points]
    if not all(isinstance(row, (list, tuple)) and len(row) == 3 for row in rows):
        raise CallFailed("A place is three numbers: x m, y m, theta rad.")
    return [[number(one) for one in row] for row in rows]


def _check_config(config: Any) -> None:
    """Raise CallFailed when a setting is not one of walking, nor of a foot."""
    known = {name.casefold() for name in (*MOVE_CONFIG, "Frequency")}
    for name in words(config, "The settings of walking"):
        if name.removeprefix("Left").removeprefix("Right").casefold() not in known:
            raise CallFailed("There is no setting “{name}” of walking.", name=name)


def _speed_of(fraction: float) -> float:
    """Return a fraction of the top speed, never quite 0. Raises CallFailed."""
    return max(SLOWEST, within(fraction, 0.0, 1.0, "The fraction of the top speed"))


def _side(hand: str) -> str:
    return SIDES[one_of(hand, SIDES, "There is no hand “{hand}”. Possible: LHand, RHand.")]


def _rising(joint: str, times: list[float], keys: list[float]) -> list[float]:
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
