"""What phones and watches write on a line: JSON or CSV, turned into readings.

Understood (source: the applications' own documentation):
SensaGram ``{"type": "android.sensor.accelerometer", "timestamp": ns, "values": [x, y, z]}``,
SensorStreamer ``{"accelerometer": {"value": [x, y, z], "timestamp": ns}, "gyroscope": ...}``,
HyperIMU ``{"Timestamp": ms, "Accelerometer": [...], "Gyroscope": [...]}`` and its CSV,
ZIG SIM ``{"device": ..., "sensordata": {"accel": {"x": g, ...}, "gravity": ..., "gyro": ...}}``,
plain ``{"t": s, "acc": [x, y, z], "gyr": [x, y, z]}``,
the paper's watch ``a;ns;x;y;z`` (acceleration) and ``y;ns;x;y;z`` (gyroscope),
CSV ``x,y,z``, ``x,y,z,gx,gy,gz``, and both with a time in front.
Acceleration is m/s² with gravity in Android's sign, rotation rad/s.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import msgspec

Vector = tuple[float, float, float]

_LONGEST_LINE = 8_192
_LARGEST = 1e5  # no sensor of a person means more
_G_M_S2 = 9.80665
_NS = 1e-9
_SEPARATORS = re.compile(r"[;,\t]|\s+")
_ACC_NAMES = ("acc", "accel", "acceleration", "accelerometer")
_GYR_NAMES = ("gyr", "gyro", "gyroscope", "rotationrate")
_TIME_NAMES = ("t", "time", "timestamp", "ts")


@dataclass(frozen=True)
class Reading:
    """One line: an acceleration, a rotation rate, or both; ``stamp`` is the sender's time.

    ``stamp_unit_s`` is None where the line does not tell the unit of its time.
    """

    acc: Vector | None = None
    gyr: Vector | None = None
    stamp: float | None = None
    stamp_unit_s: float | None = None
    gravity_included: bool = True


def read_datagram(datagram: bytes) -> tuple[list[Reading], str]:
    """All readings of a packet, and the first line that could not be read ("" when all could)."""
    readings: list[Reading] = []
    unreadable = ""
    for line in datagram.decode("utf-8", errors="replace").splitlines():
        if not line.strip():
            continue
        found = read_line(line)
        if found is None:
            unreadable = unreadable or line[:60]
        else:
            readings.extend(found)
    return readings, unreadable


def read_line(line: str) -> list[Reading] | None:
    """The readings of one line; none for a sensor that is not needed, None for what is unknown."""
    line = line.strip()
    if len(line) > _LONGEST_LINE:
        return None
    return _read_json(line) if line.startswith("{") else _read_values(line)


def _read_values(line: str) -> list[Reading] | None:
    cells = [cell for cell in _SEPARATORS.split(line) if cell]
    if cells and cells[0] in ("a", "y"):
        return _read_paper_watch(cells[0], cells[1:])
    numbers = [_number(cell) for cell in cells]
    if len(numbers) < 3 or len(numbers) % 3 == 2 or None in numbers:
        return None
    has_time = len(numbers) % 3 == 1
    vectors = numbers[1:] if has_time else numbers
    return _reading(
        acc=_vector(vectors[:3]), gyr=_vector(vectors[3:6]), stamp=numbers[0] if has_time else None
    )


def _read_paper_watch(kind: str, cells: list[str]) -> list[Reading] | None:
    if len(cells) != 4:
        return None
    stamp, values = _number(cells[0]), _vector(cells[1:])
    if stamp is None:
        return None
    if kind == "a":
        return _reading(acc=values, stamp=stamp, unit_s=_NS)
    return _reading(gyr=values, stamp=stamp, unit_s=_NS)


def _read_json(line: str) -> list[Reading] | None:
    try:
        found = msgspec.json.decode(line)
    except (msgspec.DecodeError, RecursionError):
        return None
    message = {str(name).lower(): value for name, value in found.items()}
    if "sensordata" in message:
        return _read_zig_sim(message)
    if "type" in message and "values" in message:
        return _read_sensagram(message)
    stamp = _number(_first(message, _TIME_NAMES))
    acc, gyr = _first(message, _ACC_NAMES), _first(message, _GYR_NAMES)
    if _is_streamer(acc) or _is_streamer(gyr):
        return _read_streamer(acc, gyr)
    return _reading(acc=_vector(acc), gyr=_vector(gyr), stamp=stamp)


def _read_sensagram(message: dict[str, object]) -> list[Reading] | None:
    kind, values = str(message["type"]), _vector(message["values"])
    stamp = _number(message.get("timestamp"))
    if kind == "android.sensor.accelerometer":
        return _reading(acc=values, stamp=stamp, unit_s=_NS)
    if kind == "android.sensor.gyroscope":
        return _reading(gyr=values, stamp=stamp, unit_s=_NS)
    return []


def _is_streamer(part: object) -> bool:
    return isinstance(part, dict) and "value" in part


def _read_streamer(acc: object, gyr: object) -> list[Reading] | None:
    readings: list[Reading] = []
    if isinstance(acc, dict):
        stamp = _number(acc.get("timestamp"))
        readings += _reading(acc=_vector(acc.get("value")), stamp=stamp, unit_s=_NS) or []
    if isinstance(gyr, dict):
        stamp = _number(gyr.get("timestamp"))
        readings += _reading(gyr=_vector(gyr.get("value")), stamp=stamp, unit_s=_NS) or []
    return readings or None


def _read_zig_sim(message: dict[str, object]) -> list[Reading] | None:
    """Acceleration in g, gravity apart; iOS counts both towards the earth, Android upward."""
    sensors, device = message["sensordata"], message.get("device")
    if not isinstance(sensors, dict):
        return None
    android = isinstance(device, dict) and str(device.get("os")).lower() == "android"
    scale = _G_M_S2 if android else -_G_M_S2
    moving, gravity = _vector(sensors.get("accel")), _vector(sensors.get("gravity"))
    acc = None
    if moving:
        gx, gy, gz = gravity or (0.0, 0.0, 0.0)
        acc = ((moving[0] + gx) * scale, (moving[1] + gy) * scale, (moving[2] + gz) * scale)
    return _reading(acc, _vector(sensors.get("gyro")), gravity_included=gravity is not None)


def _reading(
    acc: Vector | None = None,
    gyr: Vector | None = None,
    stamp: float | None = None,
    unit_s: float | None = None,
    gravity_included: bool = True,
) -> list[Reading] | None:
    if acc is None and gyr is None:
        return None
    return [Reading(acc, gyr, stamp, unit_s, gravity_included)]


def _first(message: dict[str, object], names: tuple[str, ...]) -> object:
    return next((message[name] for name in names if name in message), None)


def _vector(value: object) -> Vector | None:
    """Three finite numbers from ``[x, y, z]`` or ``{"x": .., "y": .., "z": ..}``."""
    if isinstance(value, dict):
        value = [value.get(axis) for axis in "xyz"]
    if not isinstance(value, list) or len(value) != 3:
        return None
    x, y, z = (_number(part) for part in value)
    if x is None or y is None or z is None or max(abs(x), abs(y), abs(z)) > _LARGEST:
        return None
    return x, y, z


def _number(value: object) -> float | None:
    """A finite number, from a number or its text."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        return None
    try:
        number = float(value)
    except (ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None
