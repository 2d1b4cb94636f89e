"""What is asked of a robot again and again: its joints and sensors, and how it is set."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, TypeGuard

from nodes.action.naobody.body import Body
from nodes.action.naobody.parts import SINGLE_PARTS, part_of

DEVICE = "Device/SubDeviceList/{name}/Value"

SENSOR_KEYS: dict[str, tuple[str, ...]] = {
    "sonar_left": ("US/Left/Sensor",),
    "sonar_right": ("US/Right/Sensor",),
    "acc_x": ("InertialSensor/AccelerometerX/Sensor", "InertialSensor/AccX/Sensor"),
    "acc_y": ("InertialSensor/AccelerometerY/Sensor", "InertialSensor/AccY/Sensor"),
    "acc_z": ("InertialSensor/AccelerometerZ/Sensor", "InertialSensor/AccZ/Sensor"),
    "gyro_x": ("InertialSensor/GyroscopeX/Sensor", "InertialSensor/GyrX/Sensor"),
    "gyro_y": ("InertialSensor/GyroscopeY/Sensor", "InertialSensor/GyrY/Sensor"),
    "gyro_z": ("InertialSensor/GyroscopeZ/Sensor", "InertialSensor/GyrZ/Sensor"),
    "angle_x": ("InertialSensor/AngleX/Sensor",),
    "angle_y": ("InertialSensor/AngleY/Sensor",),
    "foot_left": ("LFoot/FSR/TotalWeight/Sensor",),
    "foot_right": ("RFoot/FSR/TotalWeight/Sensor",),
}
"""Our sensors, each with its names in NAOqi's memory: newer robots first."""
WEIGHT_KEYS = {"foot_left": "leftFootTotalWeight", "foot_right": "rightFootTotalWeight"}
BATTERY_KEY = "Battery/Charge/Sensor"

TOUCH_EVENTS: dict[str, tuple[str, ...]] = {
    "head_front": ("FrontTactilTouched",),
    "head_middle": ("MiddleTactilTouched",),
    "head_rear": ("RearTactilTouched",),
    "hand_left": ("HandLeftBackTouched", "HandLeftLeftTouched", "HandLeftRightTouched"),
    "hand_right": ("HandRightBackTouched", "HandRightLeftTouched", "HandRightRightTouched"),
    "bumper_left": ("LeftBumperPressed",),
    "bumper_right": ("RightBumperPressed",),
    "chest_button": ("ChestButtonPressed",),
}
"""Our touch sensors, each with the events of NAOqi that tell of it: 1 touched, 0 let go."""
CLICKED_EVENT = "ALChestButton/SimpleClickOccurred"
"""On many robots the only event of the chest button: when it was let go after a short press."""

LANGUAGES = {
    "en": "English",
    "ar": "Arabic",
    "pt_br": "Brazilian",
    "zh": "Chinese",
    "cs": "Czech",
    "da": "Danish",
    "nl": "Dutch",
    "fi": "Finnish",
    "fr": "French",
    "de": "German",
    "it": "Italian",
    "ja": "Japanese",
    "ko": "Korean",
    "pl": "Polish",
    "pt": "Portuguese",
    "ru": "Russian",
    "es": "Spanish",
    "sv": "Swedish",
    "tr": "Turkish",
}
"""NAOqi's names of languages, by ours."""

Read = Callable[[Any], None]


def quick_keys(body: Body) -> list[str]:
    """What changes while a robot moves."""
    joints = [_key(f"{name}/Position/Sensor") for name in body.names]
    sensors = [_key(name) for names in SENSOR_KEYS.values() for name in names]
    return [*joints, *sensors, *WEIGHT_KEYS.values()]


def slow_keys(body: Body) -> list[str]:
    """What changes slowly."""
    hardness = [_key(f"{name}/Hardness/Actuator") for name in body.names]
    heat = [_key(f"{name}/Temperature/Sensor") for name in body.names]
    currents = [_key(f"{name}/ElectricCurrent/Sensor") for name in body.names]
    return [*hardness, *heat, *currents, _key(BATTERY_KEY)]


def joint_angles(body: Body, values: dict[str, Any]) -> dict[str, float]:
    """The joints that were told, rad."""
    told = {name: values.get(_key(f"{name}/Position/Sensor")) for name in body.names}
    return {name: float(value) for name, value in told.items() if _is_number(value)}


def sensors(body: Body, values: dict[str, Any]) -> dict[str, float]:
    """Our sensors, as far as they were told."""
    found = dict(_sensors(values))
    for name, key in WEIGHT_KEYS.items():
        if name not in found and _is_number(values.get(key)):
            found[name] = float(values[key])
    for name in body.names:
        current = values.get(_key(f"{name}/ElectricCurrent/Sensor"))
        if _is_number(current):
            found[f"current_{name}"] = float(current)
    return found


def parts_of(body: Body) -> dict[str, list[str]]:
    """The joints of each part of the body that there is."""
    parts = {part: [n for n in body.names if part_of(body, n) == part] for part in SINGLE_PARTS}
    return {part: joints for part, joints in parts.items() if joints}


def loose_parts(body: Body, values: dict[str, Any]) -> dict[str, bool]:
    """Whether the motors of each part of the body are off, as far as that was told."""
    loose = {}
    for part, joints in parts_of(body).items():
        told = [values.get(_key(f"{name}/Hardness/Actuator")) for name in joints]
        firm = [value for value in told if _is_number(value)]
        if firm:
            loose[part] = max(firm) <= 0.0
    return loose


def battery(values: dict[str, Any]) -> float | None:
    """How full the battery is, 0 to 1; None when nobody says."""
    charge = values.get(_key(BATTERY_KEY))
    return float(charge) if _is_number(charge) else None


def hottest(body: Body, values: dict[str, Any]) -> tuple[str, float]:
    """The joint with the hottest motor, and °C; "" when nobody says."""
    heat = {name: values.get(_key(f"{name}/Temperature/Sensor")) for name in body.names}
    told = {name: float(value) for name, value in heat.items() if _is_number(value)}
    return max(told.items(), key=lambda one: one[1], default=("", 0.0))


def language_code(name: object) -> str:
    """Our word for a language of NAOqi; its own when we have none."""
    return next((code for code, known in LANGUAGES.items() if known == name), str(name))


def _sensors(values: dict[str, Any]) -> Iterator[tuple[str, float]]:
    for name, keys in SENSOR_KEYS.items():
        told = [values.get(_key(key)) for key in keys]
        value = next((one for one in told if _is_number(one)), None)
        if value is not None:
            yield name, float(value)


def _key(name: str) -> str:
    return DEVICE.format(name=name)


def _is_number(value: Any) -> TypeGuard[float]:
    is_one = isinstance(value, int | float) and not isinstance(value, bool)
    return is_one and math.isfinite(value)
