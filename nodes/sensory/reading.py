"""What one message of a sensor says, and the lines of apps and watches that are messages.

A reading is an acceleration, a rotation rate, or both.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import msgspec

from nep_core.processes.manifest import finite_number
from nep_core.wire.frames import CANNOT_DECODE
from nodes.recordings import Floats

Vector = tuple[float, float, float]

G_M_S2 = 9.80665
NS = 1e-9
_LARGEST = 1e5  # no sensor of a person means more, in any unit


@dataclass(frozen=True)
class Reading:
    """An acceleration in m/s² (Android's sign), a rotation rate in rad/s, or both, at one time.

    ``stamp`` is the sender's own time; ``stamp_unit_s`` is its unit in s, None where the sender
    does not tell it. At rest, face up, ``acc`` is (0, 0, +9.81) where gravity is included.
    """

    acc: Vector | None = None
    gyr: Vector | None = None
    stamp: float | None = None
    stamp_unit_s: float | None = None
    gravity_included: bool = True


def vector(value: object) -> Vector | None:
    """Three finite numbers from ``[x, y, z]`` or ``{"x": .., "y": .., "z": ..}``, else None."""
    if isinstance(value, dict):
        value = [value.get(axis) for axis in "xyz"]
    if not isinstance(value, (list, tuple)) or len(value) != 3:
        return None
    x, y, z = (finite_number(part) for part in value)
    if x is None or y is None or z is None or max(abs(x), abs(y), abs(z)) > _LARGEST:
        return None
    return x, y, z


def scaled(parts: Vector, factor: float) -> Vector:
    """Each of the three, times a factor."""
    return parts[0] * factor, parts[1] * factor, parts[2] * factor


def added(one: Vector, other: Vector) -> Vector:
    """The sum of two vectors."""
    return one[0] + other[0], one[1] + other[1], one[2] + other[2]


# Samples in the shape of an ``/imu`` message.

Row = tuple[float, float, float]


def rows(vectors: Floats) -> list[Row]:
    """An array (n, 3) as n rows."""
    return [(x, y, z) for x, y, z in vectors.tolist()]


# Lines of the apps and watches that say themselves what they are, turned into readings.
#
# Understood (by the applications' own documentation and source):
# SensaGram ``{"type": "android.sensor.accelerometer", "timestamp": ns, "values": [x, y, z]}``
# (umer0586/SensaGram, SensorStreamer.kt),
# SensorStreamer ``{"accelerometer": {"x": .., "y": .., "z": .., "timestamp": ns},
# "gyroscope": ..}`` (yaqwsx/SensorStreamer, JsonPacketComposer.java;
# other versions write ``"value": [x, y, z]``),
# HyperIMU ``{"op": "hyperimu", "Timestamp": ms, "Accelerometer": [...], "Gyroscope": [...]}``
# (ianovir.com, HyperIMU help),
# ZIG SIM ``{"device": ..., "sensordata": {"accel": {"x": g, ...}, "gravity": ..., "gyro": ...}}``
# (1-10.github.io/zigsim),
# the paper's watch ``a;ns;x;y;z`` (acceleration) and ``y;ns;x;y;z`` (gyroscope)
# (enriquecoronadozu/smartwatches_apps).
# Acceleration is m/s² with gravity in Android's sign, rotation rad/s. Everything else is guessed
# (line_reader.py).

_MS = 1e-3
_PAPER = re.compile(r"[ay]\s*;")


def is_of_paper_watch(line: str) -> bool:
    """Whether a line begins as the paper's watch writes it."""
    return _PAPER.match(line) is not None


def read_paper_watch(line: str) -> list[Reading] | None:
    """``a;ns;x;y;z`` or ``y;ns;x;y;z``; None where it is broken."""
    kind, *cells = (cell.strip() for cell in line.split(";"))
    if cells and not cells[-1]:
        cells.pop()
    if len(cells) != 4:
        return None
    stamp, values = finite_number(cells[0]), vector(cells[1:])
    if stamp is None or values is None:
        return None
    return [_of_android(values, stamp, is_turning=kind != "a")]


def read_json(line: str) -> dict[str, object] | None:
    """A line's JSON object with its names in small letters, None where it is none."""
    try:
        found = msgspec.json.decode(line)
    except CANNOT_DECODE:
        return None
    if not isinstance(found, dict):
        return None
    return {str(name).lower(): value for name, value in found.items()}


def is_of_an_app(message: Mapping[str, object]) -> bool:
    """Whether an object is written as one of the known apps does, so that its units are known."""
    if "sensordata" in message or message.get("op") == "hyperimu":
        return True
    if str(message.get("type")).startswith("android.") or {"type", "values"} <= message.keys():
        return True
    return any(_is_streamer(message.get(name)) for name in ("accelerometer", "gyroscope"))


def read_app(message: Mapping[str, object]) -> list[Reading] | None:
    """The readings of a known app's object; none of a sensor that is not needed, None if broken."""
    if "sensordata" in message:
        return _read_zig_sim(message)
    if message.get("op") == "hyperimu":
        acc, gyr = vector(message.get("accelerometer")), vector(message.get("gyroscope"))
        if acc is None and gyr is None:
            return None
        return [Reading(acc, gyr, finite_number(message.get("timestamp")), _MS)]
    if "type" in message:
        return read_android(message)
    readings: list[Reading] = []
    for name in ("accelerometer", "gyroscope"):
        part = message.get(name)
        if not isinstance(part, dict):
            continue
        values = vector(part.get("value", part))
        stamp = finite_number(part.get("timestamp"))
        if values is not None:
            readings.append(_of_android(values, stamp, is_turning=name == "gyroscope"))
    return readings or None


def read_android(message: Mapping[str, object], kind: str = "") -> list[Reading] | None:
    """An Android sensor event; ``kind`` is its sensor where it does not say so itself."""
    kind = kind or str(message.get("type"))
    if kind not in ("android.sensor.accelerometer", "android.sensor.gyroscope"):
        return []
    three, stamp = vector(message.get("values")), finite_number(message.get("timestamp"))
    if three is None:
        return None
    return [_of_android(three, stamp, is_turning=kind == "android.sensor.gyroscope")]


def _of_android(values: Vector, stamp: float | None, *, is_turning: bool) -> Reading:
    """What the gyroscope, or else the accelerometer, says; Android counts nanoseconds."""
    if is_turning:
        return Reading(gyr=values, stamp=stamp, stamp_unit_s=NS)
    return Reading(acc=values, stamp=stamp, stamp_unit_s=NS)


def _is_streamer(part: object) -> bool:
    return isinstance(part, dict) and "timestamp" in part and ("value" in part or "x" in part)


def _read_zig_sim(message: Mapping[str, object]) -> list[Reading] | None:
    """Acceleration in g, gravity apart; iOS counts both towards the earth, Android upward."""
    sensors, device = message["sensordata"], message.get("device")
    if not isinstance(sensors, dict):
        return None
    android = isinstance(device, dict) and str(device.get("os")).lower() == "android"
    scale = G_M_S2 if android else -G_M_S2
    moving, gravity = vector(sensors.get("accel")), vector(sensors.get("gravity"))
    gyr = vector(sensors.get("gyro"))
    acc = scaled(added(moving, gravity or (0.0, 0.0, 0.0)), scale) if moving else None
    if acc is None and gyr is None:
        return None
    return [Reading(acc, gyr, gravity_included=gravity is not None)]
