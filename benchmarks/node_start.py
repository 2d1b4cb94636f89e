"""How long a node takes from the launcher's start to ``ready``; the reference is bare Python."""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import Launcher

NODES: dict[str, dict[str, str | float]] = {
    "sensory/virtual_watch": {},
    "perceptual/gesture": {"gesture": "karate"},
    "action/nao": {},
}
ROUNDS = 7
GOAL_S = 0.5


def run() -> list[dict[str, Any]]:
    """A row a node: median seconds, goal under 0.5."""
    master = Master("tcp://127.0.0.1:*")
    with (
        tempfile.TemporaryDirectory() as logs,
        PeerNetwork("bench", master=master.endpoint) as network,
        Launcher(master=master.endpoint, logs=Path(logs)) as launcher,
    ):
        launcher.hear(network)
        times_s: dict[str, list[float]] = {node: [] for node in NODES}
        bare_s = []
        for _ in range(ROUNDS):
            bare_s.append(_bare_start_s())
            for node in NODES:
                times_s[node].append(_start_s(launcher, node))
    master.close()
    return [_row(node, statistics.median(times_s[node]), bare_s) for node in NODES]


def _start_s(launcher: Launcher, node: str) -> float:
    started_s = time.monotonic()
    launched = launcher.launch(node, "bench_node", NODES[node])
    launched.ready.wait(20)
    elapsed_s = time.monotonic() - started_s
    launcher.stop("bench_node")
    return elapsed_s


def _bare_start_s() -> float:
    started_s = time.monotonic()
    subprocess.run([sys.executable, "-c", "pass"], check=True)
    return time.monotonic() - started_s


def _row(node: str, seconds: float, bare_s: list[float]) -> dict[str, Any]:
    bare = statistics.median(bare_s)
    return {
        "name": f"start of {node}",
        "value": round(seconds, 3),
        "unit": "s",
        "reference": round(bare, 3),
        "ratio": round(seconds / bare, 2),
        "goal": "under 0.5 s",
        "ok": seconds < GOAL_S,
    }
