"""What the app Sensor Logger pushes, turned into readings.

Source: tszheichoi/awesome-sensor-logger, PUSHING.md (the schema of messages), UNITS.md,
COORDINATES.md and CROSSPLATFORM.md. A message is ``{"messageId", "sessionId", "deviceId",
"payload": [{"name", "time": nanoseconds since 1970, "values": {...}}, ...]}``; readings of
different sensors come in any order. ``accelerometer`` has no gravity, which is a sensor of its
own; ``totalacceleration`` (Android) and ``accelerometeruncalibrated`` have it. ``wrist motion`` is
the watch. All count in m/s² and rad/s as Android does, if "Standardise Units & Frames" is on; else
iPhones turn all axes of accelerations round, and count the uncalibrated one and those of the watch
in g.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import msgspec

from nodes.sensory.reading import G_M_S2, NS, Reading, Vector, added, finite_number, scaled, vector
from nodes.sensory.ways.joining import Timed, nearest

_WITHIN_NS = 50e6
_G_SIZES = (0.3, 3.0)  # a gravity of such a size is counted in g
_WRIST = "wristmotion"
_MOST_NAMES, _LONGEST_NAME = 8, 30
_PARTS = ("rotationRate", "gravity", "acceleration")
_USED = (*"xyz", *(f"{part}{axis}" for part in _PARTS for axis in "XYZ"))


class Message(msgspec.Struct):
    """A pushed message, as far as it is used."""

    payload: list[dict[str, object]]
    messageId: int | None = None  # noqa: N815 - the app's own names
    sessionId: str = ""  # noqa: N815
    deviceId: str = ""  # noqa: N815


@dataclass(frozen=True)
class Pushed:
    """A message's readings in the order of their times; ``used`` names their sensors.

    ``sent`` names all sensors of the message; ``broken`` counts values that are no numbers.
    """

    readings: list[Reading]
    used: str = ""
    has_wrist: bool = False
    sent: tuple[str, ...] = ()
    broken: int = 0


@dataclass
class _Sensors:
    """The sensors of a message by name, each in the order of its times."""

    by_name: dict[str, list[Timed]] = field(default_factory=dict)
    broken: int = 0

    def add(self, name: str, time: float | None, values: Vector | None) -> None:
        if time is None or values is None:
            self.broken += 1
        else:
            self.by_name.setdefault(name, []).append((time, values))

    def of(self, name: str) -> list[Timed]:
        return sorted(self.by_name.get(name, ()))


def read_message(body: bytes) -> Message | None:
    """A pushed body; None when it is none."""
    try:
        message = msgspec.json.decode(body, type=Message)
    except (msgspec.DecodeError, RecursionError):
        return None
    message.payload = [_needed(one) for one in message.payload]
    return message


def _needed(one: Mapping[str, object]) -> dict[str, object]:
    """What is used of one sensor: messages may be held back, so what else it says must go."""
    values, time = one.get("values"), one.get("time")
    kept: dict[str, object] = {"name": str(one.get("name"))[:_LONGEST_NAME]}
    if _is_short(time):
        kept["time"] = time
    if isinstance(values, dict):
        kept["values"] = {name: values[name] for name in _USED if _is_short(values.get(name))}
    return kept


def _is_short(value: object) -> bool:
    return isinstance(value, (int, float)) or (isinstance(value, str) and len(value) < 40)


def readings_of(message: Message, units: str, *, follows_wrist: bool = False) -> Pushed:
    """The readings of a message; those of the phone only, where no watch sends.

    ``units`` is "guess", "standard" or "apple", as set by the user.
    """
    sensors = _sensors(message.payload)
    has_wrist = f"{_WRIST}.rotationrate" in sensors.by_name
    uses_wrist = has_wrist or follows_wrist
    readings, used = _wrist(sensors, units) if uses_wrist else _phone(sensors, units)
    sent = dict.fromkeys(str(one.get("name"))[:_LONGEST_NAME] for one in message.payload)
    return Pushed(readings, used, has_wrist, tuple(sent)[:_MOST_NAMES], sensors.broken)


def _sensors(payload: Iterable[Mapping[str, object]]) -> _Sensors:
    found = _Sensors()
    for one in payload:
        name = str(one.get("name")).lower().replace(" ", "").replace("_", "")
        values, time = one.get("values"), finite_number(one.get("time"))
        if not isinstance(values, dict):
            continue
        if name == _WRIST:
            for part in _PARTS:
                three = vector([values.get(f"{part}{axis}") for axis in "XYZ"])
                found.add(f"{name}.{part.lower()}", time, three)
        elif "x" in values:
            found.add(name, time, vector(values))
    return found


def _wrist(sensors: _Sensors, units: str) -> tuple[list[Reading], str]:
    """Those of the watch: acceleration and gravity apart, in one time."""
    moving = sensors.of(f"{_WRIST}.acceleration")
    gravity = sensors.of(f"{_WRIST}.gravity")
    turning = sensors.of(f"{_WRIST}.rotationrate")
    is_in_g = units == "apple" or (units == "guess" and _is_in_g(gravity))
    scale = -G_M_S2 if is_in_g else 1.0
    return _joined(_sum(moving, gravity), turning, scale), "wrist motion"


def _phone(sensors: _Sensors, units: str) -> tuple[list[Reading], str]:
    """Those of the phone: the best acceleration that it sends."""
    turning = sensors.of("gyroscope") or sensors.of("gyroscopeuncalibrated")
    gravity, raw = sensors.of("gravity"), sensors.of("accelerometeruncalibrated")
    is_apple = units == "apple" or (units == "guess" and _is_in_g(raw))
    total, moving = sensors.of("totalacceleration"), sensors.of("accelerometer")
    gyroscope = " + gyroscope" if turning else ""
    if total:
        return _joined(total, turning, 1.0), f"total acceleration{gyroscope}"
    if moving and gravity:
        sign = -1.0 if is_apple else 1.0
        return _joined(_sum(moving, gravity), turning, sign), f"accelerometer + gravity{gyroscope}"
    if raw:
        scale = -G_M_S2 if is_apple else 1.0
        return _joined(raw, turning, scale), f"accelerometer uncalibrated{gyroscope}"
    sign = -1.0 if is_apple else 1.0
    return _joined(moving, turning, sign, has_gravity=False), f"accelerometer{gyroscope}"


def _is_in_g(gravity: list[Timed]) -> bool:
    """Whether the usual size is that of gravity in g."""
    sizes = sorted(sum(one * one for one in values) ** 0.5 for _, values in gravity)
    return bool(sizes) and _G_SIZES[0] < sizes[len(sizes) // 2] < _G_SIZES[1]


def _sum(moving: list[Timed], gravity: list[Timed]) -> list[Timed]:
    found = []
    for time, values in moving:
        other = nearest(gravity, time, _WITHIN_NS)
        if other is not None:
            found.append((time, added(values, other)))
    return found


def _joined(
    acc: list[Timed], turning: list[Timed], scale: float, *, has_gravity: bool = True
) -> list[Reading]:
    return [
        Reading(scaled(values, scale), nearest(turning, time, _WITHIN_NS), time, NS, has_gravity)
        for time, values in acc
    ]
