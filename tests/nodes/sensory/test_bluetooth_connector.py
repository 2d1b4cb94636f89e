"""Bluetooth devices over bleak itself and a real message bus, with a stand-in for BlueZ on it."""

import contextlib
import shutil
import struct
import sys
import time

import pytest

from nep_core.errors import NodeStartError
from nodes.sensory.connectors import bluetooth as bluetooth_way
from nodes.sensory.connectors.bluetooth import BluetoothConnector, profiles
from nodes.sensory.connectors.connector import Settings
from tests.nodes.sensory.chromium import wait_until

needs_bus = pytest.mark.skipif(
    sys.platform != "linux" or shutil.which("dbus-daemon") is None,
    reason="there is no dbus-daemon here",
)
MICROBIT = profiles()["microbit"]
NAME = "BBC micro:bit [zuzuv]"
FACE_UP = struct.pack("<3h", 0, 0, -1024)


@pytest.fixture
def bluez(monkeypatch):
    pytest.importorskip("bleak")
    from tests.nodes.sensory.bluez_double import BlueZDouble, own_bus

    monkeypatch.setattr(bluetooth_way, "AGAIN_S", 0.05)
    with own_bus() as address:
        monkeypatch.setenv("DBUS_SYSTEM_BUS_ADDRESS", address)
        double = BlueZDouble(address)
        yield double
        double.close()


@contextlib.contextmanager
def opened(address="", known=None):
    connector = BluetoothConnector(Settings(port=0, address=address), known)
    connector.open()
    try:
        yield connector
    finally:
        connector.close()


def microbit(bluez, name=NAME):
    return bluez.add(
        name, MICROBIT.service, MICROBIT.writes[0].uuid, MICROBIT.characteristics[0].uuid
    )


def heard(connector, is_wanted):
    """All that arrives up to the first that is wanted."""
    found = []

    def look():
        found.extend(connector.readings(time.monotonic() + 0.05))
        return any(map(is_wanted, found))

    wait_until(look, bool, 5.0)
    return found


@needs_bus
def test_a_known_device_is_found_prepared_and_heard(bluez):
    _, (period, motion) = microbit(bluez)

    with opened() as connector:
        found = heard(connector, lambda arrived: arrived.sender == NAME)  # there, but silent
        wait_until(lambda: motion.is_notifying, bool)
        bluez.do(motion.tell, FACE_UP)
        found += heard(connector, lambda arrived: arrived.readings)

    assert period.written == [b"\x0a\x00"]
    assert found[-1].sender == NAME
    assert found[-1].readings[0].acc == pytest.approx((0, 0, 1.024 * 9.80665))


@needs_bus
def test_a_device_that_was_gone_is_found_again(bluez):
    device, (_, motion) = microbit(bluez)

    with opened(address="bbc micro") as connector:
        wait_until(lambda: motion.is_notifying, bool)
        motion.is_notifying = False
        bluez.do(device.change, False)
        wait_until(lambda: motion.is_notifying, bool)
        bluez.do(motion.tell, FACE_UP)

        assert heard(connector, lambda arrived: arrived.readings)


@needs_bus
def test_what_cannot_be_read_is_told(bluez):
    _, (_, motion) = microbit(bluez)

    with opened() as connector:
        wait_until(lambda: motion.is_notifying, bool)
        bluez.do(motion.tell, b"\x01\x02\x03")
        found = heard(connector, lambda arrived: arrived.trouble)

    assert str(found[-1].trouble) == f"{NAME} sends something that cannot be read; it is left out."


@needs_bus
def test_a_device_that_nobody_described_is_told(bluez):
    bluez.add("Lamp", "6e657000-0000-4000-8000-0000000000aa")

    with opened(address="Lamp") as connector:
        found = heard(connector, lambda arrived: arrived.trouble)

    assert str(found[-1].trouble).startswith("Lamp is none of the devices that are known here.")


@needs_bus
def test_a_device_that_is_not_there_is_told(bluez, monkeypatch):
    monkeypatch.setattr(bluetooth_way, "SEARCH_S", 0.2)
    microbit(bluez)

    with opened(address="Thingy") as connector:
        found = heard(connector, lambda arrived: arrived.trouble)

    assert str(found[-1].trouble).startswith(
        "No Bluetooth device “Thingy” is found. Is it switched on"
    )


def test_a_computer_without_bluetooth_is_told(monkeypatch, tmp_path):
    pytest.importorskip("bleak")
    monkeypatch.setenv("DBUS_SYSTEM_BUS_ADDRESS", f"unix:path={tmp_path}/nobody")

    with opened() as connector:
        found = heard(connector, lambda arrived: arrived.trouble)

    assert str(found[0].trouble).startswith("Bluetooth cannot be used on this computer.")


def test_without_bleak_it_says_what_to_install(monkeypatch):
    monkeypatch.setattr(bluetooth_way.importlib.util, "find_spec", lambda name: None)
    connector = BluetoothConnector(Settings(port=0))

    with pytest.raises(NodeStartError, match="needs the package bleak") as told:
        connector.open()
    connector.close()

    assert 'pip install "nep-studio[bluetooth]"' in str(told.value.checklist[0])


def test_the_way_says_what_it_looks_for():
    assert (
        str(BluetoothConnector(Settings(port=0)).where)
        == "looks for a Bluetooth device that measures motion"
    )
    assert "“Thingy”" in str(BluetoothConnector(Settings(port=0, address=" Thingy ")).missing)
