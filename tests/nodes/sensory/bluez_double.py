"""A stand-in for BlueZ on a bus of its own: an adapter, and devices with one service each."""

# D-Bus has its names in capitals, and dbus_fast reads its types from annotations:
# ruff: noqa: N802, F722, F821, UP037

from __future__ import annotations

import asyncio
import contextlib
import shutil
import subprocess
import threading
from collections.abc import Iterator
from typing import Any

from dbus_fast import PropertyAccess
from dbus_fast.aio import MessageBus
from dbus_fast.service import ServiceInterface, dbus_property, method

ADAPTER = "/org/bluez/hci0"
READ = PropertyAccess.READ
ANSWER_S = 5.0
ADVERTISE_S = 0.05


@contextlib.contextmanager
def own_bus() -> Iterator[str]:
    """The address of a message bus that only this test uses."""
    program = shutil.which("dbus-daemon")
    assert program is not None
    command = [program, "--session", "--nofork", "--nopidfile", "--print-address"]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as bus:
        assert bus.stdout is not None
        try:
            yield bus.stdout.readline().strip()
        finally:
            bus.terminate()


class Adapter(ServiceInterface):
    """The radio of the computer."""

    def __init__(self) -> None:
        super().__init__("org.bluez.Adapter1")
        self.near: list[Device] = []
        self.is_discovering = False

    @dbus_property(access=READ)
    def Powered(self) -> "b":
        return True

    @dbus_property(access=READ)
    def Address(self) -> "s":
        return "00:11:22:33:44:55"

    @dbus_property(access=READ)
    def Roles(self) -> "as":
        return ["central"]

    @method()
    def SetDiscoveryFilter(self, wanted: "a{sv}"):
        pass

    @method()
    def StartDiscovery(self):
        self.is_discovering = True
        self._see()

    def _see(self) -> None:
        """Devices tell again and again that they are there."""
        if self.is_discovering:
            for device in self.near:
                device.emit_properties_changed({"RSSI": device.RSSI})
            asyncio.get_running_loop().call_later(ADVERTISE_S, self._see)

    @method()
    def StopDiscovery(self):
        self.is_discovering = False


class Device(ServiceInterface):
    """What is seen in the air, and can be connected."""

    def __init__(self, name: str, address: str, service: str) -> None:
        super().__init__("org.bluez.Device1")
        self.called, self.address, self.service = name, address, service
        self.is_connected = False
        self.path = f"{ADAPTER}/dev_{address.replace(':', '_')}"

    @dbus_property(access=READ)
    def Address(self) -> "s":
        return self.address

    @dbus_property(access=READ)
    def Name(self) -> "s":
        return self.called

    @dbus_property(access=READ)
    def Alias(self) -> "s":
        return self.called

    @dbus_property(access=READ)
    def Adapter(self) -> "o":
        return ADAPTER

    @dbus_property(access=READ)
    def UUIDs(self) -> "as":
        return [self.service]

    @dbus_property(access=READ)
    def RSSI(self) -> "n":
        return -50

    @dbus_property(access=READ)
    def Paired(self) -> "b":
        return False

    @dbus_property(access=READ)
    def Connected(self) -> "b":
        return self.is_connected

    @dbus_property(access=READ)
    def ServicesResolved(self) -> "b":
        return self.is_connected

    @method()
    def Connect(self):
        self.change(True)

    @method()
    def Disconnect(self):
        self.change(False)

    def change(self, is_connected: bool) -> None:
        """Connect, or leave as a device that is switched off."""
        self.is_connected = is_connected
        told = {"Connected": is_connected, "ServicesResolved": is_connected}
        self.emit_properties_changed(told)


class Service(ServiceInterface):
    """What a device can do."""

    def __init__(self, device: Device) -> None:
        super().__init__("org.bluez.GattService1")
        self.device = device
        self.path = f"{device.path}/service0001"

    @dbus_property(access=READ)
    def UUID(self) -> "s":
        return self.device.service

    @dbus_property(access=READ)
    def Device(self) -> "o":
        return self.device.path

    @dbus_property(access=READ)
    def Primary(self) -> "b":
        return True


class Characteristic(ServiceInterface):
    """A value that is told again and again, or can be written."""

    def __init__(self, service: Service, uuid: str, number: int) -> None:
        super().__init__("org.bluez.GattCharacteristic1")
        self.service, self.uuid = service, uuid
        self.path = f"{service.path}/char{number:04x}"
        self.is_notifying = False
        self.value = b""
        self.written: list[bytes] = []

    @dbus_property(access=READ)
    def UUID(self) -> "s":
        return self.uuid

    @dbus_property(access=READ)
    def Service(self) -> "o":
        return self.service.path

    @dbus_property(access=READ)
    def Flags(self) -> "as":
        return ["notify", "write"]

    @dbus_property(access=READ)
    def MTU(self) -> "q":
        return 23

    @method()
    def StartNotify(self):
        self.is_notifying = True

    @method()
    def StopNotify(self):
        self.is_notifying = False

    @method()
    def WriteValue(self, value: "ay", options: "a{sv}"):
        self.written.append(bytes(value))

    @dbus_property(access=READ)
    def Value(self) -> "ay":
        return self.value

    def tell(self, value: bytes) -> None:
        """Send a value to who listens."""
        self.value = value
        self.emit_properties_changed({"Value": value})


class BlueZDouble:
    """Answers as BlueZ in a thread of its own, until it is closed."""

    def __init__(self, address: str) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self._bus: MessageBus = self._run(self._open(address))

    async def _open(self, address: str) -> MessageBus:
        bus = await MessageBus(bus_address=address).connect()
        self._adapter = Adapter()
        bus.export(ADAPTER, self._adapter)
        await bus.request_name("org.bluez")
        return bus

    def add(
        self, name: str, service: str, *characteristics: str
    ) -> tuple[Device, list[Characteristic]]:
        """A device comes near."""
        return self._run(self._add(name, service, characteristics))

    async def _add(
        self, name: str, service_uuid: str, uuids: tuple[str, ...]
    ) -> tuple[Device, list[Characteristic]]:
        device = Device(name, "AA:BB:CC:DD:EE:01", service_uuid)
        service = Service(device)
        found = [Characteristic(service, uuid, at) for at, uuid in enumerate(uuids, start=2)]
        for each in (device, service, *found):
            self._bus.export(each.path, each)
        self._adapter.near.append(device)
        return device, found

    def do(self, work: Any, *arguments: Any) -> None:
        """Call something of a device in the thread of the bus."""

        async def go() -> None:
            work(*arguments)

        self._run(go())

    def close(self) -> None:
        """Leave the bus."""

        async def go() -> None:
            self._bus.disconnect()
            await self._bus.wait_for_disconnect()

        with contextlib.suppress(Exception):
            self._run(go())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def _run(self, work: Any) -> Any:
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(ANSWER_S)
