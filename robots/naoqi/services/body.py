"""The small services of the body: touch, battery, temperature, and the system itself."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from robots.naoqi.server.module import VERSION
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import chains_of
from .memory import TOUCH_NAMES
from .module import Module


class ALTouch(Module):
    """Which sensors are touched."""

    @method("getSensorList::[s]()")
    def sensor_list(self) -> list[str]:
        """Return the names of the sensors."""
        return list(TOUCH_NAMES.values())

    @method("getStatus::m()")
    def status(self) -> list[list[Any]]:
        """Return for each sensor its name and whether it is touched."""
        sensors = self._robot.state().sensors
        return [[name, sensors.get(sensor, 0.0) > 0.0, []] for sensor, name in TOUCH_NAMES.items()]


class ALBattery(Module):
    """How full the battery is."""

    @method("getBatteryCharge::i()")
    def charge(self) -> int:
        """Return how full it is, in percent."""
        return round(self._robot.state().battery * 100)


class ALBodyTemperature(Module):
    """How hot the motors are: never too hot."""

    @method("getTemperatureDiagnosis::m()")
    def diagnosis(self) -> Any:
        """Return what is too hot: nothing, which NAOqi tells with no value."""
        return None

    @method("setEnableNotifications::v(b)")
    def set_notifications(self, is_on: bool) -> None:
        """Remember whether the robot says when it is hot."""
        self._kept["notifications"] = is_on

    @method("areNotificationsEnabled::b()")
    def notifications(self) -> bool:
        """Return whether the robot says when it is hot."""
        return bool(self._kept.get("notifications", True))


class ALSystem(Module):
    """The name and the version of the robot."""

    @method("robotName::s()")
    def robot_name(self) -> str:
        """Return the robot's name."""
        return self._robot.name

    @method("setRobotName::b(s)")
    def set_robot_name(self, name: str) -> bool:
        """Return false: the robot has the name that it has on the Robots page."""
        return False

    @method("systemVersion::s()")
    def system_version(self) -> str:
        """Return the version of the system."""
        return VERSION

    @method("previousSystemVersion::s()")
    def previous_system_version(self) -> str:
        """Return the version before the last change: there was none."""
        return ""

    @method("timezone::s()")
    def timezone(self) -> str:
        """Return the time zone."""
        return time.tzname[0]

    @method("shutdown::v()")
    def shutdown(self) -> None:
        """Raise CallFailed: its window switches it off."""
        raise CallFailed("The robot on the screen is switched off by stopping its node.")

    @method("reboot::v()")
    def reboot(self) -> None:
        """Raise CallFailed: its window starts it again."""
        raise CallFailed("The robot on the screen is started again by restarting its node.")


class ALRobotModel(Module):
    """What kind of robot it is."""

    @method("getRobotType::s()")
    def robot_type(self) -> str:
        """Return the kind of robot."""
        return Path(self._robot.robot.model).name.capitalize() or "Nao"

    @method("getConfig::s()")
    def config(self) -> str:
        """Return the kind of robot and its version, as text."""
        return "Body/Type nao\nHead/BaseVersion VERSION_60\nBody/BaseVersion VERSION_60"

    @method("hasArms::b()")
    def has_arms(self) -> bool:
        """Return whether it has arms."""
        return "LArm" in chains_of(self._robot.robot.body)

    @method("hasHands::b()")
    def has_hands(self) -> bool:
        """Return whether it has hands."""
        return "LHand" in self._robot.robot.body.index

    @method("hasLegs::b()")
    def has_legs(self) -> bool:
        """Return whether it has legs."""
        return "LLeg" in chains_of(self._robot.robot.body)
