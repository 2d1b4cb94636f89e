"""The thread of a way ends whenever it is stopped, and nothing that senders do stays in memory."""

import json
import math
import socket
import threading
import time

import pytest

from nodes.sensory.connectors import lines
from nodes.sensory.connectors.sensor_logger import read_message
from nodes.sensory.connectors.servers import Background
from nodes.sensory.line_reader import LineReader
from nodes.sensory.phone_page.site import read_message as read_batch
from nodes.sensory.reading import Reading
from nodes.sensory.sample_stream import SampleStream
from tests.nodes.sensory.connector_hearing import free_port, opened, turned
from tests.nodes.sensory.senders import TcpSender

GRAVITY_M_S2 = 9.81


def test_a_way_that_is_stopped_as_soon_as_it_was_started_ends():
    begun = []

    class Way(Background):
        async def _serve(self):
            begun.append(True)

    for _ in range(20):
        background = Way()
        background.start()
        thread = background._thread
        began_s = time.monotonic()
        background.close()

        assert thread is not None and not thread.is_alive()
        assert time.monotonic() - began_s < 0.5
    assert not [one for one in threading.enumerate() if one.name == "way"]


@pytest.mark.parametrize("address", ["a..b", "."])
def test_an_address_that_no_host_can_have_is_told(address):
    with opened("sensor_server", address=address, port=free_port()) as heard:
        heard.until(lambda: "does not answer" in heard.troubles)


def test_silent_connections_make_room_for_a_device_that_sends(monkeypatch):
    monkeypatch.setattr(lines, "_GONE_S", 0.0)
    with opened("tcp") as heard:
        gone = [socket.create_connection(("127.0.0.1", heard.port)) for _ in range(16)]
        heard.until(lambda: len(heard.arrivals) >= 16)
        with TcpSender(heard.port) as sender:
            sender.start(turned(0.2))
            heard.until(lambda: heard.readings)
        for client in gone:
            client.close()

    assert heard.troubles == ""


def test_what_nobody_needs_of_a_message_is_not_kept():
    values = {"x": 1.0, "y": "2", "z": 3, "rest": [[]] * 9, "long": "x" * 90}
    body = {"payload": [{"name": "gyroscope", "time": "1", "values": values, "more": {}}]}

    message = read_message(json.dumps(body).encode())

    kept = {"name": "gyroscope", "time": "1", "values": {"x": 1.0, "y": "2", "z": 3}}
    assert message is not None and message.payload == [kept]


def test_a_batch_that_is_nested_too_deep_is_refused():
    deep = '{"id":"a","t":[],"acc":[],"more":' + "[" * 20_000 + "]" * 20_000 + "}"

    with pytest.raises(ValueError, match="nested"):
        read_batch(deep)


@pytest.mark.parametrize("step", [5e-324, 1e307])
def test_times_that_no_clock_has_are_no_times(step):
    reader = LineReader()

    for number in range(40):
        line = f"{number * step!r},0.1,0.2,9.8"
        reader.read([line.encode()], number * 0.05)

    assert "t" not in reader.columns.split(", ")


def gravity_told(accelerations):
    stream, told = SampleStream(), []
    for number, acc in enumerate(accelerations):
        stream.samples([Reading(acc, stamp=number * 0.01, stamp_unit_s=1.0)], number * 0.01)
        told.append(stream.gravity_included)
    return told


@pytest.mark.parametrize("strength_m_s2", [15.0, 40.0])
def test_shaking_a_sensor_does_not_take_its_gravity_away(strength_m_s2):
    shaken = [strength_m_s2 * math.sin(n * 0.2) for n in range(600)]

    told = gravity_told([*[(0.0, 0.0, GRAVITY_M_S2)] * 100, *[(x, 0, 9.81) for x in shaken]])

    assert all(told)


def test_shaking_a_sensor_without_gravity_gives_it_none():
    calm = [(0.1, 0.2, 0.1)] * 100
    shaken = [(14 * math.sin(n * 0.2), 0.0, 0.0) for n in range(600)]

    told = gravity_told([*calm, *shaken])

    assert not any(told)
