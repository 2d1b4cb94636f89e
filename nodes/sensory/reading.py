"""What one message of a sensor says: an acceleration, a rotation rate, or both."""

from __future__ import annotations

import math
from dataclasses import dataclass

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


def finite_number(value: object) -> float | None:
    """A finite number, from a number or its text; None for anything else."""
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        return None
    try:
        number = float(value)
    except (ValueError, OverflowError):
        return None
    return number if math.isfinite(number) else None


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
