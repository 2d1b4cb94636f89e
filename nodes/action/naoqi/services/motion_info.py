"""The part of ALMotion that tells of the body, and of what goes on."""

from __future__ import annotations

import zlib
from typing import Any

from nodes.action.naobody.limbs import MOVING
from nodes.action.naobody.schedule import Command
from nodes.action.naoqi.server import CallFailed, method
from nodes.action.naoqi.services.arguments import EVERYTHING, chains_of, joint_names
from nodes.action.naoqi.services.module import Module, kept

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
