"""Lines by UDP and TCP, from good senders and from hostile ones."""

import socket
import time
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import PortTaken
from nodes.sensory.connectors import CONNECTORS
from nodes.sensory.connectors.connector import Settings
from nodes.sensory.connectors.lines import Client
from tests.nodes.sensory.connector_hearing import opened, turned
from tests.nodes.sensory.senders import (
    TcpSender,
    UdpSender,
    csv_line,
    paper_line,
    sensagram_line,
)


@pytest.mark.parametrize("line", [paper_line, sensagram_line])
def test_lines_by_udp_are_the_senders_movement(line):
    with opened("udp") as heard, UdpSender(heard.port, line) as sender:
        sender.start(turned(), speed=4)
        heard.until(lambda: len(heard.readings) >= 190)

    acc = [reading for reading in heard.readings if reading.acc is not None]
    gyr = [reading.gyr for reading in heard.readings if reading.acc is None]
    assert acc[50].acc == pytest.approx(turned().acc[50])
    assert gyr[50] == pytest.approx(turned().gyr[50])
    assert heard.troubles == ""


def test_columns_by_udp_are_guessed_and_told():
    with opened("udp") as heard, UdpSender(heard.port, csv_line) as sender:
        sender.start(turned(2.0), speed=2)
        heard.until(lambda: len(heard.readings) >= 150)

    assert heard.columns == "t (ms), ax, ay, az (m/s²), gx, gy, gz (rad/s)"


def test_lines_by_tcp_are_put_together_from_pieces():
    with opened("paper_watch") as heard, TcpSender(heard.port) as sender:
        sender.start(turned(), speed=4)
        heard.until(lambda: len(heard.readings) == 200)

    acc = [reading for reading in heard.readings if reading.acc is not None]
    assert [one.acc for one in acc] == [tuple(row) for row in turned().acc.tolist()]
    assert heard.troubles == ""


def test_each_of_many_clients_is_a_sender_of_its_own():
    with opened("tcp") as heard:
        one = TcpSender(heard.port, paper_line)
        other = TcpSender(heard.port, csv_line, address="127.0.0.2")
        with one, other:
            one.start(turned(), speed=5)
            other.start(turned(), speed=5)
            heard.until(
                lambda: (
                    {it.sender for it in heard.arrivals if it.readings}
                    == {"127.0.0.1", "127.0.0.2"}
                )
            )

    assert heard.troubles == ""


def test_a_taken_port_is_told_with_what_to_do():
    with opened("tcp") as heard:
        other = CONNECTORS["paper_watch"].make(Settings(heard.port))
        with pytest.raises(PortTaken) as told:
            other.open()
        other.close()

    assert f"TCP port {heard.port} cannot be opened" in str(told.value.sentence)
    assert told.value.checklist


def test_a_client_that_connects_and_is_silent_is_there():
    with opened("tcp") as heard, socket.create_connection(("127.0.0.1", heard.port)):
        heard.until(lambda: heard.arrivals)

    assert heard.arrivals[0].sender == "127.0.0.1"
    assert heard.readings == []


def test_a_line_that_does_not_end_is_told_once_and_takes_no_memory():
    with opened("tcp") as heard, socket.create_connection(("127.0.0.1", heard.port)) as client:
        client.settimeout(5)
        for _ in range(100):
            client.sendall(b"1" * 10_000)
            heard.arrivals += heard.connector.readings(time.monotonic() + 0.002)
        client.sendall(b"\na;1;0;0;9.81\n")
        heard.until(lambda: heard.readings)

    assert heard.troubles.count("does not end") == 1
    assert [one.acc for one in heard.readings] == [(0, 0, 9.81)]


@given(st.lists(st.binary(max_size=6), max_size=8), st.lists(st.integers(0, 60), max_size=6))
def test_lines_are_the_same_however_they_are_cut(lines, cuts):
    lines = [line.replace(b"\n", b"") for line in lines]
    data = b"".join(line + b"\n" for line in lines)
    places = [0, *sorted(min(cut, len(data)) for cut in cuts), len(data)]

    client = Client("somebody")
    found = [line for a, b in pairwise(places) for line in client.lines(data[a:b])]

    assert found == lines


def test_a_client_that_leaves_in_the_middle_of_a_line_is_forgotten():
    with opened("tcp") as heard:
        with socket.create_connection(("127.0.0.1", heard.port)) as client:
            client.sendall(b"a;1;0;0;9.81\na;2;0;0;9.")
            heard.until(lambda: heard.readings)
        with TcpSender(heard.port) as sender:
            sender.start(turned(0.1))
            heard.until(lambda: len(heard.readings) > 5)

    assert heard.readings[0].acc == (0, 0, 9.81)
    assert (0, 0, 9.0) not in [one.acc for one in heard.readings]


def test_more_clients_than_anybody_has_are_turned_away():
    with opened("tcp") as heard:
        clients = [socket.create_connection(("127.0.0.1", heard.port)) for _ in range(20)]
        heard.until(lambda: "turned away" in heard.troubles)
        for client in clients:
            client.close()
        with TcpSender(heard.port) as sender:
            sender.start(turned(0.1))
            heard.until(lambda: heard.readings)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"POST /data HTTP/1.1\r\nHost: x\r\n\r\n", "speaks HTTP"),
        (b"\x16\x03\x01\x02\x00\x01\n", "encrypted"),
        (b"a;1;nan;2;3\n", "not numbers"),
        (b"temperature is 20 degrees\n", "cannot be read"),
        (b"[" * 5_000 + b"\n", "cannot be read"),
        (b'{"accelerometer":' + b"[" * 5_000 + b"\n", "cannot be read"),
        (b'{"type": "\xff"}\n', "cannot be read"),
    ],
)
@pytest.mark.parametrize("through", ["udp", "tcp"])
def test_what_is_no_sensor_is_told(through, data, words):
    kind = socket.SOCK_DGRAM if through == "udp" else socket.SOCK_STREAM
    with opened(through) as heard, socket.socket(socket.AF_INET, kind) as client:
        client.connect(("127.0.0.1", heard.port))
        client.sendall(data)
        heard.until(lambda: words in heard.troubles)

    assert heard.readings == []


def test_many_senders_take_no_more_memory():
    with opened("udp") as heard:
        senders = [f"127.0.0.{number}" for number in range(2, 60)]
        for sender in senders:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
                client.bind((sender, 0))
                client.sendto(b"a;1;0;0;9.81", ("127.0.0.1", heard.port))
        heard.until(lambda: len(heard.readings) == len(senders))

        assert len(heard.connector._senders._readers) <= 32


@pytest.mark.parametrize("through", ["udp", "tcp", "sensor_logger", "phyphox", "sensor_server"])
def test_a_way_that_was_never_opened_can_be_closed(through):
    connector = CONNECTORS[through].make(Settings(port=1))

    connector.close()

    assert connector.where
    assert connector.missing


def test_when_nothing_comes_the_user_is_told_where_to_send():
    alone, open_to_all = Settings(8086), Settings(8086, listen_on="network")

    for kind in ("udp", "tcp", "paper_watch", "sensor_logger"):
        assert "set “listen on” to network" in str(CONNECTORS[kind].make(alone).missing)
        told = str(CONNECTORS[kind].make(open_to_all).missing)
        assert "8086" in told
        assert "firewall" in told
