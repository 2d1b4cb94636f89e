"""How quickly nodes and topics register with the master, and how quickly it finds one.

Real nodes, fifty in each of four processes, which register one after the other; the master is a
process of its own. The time is from the start until the last node has all its topics.
"""

from __future__ import annotations

import contextlib
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from typing import Any

import psutil

from benchmarks._registry_child import TOPICS_A_NODE
from nep_core.networks import master_messages as says
from nep_core.networks.master_messages import MasterProbe, ask_master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher

NODES = 200
PROCESSES = 4
TOPICS = NODES * TOPICS_A_NODE
LOOKUPS = 1000
MOST_S = 3.0
MOST_LOOKUP_MS = 1.0
LONGEST_RECOVERY_S = 20.0


def run() -> list[dict[str, Any]]:
    """Registering (goal: at most 3 s), a lookup (at most 1 ms), one node alone with all topics."""
    rows = []
    for kind, words in (
        ("topics", f"{NODES} nodes with {TOPICS} topics"),
        ("subscribers", "the same, a subscriber each"),
        ("shared", "the same, with one topic of all that ten hear"),
    ):
        with master_process() as (endpoint, master), nodes(endpoint, kind) as took_s:
            # The last of them grows with the square of the nodes, so it has no goal.
            rows.append(row(words, took_s, "s", MOST_S if kind != "shared" else None))
            if kind == "subscribers":
                rows += lookups(endpoint)
                rows.append(row("memory of the master", master.memory_info().rss / 1e6, "MB"))
                rows.append(row("all back after a restart", recovery_s(endpoint, master), "s", 2.0))
    rows.append(row(f"one node with {TOPICS} topics", one_node_s(), "s"))
    return rows


def row(name: str, value: float, unit: str, most: float | None = None) -> dict[str, Any]:
    """A figure, with a goal where there is one."""
    figure: dict[str, Any] = {"name": name, "value": round(value, 4), "unit": unit}
    return figure if most is None else figure | {"goal": f"at most {most:g}", "ok": value <= most}


@contextlib.contextmanager
def master_process(endpoint: str = "tcp://127.0.0.1:*") -> Iterator[tuple[str, psutil.Process]]:
    """A master in a process of its own, and where it is."""
    command = [sys.executable, "-m", "benchmarks._master_child", endpoint]
    child = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    try:
        yield child.stdout.readline().strip(), psutil.Process(child.pid)
    finally:
        child.kill()
        child.communicate()


@contextlib.contextmanager
def nodes(endpoint: str, kind: str) -> Iterator[float]:
    """All nodes at work, and how long it took until they were (s)."""
    count = NODES // PROCESSES
    command = [sys.executable, "-m", "benchmarks._registry_child", endpoint, kind]
    pipe = subprocess.PIPE
    children = [
        subprocess.Popen([*command, str(i * count), str(count)], stdin=pipe, stdout=pipe)
        for i in range(PROCESSES)
    ]
    try:
        for child in children:
            expect(child, b"there\n")
        began_s = time.monotonic()
        for child in children:
            begin(child)
        for child in children:
            expect(child, b"done\n")
        yield time.monotonic() - began_s
    finally:
        for child in children:
            child.kill()
            child.communicate()


def expect(child: subprocess.Popen[bytes], line: bytes) -> None:
    """Wait for a line of a child."""
    assert child.stdout is not None
    heard = child.stdout.readline()
    assert heard == line, heard


def begin(child: subprocess.Popen[bytes]) -> None:
    """Let a child go on."""
    assert child.stdin is not None
    child.stdin.write(b"\n")
    child.stdin.flush()


def lookups(endpoint: str) -> list[dict[str, Any]]:
    """How long the master takes to say who publishes a topic."""
    times_ms = []
    with contextlib.closing(MasterProbe(endpoint)) as probe:
        for i in range(LOOKUPS):
            began_s = time.perf_counter()
            found = probe.ask(says.Find(topic=f"/bench/{i % NODES}/0"), says.Found)
            times_ms.append((time.perf_counter() - began_s) * 1000)
            assert found is not None and len(found.publishers) == 1
    p99 = statistics.quantiles(times_ms, n=100)[-1]
    return [
        row("lookup of a topic, median", statistics.median(times_ms), "ms", MOST_LOOKUP_MS),
        row("lookup of a topic, p99", p99, "ms"),
    ]


def recovery_s(endpoint: str, master: psutil.Process) -> float:
    """How long a new master takes to know all nodes, when the one before is killed."""
    master.kill()
    master.wait()
    with master_process(endpoint):
        began_s = time.monotonic()
        while time.monotonic() < began_s + LONGEST_RECOVERY_S:
            listing = ask_master(endpoint)
            if listing is not None and len(listing.registrations) == NODES:
                break
        return time.monotonic() - began_s


def one_node_s() -> float:
    """How long one node takes to register many topics, one by one."""
    with master_process() as (endpoint, _), PeerNetwork("alone", master=endpoint) as network:
        began_s = time.monotonic()
        for i in range(TOPICS):
            Publisher(f"/bench/{i}", network=network)
        return time.monotonic() - began_s
