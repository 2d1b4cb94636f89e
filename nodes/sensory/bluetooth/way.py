"""A Bluetooth device that measures motion, as a way that its sensors reach the node."""

from __future__ import annotations

import asyncio
import importlib.util
import time
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from nep_core.errors import NodeStartError
from nodes.sensory.bluetooth.profile import Decoder, Profile, profiles
from nodes.sensory.ways.background import Background
from nodes.sensory.ways.way import Arrived, Settings

if TYPE_CHECKING:
    from bleak import BleakClient
    from bleak.backends.characteristic import BleakGATTCharacteristic
    from bleak.backends.device import BLEDevice
    from bleak.backends.scanner import AdvertisementData

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


class BluetoothWay:
    """Looks for a device, listens to it, and looks again when it is gone.

    ``address`` in the settings is its name or Bluetooth address; empty: any that is known.
    """

    def __init__(self, settings: Settings, known: Mapping[str, Profile] | None = None) -> None:
        self._wanted = settings.address.strip()
        self._known = known
        self._background = Background(self._follow)

    @property
    def where(self) -> str:
        """What the node is ready for."""
        return f"looks for a {self._thing}"

    @property
    def missing(self) -> str:
        """What to check when nothing has arrived."""
        return "Nothing has arrived for 10 seconds. " + NOT_FOUND.format(wanted=self._thing)

    @property
    def _thing(self) -> str:
        name = f" “{self._wanted}”" if self._wanted else " that measures motion"
        return f"Bluetooth device{name}"

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
        self._background.start()

    def readings(self, until_s: float) -> list[Arrived]:
        """What the device has sent up to then."""
        return self._background.take(until_s)

    def close(self) -> None:
        """Leave the device."""
        self._background.stop()

    async def _follow(self) -> None:
        from bleak import BleakScanner
        from bleak.exc import BleakError

        while True:
            try:
                device = await BleakScanner.find_device_by_filter(self._is_wanted, SEARCH_S)
                if device is None:
                    self._say(NOT_FOUND.format(wanted=self._thing))
                else:
                    await self._listen(device)
            except (BleakError, OSError, EOFError, TimeoutError) as error:
                self._say(OFF.format(reason=str(error) or type(error).__name__))
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
                self._say(UNKNOWN.format(name=name), name)
                return
            await self._begin(client, found[0], name)
            await gone.wait()

    async def _begin(self, client: BleakClient, profile: Profile, name: str) -> None:
        self._background.put(Arrived(name, arrived_s=time.monotonic()))
        for write in profile.writes:
            await client.write_gatt_char(write.uuid, bytes.fromhex(write.bytes), response=True)
        for characteristic in profile.characteristics:
            hear = self._hearing(Decoder(characteristic), name)
            await client.start_notify(characteristic.uuid, hear)

    def _hearing(
        self, decoder: Decoder, name: str
    ) -> Callable[[BleakGATTCharacteristic, bytearray], None]:
        def hear(_characteristic: BleakGATTCharacteristic, data: bytearray) -> None:
            readings = decoder.readings(bytes(data))
            if readings is None:
                self._say(LEFT_OUT.format(name=name), name)
            else:
                self._background.put(Arrived(name, readings, time.monotonic()))

        return hear

    def _say(self, trouble: str, sender: str = "") -> None:
        self._background.put(
            Arrived(
                sender or self._wanted or "Bluetooth", arrived_s=time.monotonic(), trouble=trouble
            )
        )
