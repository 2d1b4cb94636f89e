"""Which column of a recording is which: time, acceleration, gyroscope, gesture."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_UNIT_IN_BRACKETS = re.compile(r"[(\[].*?[)\]]")
_ACCELERATION = r"(?:lin|linear|user)?(?:a|acc|accel|acceleration|accelerometer)"
_ROTATION = r"(?:g|gyr|gyro|gyroscope|rotation|rotationrate)"
_TIME = re.compile(r"(?:t|ts|time|timestamp|seconds|elapsed|secondselapsed)(s|ms|us|ns)?")
_TIME_UNITS_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


@dataclass(frozen=True)
class Columns:
    """Where the columns of a table are, counted from 0; ``time_unit_s`` is None when unsaid."""

    time: int
    time_unit_s: float | None
    acc: tuple[int, int, int]
    gyr: tuple[int, int, int] | None
    gesture: int | None
    gravity_removed: bool

    @property
    def numbers(self) -> tuple[int, ...]:
        """The columns that hold numbers, in the order time, acceleration, gyroscope."""
        return (self.time, *self.acc, *(self.gyr or ()))

    def unit_of(self, steps: NDArray[np.float64]) -> float:
        """The unit of time in s: as the column's name says, or as ``steps`` (n - 1,) suggest."""
        return self.time_unit_s or guess_time_unit_s(float(np.median(steps)))


def find_columns(header: list[str]) -> Columns | None:
    """Find the columns by their names, in any order; None without a time or an acceleration."""
    names = [_plain(name) for name in header]
    acc = _axes(names, _ACCELERATION) or _axes(names, "")
    times = [(at, match) for at, name in enumerate(names) if (match := _TIME.fullmatch(name))]
    if acc is None or not times:
        return None
    at, match = times[0]
    return Columns(
        time=at,
        time_unit_s=_TIME_UNITS_S.get(match[1] or ""),
        acc=acc,
        gyr=_axes(names, _ROTATION),
        gesture=names.index("gesture") if "gesture" in names else None,
        gravity_removed=bool(re.search("lin|user", names[acc[0]])),
    )


def guess_time_unit_s(step: float) -> float:
    """The unit of time stamps that are ``step`` apart, for sensors of about 1 to 1,000 Hz."""
    for limit, unit in ((0.9, "s"), (900.0, "ms"), (9e5, "us")):
        if step < limit:
            return _TIME_UNITS_S[unit]
    return _TIME_UNITS_S["ns"]


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", _UNIT_IN_BRACKETS.sub("", name.lower()))


def _axes(names: list[str], what: str) -> tuple[int, int, int] | None:
    found = []
    for axis in "xyz":
        pattern = re.compile(f"{what}{axis}|{axis}{what}")
        at = next((i for i, name in enumerate(names) if pattern.fullmatch(name)), None)
        if at is None:
            return None
        found.append(at)
    return found[0], found[1], found[2]
