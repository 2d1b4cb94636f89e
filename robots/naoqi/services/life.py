"""The small services: a NAO's life of its own, touch, battery, temperature, the system itself."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from robots.naoqi.server.module import VERSION
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.service import method

from .arguments import chains_of, one_of
from .memory import TOUCH_NAMES
from .module import Module, always, kept, kept_each

STATES = ("solitary", "interactive", "disabled", "safeguard")
STIMULI = ("Sound", "Movement", "NavigationMotion", "People", "Touch", "TabletTouch")
ABILITIES = (
    "AutonomousBlinking",
    "BackgroundMovement",
    "BasicAwareness",
    "ListeningMovement",
    "SpeakingMovement",
)


class ALBasicAwareness(Module):
    """Looks at people by itself."""

    engagement = kept(
        "getEngagementMode::s()", "Unengaged", ("Unengaged", "SemiEngaged", "FullyEngaged")
    )
    tracking = kept(
        "getTrackingMode::s()", "Head", ("Head", "BodyRotation", "WholeBody", "MoveContextually")
    )

    set_enabled = method("setEnabled::v(b)")(lambda self, is_on: self._do("awareness", on=is_on))

    is_enabled = method("isEnabled::b()", "isRunning::b()", "isAwarenessRunning::b()")(
        lambda self: bool(self._robot.state().settings["awareness"])
    )
    begin = method("startAwareness::v()", "resumeAwareness::v()")(
        lambda self: self.set_enabled(True)
    )
    end = method("stopAwareness::v()", "pauseAwareness::v()")(lambda self: self.set_enabled(False))
    is_awareness_paused = method("isAwarenessPaused::b()")(lambda self: not self.is_enabled())

    stimulus = kept_each(
        "isStimulusDetectionEnabled::b(s)",
        True,
        known=lambda self, name: one_of(
            name, STIMULI, "There is no stimulus “{name}”. Possible: {stimuli}."
        ),
    )

    @method("setParameter::v(sm)")
    def set_parameter(self, name: str, value: Any) -> None:
        """Remember how it looks at people."""
        self._kept[f"parameter {name}"] = value

    @method("getParameter::m(s)")
    def parameter(self, name: str) -> Any:
        """Return how it looks at people."""
        if f"parameter {name}" not in self._kept:
            raise CallFailed("There is no parameter “{name}”.", name=name)
        return self._kept[f"parameter {name}"]

    reset_all_parameters = method("resetAllParameters::v()")(lambda self: self._kept.clear())


class ALAutonomousLife(Module):
    """What the robot does by itself when nobody asks anything: nothing, until it is told to."""

    def __init__(self, robot: ServedRobot) -> None:
        super().__init__(robot)
        self._state = "disabled"
        self._history = [(self._state, int(time.time()))]

    @method("setState::v(s)")
    def set_state(self, state: str) -> Any:
        """Let it live by itself (solitary, interactive), or not (disabled)."""
        self._state = one_of(state, STATES, "There is no state “{state}”. Possible: {states}.")
        self._history.append((state, int(time.time())))
        return self._do("awareness", on=state in ("solitary", "interactive"))

    state = method("getState::s()")(lambda self: self._state)
    # The states that it was in, with the seconds of their beginning
    state_history = method("getStateHistory::[(si)]()")(lambda self: list(self._history))
    # The program that it plays by itself: none
    focused_activity = always("", "focusedActivity::s()")
    # Stop the programs that it plays by itself: there are none
    stop_all = always(None, "stopFocus::v()", "stopAll::v()")

    ability = kept_each(
        "getAutonomousAbilityEnabled::b(s)",
        True,
        known=lambda self, ability: one_of(
            ability, ABILITIES, "There is no ability “{ability}”. Possible: {known}."
        ),
    )
    safeguard = kept_each("isSafeguardEnabled::b(s)", True)
    # How high above the floor it stands, m
    offset = kept("getRobotOffsetFromFloor::f()", 0.0)

    life_time = method("getLifeTime::i()")(lambda self: int(time.time()) - self._history[0][1])


class ALBackgroundMovement(Module):
    """Moves a little, as if it breathed, while nothing else moves it."""

    set_enabled = method("setEnabled::v(b)")(lambda self, is_on: self._do("breathing", on=is_on))

    is_enabled = method("isEnabled::b()", "isRunning::b()")(
        lambda self: bool(self._robot.state().settings["breathing"])
    )


class ALSpeakingMovement(Module):
    """Remembers whether it may move while it speaks."""

    enabled = kept("isEnabled::b()", True)
    mode = kept("getMode::s()", "contextual", ("contextual", "random", "disabled"))

    runs = method("isRunning::b()")(
        lambda self: bool(self.enabled() and self._robot.state().saying)
    )


class ALListeningMovement(Module):
    """Remembers whether it may move while it listens."""

    enabled = kept("isEnabled::b()", True)

    runs = method("isRunning::b()")(
        lambda self: bool(self.enabled() and self._robot.state().listening)
    )


class ALAutonomousBlinking(Module):
    """Remembers whether its eyes may blink."""

    enabled = kept("isEnabled::b()", True)


# The body and the system: touch, battery, temperature, names and versions.


class ALTouch(Module):
    """Which sensors are touched."""

    sensor_list = method("getSensorList::[s]()")(lambda self: list(TOUCH_NAMES.values()))

    @method("getStatus::m()")
    def status(self) -> list[list[Any]]:
        """Return for each sensor its name and whether it is touched."""
        sensors = self._robot.state().sensors
        return [[name, sensors.get(sensor, 0.0) > 0.0, []] for sensor, name in TOUCH_NAMES.items()]


class ALBattery(Module):
    """How full the battery is."""

    # How full it is, in percent
    charge = method("getBatteryCharge::i()")(lambda self: round(self._robot.state().battery * 100))


class ALBodyTemperature(Module):
    """How hot the motors are: never too hot."""

    # What is too hot: nothing, which NAOqi tells with no value
    diagnosis = always(None, "getTemperatureDiagnosis::m()")

    notifications = kept(
        "areNotificationsEnabled::b()", True, setter="setEnableNotifications::v(b)"
    )


class ALSystem(Module):
    """The name and the version of the robot."""

    robot_name = method("robotName::s()")(lambda self: self._robot.name)
    # False: the robot has the name that it has on the Robots page
    set_robot_name = always(False, "setRobotName::b(s)")
    system_version = always(VERSION, "systemVersion::s()")
    # The version before the last change: there was none
    previous_system_version = always("", "previousSystemVersion::s()")
    timezone = method("timezone::s()")(lambda self: time.tzname[0])

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

    robot_type = method("getRobotType::s()")(
        lambda self: Path(self._robot.robot.model).name.capitalize() or "Nao"
    )
    config = always(
        "Body/Type nao\nHead/BaseVersion VERSION_60\nBody/BaseVersion VERSION_60", "getConfig::s()"
    )

    has_arms = method("hasArms::b()")(lambda self: "LArm" in chains_of(self._robot.robot.body))
    has_hands = method("hasHands::b()")(lambda self: "LHand" in self._robot.robot.body.index)
    has_legs = method("hasLegs::b()")(lambda self: "LLeg" in chains_of(self._robot.robot.body))
