"""How long a NAO that walks freely goes on when who drives it is gone, at any moment of its steps.

The robot is the virtual NAO behind NAOqi, in a process of its own. Measured from the fault to the
last moment at which ALMotion says that it walks, and at which it still gets on; the worst round.
The faults: a link that passes nothing on any more, also one that needs 20 ms each way; the robot's
node that stands still or is killed; the program that is killed, while the node goes on.
"""

from __future__ import annotations

import contextlib
import os
import queue
import random
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

from nep_core.wire.messages import ACTION_REQUEST, ActionRequest
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import PlannedNode
from robots.naoqi.client.session import Session

from .naoqi_faults import Pilot, virtual_nao

GOAL_S, PROGRAM_GOAL_S = 1.0, 2.0
PACE_GOAL_M_S = 0.07
ROUNDS, PROCESS_ROUNDS = 30, 10
LATENCY_S = 0.02
STILL_S = 0.8
WAIT_S = 30.0
LIMIT_S = 1800.0
MOMENTS_S = (0.5, 1.5)
"""The fault comes so long after the robot has begun to walk."""
LONG_M = 1.0
PROGRAM = """
import time
from nep_core import Robot
Robot("NAO").start_walking(100)
time.sleep(60)
"""


def run() -> list[dict[str, Any]]:
    """Two rows for each fault, and how fast it walks while nothing is wrong."""
    rows = [_pace_row("", 0.0), _pace_row(", 20 ms each way", LATENCY_S)]
    for name, latency_s in (("", 0.0), (", 20 ms each way", LATENCY_S)):
        rows += _rows(f"a frozen link{name}", _frozen(latency_s), GOAL_S)
    for name, how in (("stands still", signal.SIGSTOP), ("is killed", signal.SIGKILL)):
        rounds = [_node_ends(how) for _ in range(PROCESS_ROUNDS)]
        rows += _rows(f"a node that {name}", rounds, GOAL_S)
    rounds = [_program_ends() for _ in range(PROCESS_ROUNDS)]
    return rows + _rows("a program that is killed", rounds, PROGRAM_GOAL_S)


class Line:
    """Passes on what a robot and its driver say, later by some time, until it is frozen."""

    def __init__(self, port: int, latency_s: float) -> None:
        self.is_frozen = False
        self._port, self._latency_s = port, latency_s
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._server.getsockname()[1])
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        """Let nobody in any more."""
        self._server.close()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                driver, _ = self._server.accept()
                robot = socket.create_connection(("127.0.0.1", self._port))
                for one, other in ((driver, robot), (robot, driver)):
                    one.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                    due: queue.SimpleQueue[tuple[float, bytes]] = queue.SimpleQueue()
                    for work, end in ((self._take, one), (self._give, other)):
                        threading.Thread(target=work, args=(end, due), daemon=True).start()

    def _take(self, one: socket.socket, due: queue.SimpleQueue[tuple[float, bytes]]) -> None:
        words = b"-"
        with contextlib.suppress(OSError):
            while words:
                words = one.recv(65536)
                due.put((time.monotonic() + self._latency_s, words))
        due.put((0.0, b""))

    def _give(self, other: socket.socket, due: queue.SimpleQueue[tuple[float, bytes]]) -> None:
        with contextlib.suppress(OSError):
            while True:
                due_s, words = due.get()
                while self.is_frozen or time.monotonic() < due_s:
                    time.sleep(0.001)
                if not words:
                    other.shutdown(socket.SHUT_RDWR)
                    return
                other.sendall(words)


class Onlooker:
    """Sees by a line of its own whether the robot walks, and where it is."""

    def __init__(self, port: int) -> None:
        self.session = Session(("127.0.0.1", port))
        self.session.connect()
        self._motion = self.session.service("ALMotion")
        self.active_s = self.moved_s = self.now_s = time.monotonic()
        self._place = self.place()

    def place(self) -> list[float]:
        """Where the robot is: m, m, rad."""
        return list(self._motion.call("getRobotPosition", True))

    def is_still(self) -> bool:
        """Look once more; whether the robot has done nothing for a while."""
        if self._motion.call("moveIsActive"):
            self.active_s = time.monotonic()
        place = self.place()
        if place != self._place:
            self._place, self.moved_s = place, time.monotonic()
        return time.monotonic() - max(self.active_s, self.moved_s) > STILL_S

    def until(self, is_so: Callable[[], bool]) -> None:
        """Wait until something is so. Raises TimeoutError."""
        end_s = time.monotonic() + WAIT_S
        while not is_so():
            if time.monotonic() > end_s:
                raise TimeoutError("the robot does not do what it should")
            time.sleep(0.003)

    def after(self, fault_s: float) -> tuple[float, float]:
        """How long after a fault it walked, and moved, when it has been still since."""
        return self.active_s - fault_s, self.moved_s - fault_s


@contextlib.contextmanager
def _piloted(latency_s: float) -> Iterator[tuple[Pilot, Line, Onlooker]]:
    """A robot, its driver at the end of a line, and who looks on."""
    with virtual_nao() as (port, _), closing(Line(port, latency_s)) as line:
        pilot, onlooker = Pilot(line.port), Onlooker(port)
        pilot.until(lambda: pilot.is_told("connected") and pilot.driver.state() is not None)
        yield pilot, line, onlooker
        pilot.driver.disconnect()
        onlooker.session.close()


def _frozen(latency_s: float) -> list[tuple[float, float]]:
    rounds = []
    with _piloted(latency_s) as (pilot, line, onlooker):
        for _ in range(ROUNDS):
            pilot.until(lambda: pilot.is_told("connected") and not pilot.driver.moving)
            here = onlooker.place()
            pilot.ask("walk_freely", forward=1.0)
            pilot.until(lambda here=here: _far(here, onlooker.place()) > 0.02)  # type: ignore[misc]
            _pass_time(pilot, random.uniform(*MOMENTS_S))
            line.is_frozen, fault_s = True, time.monotonic()
            pilot.until(onlooker.is_still)
            rounds.append(onlooker.after(fault_s))
            line.is_frozen = False
            pilot.ask("stop")
    return rounds


def _pass_time(pilot: Pilot, seconds: float) -> None:
    end_s = time.monotonic() + seconds
    pilot.until(lambda: time.monotonic() >= end_s)


def _node_ends(how: signal.Signals) -> tuple[float, float]:
    with _driven() as (network, pid, onlooker):
        args = {"forward": 1.0}
        request = ActionRequest(id="1", robots=["NAO"], action="walk_freely", args=args)
        network.tell(ACTION_REQUEST, request)
        return _ended(pid, how, onlooker)


def _program_ends() -> tuple[float, float]:
    with _driven() as (network, _, onlooker):
        environment = os.environ | {"NEP_MASTER": network.launcher.master}
        program = subprocess.Popen([sys.executable, "-c", PROGRAM], env=environment)
        try:
            return _ended(program.pid, signal.SIGKILL, onlooker)
        finally:
            program.kill()
            program.wait()


@contextlib.contextmanager
def _driven() -> Iterator[tuple[LocalNetwork, int, Onlooker]]:
    """A robot that a node drives: its network, the node's process, and who looks on."""
    with tempfile.TemporaryDirectory() as folder, virtual_nao() as (port, _):
        settings = {"robot": "NAO", "driver": "naoqi", "address": f"127.0.0.1:{port}"}
        network = LocalNetwork(logs=Path(folder))
        with closing(network):
            network.open()
            (node,) = network.start([PlannedNode("action/nao", "NAO", settings)])
            node.wait_ready()
            onlooker = Onlooker(port)
            yield network, node.pid, onlooker
            onlooker.session.close()


def _ended(pid: int, how: signal.Signals, onlooker: Onlooker) -> tuple[float, float]:
    """End a process in the middle of a walk; how long the robot goes on."""
    onlooker.until(lambda: onlooker.place()[0] > 0.02)
    time.sleep(random.uniform(*MOMENTS_S))
    fault_s = time.monotonic()
    os.kill(pid, how)
    onlooker.until(onlooker.is_still)
    if how == signal.SIGSTOP:
        os.kill(pid, signal.SIGKILL)
    return onlooker.after(fault_s)


def _far(here: list[float], there: list[float]) -> float:
    return abs(there[0] - here[0]) + abs(there[1] - here[1])


def _rows(name: str, rounds: list[tuple[float, float]], goal_s: float) -> list[dict[str, Any]]:
    walked_s, moved_s = (max(of_each) for of_each in zip(*rounds, strict=True))
    return [
        {
            "name": f"{name}: the robot {what} so long",
            "value": round(seconds, 2),
            "unit": "s",
            "goal": f"at most {goal_s:g} s",
            "ok": seconds <= goal_s,
        }
        for what, seconds in (("walks", walked_s), ("gets on", moved_s))
    ]


def _pace_row(name: str, latency_s: float) -> dict[str, Any]:
    with _piloted(latency_s) as (pilot, _, onlooker):
        pilot.ask("walk_freely", forward=1.0)
        pilot.until(lambda: onlooker.place()[0] > 0.1)
        seconds = pilot.until(lambda: onlooker.place()[0] > 0.1 + LONG_M)
        pilot.ask("stop")
    return {
        "name": f"a free walk gets on{name}",
        "value": round(LONG_M / seconds, 3),
        "unit": "m/s",
        "goal": f"at least {PACE_GOAL_M_S:g} m/s",
        "ok": LONG_M / seconds >= PACE_GOAL_M_S,
    }
