"""A Bluetooth device that measures motion, as a way that its sensors reach the node."""

from __future__ import annotations

import asyncio
import importlib.util
import math
import struct
import time
import tomllib
import uuid
from collections.abc import Iterable, Mapping
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import msgspec

from faults import Text, Words, text_of
from nep_core.errors import NodeStartError
from nodes.resources import resource_folder
from nodes.sensory.phone_page.server import certificate_folder
from nodes.sensory.reading import G_M_S2, Reading, Vector

from .connector import Arrived, Settings
from .servers import Background

if TYPE_CHECKING:
    from bleak import BleakClient
    from bleak.backends.characteristic import BleakGATTCharacteristic
    from bleak.backends.device import BLEDevice
    from bleak.backends.scanner import AdvertisementData


# What a Bluetooth device sends when it moves: read from a file, checked, and used to decode.

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
        found = (self._reading(data[start + size * at :][:size]) for at in range(count))
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
    except (OSError, ValueError, RecursionError) as error:
        raise NodeStartError(
            "The Bluetooth device file {name} cannot be used: {error}.",
            checklist=(
                "Compare it with six_int16.toml in the folder imu_profiles of NEP Studio.",
                "Delete it if you do not need it.",
            ),
            details=str(path),
            name=path.name,
            error=error,
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
    named = (*(one.uuid for one in profile.characteristics), *(one.uuid for one in profile.writes))
    for text in (profile.service, *named):
        uuid.UUID(text)
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


SEARCH_S = 10.0
CONNECT_S = 15.0
AGAIN_S = 3.0
OFF = "Bluetooth cannot be used on this computer. Is it switched on? ({reason})"
NOT_FOUND = (
    "No {wanted} is found. Is it switched on, near this computer, and not connected to a phone?"
)
LEFT_OUT = "{name} sends something that cannot be read; it is left out."
UNKNOWN = (
    "{name} is none of the devices that are known here. Describe what it sends in a file in the "
    "folder imu_profiles."
)


class BluetoothConnector(Background):
    """Looks for a device, listens to it, and looks again when it is gone.

    ``address`` in the settings is its name or Bluetooth address; empty: any that is known.
    """

    def __init__(self, settings: Settings, known: Mapping[str, Profile] | None = None) -> None:
        super().__init__()
        self._wanted = settings.address.strip()
        self._known = known

    @property
    def where(self) -> Text:
        """What the node is ready for."""
        return text_of("looks for a {wanted}", wanted=self._thing)

    @property
    def missing(self) -> Text:
        """What to check when nothing has arrived."""
        sentence = text_of(NOT_FOUND, wanted=self._thing)
        return text_of("Nothing has arrived for 10 seconds. {sentence}", sentence=sentence)

    @property
    def _thing(self) -> Text:
        if not self._wanted:
            return Text("Bluetooth device that measures motion")
        return text_of("Bluetooth device “{name}”", name=self._wanted)

    def open(self) -> None:
        """Begin to look; raises NodeStartError where that is not possible."""
        if importlib.util.find_spec("bleak") is None:
            raise NodeStartError(
                "Bluetooth needs the package bleak, which is not installed.",
                checklist=(
                    'Install it: pip install "nep-studio[bluetooth]"',
                    "Or choose another way, such as a page in the phone's browser.",
                ),
            )
        if self._known is None:
            self._known = profiles()
        self.start()

    async def _serve(self) -> None:
        from bleak import BleakScanner
        from bleak.exc import BleakError

        while True:
            try:
                device = await BleakScanner.find_device_by_filter(self._is_wanted, SEARCH_S)
                if device is None:
                    self._say(text_of(NOT_FOUND, wanted=self._thing))
                else:
                    await self._listen(device)
            except (BleakError, OSError, EOFError, TimeoutError) as error:
                self._say(text_of(OFF, reason=str(error) or type(error).__name__))
            await asyncio.sleep(AGAIN_S)

    def _is_wanted(self, device: BLEDevice, told: AdvertisementData) -> bool:
        """Whether what was seen is the device that the user named, or one that is known."""
        name = (told.local_name or device.name or "").casefold()
        if self._wanted:
            wanted = self._wanted.casefold()
            return device.address.casefold() == wanted or name.startswith(wanted)
        services = {service.lower() for service in told.service_uuids}
        return any(
            profile.service.lower() in services
            or any(name.startswith(begin.casefold()) for begin in profile.names if name)
            for profile in (self._known or {}).values()
        )

    async def _listen(self, device: BLEDevice) -> None:
        """Hand over what the device sends until it is gone."""
        from bleak import BleakClient

        name, gone = device.name or device.address, asyncio.Event()
        async with BleakClient(
            device, disconnected_callback=lambda _client: gone.set(), timeout=CONNECT_S
        ) as client:
            found = [
                profile
                for profile in (self._known or {}).values()
                if client.services.get_service(profile.service) is not None
            ]
            if not found:
                self._say(text_of(UNKNOWN, name=name), name)
                return
            await self._begin(client, found[0], name)
            await gone.wait()

    async def _begin(self, client: BleakClient, profile: Profile, name: str) -> None:
        self.put(Arrived(name, arrived_s=time.monotonic()))
        for write in profile.writes:
            await client.write_gatt_char(write.uuid, bytes.fromhex(write.bytes), response=True)
        for characteristic in profile.characteristics:
            hear = partial(self._hear, Decoder(characteristic), name)
            await client.start_notify(characteristic.uuid, hear)

    def _hear(
        self, decoder: Decoder, name: str, _of: BleakGATTCharacteristic, data: bytearray
    ) -> None:
        readings = decoder.readings(bytes(data))
        if readings is None:
            self._say(text_of(LEFT_OUT, name=name), name)
        else:
            self.put(Arrived(name, readings, time.monotonic()))

    def _say(self, trouble: Words, sender: str = "") -> None:
        sender = sender or self._wanted or "Bluetooth"
        self.put(Arrived(sender, arrived_s=time.monotonic(), trouble=trouble))
