"""How soon the network hears that a node has crashed; the reference is the wait of its parent."""

from __future__ import annotations

import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import LaunchedNode, Launcher
from nep_core.processes.process import descendants
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber

ROUNDS = 11
GOAL_MS = 300
LONG_S = 20.0
TOPIC = "/bench_fail"

MANIFEST = 'type = "sensory"\nname = "{name}"\ntitle = "T"\ndescription = "D"\nrestart = "never"\n'
PYTHON = f"""
def run(node):
    orders = node.subscriber("{TOPIC}")
    node.ready()
    if orders.receive() is not None:
        raise RuntimeError("the lamp broke")
"""
SHELL = 'command = ["sh", "-c", "echo here; while :; do sleep 1; done"]\n'


def run() -> list[dict[str, Any]]:
    """A row a way to crash: median ms until a subscriber has the state; goal under 300."""
    master = Master("tcp://127.0.0.1:*")
    with (
        tempfile.TemporaryDirectory() as folder,
        PeerNetwork("bench", master=master.endpoint) as network,
        PeerNetwork("watcher", master=master.endpoint) as watcher,
        Launcher(master=master.endpoint, logs=Path(folder), folders=(Path(folder),)) as launcher,
    ):
        _write_nodes(Path(folder) / "sensory")
        launcher.hear(network)
        states = Subscriber(NODE_STATE, NodeState, network=watcher)
        orders = Publisher(TOPIC, network=network)
        ways: dict[str, tuple[str, Callable[[LaunchedNode], object]]] = {
            "a node that is killed": ("lamp", lambda node: os.kill(node.pid, signal.SIGKILL)),
            "a node that raises": ("lamp", lambda _node: orders.send({"now": True})),
            "a shell node that is killed": ("shell", _kill_shell),
        }
        times_ms: dict[str, list[float]] = {connector: [] for connector in ways}
        bare_ms = []
        for _ in range(ROUNDS):
            bare_ms.append(_bare_ms())
            for connector, (node, crash) in ways.items():
                times_ms[connector].append(_crash_ms(launcher, states, node, crash))
    master.close()
    return [
        _row(connector, times, statistics.median(bare_ms)) for connector, times in times_ms.items()
    ]


def _write_nodes(folder: Path) -> None:
    folder.mkdir()
    (folder / "lamp.toml").write_text(MANIFEST.format(name="lamp"), encoding="utf-8")
    (folder / "lamp.py").write_text(PYTHON, encoding="utf-8")
    (folder / "shell.toml").write_text(MANIFEST.format(name="shell") + SHELL, encoding="utf-8")


def _kill_shell(node: LaunchedNode) -> None:
    for process in descendants(node.pid):
        process.kill()


def _crash_ms(
    launcher: Launcher,
    states: Subscriber[NodeState],
    node: str,
    crash: Callable[[LaunchedNode], object],
) -> float:
    launched = launcher.launch(f"sensory/{node}")
    if node == "lamp":
        launched.wait_ready()
    while node == "shell" and not (launched.process and launched.process.last_lines):
        time.sleep(0.01)
    while states.receive(0) is not None:
        pass  # what it told before
    started_s = time.perf_counter()
    crash(launched)
    while (state := states.receive(LONG_S)) is not None and state.event != "crashed":
        pass
    took_ms = (time.perf_counter() - started_s) * 1000
    launched.end_reported.wait(LONG_S)
    return took_ms


def _bare_ms() -> float:
    with subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE) as child:
        started_s = time.perf_counter()
        child.kill()
        child.wait()
    return (time.perf_counter() - started_s) * 1000


def _row(connector: str, times_ms: list[float], bare_ms: float) -> dict[str, Any]:
    median = statistics.median(times_ms)
    return {
        "name": f"crash of {connector} is heard",
        "value": round(median, 1),
        "unit": "ms",
        "reference": round(bare_ms, 1),
        "ratio": round(median / bare_ms, 1),
        "goal": f"under {GOAL_MS} ms",
        "ok": median < GOAL_MS,
    }
