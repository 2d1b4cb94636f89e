"""The ways to send and hear that the publish and subscribe benchmark compares, all alike.

Each message carries when it was sent (monotonic s, the same clock in both processes) and is
filled up to its size. The hearing side binds, the talking side connects. ``is_plain`` means: as
the library comes; otherwise both sides queue without limit, so that a flood arrives whole.
"""

from __future__ import annotations

import contextlib
import socket as sockets
import time
from collections.abc import Callable, Iterator
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import msgspec
import zmq

from nep_core.networks.zmq_networks import DirectNetwork
from nep_core.wire.outbox import HIGH_WATER_MARK
from nep_core.wire.pubsub import Publisher, Subscriber

Send = Callable[[float], object]
Hear = Callable[[float], float | None]
"""When the next message was sent; None when nothing came for so many seconds."""

CONNECTED_S = 0.3
MATCHED_S = 10.0


class Text(msgspec.Struct):
    """A message of any size."""

    sent_s: float
    text: str


def filling(size: int) -> str:
    """What fills a JSON message up to ``size`` bytes."""
    return "x" * (size - len(msgspec.json.encode(Text(12345.123456789, ""))))


@contextlib.contextmanager
def _hear_raw(port: int, is_plain: bool) -> Iterator[Hear]:
    with zmq.Context() as context, context.socket(zmq.SUB) as socket:
        if not is_plain:
            socket.rcvhwm = 0
        socket.subscribe(b"")
        socket.bind(f"tcp://127.0.0.1:{port}")
        waits_s = None

        def hear(timeout_s: float) -> float | None:
            nonlocal waits_s
            if timeout_s != waits_s:
                waits_s, socket.rcvtimeo = timeout_s, int(timeout_s * 1000)
            try:
                return float(socket.recv()[:20])
            except zmq.Again:
                return None

        yield hear


@contextlib.contextmanager
def _send_raw(port: int, size: int, is_plain: bool) -> Iterator[Send]:
    with zmq.Context() as context, context.socket(zmq.PUB) as socket:
        if not is_plain:
            socket.sndhwm = 0
        socket.connect(f"tcp://127.0.0.1:{port}")
        time.sleep(CONNECTED_S)  # raw PUB and SUB cannot tell when they are connected
        rest = b"x" * (size - 20)
        yield lambda now_s: socket.send(b"%20.9f%b" % (now_s, rest))


def _network(port: int, node: str, is_plain: bool) -> DirectNetwork:
    return DirectNetwork(
        f"tcp://127.0.0.1:{port}",
        binds="subscriber",
        node=node,
        high_water_mark=HIGH_WATER_MARK if is_plain else 0,
    )


@contextlib.contextmanager
def _hear_ours(port: int, is_plain: bool) -> Iterator[Hear]:
    with _network(port, "hearer", is_plain) as network:
        subscriber = Subscriber("/bench", Text, network=network)

        def hear(timeout_s: float) -> float | None:
            message = subscriber.receive(timeout_s)
            return None if message is None else message.sent_s

        yield hear


@contextlib.contextmanager
def _send_ours(port: int, size: int, is_plain: bool) -> Iterator[Send]:
    with _network(port, "talker", is_plain) as network:
        publisher = Publisher("/bench", network=network, wait_for_subscribers=1)
        text = filling(size)
        yield lambda now_s: publisher.send(Text(now_s, text))


def _zenoh_session(**endpoints: str) -> Any:
    import zenoh

    config = zenoh.Config()
    config.insert_json5("mode", '"peer"')
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5("listen/endpoints", "[]")
    for side, endpoint in endpoints.items():
        config.insert_json5(f"{side}/endpoints", f'["{endpoint}"]')
    return zenoh.open(config)


@contextlib.contextmanager
def _hear_zenoh(port: int, is_plain: bool) -> Iterator[Hear]:
    from queue import Empty, SimpleQueue

    arrived: SimpleQueue[bytes] = SimpleQueue()
    with _zenoh_session(listen=f"tcp/127.0.0.1:{port}") as session:
        session.declare_subscriber("bench", lambda sample: arrived.put(sample.payload.to_bytes()))

        def hear(timeout_s: float) -> float | None:
            with contextlib.suppress(Empty):
                return float(arrived.get(timeout=timeout_s)[:20])
            return None

        yield hear


@contextlib.contextmanager
def _send_zenoh(port: int, size: int, is_plain: bool) -> Iterator[Send]:
    import zenoh

    with _zenoh_session(connect=f"tcp/127.0.0.1:{port}") as session:
        publisher = session.declare_publisher(
            "bench", congestion_control=zenoh.CongestionControl.BLOCK
        )
        until_s = time.monotonic() + MATCHED_S
        while not publisher.matching_status.matching and time.monotonic() < until_s:
            time.sleep(0.01)
        rest = b"x" * (size - 20)
        yield lambda now_s: publisher.put(b"%20.9f%b" % (now_s, rest))


def _original_place(port: int) -> dict[str, str]:
    place = {"transport": "ZMQ", "network": "direct", "mode": "many2one"}
    return place | {"ip": "127.0.0.1", "port": str(port)}


@contextlib.contextmanager
def _hear_original(port: int, is_plain: bool) -> Iterator[Hear]:
    nep = import_module("nep")
    subscriber = nep.subscriber("bench", "hearer", "json", _original_place(port))

    def hear(timeout_s: float) -> float | None:
        until_s = time.monotonic() + timeout_s
        while time.monotonic() < until_s:
            is_there, message = subscriber.listen()
            if is_there:
                return float(message["sent_s"])
            time.sleep(0)  # it has no wait with a limit
        return None

    yield hear
    subscriber.close_ZMQ_subscriber()


@contextlib.contextmanager
def _send_original(port: int, size: int, is_plain: bool) -> Iterator[Send]:
    nep = import_module("nep")
    publisher = nep.publisher("bench", "talker", "json", _original_place(port))
    text = filling(size)
    yield lambda now_s: publisher.publish({"sent_s": now_s, "text": text})
    time.sleep(CONNECTED_S)  # nothing in it waits for what is on its way


HEARERS = {"raw": _hear_raw, "ours": _hear_ours, "zenoh": _hear_zenoh, "nep": _hear_original}
TALKERS = {"raw": _send_raw, "ours": _send_ours, "zenoh": _send_zenoh, "nep": _send_original}


def known_sides() -> list[str]:
    """The sides that can be measured here."""
    return [side for side in HEARERS if side in ("raw", "ours") or find_spec(side) is not None]


def free_ports(count: int) -> list[int]:
    """Ports that nobody used a moment ago."""
    with contextlib.ExitStack() as stack:
        probes = [stack.enter_context(sockets.socket()) for _ in range(count)]
        for probe in probes:
            probe.bind(("127.0.0.1", 0))
        return [probe.getsockname()[1] for probe in probes]
