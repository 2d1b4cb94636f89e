"""Things that go wrong in a real window, in a process of its own: prints how soon each is told."""

from __future__ import annotations

import json
import os
import signal
import socket
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import psutil

from benchmarks._heartbeat_child import wait
from nep_core.processes.launcher import LaunchedNode
from nep_core.processes.process import Outcome
from nep_core.wire import messages as m
from nep_studio import paths
from nep_studio.run.node_board import FROZEN_S
from nep_studio.run.plan import MASTER, PROGRAM, PlannedNode
from nep_studio.settings import Settings
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.app import make_application
from nep_studio.ui.shell.main_window import MainWindow

ROUNDS = 2


class Clock:
    """When processes ended, what nodes told, and what the person was told (time.time())."""

    def __init__(self, window: MainWindow) -> None:
        self.runner = window.running.runner
        self.ends: dict[str, float] = {}
        self.states: list[m.NodeState] = []
        self.alarms: list[tuple[float, str]] = []
        window.messages.told.connect(self._on_told)
        self.runner.local.listen(self._on_message, self._on_end)

    def clear(self) -> None:
        """Forget all that was."""
        self.ends.clear()
        self.states.clear()
        self.alarms.clear()

    def told_s(self) -> float:
        """When the first alarm was told; waits for it."""
        wait(lambda: bool(self.alarms))
        return self.alarms[0][0]

    def state_s(self, node: str, event: str) -> float:
        """When a node told that, by its own clock."""
        return next(one.time for one in self.states if (one.node, one.event) == (node, event))

    def _on_told(self, told: object) -> None:
        if told.message.kind in ("warning", "error"):  # type: ignore[attr-defined]
            self.alarms.append((time.time(), told.message.title))  # type: ignore[attr-defined]

    def _on_message(self, _topic: str, message: object) -> None:
        if isinstance(message, m.NodeState):
            self.states.append(message)

    def _on_end(self, launched: LaunchedNode, _outcome: Outcome, _again: bool) -> None:
        self.ends.setdefault(launched.name, time.time())


def kill(window: MainWindow, clock: Clock, name: str) -> float:
    """From the moment at which a process is killed to the message, in ms."""
    run(clock)
    local = clock.runner.local
    launcher = local._master_launcher if name == MASTER else local.launcher
    pid = launcher.nodes[name].pid
    assert pid  # 0 would be this process and its parents
    clock.clear()
    began_s = time.time()
    os.kill(pid, signal.SIGKILL)
    told_s = clock.told_s()
    if name == MASTER:
        wait(lambda: any("open again" in card.message.title for card in window.message_area.cards))
    else:
        board = clock.runner.board.nodes
        wait(lambda: board[name].health in ("ready", "busy") and board[name].pid != pid)
    return 1000 * (told_s - began_s)


def run(clock: Clock) -> None:
    """Let the program run from its beginning: the example ends after a while."""
    clock.runner.stop()
    wait(lambda: clock.runner.state == "idle")
    clock.runner.run()
    board = clock.runner.board.nodes
    names = ("karate", "NAO", "watch", PROGRAM)
    wait(lambda: all(name in board and board[name].health in ("ready", "busy") for name in names))
    wait(lambda: clock.runner.state == "running")


def freeze(clock: Clock, name: str) -> float:
    """From the third missed heartbeat to the message, in ms."""
    process = psutil.Process(clock.runner.local.launcher.nodes[name].pid)
    clock.clear()
    process.suspend()
    told_s = clock.told_s()
    missed_s = clock.runner.board.nodes[name].heard_s + FROZEN_S
    process.resume()
    wait(lambda: clock.runner.board.nodes[name].health == "ready")
    return 1000 * (told_s - missed_s)


def fall_silent(clock: Clock) -> float:
    """From the moment at which the node of a watch misses its samples to the message, in ms."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    clock.runner.start_node(PlannedNode("sensory/smartwatch", "phone", {"port": port}))
    board = clock.runner.board.nodes
    wait(lambda: "phone" in board and board["phone"].health == "ready")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as watch:
        number = 0

        def is_connected() -> bool:
            nonlocal number
            number += 1
            watch.sendto(f"a;{number * 20_000_000};0;0;9.81\n".encode(), ("127.0.0.1", port))
            return board["phone"].event == "connected"

        wait(is_connected)
    clock.clear()
    return 1000 * (clock.told_s() - clock.state_s("phone", "disconnected"))


def miss_robot(clock: Clock) -> float:
    """From the moment at which the robot's node knows that nobody answers to the message, in ms."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{probe.getsockname()[1]}"
    settings = {"robot": "NAO2", "driver": "naoqi", "address": address}
    clock.clear()
    clock.runner.start_node(PlannedNode("action/nao", "NAO2", settings))
    return 1000 * (clock.told_s() - clock.state_s("NAO2", "connection_failed"))


def measure(folder: Path) -> dict[str, float]:
    """How soon each is told, in ms; the worst of all rounds."""
    app = make_application()
    window = MainWindow(Studio(app, Settings(folder)))
    window.show()
    window.start(None)
    window.files.open_example(paths.examples() / "karate_greeting.nep")
    clock = Clock(window)
    faults: dict[str, Callable[[], float]] = {
        name: lambda name=name: kill(window, clock, name)  # type: ignore[misc]
        for name in ("karate", "NAO", "watch", PROGRAM, MASTER)
    }
    found = {f"kill -9 {name}": max(do() for _ in range(ROUNDS)) for name, do in faults.items()}
    run(clock)
    found["a node freezes"] = freeze(clock, "karate")
    found["a watch falls silent"] = fall_silent(clock)
    found["a wrong robot address"] = miss_robot(clock)
    window.running.close()
    return found


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="nep-faults-", ignore_cleanup_errors=True) as home:
        os.environ["NEP_STUDIO_FOLDER"] = home
        result = measure(Path(home))
        print(json.dumps(result), file=sys.stdout, flush=True)
        os._exit(0)
