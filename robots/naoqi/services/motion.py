"""ALMotion: joints, stiffness, walking, and what there is to know about the body."""

from __future__ import annotations

import math
import time
import zlib
from collections.abc import Callable
from typing import Any

from robots.body.actions import Turn, Walk, WalkFreely
from robots.body.gait import STEP_FORWARD_M, STEP_LEFT_M, STEP_S, STEP_TURN_RAD
from robots.body.limbs import MOVING
from robots.body.schedule import Command
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.service import method

from .arguments import EVERYTHING, chains_of, joint_names, number, within, words
from .module import Module, kept, one_by_one, play_script
from .motion_joints import JointControl, Places, Reaching

# The part of ALMotion that tells of the body, and of what goes on.

CYCLE_MS = 10
TORQUE = 0.0
"""What ALMotion tells for a torque that it does not know."""
CHAIN_NAMES = ["Head", "LArm", "LLeg", "RLeg", "Leg", "RArm"]
SENSORS = [
    "AccelerometerX",
    "AccelerometerY",
    "AccelerometerZ",
    "GyroscopeX",
    "GyroscopeY",
    "GyroscopeZ",
    "CameraTop",
    "CameraBottom",
    "HeadTouchFront",
    "HeadTouchMiddle",
    "HeadTouchRear",
    "SonarLeft",
    "SonarRight",
]


class BodyInfo(Module):
    """Names, limits, tasks, and what ALMotion only remembers."""

    set_fall, fall = kept("setFallManagerEnabled::v(b)", "getFallManagerEnabled::b()", True)
    set_push, push = kept("setPushRecoveryEnabled::v(b)", "getPushRecoveryEnabled::b()", True)
    set_smart, smart = kept("setSmartStiffnessEnabled::v(b)", "getSmartStiffnessEnabled::b()", True)
    set_diagnosis, diagnosis = kept(
        "setDiagnosisEffectEnabled::v(b)", "getDiagnosisEffectEnabled::b()", True
    )
    set_orthogonal, orthogonal = kept(
        "setOrthogonalSecurityDistance::v(f)", "getOrthogonalSecurityDistance::f()", 0.4
    )
    set_tangential, tangential = kept(
        "setTangentialSecurityDistance::v(f)", "getTangentialSecurityDistance::f()", 0.1
    )
    set_notifications, notifications = kept(
        "setEnableNotifications::v(b)", "areNotificationsEnabled::b()", True
    )
    set_breath_config, breath_config = kept(
        "setBreathConfig::v(m)", "getBreathConfig::m()", [["Bpm", 12.0], ["Amplitude", 0.5]]
    )

    @method("getBodyNames::[s](s)")
    def body_names(self, name: str) -> list[str]:
        """Return the joints of a chain or group; “Chains” are the names of the chains."""
        if name == "Chains":
            return [name for name in CHAIN_NAMES if name in chains_of(self._robot.robot.body)]
        return joint_names(self._robot.robot.body, name)

    @method("getJointNames::[s](s)")
    def joint_names(self, name: str) -> list[str]:
        """Return the joints of a chain or group."""
        return self.body_names(name)

    @method("getSensorNames::[s]()")
    def sensor_names(self) -> list[str]:
        """Return the names of the sensors."""
        return list(SENSORS)

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

    @method("getMotionCycleTime::i()")
    def cycle_time(self) -> int:
        """Return how long a step of the movement lasts, in milliseconds."""
        return CYCLE_MS

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

    @method("setIdlePostureEnabled::v(sb)")
    def set_idle_posture(self, chain: str, is_on: bool) -> None:
        """Remember whether a chain keeps its posture while nobody asks anything."""
        joint_names(self._robot.robot.body, chain)
        self._kept[f"idle {chain}"] = is_on

    @method("getIdlePostureEnabled::b(s)")
    def idle_posture(self, chain: str) -> bool:
        """Return whether a chain keeps its posture."""
        return bool(self._kept.get(f"idle {chain}", False))

    @method("setCollisionProtectionEnabled::b(sb)")
    def set_collision_protection(self, chain: str, is_on: bool) -> bool:
        """Remember whether an arm avoids the body."""
        self._kept[f"collision {chain}"] = is_on
        return True

    @method("getCollisionProtectionEnabled::b(s)")
    def collision_protection(self, chain: str) -> bool:
        """Return whether an arm avoids the body."""
        return bool(self._kept.get(f"collision {chain}", True))

    @method("setExternalCollisionProtectionEnabled::v(sb)")
    def set_external_collision_protection(self, name: str, is_on: bool) -> None:
        """Remember whether it stops before obstacles."""
        self._kept[f"external {name}"] = is_on

    @method("getExternalCollisionProtectionEnabled::b(s)")
    def external_collision_protection(self, name: str) -> bool:
        """Return whether it stops before obstacles."""
        return bool(self._kept.get(f"external {name}", self._kept.get("external All", True)))

    @method("getTaskList::m()")
    def task_list(self) -> list[list[Any]]:
        """Return what moves it: name, number, who asked, priority, joints."""
        return [self._task(command) for command in self._moving()]

    @method("areResourcesAvailable::b([s])")
    def are_resources_available(self, names: list[str]) -> bool:
        """Return whether nothing uses some joints or chains."""
        return not self._limbs(names) & self._robot.busy_limbs()

    @method("killTask::b(i)")
    def kill_task(self, number: int) -> bool:
        """End one of the tasks."""
        known = [command.id for command in self._moving() if _number(command) == number]
        self._robot.stop(lambda command: command.id in known)
        return bool(known)

    @method("killTasksUsingResources::v([s])")
    def kill_tasks_using_resources(self, names: list[str]) -> None:
        """End what uses some joints or chains."""
        limbs = self._limbs(names)
        self._robot.stop(lambda command: bool(command.limbs & limbs))

    @method("killAll::v()")
    def kill_all(self) -> None:
        """End all that moves joints."""
        self._robot.stop(lambda command: bool(command.limbs & MOVING))

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


def _number(command: Command) -> int:
    return zlib.crc32(command.id.encode()) & 0x7FFFFFFF


# The part of ALMotion that walks.

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


class Locomotion(Module):
    """Walking; NAOqi's older names for the same are there too."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._next_change_s = 0.0
        self._end_waiting: Callable[[], bool] = lambda: False

    @method("moveInit::v()")
    def move_init(self) -> Any:
        """Stand ready to walk."""
        return self._do("do", posture="posture_stand_init")

    @method("walkInit::v()")
    def walk_init(self) -> Any:
        """Stand ready to walk."""
        return self.move_init()

    @method("moveTo::b(fff)")
    def move_to(self, x: float, y: float, theta: float) -> Any:
        """Walk x m forward and y m to the left, turning theta rad; wait for the end."""
        return self._walk([[x, y, theta]])

    @method("moveTo::b(ffff)")
    def move_to_in(self, x: float, y: float, theta: float, seconds: float) -> Any:
        """Walk a way; this robot walks at the pace that it has."""
        return self._walk([[x, y, theta]])

    @method("moveTo::b(fffm)")
    def move_to_with(self, x: float, y: float, theta: float, config: Any) -> Any:
        """Walk a way, with settings."""
        _check_config(config)
        return self._walk([[x, y, theta]])

    @method("moveTo::b(ffffm)")
    def move_to_in_with(self, x: float, y: float, theta: float, seconds: float, config: Any) -> Any:
        """Walk a way, with settings; this robot walks at the pace that it has."""
        return self.move_to_with(x, y, theta, config)

    @method("moveTo::b(m)")
    def move_along(self, points: Any) -> Any:
        """Walk by one or several places, each x m, y m, theta rad from where it starts."""
        return self._walk(_places(points))

    @method("moveTo::b(mm)")
    def move_along_with(self, points: Any, config: Any) -> Any:
        """Walk by one or several places, with settings."""
        _check_config(config)
        return self._walk(_places(points))

    @method("walkTo::b(fff)")
    def walk_to(self, x: float, y: float, theta: float) -> Any:
        """Walk a way; wait for the end."""
        return self._walk([[x, y, theta]])

    @method("walkTo::b(fffm)")
    def walk_to_with(self, x: float, y: float, theta: float, config: Any) -> Any:
        """Walk a way, with settings."""
        return self.move_to_with(x, y, theta, config)

    @method("walkTo::b(m)")
    def walk_along(self, points: Any) -> Any:
        """Walk by one or several places."""
        return self._walk(_places(points))

    @method("move::v(fff)")
    def move(self, x: float, y: float, theta: float) -> None:
        """Walk on at speeds (m/s, m/s, rad/s) until told otherwise; nobody waits."""
        speeds = [number(speed) for speed in (x, y, theta)]
        parts = [speed / most for speed, most in zip(speeds, FASTEST, strict=True)]
        self._walk_on([min(max(part, -1.0), 1.0) for part in parts])

    @method("move::v(fffm)")
    def move_with(self, x: float, y: float, theta: float, config: Any) -> None:
        """Walk on at speeds, with settings."""
        _check_config(config)
        self.move(x, y, theta)

    @method("moveToward::v(fff)")
    def move_toward(self, x: float, y: float, theta: float) -> None:
        """Walk on at parts (-1 to 1) of the highest speeds; nobody waits."""
        self._walk_on([within(part, -1.0, 1.0, "A speed") for part in (x, y, theta)])

    @method("moveToward::v(fffm)")
    def move_toward_with(self, x: float, y: float, theta: float, config: Any) -> None:
        """Walk on at parts of the highest speeds, with settings."""
        _check_config(config)
        self.move_toward(x, y, theta)

    @method("setWalkTargetVelocity::v(ffff)")
    def set_walk_target_velocity(self, x: float, y: float, theta: float, frequency: float) -> None:
        """Walk on at parts of the highest speeds; this robot has one frequency of steps."""
        within(frequency, 0.0, 1.0, "The frequency")
        self.move_toward(x, y, theta)

    @method("setWalkTargetVelocity::v(ffffm)")
    def set_walk_target_velocity_with(
        self, x: float, y: float, theta: float, frequency: float, config: Any
    ) -> None:
        """Walk on at parts of the highest speeds, with settings."""
        _check_config(config)
        self.set_walk_target_velocity(x, y, theta, frequency)

    @method("waitUntilMoveIsFinished::v()")
    def wait_until_move_is_finished(self) -> Any:
        """Wait until it does not walk any more."""
        promise = Promise()
        stop = self._robot.when(lambda: not self.move_is_active(), lambda: promise.set(None))
        promise.on_cancel = lambda: promise.cancelled() if stop() else None
        return promise.future

    @method("waitUntilWalkIsFinished::v()")
    def wait_until_walk_is_finished(self) -> Any:
        """Wait until it does not walk any more."""
        return self.wait_until_move_is_finished()

    @method("moveIsActive::b()")
    def move_is_active(self) -> bool:
        """Return whether it walks."""
        return any(map(_is_walk, self._robot.commands()))

    @method("walkIsActive::b()")
    def walk_is_active(self) -> bool:
        """Return whether it walks."""
        return self.move_is_active()

    @method("stopMove::b()")
    def stop_move(self) -> bool:
        """Stop walking."""
        self.kill_move()
        return True

    @method("stopWalk::b()")
    def stop_walk(self) -> bool:
        """Stop walking."""
        return self.stop_move()

    @method("killMove::v()")
    def kill_move(self) -> None:
        """Stop walking."""
        self._end_waiting()
        self._robot.stop(_is_walk)

    @method("killWalk::v()")
    def kill_walk(self) -> None:
        """Stop walking."""
        self.kill_move()

    @method("getRobotPosition::[f](b)")
    def robot_position(self, use_sensors: bool) -> list[float]:
        """Return where it is on the floor: x m, y m, theta rad from where it was switched on."""
        return list(self._robot.state().base)

    @method("getNextRobotPosition::[f]()")
    def next_robot_position(self) -> list[float]:
        """Return where it will be after the steps that it cannot change any more: here, now."""
        return list(self._robot.state().base)

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
        if chain not in arms:
            raise CallFailed("There is no arm “{chain}”. Possible: LArm, RArm, Arms.", chain=chain)
        return bool(arms[chain])

    def _walk(self, places: list[list[float]]) -> Any:
        here = (0.0, 0.0, 0.0)
        ways = []
        for x, y, theta in places:
            ways.append(("walk", _way(here, (x, y, theta))))
            here = (x, y, theta)
        return play_script(self._robot, one_by_one(ways), True, stopped=False)

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


def _is_walk(command: Command) -> bool:
    return isinstance(command.action, (Walk, Turn, WalkFreely))


def _way(here: tuple[float, float, float], there: tuple[float, float, float]) -> dict[str, float]:
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


class ALMotion(JointControl, Locomotion, BodyInfo, Places, Reaching):
    """All that moves."""

    @method("getSummary::s()")
    def summary(self) -> str:
        """Return a table of the joints: stiffness, and angle as told and as felt."""
        lines = [f"{'JointName':>16} {'Stiffness':>10} {'Command':>10} {'Sensor':>10}"]
        for joint in self._robot.robot.body.names:
            numbers = self.stiffnesses(joint) + self.angles(joint, False) + self.angles(joint, True)
            lines.append(f"{joint:>16} " + " ".join(f"{number:>10.6f}" for number in numbers))
        return "\n".join(lines)
