"""Hearing messages unread: frames of several, what is lost, what nobody can read."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
import zmq

from nep_core.networks.zmq_networks import DirectNetwork
from nep_core.recordings.raw import RawSubscriber, SteadyClock
from nep_core.wire.frames import Encoding, join
from tests.nep_core.cli.conftest import until

START = b"/x\0"


@pytest.fixture
def talker(free_port: int) -> Iterator[tuple[zmq.Socket[bytes], RawSubscriber]]:
    """A publisher of another make, and who hears it."""
    with zmq.Context() as context, context.socket(zmq.XPUB) as socket:
        socket.linger = 0
        socket.bind(f"tcp://127.0.0.1:{free_port}")
        with DirectNetwork(f"tcp://127.0.0.1:{free_port}") as network:
            subscriber = RawSubscriber("/x", network=network)
            assert socket.poll(5000)
            yield socket, subscriber


def frame(sequence: int, payload: bytes, encoding: Encoding = "json") -> bytes:
    return join(START, "other", sequence, 7, encoding, payload, "run00001")


def test_messages_of_one_frame_come_one_by_one(
    talker: tuple[zmq.Socket[bytes], RawSubscriber],
) -> None:
    socket, subscriber = talker
    socket.send(frame(1, b"1\0002\0003"))
    socket.send(frame(4, b"a\0b", "bytes"))

    heard = [subscriber.receive(5) for _ in range(4)]

    assert [(one.sequence, one.payload) for one in heard if one] == [
        (1, b"1"),
        (2, b"2"),
        (3, b"3"),
        (4, b"a\0b"),
    ]


def test_what_is_lost_is_counted(talker: tuple[zmq.Socket[bytes], RawSubscriber]) -> None:
    socket, subscriber = talker
    for sequence in (1, 5, 6):
        socket.send(frame(sequence, b"1"))

    while (message := subscriber.receive(5)) is not None and message.sequence < 6:
        pass

    until(lambda: subscriber.lost == 3)


def test_what_nobody_can_read_is_told_and_passed_over(
    talker: tuple[zmq.Socket[bytes], RawSubscriber], caplog: pytest.LogCaptureFixture
) -> None:
    socket, subscriber = talker
    for rubbish in (b"", b"no header", b"{}\0{}", b'["a"]\0{}'):
        socket.send(START + rubbish)
    socket.send(frame(1, b"1"))

    message = subscriber.receive(5)

    assert message is not None and message.payload == b"1"
    told = [record.getMessage() for record in caplog.records]
    assert len(told) == 4
    assert told[0] == "/x: a frame has no header: its sender does not speak NEP"


def test_a_steady_clock_tells_the_time_and_never_goes_back() -> None:
    clock = SteadyClock()

    times = [clock.now_ns() for _ in range(100)]

    assert times == sorted(times)
