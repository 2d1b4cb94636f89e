"""What a NAO's sensors write into ALMemory, by NAOqi's keys, read from the robot's state."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from nep_core.messages import RobotState
from nodes.action.naobody.motor_tasks import stiffness
from nodes.action.naoqi.services.memory import Reader
from nodes.action.naoqi.services.posture import family_of, posture_of
from nodes.action.naoqi.serving import ServedRobot

DEVICE = "Device/SubDeviceList"
TOUCH_EVENTS = {
    "head_front": "FrontTactilTouched",
    "head_middle": "MiddleTactilTouched",
    "head_rear": "RearTactilTouched",
    "hand_left": "HandLeftBackTouched",
    "hand_right": "HandRightBackTouched",
    "bumper_left": "LeftBumperPressed",
    "bumper_right": "RightBumperPressed",
    "chest_button": "ChestButtonPressed",
}
"""The events of what is touched, by sensor."""
TOUCH_NAMES = {
    "head_front": "Head/Touch/Front",
    "head_middle": "Head/Touch/Middle",
    "head_rear": "Head/Touch/Rear",
    "hand_left": "LHand/Touch/Back",
    "hand_right": "RHand/Touch/Back",
    "bumper_left": "LFoot/Bumper/Left",
    "bumper_right": "RFoot/Bumper/Right",
}
"""What ALTouch calls them."""
MEASURES = {
    f"{DEVICE}/US/Left/Sensor/Value": "sonar_left",
    f"{DEVICE}/US/Right/Sensor/Value": "sonar_right",
    f"{DEVICE}/InertialSensor/AccelerometerX/Sensor/Value": "acc_x",
    f"{DEVICE}/InertialSensor/AccelerometerY/Sensor/Value": "acc_y",
    f"{DEVICE}/InertialSensor/AccelerometerZ/Sensor/Value": "acc_z",
    f"{DEVICE}/InertialSensor/GyroscopeX/Sensor/Value": "gyro_x",
    f"{DEVICE}/InertialSensor/GyroscopeY/Sensor/Value": "gyro_y",
    f"{DEVICE}/InertialSensor/GyroscopeZ/Sensor/Value": "gyro_z",
    f"{DEVICE}/LFoot/FSR/TotalWeight/Sensor/Value": "foot_left",
    f"{DEVICE}/RFoot/FSR/TotalWeight/Sensor/Value": "foot_right",
    "leftFootTotalWeight": "foot_left",
    "rightFootTotalWeight": "foot_right",
    f"{DEVICE}/Head/Touch/Front/Sensor/Value": "head_front",
    f"{DEVICE}/Head/Touch/Middle/Sensor/Value": "head_middle",
    f"{DEVICE}/Head/Touch/Rear/Sensor/Value": "head_rear",
    f"{DEVICE}/LHand/Touch/Back/Sensor/Value": "hand_left",
    f"{DEVICE}/RHand/Touch/Back/Sensor/Value": "hand_right",
    f"{DEVICE}/LFoot/Bumper/Left/Sensor/Value": "bumper_left",
    f"{DEVICE}/RFoot/Bumper/Right/Sensor/Value": "bumper_right",
    f"{DEVICE}/ChestBoard/Button/Sensor/Value": "chest_button",
    **{event: sensor for sensor, event in TOUCH_EVENTS.items()},
}
"""The keys of what RobotState.sensors measures."""


def keys_of(robot: ServedRobot) -> dict[str, Reader]:
    """Return all keys that a robot's state gives a value."""

    def of_state(read: Callable[[RobotState], Any]) -> Reader:
        return lambda: read(robot.state())

    def of_sensor(name: str) -> Reader:
        return of_state(lambda state: state.sensors.get(name, 0.0))

    keys = {key: of_sensor(sensor) for key, sensor in MEASURES.items()}
    for joint in robot.robot.body.names:
        keys |= _keys_of_joint(robot, joint)
    return keys | {
        f"{DEVICE}/Battery/Charge/Sensor/Value": of_state(lambda state: state.battery),
        "BatteryChargeChanged": of_state(lambda state: round(state.battery * 100)),
        "robotIsWakeUp": of_state(lambda state: bool(state.settings["awake"])),
        "ALTextToSpeech/CurrentSentence": of_state(lambda state: state.saying),
        "PostureChanged": lambda: posture_of(robot.robot),
        "PostureFamilyChanged": lambda: family_of(robot.robot),
        "RobotConfig/Body/Type": lambda: "nao",
        "RobotConfig/Head/BaseVersion": lambda: "VERSION_60",
        "RobotConfig/Body/BaseVersion": lambda: "VERSION_60",
        "DCM/Time": lambda: int(time.monotonic() * 1000) & 0x7FFFFFFF,
    }


def _keys_of_joint(robot: ServedRobot, joint: str) -> dict[str, Reader]:
    def angle() -> float:
        return robot.state().joints[joint]

    return {
        f"{DEVICE}/{joint}/Position/Sensor/Value": angle,
        f"{DEVICE}/{joint}/Position/Actuator/Value": angle,
        f"{DEVICE}/{joint}/ElectricCurrent/Sensor/Value": lambda: robot.state().sensors.get(
            f"current_{joint}", 0.0
        ),
        f"{DEVICE}/{joint}/Hardness/Actuator/Value": lambda: stiffness(robot.robot, joint),
    }
