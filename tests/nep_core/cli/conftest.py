"""A network with something going on, and the command line as a person calls it."""

from __future__ import annotations

import shlex
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import pytest

from nep_core.cli import main
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.node import Node
from nep_core.wire.messages import HUMAN_BEHAVIOR, IMU, HumanBehavior, Imu

PAUSE_S = 0.01


@dataclass
class Answer:
    """What a command gave: its exit code, its output, what it said beside it."""

    code: int
    out: str
    err: str


Call = Callable[[str], Answer]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """Runs a command line in this process."""

    def run(line: str) -> Answer:
        capsys.readouterr()
        try:
            code = main(shlex.split(line)[1:])
        except SystemExit as end:
            code = int(end.code or 0)
        told = capsys.readouterr()
        return Answer(code, told.out, told.err)

    return run


@pytest.fixture
def busy(join: Callable[[str], PeerNetwork]) -> Iterator[PeerNetwork]:
    """A node "watch" that publishes /imu, /human_behavior and /speed 100 times a second."""
    network = join("watch")
    stopping = threading.Event()
    network.on_stop = stopping.set

    def talk() -> None:
        with Node("watch", "sensory", network=network) as node:
            says = [node.publisher(topic) for topic in (IMU, HUMAN_BEHAVIOR, "/speed")]
            started.set()
            node.ready("")
            while not stopping.wait(PAUSE_S):
                says[0].send(Imu(source="w", rate_hz=100.0, t=[0.0], acc=[(0.0, 0.0, 9.8)]))
                says[1].send(HumanBehavior(human_state="happy"))
                says[2].send({"m_s": 0.5})

    started = threading.Event()
    talker = threading.Thread(target=talk)
    talker.start()
    assert started.wait(30)
    yield network
    stopping.set()
    talker.join()


def until(is_so: Callable[[], object], timeout_s: float = 10.0) -> None:
    """Wait for a condition."""
    end_s = time.monotonic() + timeout_s
    while not is_so():
        assert time.monotonic() < end_s, "it did not happen in time"
        time.sleep(0.01)


def nep(*words: str, **how: object) -> subprocess.Popen[str]:
    """Start the command ``nep`` in a process of its own."""
    command = [sys.executable, "-m", "nep_core.cli", *words]
    return subprocess.Popen(command, text=True, encoding="utf-8", **how)  # type: ignore[call-overload]
