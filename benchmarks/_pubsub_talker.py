"""The sending process of the publish and subscribe benchmark: ``WHO KIND SIZE ENDPOINT``."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import msgspec
import zmq

from nep_core.network import DirectNetwork
from nep_core.pubsub import Publisher

COUNTS = {"flood": 150_000, "pings": 1_200}
PING_PAUSE_S = 0.001
LAST = "last"
CONNECTED_S = 0.3


class Text(msgspec.Struct):
    """A message of any size; ``sent_s`` is monotonic."""

    sent_s: float
    text: str


def talk(kind: str, send: Callable[[float], None]) -> None:
    """Send as fast as it goes, or one message a millisecond."""
    for _ in range(COUNTS[kind]):
        send(time.monotonic())
        if kind == "pings":
            time.sleep(PING_PAUSE_S)


def talk_raw(kind: str, size: int, endpoint: str) -> None:
    """Raw pyzmq: PUB, one frame of bytes that begins with the time."""
    with zmq.Context() as context, context.socket(zmq.PUB) as socket:
        socket.sndhwm = 0
        socket.connect(endpoint)
        time.sleep(CONNECTED_S)  # raw PUB and SUB cannot tell when they are connected
        filling = b"x" * (size - 20)
        talk(kind, lambda now_s: socket.send(b"%20.9f%b" % (now_s, filling)))
        socket.send(LAST.encode())


def talk_ours(kind: str, size: int, endpoint: str) -> None:
    """A Publisher of JSON messages of the same size."""
    filling = "x" * (size - len(msgspec.json.encode(Text(12345.123456789, ""))))
    network = DirectNetwork(endpoint, binds="subscriber", node="talker", high_water_mark=0)
    with network:
        publisher = Publisher("/bench", network=network, wait_for_subscribers=1)
        talk(kind, lambda now_s: publisher.send(Text(now_s, filling)))
        publisher.send(Text(0.0, LAST))


if __name__ == "__main__":
    who, kind, size, endpoint = sys.argv[1:]
    {"raw": talk_raw, "ours": talk_ours}[who](kind, int(size), endpoint)
