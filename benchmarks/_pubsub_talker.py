"""The sending process of the publish and subscribe benchmark: ``KIND SIZE OURS THEIRS``."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import msgspec
import zmq

from nep_core.network import DirectNetwork
from nep_core.pubsub import Publisher

FLOOD = 150_000
PINGS = 2_000
PING_PAUSE_S = 0.001
CONNECTED_S = 0.3


class Text(msgspec.Struct):
    """A message of any size; ``sent_s`` is monotonic."""

    sent_s: float
    text: str


def main(kind: str, size: int, ours: str, theirs: str) -> None:
    """Talk to the two endpoints: "raw" or "ours" in a flood, or "pings" by turns."""
    network = DirectNetwork(ours, binds="subscriber", node="talker", high_water_mark=0)
    with zmq.Context() as context, context.socket(zmq.PUB) as socket, network:
        socket.sndhwm = 0
        socket.connect(theirs)
        publisher = Publisher("/bench", network=network, wait_for_subscribers=1)
        time.sleep(CONNECTED_S)  # raw PUB and SUB cannot tell when they are connected
        raw_filling = b"x" * (size - 20)
        filling = "x" * (size - len(msgspec.json.encode(Text(12345.123456789, ""))))

        def send_raw(now_s: float) -> None:
            socket.send(b"%20.9f%b" % (now_s, raw_filling))

        def send_ours(now_s: float) -> None:
            publisher.send(Text(now_s, filling))

        if kind == "pings":
            ping(send_raw, send_ours)
        else:
            flood(send_raw if kind == "raw" else send_ours)


def flood(send: Callable[[float], None]) -> None:
    """Send as fast as it goes."""
    for _ in range(FLOOD):
        send(time.monotonic())


def ping(*ways: Callable[[float], None]) -> None:
    """Send one message a millisecond, by turns."""
    for _ in range(PINGS):
        for send in ways:
            time.sleep(PING_PAUSE_S)
            send(time.monotonic())


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4])
