"""Publisher to Subscriber against raw pyzmq (PUB and SUB, bytes, one frame), in the same run.

Two processes over loopback TCP. Floods of both kinds alternate, pings (one a millisecond) go by
turns from the same process to the same process; ratios are medians over the rounds. Both sides
queue without limit, so nothing is lost. Our messages are JSON of the given size, encoded from a
struct and decoded into one; theirs are bytes.
"""

from __future__ import annotations

import contextlib
import socket as sockets
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import zmq

from benchmarks._pubsub_talker import FLOOD, PINGS, Text
from nep_core.network import DirectNetwork
from nep_core.pubsub import Subscriber

SIZES = {"100 B": 100, "1 KB": 1000}
FLOOD_ROUNDS = 7
PING_ROUNDS = 5


@dataclass(frozen=True)
class Hearer:
    """A raw socket and a Subscriber that the same process talks to."""

    socket: zmq.Socket[bytes]
    subscriber: Subscriber[Text]

    def raw(self) -> float:
        """When the next raw message was sent (monotonic s)."""
        return float(self.socket.recv()[:20])

    def ours(self) -> float:
        """When our next message was sent."""
        message = self.subscriber.receive(60)
        assert message is not None, "a message was lost"
        return message.sent_s


def run() -> list[dict[str, Any]]:
    """Throughput (goal: at least 0.85 of raw) and one-way latency (at most 1.2 of raw)."""
    rows = []
    for label, size in SIZES.items():
        floods = [(_flood("raw", size), _flood("ours", size)) for _ in range(FLOOD_ROUNDS)]
        rows.append(_row(f"throughput {label}", "messages/s", floods, at_least=0.85))
        pings = [_pings(size) for _ in range(PING_ROUNDS)]
        rows.append(_row(f"latency p50 {label}", "us", pings, at_most=1.2))
    return rows


def _row(
    name: str,
    unit: str,
    rounds: list[tuple[float, float]],
    *,
    at_least: float = 0.0,
    at_most: float = float("inf"),
) -> dict[str, Any]:
    raw, ours = (statistics.median(side) for side in zip(*rounds, strict=True))
    ratio = statistics.median(ours / raw for raw, ours in rounds)
    return {
        "name": name,
        "value": round(ours, 1),
        "unit": unit,
        "reference": round(raw, 1),
        "ratio": round(ratio, 3),
        "goal": f"at least {at_least}" if at_least else f"at most {at_most}",
        "ok": at_least <= ratio <= at_most,
    }


def _flood(kind: str, size: int) -> float:
    """Messages a second, from the first sending to the last arrival."""
    with _hearer(kind, size) as hearer:
        hear = hearer.raw if kind == "raw" else hearer.ours
        first_sent_s = hear()
        for _ in range(FLOOD - 1):
            hear()
        return FLOOD / (time.monotonic() - first_sent_s)


def _pings(size: int) -> tuple[float, float]:
    """The median delays of raw and of our messages, in us."""
    delays_s: tuple[list[float], list[float]] = ([], [])
    with _hearer("pings", size) as hearer:
        for _ in range(PINGS):
            for kept, hear in zip(delays_s, (hearer.raw, hearer.ours), strict=True):
                sent_s = hear()
                kept.append(time.monotonic() - sent_s)
    raw, ours = (statistics.median(side) * 1e6 for side in delays_s)
    return raw, ours


@contextlib.contextmanager
def _hearer(kind: str, size: int) -> Iterator[Hearer]:
    with zmq.Context() as context, context.socket(zmq.SUB) as socket:
        with sockets.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            ours = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
        socket.rcvhwm = 0
        socket.subscribe(b"")
        theirs = f"tcp://127.0.0.1:{socket.bind_to_random_port('tcp://127.0.0.1')}"
        with DirectNetwork(ours, binds="subscriber", node="hearer", high_water_mark=0) as network:
            subscriber = Subscriber("/bench", Text, network=network)
            command = [sys.executable, "-m", "benchmarks._pubsub_talker"]
            talker = subprocess.Popen([*command, kind, str(size), ours, theirs])
            yield Hearer(socket, subscriber)
            talker.wait()
