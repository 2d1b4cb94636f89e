"""What a Bluetooth device sends when it moves: read from a file, checked, and used to decode."""

from __future__ import annotations

import math
import struct
import tomllib
import uuid
from collections.abc import Iterable
from functools import cached_property
from pathlib import Path
from typing import Annotated, Literal

import msgspec

from nep_core.errors import NodeStartError
from nodes.resources import resource_folder
from nodes.sensory.phone_page.certificate import certificate_folder
from nodes.sensory.reading import G_M_S2, Reading, Vector

FOLDER = "imu_profiles"
CODES = {
    "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I",
    "float32": "f", "float64": "d",
}  # fmt: skip
ORDERS = {"little": "<", "big": ">"}
UNITS = {
    "m/s²": 1.0, "g": G_M_S2, "mg": G_M_S2 / 1000,
    "rad/s": 1.0, "deg/s": math.pi / 180,
    "s": 1.0, "ms": 1e-3, "µs": 1e-6,
}  # fmt: skip
"""What each unit is in ours: m/s², rad/s, s."""
_FITTING = {"a": ("m/s²", "g", "mg"), "g": ("rad/s", "deg/s"), "t": ("s", "ms", "µs")}
_ACC, _GYR = ("ax", "ay", "az"), ("gx", "gy", "gz")
_LARGEST = 1e5

Meaning = Literal["t", "ax", "ay", "az", "gx", "gy", "gz", "skip"]
Type = Literal["int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"]


class Field(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A number in a message: what it is, how it is written, and what 1 of it is in ``unit``."""

    is_: Meaning = msgspec.field(name="is")
    type: Type
    unit: Literal["m/s²", "g", "mg", "rad/s", "deg/s", "s", "ms", "µs", ""] = ""
    scale: float = 1.0


class Characteristic(msgspec.Struct, forbid_unknown_fields=True, frozen=True, dict=True):
    """A value that a device sends again and again: some samples, each of the same fields."""

    uuid: str
    fields: Annotated[list[Field], msgspec.Meta(min_length=1, max_length=32)]
    byte_order: Literal["little", "big"] = "little"
    header: Annotated[int, msgspec.Meta(ge=0, le=64)] = 0
    gravity_included: bool = True

    @cached_property
    def layout(self) -> struct.Struct:
        """One sample in bytes."""
        return struct.Struct(
            ORDERS[self.byte_order] + "".join(CODES[field.type] for field in self.fields)
        )

    def has(self, names: Iterable[str]) -> bool:
        """Whether its samples have all of these."""
        return set(names) <= {field.is_ for field in self.fields}


class Write(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Bytes, in hexadecimal, that a device needs before it sends."""

    uuid: str
    bytes: Annotated[str, msgspec.Meta(pattern=r"^([0-9a-fA-F]{2} ?)+$")]


class Profile(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """One kind of device; ``names`` are how the names begin under which it is seen.

    ``about`` says where the layout comes from and how to prepare the device.
    """

    title: str
    about: str
    service: str
    characteristics: Annotated[list[Characteristic], msgspec.Meta(min_length=1, max_length=8)]
    names: list[str] = []
    writes: list[Write] = []


class Decoder:
    """Makes readings of what one characteristic sends; a time that begins anew goes on."""

    def __init__(self, characteristic: Characteristic) -> None:
        self._own = characteristic
        self._last_raw = self._turns = 0.0

    def readings(self, data: bytes) -> list[Reading] | None:
        """The samples of a message, None when it is not of this kind."""
        size, start = self._own.layout.size, self._own.header
        count, rest = divmod(len(data) - start, size)
        if count < 1 or rest:
            return None
        found = [self._reading(data[start + size * at :][:size]) for at in range(count)]
        whole = [reading for reading in found if reading is not None]
        return whole if len(whole) == count else None

    def _reading(self, sample: bytes) -> Reading | None:
        values: dict[str, float] = {}
        for field, raw in zip(self._own.fields, self._own.layout.unpack(sample), strict=True):
            if field.is_ == "skip":
                continue
            counted = self._counted(field, raw) if field.is_ == "t" else raw
            value = counted * field.scale * UNITS[field.unit] + 0.0  # of -0.0 this makes 0.0
            if not math.isfinite(value) or (field.is_ != "t" and abs(value) > _LARGEST):
                return None
            values[field.is_] = value
        return Reading(
            acc=_vector(values, _ACC),
            gyr=_vector(values, _GYR),
            stamp=values.get("t"),
            stamp_unit_s=1.0 if "t" in values else None,
            gravity_included=self._own.gravity_included,
        )

    def _counted(self, field: Field, raw: float) -> float:
        """A counter of few bytes begins anew at 0 now and then."""
        if raw < self._last_raw and field.type.startswith("uint"):
            self._turns += 2.0 ** (8 * struct.calcsize(CODES[field.type]))
        self._last_raw = raw
        return raw + self._turns


def read_profile(path: Path) -> Profile:
    """The profile in a file. Raises NodeStartError with what is wrong in it."""
    try:
        profile = msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8")), Profile)
        _check(profile)
    except (OSError, ValueError) as error:
        raise NodeStartError(
            f"The Bluetooth device file {path.name} cannot be used: {error}.",
            checklist=(
                "Compare it with six_int16.toml in the folder imu_profiles of NEP Studio.",
                "Delete it if you do not need it.",
            ),
            details=str(path),
        ) from error
    return profile


def profile_folders() -> list[Path]:
    """Where profiles are: the user's own go first."""
    return [certificate_folder() / FOLDER, resource_folder() / FOLDER]


def profiles() -> dict[str, Profile]:
    """All profiles by the name of their file."""
    found: dict[str, Profile] = {}
    for folder in profile_folders():
        for path in sorted(folder.glob("*.toml")):
            found.setdefault(path.stem, read_profile(path))
    return found


def _check(profile: Profile) -> None:
    for text in (profile.service, *(one.uuid for one in profile.characteristics)):
        uuid.UUID(text)
    for write in profile.writes:
        uuid.UUID(write.uuid)
    for characteristic in profile.characteristics:
        _check_fields(characteristic)
    if not any(one.has(_ACC) for one in profile.characteristics):
        raise ValueError("no characteristic has ax, ay and az")


def _check_fields(characteristic: Characteristic) -> None:
    names = [field.is_ for field in characteristic.fields if field.is_ != "skip"]
    if len(set(names)) != len(names):
        raise ValueError("a value is there twice")
    for axes in (_ACC, _GYR):
        if set(axes) & set(names) and not set(axes) <= set(names):
            raise ValueError(f"{', '.join(axes)} belong together")
    for field in characteristic.fields:
        if field.is_ != "skip" and field.unit not in _FITTING[field.is_[0]]:
            raise ValueError(f"{field.is_} cannot be in {field.unit or 'no unit'}")


def _vector(values: dict[str, float], axes: tuple[str, str, str]) -> Vector | None:
    if axes[0] not in values:
        return None
    return values[axes[0]], values[axes[1]], values[axes[2]]
