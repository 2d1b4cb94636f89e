"""A real robot as tasks see it: its services, and what was last heard of its body."""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeGuard

import numpy as np

from faults import Text
from robots.body.body import PLAIN_NAMES, SINGLE_PARTS, Angles, Body, part_of, parts_of_limbs
from robots.body.limbs import Limb
from robots.body.pose import VirtualRobot
from robots.errors import ActionFailed
from robots.naoqi.services.arguments import CODES

from .calls import ANSWER_S, Calling, Calls

# What is asked of a robot again and again: its joints and sensors, and how it is set.

DEVICE = "Device/SubDeviceList/{name}/Value"

SENSOR_KEYS: dict[str, tuple[str, ...]] = {
    "sonar_left": ("US/Left/Sensor",),
    "sonar_right": ("US/Right/Sensor",),
    **{
        f"{ours}_{axis.lower()}": tuple(f"InertialSensor/{one}{axis}/Sensor" for one in names)
        for ours, names in (("acc", ("Accelerometer", "Acc")), ("gyro", ("Gyroscope", "Gyr")))
        for axis in "XYZ"
    },
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
    return _of_joints(body, values, "Position/Sensor")


def sensors(body: Body, values: dict[str, Any]) -> dict[str, float]:
    """Our sensors, as far as they were told."""
    currents = _of_joints(body, values, "ElectricCurrent/Sensor")
    found = {f"current_{name}": current for name, current in currents.items()}
    for name, keys in SENSOR_KEYS.items():
        told = [values.get(key) for key in (*map(_key, keys), WEIGHT_KEYS.get(name, ""))]
        value = next((one for one in told if _is_number(one)), None)
        if value is not None:
            found[name] = float(value)
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
    told = _of_joints(body, values, "Temperature/Sensor")
    return max(told.items(), key=lambda one: one[1], default=("", 0.0))


def language_code(name: object) -> str:
    """Our word for a language of NAOqi; its own when we have none."""
    return CODES.get(str(name), str(name))


def _of_joints(body: Body, values: dict[str, Any], what: str) -> dict[str, float]:
    """Something that is measured at each joint, as far as it was told."""
    told = {name: values.get(_key(f"{name}/{what}")) for name in body.names}
    return {name: float(value) for name, value in told.items() if _is_number(value)}


def _key(name: str) -> str:
    return DEVICE.format(name=name)


def _is_number(value: Any) -> TypeGuard[float]:
    is_one = isinstance(value, int | float) and not isinstance(value, bool)
    return is_one and math.isfinite(value)


NEAR_RAD = 0.14
"""So far (8 degrees) a joint may be from where it was sent: motors give way a little."""
HANDS_NEAR = 0.35
"""The same for hands, which count 0 to 1 and are soft."""
LARGEST_RAD = 10.0
"""No joint of a robot turns so far."""
SETTLING_S = 0.6
"""So long joints may still move after NAOqi says that they are there."""
LIFE_S = 8.0
LIFE_OFF = "disabled"
"""NAOqi's word for a robot that does nothing by itself."""
UPRIGHT = (0.0, 0.0, -1.0)


@dataclass
class RealRobot:
    """``known`` is a picture of the robot, kept true by what it is asked again and again.

    ``torso``: as in RobotState. ``life_is_off``: its own life was switched off already, so that
    only programs move it. ``hottest``: the joint with the hottest motor, and its °C.
    """

    known: VirtualRobot
    calls: Calls
    sensors: dict[str, float] = field(default_factory=dict)
    battery: float = 1.0
    torso: tuple[float, float, float, float, float, float] | None = None
    has_fallen: bool = False
    life_is_off: bool = False
    hottest: tuple[str, float] = ("", 0.0)
    _is_taking_over: bool = False

    @property
    def name(self) -> str:
        """The robot's name."""
        return self.known.name

    @property
    def parts(self) -> dict[str, list[str]]:
        """The joints of each part of the body that can be locked and released."""
        return parts_of(self.known.body)

    def call(
        self, service: str, method: str, *args: Any, limit_s: float = ANSWER_S, uses: object = ()
    ) -> Calling:
        """Call a service and wait for its answer (see Calls)."""
        return self.calls.call(service, method, *args, limit_s=limit_s, uses=uses)

    def names(self, limbs: Collection[Limb]) -> list[str]:
        """The joints of some limbs."""
        return [self.known.body.names[column] for column in self.known.body.columns(limbs)]

    def check_locked(self, limbs: frozenset[Limb]) -> None:
        """Raise ActionFailed when the motors of a limb are off."""
        if loose := sorted(parts_of_limbs(limbs) & self.known.released):
            raise ActionFailed(
                "{name}'s {loose} is released and cannot move. Lock it first, or let the robot "
                "wake up.",
                name=self.name,
                loose=Text(PLAIN_NAMES[loose[0]]),
            )

    def take_over(self) -> Calling:
        """Switch the robot's own life off once, so that nothing else moves it."""
        while self._is_taking_over:
            yield  # for another movement, which waits for it too
        if self.life_is_off:
            return
        self._is_taking_over = True
        try:
            if self.calls.has("ALAutonomousLife", "setState"):
                state = yield from self.call("ALAutonomousLife", "getState")
                if state != LIFE_OFF:
                    yield from self.calls.finished(self._end_life())
            self.life_is_off = True
        finally:
            self._is_taking_over = False

    def _end_life(self) -> Calling:
        was_awake = not self.known.released
        yield from self.call("ALAutonomousLife", "setState", LIFE_OFF, limit_s=LIFE_S)
        self.life_is_off = True  # also when this is finished after it was stopped
        if was_awake and self.calls.has("ALMotion", "wakeUp"):
            awake = yield from self.call("ALMotion", "robotIsWakeUp")
            if not awake:  # many robots sit down when their own life ends
                yield from self.call("ALMotion", "wakeUp", limit_s=20.0)
        return ""

    def measure(self, joints: Sequence[str]) -> Calling:
        """Ask where some joints are now; rad by name."""
        names = list(joints)
        angles = yield from self.call("ALMotion", "getAngles", names, True)
        measured = dict(zip(names, map(float, angles), strict=False))
        self.take_in(measured)
        return measured

    def check_reached(self, goal: Mapping[str, float]) -> Calling:
        """Raise ActionFailed when joints are not where they were sent, and do not get there."""
        end_s = time.monotonic() + SETTLING_S
        while missed := _missed(goal, (yield from self.measure(list(goal)))):
            if time.monotonic() > end_s:
                raise ActionFailed(
                    "{name}'s joint {missed} did not get where it was sent. Look whether something "
                    "holds it, or whether its motors are hot.",
                    name=self.name,
                    missed=missed,
                )

    def take_in(self, angles: Mapping[str, float]) -> None:
        """Keep where joints are; what cannot be an angle is left out."""
        index = self.known.body.index
        for name, angle in angles.items():
            if name in index and abs(angle) <= LARGEST_RAD:  # which "not a number" is not
                self.known.angles[index[name]] = angle

    def be_at(self, place: Sequence[float]) -> tuple[float, float, float]:
        """Keep where the robot is on the floor (x m, y m, theta rad). Raises ValueError."""
        x, y, theta = map(float, place)
        if not all(map(math.isfinite, (x, y, theta))):
            raise ValueError("a place that is none")
        self.known.base[:] = x, y, theta
        return x, y, theta

    def stand_as_told(self) -> None:
        """Let the picture stand on the floor as its joints and its place say."""
        known = self.known
        posture = known.body.postures.get(known.posture)
        down = posture.down if posture is not None else UPRIGHT
        known.stance.put_down(known.angles, known.base, down)

    def goal_of(self, angles: Mapping[str, float]) -> tuple[dict[str, float], list[str]]:
        """Return the nearest angles that joints can have, and the joints that were clamped."""
        body = self.known.body
        goal = self.known.angles.copy()
        for name, angle in angles.items():
            motor = body.same_motor.get(name, name)
            for other in (name, motor):
                goal[body.index[other]] = angle
        allowed, clamped = body.clamped(goal)
        clamped = [name for name in clamped if name in angles]
        return self.picked(allowed, angles), clamped

    def picked(self, angles: Angles, joints: Iterable[str]) -> dict[str, float]:
        """Return some joints out of the angles of all."""
        body = self.known.body
        return {name: float(angles[body.index[name]]) for name in joints}

    def go_to(self, goal: Mapping[str, float], speed: float) -> Calling:
        """Move joints to angles, with at most a part of their top speed, and look that they are."""
        if not goal:
            return
        names, angles, body = list(goal), list(goal.values()), self.known.body
        columns = [body.index[name] for name in names]
        # How long the slowest joint needs at its top speed, generously
        needed_s = 3.0 * np.abs(self.known.angles[columns] - angles) / body.max_speed[columns]
        limit_s = 4.0 + float(needed_s.max()) / speed
        yield from self.call(
            "ALMotion",
            "angleInterpolationWithSpeed",
            names,
            angles,
            float(speed),
            limit_s=limit_s,
            uses=names,
        )
        yield from self.check_reached(goal)


def _missed(goal: Mapping[str, float], measured: Mapping[str, float]) -> str:
    """A joint that is not where it should be, "" when all are."""
    for name, angle in goal.items():
        near = HANDS_NEAR if name.endswith("Hand") else NEAR_RAD
        if abs(measured.get(name, angle) - angle) > near:
            return name
    return ""
