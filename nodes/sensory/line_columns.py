"""Which column of a line is which, by names that a person or a header line gives."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from nodes.sensory.reading import G_M_S2, Reading, vector

TIME_UNITS_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}
ACC_UNITS = {"m/s²": 1.0, "g": G_M_S2, "mg": G_M_S2 / 1000}
GYR_UNITS = {"rad/s": 1.0, "°/s": 0.017453292519943295, "m°/s": 1.7453292519943295e-5}
_SPELLINGS = {
    "m/s2": "m/s²", "m/s^2": "m/s²", "ms-2": "m/s²", "deg/s": "°/s", "dps": "°/s", "d/s": "°/s",
    "mdps": "m°/s", "rad": "rad/s", "deg": "°/s", "sec": "s",
}  # fmt: skip
_UNIT = re.compile(r"\s*(?:[(\[]\s*(?P<in>[^)\]]*?)\s*[)\]]|[\s_](?P<after>[a-zµ°/²^\d-]+))?\s*$")
_TIME = re.compile(r"(t|ts|time|timestamp|seconds|elapsed|secondselapsed)(s|ms|us|ns)?")
_ACC = re.compile(r"(?:lin|linear|user|total)?(?:a|acc|accel|acceleration|accelerometer)?([xyz])")
_GYR = re.compile(r"(?:g|gyr|gyro|gyroscope|w|rot|rotation|rotationrate)([xyz])")
_LONGEST_NAME = 60
AXES = ("ax", "ay", "az", "gx", "gy", "gz")


@dataclass(frozen=True)
class Layout:
    """What the columns are: "t", "ax" ... "gz", or "-" for one that is left out; their units."""

    roles: tuple[str, ...]
    time_unit: str = ""
    acc_unit: str = ""
    gyr_unit: str = ""
    gravity_included: bool = True

    @property
    def told(self) -> str:
        """The columns for a person: "t (ms), ax, ay, az (m/s²), gx, gy, gz (rad/s)"."""
        units = {"t": self.time_unit, "az": self.acc_unit, "gz": self.gyr_unit}
        names = [f"{role} ({units[role]})" if units.get(role) else role for role in self.roles]
        return ", ".join(names)

    def reading(self, values: Sequence[float]) -> Reading | None:
        """One line of numbers, as many as there are roles; None when they are too large."""
        found = dict(zip(self.roles, values, strict=False))
        acc = self._three(found, "a", ACC_UNITS.get(self.acc_unit, 1.0))
        gyr = self._three(found, "g", GYR_UNITS.get(self.gyr_unit, 1.0))
        if acc is None and gyr is None:
            return None
        unit_s = TIME_UNITS_S.get(self.time_unit)
        return Reading(acc, gyr, found.get("t"), unit_s, self.gravity_included)

    def _three(
        self, found: dict[str, float], kind: str, unit: float
    ) -> tuple[float, float, float] | None:
        if f"{kind}x" not in self.roles:
            return None
        return vector([found[f"{kind}{axis}"] * unit for axis in "xyz"])


def named_columns(names: Sequence[str]) -> Layout | None:
    """What columns of such names are, with the units that they tell; None without any sensor.

    A time may be ``t``, ``timestamp``, ``time_ms``; an axis ``ax``, ``acc_x``, ``gyro.z (deg/s)``,
    or ``x`` for an acceleration; ``-`` and what is unknown is left out.
    """
    roles: list[str] = []
    units = {"t": "", "a": "", "g": ""}
    for name in names:
        role, unit = _role(name)
        role = "-" if role in roles else role
        roles.append(role)
        if role != "-" and unit:
            units[role[0]] = units[role[0]] or unit
    whole = [role if role == "t" or _is_whole(role, roles) else "-" for role in roles]
    if "ax" not in whole and "gx" not in whole:
        return None
    return Layout(tuple(whole), units["t"], units["a"], units["g"])


def _role(name: str) -> tuple[str, str]:
    """What one name means, and its unit; "-" for what is not needed."""
    name = name[:_LONGEST_NAME].strip().lower()
    found = _UNIT.search(name)
    unit = (found["in"] or found["after"] or "") if found else ""
    unit = _SPELLINGS.get(unit, unit)
    known = unit in TIME_UNITS_S or unit in ACC_UNITS or unit in GYR_UNITS
    bare = name[: found.start()] if found and (known or found["in"] is not None) else name
    plain = re.sub(r"[^a-z0-9]", "", bare)
    if time := _TIME.fullmatch(plain):
        return "t", unit if unit in TIME_UNITS_S else time[2] or ""
    if axis := _GYR.fullmatch(plain):
        return f"g{axis[1]}", unit if unit in GYR_UNITS else ""
    if axis := _ACC.fullmatch(plain):
        return f"a{axis[1]}", unit if unit in ACC_UNITS else ""
    return "-", ""


def _is_whole(role: str, roles: list[str]) -> bool:
    return role != "-" and all(f"{role[0]}{axis}" in roles for axis in "xyz")
