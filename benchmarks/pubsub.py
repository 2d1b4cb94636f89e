"""Publisher to Subscriber against raw pyzmq (PUB and SUB, bytes, one frame), in the same run.

Two processes over loopback TCP, rounds interleaved; a figure is the median of the rounds, a ratio
the median of the rounds' ratios. Both sides queue without limit, so nothing is lost. Our messages
are JSON of the given size, encoded from a struct and decoded into one; theirs are bytes.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import zmq

from benchmarks._pubsub_talker import COUNTS, LAST, Text
from nep_core.network import DirectNetwork
from nep_core.pubsub import Subscriber

SIZES = {"100 B": 100, "1 KB": 1000}
ROUNDS = 5

Hear = Callable[[str, int], float]


def run() -> list[dict[str, Any]]:
    """Throughput (goal: at least 0.85 of raw) and one-way latency (at most 1.2 of raw)."""
    rows = []
    for label, size in SIZES.items():
        for kind, name, unit in (
            ("flood", "throughput", "messages/s"),
            ("pings", "latency p50", "us"),
        ):
            raw, ours, ratio = _compare(kind, size)
            ok = ratio >= 0.85 if kind == "flood" else ratio <= 1.2
            rows.append(
                {
                    "name": f"{name} {label}",
                    "value": round(ours, 1),
                    "unit": unit,
                    "reference": round(raw, 1),
                    "ratio": round(ratio, 3),
                    "goal": "at least 0.85" if kind == "flood" else "at most 1.2",
                    "ok": ok,
                }
            )
    return rows


def _compare(kind: str, size: int) -> tuple[float, float, float]:
    pairs = [(_hear_raw(kind, size), _hear_ours(kind, size)) for _ in range(ROUNDS)]
    raw, ours = (statistics.median(side) for side in zip(*pairs, strict=True))
    return raw, ours, statistics.median(ours / raw for raw, ours in pairs)


def _hear_raw(kind: str, size: int) -> float:
    with zmq.Context() as context, context.socket(zmq.SUB) as socket:
        socket.rcvhwm = 0
        socket.subscribe(b"")
        port = socket.bind_to_random_port("tcp://127.0.0.1")
        talker = _talker("raw", kind, size, f"tcp://127.0.0.1:{port}")
        last = LAST.encode()
        frames, arrivals_s = [], []
        while (frame := socket.recv()) != last:
            frames.append(frame)
            if kind == "pings":
                arrivals_s.append(time.monotonic())
        end_s = time.monotonic()
        talker.wait()
    return _figure(kind, [float(frame[:20]) for frame in frames], arrivals_s, end_s)


def _hear_ours(kind: str, size: int) -> float:
    with zmq.Context() as context, context.socket(zmq.SUB) as probe:
        port = probe.bind_to_random_port("tcp://127.0.0.1")
    endpoint = f"tcp://127.0.0.1:{port}"
    with DirectNetwork(endpoint, binds="subscriber", node="hearer", high_water_mark=0) as network:
        subscriber = Subscriber("/bench", Text, network=network)
        talker = _talker("ours", kind, size, endpoint)
        messages, arrivals_s = [], []
        while (message := subscriber.receive(60)) is not None and message.text != LAST:
            messages.append(message)
            if kind == "pings":
                arrivals_s.append(time.monotonic())
        end_s = time.monotonic()
        talker.wait()
    return _figure(kind, [message.sent_s for message in messages], arrivals_s, end_s)


def _figure(kind: str, sent_s: list[float], arrivals_s: list[float], end_s: float) -> float:
    """Messages a second from the first sending to the last arrival, or the median delay in us."""
    assert len(sent_s) == COUNTS[kind], "messages were lost"
    if kind == "flood":
        return len(sent_s) / (end_s - sent_s[0])
    delays_s = [came - left for left, came in zip(sent_s, arrivals_s, strict=True)]
    return statistics.median(delays_s) * 1e6


def _talker(who: str, kind: str, size: int, endpoint: str) -> subprocess.Popen[bytes]:
    module = "benchmarks._pubsub_talker"
    return subprocess.Popen([sys.executable, "-m", module, who, kind, str(size), endpoint])
