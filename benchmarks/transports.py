"""The same Publisher and Subscriber over p2p, through a NEP broker and through a zenoh router.

Two processes and, where there is one, the central service in a third. Floods are JSON messages of
100 bytes as fast as they go; pings one a millisecond. The reference is p2p, in the same run.
"""

from __future__ import annotations

import contextlib
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from importlib.util import find_spec
from typing import Any

from benchmarks._pubsub_sides import Text, filling, free_ports
from benchmarks._pubsub_talker import flood, ping
from nep_core.networks.endpoints import NETWORK_VARIABLE
from nep_core.networks.transports import TRANSPORTS, network_for
from nep_core.wire.pubsub import Publisher, Subscriber

Row = dict[str, Any]

SIZE = 100
FLOOD = 30_000
PINGS = 500
ROUNDS = 3
START_S = 10.0
QUIET_S = 1.0


def run() -> list[Row]:
    """Messages a second and one-way delay of each transport; no goal, but all must arrive."""
    kinds = [kind for kind in TRANSPORTS if kind != "zenoh" or find_spec("zenoh")]
    with contextlib.ExitStack() as stack:
        for kind, port in zip(kinds, free_ports(len(kinds)), strict=True):
            stack.enter_context(_service(kind, port))
        floods = [{kind: _flood(kind) for kind in kinds} for _ in range(ROUNDS)]
        pings = [{kind: _ping_us(kind) for kind in kinds} for _ in range(ROUNDS)]
    rows: list[Row] = []
    for kind in kinds:
        rates = [one[kind][0] for one in floods]
        arrived = min(one[kind][1] for one in floods)
        rows += [
            _row(f"throughput over {kind}", "messages/s", rates, [one["p2p"][0] for one in floods]),
            {
                "name": f"delivered of a flood over {kind}",
                "value": round(100 * arrived / FLOOD, 2),
                "unit": "%",
                "goal": "100 %",
                "ok": arrived == FLOOD,
            },
            _row(
                f"delay p50 over {kind}",
                "us",
                [one[kind] for one in pings],
                [one["p2p"] for one in pings],
            ),
        ]
    return rows


def _row(name: str, unit: str, values: list[float], references: list[float]) -> Row:
    ratio = statistics.median(
        value / reference for value, reference in zip(values, references, strict=True)
    )
    return {
        "name": name,
        "value": round(statistics.median(values), 1),
        "unit": unit,
        "reference": round(statistics.median(references), 1),
        "ratio": round(ratio, 3),
    }


@contextlib.contextmanager
def _service(kind: str, port: int) -> Iterator[None]:
    """The central service of a transport; programs that are started from here find it."""
    variable, endpoint, words = {
        "p2p": ("NEP_MASTER", f"tcp://127.0.0.1:{port}", ["master", "--no-original", "--endpoint"]),
        "broker": ("NEP_BROKER", f"tcp://127.0.0.1:{port}", ["broker", "--endpoint"]),
        "zenoh": ("NEP_ZENOH", f"tcp/127.0.0.1:{port}", ["broker", "--zenoh", "--listen"]),
    }[kind]
    os.environ[variable] = endpoint
    command = [sys.executable, "-c", "from nep_core.cli import main; main()", *words, endpoint]
    service = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert service.stdout is not None
        if "serves" not in service.stdout.readline():
            raise RuntimeError(f"the service of {kind} did not start")
        yield
    finally:
        service.terminate()
        service.wait()


@contextlib.contextmanager
def _hearing(kind: str, job: str) -> Iterator[Subscriber[Text]]:
    """A subscriber to which a process of its own talks."""
    os.environ[NETWORK_VARIABLE] = kind
    with network_for("bench-hearer") as network:
        subscriber = Subscriber("/bench", Text, network=network)
        talker = subprocess.Popen([sys.executable, "-m", "benchmarks.transports", job])
        try:
            yield subscriber
        finally:
            talker.wait(START_S)


def _flood(kind: str) -> tuple[float, int]:
    """Messages a second, from the first sending to the last arrival; how many arrived."""
    with _hearing(kind, "flood") as subscriber:
        first = subscriber.receive(START_S)
        if first is None:
            raise RuntimeError(f"nothing came over {kind}")
        arrived, last_s = 1, time.monotonic()
        while arrived < FLOOD and subscriber.receive(QUIET_S) is not None:
            arrived, last_s = arrived + 1, time.monotonic()
    return arrived / (last_s - first.sent_s), arrived


def _ping_us(kind: str) -> float:
    delays: list[float] = []
    with _hearing(kind, "ping") as subscriber:
        while len(delays) < PINGS and (message := subscriber.receive(START_S)) is not None:
            delays.append((time.monotonic() - message.sent_s) * 1e6)
    return statistics.median(delays)


def _talk(job: str) -> None:
    with network_for("bench-talker") as network:
        publisher = Publisher("/bench", network=network, wait_for_subscribers=1)
        text = filling(SIZE)

        def send(now_s: float) -> None:
            publisher.send(Text(now_s, text))

        if job == "flood":
            flood(send, FLOOD)
        else:
            ping([send], PINGS)


if __name__ == "__main__":
    _talk(sys.argv[1])
