"""A master in this process, and nodes in processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeVar

import pytest

from nep_core.endpoints import MASTER_VARIABLE
from nep_core.master import Master
from nep_core.messages import IMU, NODE_STATE, Imu, NodeState
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Publisher, Subscriber

T = TypeVar("T")

NODES = Path(__file__).resolve().parents[3] / "nodes"
START = """
import ast, sys
from pathlib import Path
from nep_core.manifest import read_manifest
from nep_core.run_node import run_node
sys.exit(run_node(read_manifest(Path(sys.argv[1])), sys.argv[2], ast.literal_eval(sys.argv[3])))
"""


class Listener:
    """A program that hears what sensory nodes say."""

    def __init__(self, master: str) -> None:
        self.master = master
        self.network = PeerNetwork("listener", master=master)
        self.imu = Subscriber(IMU, Imu, network=self.network)
        self.states = Subscriber(NODE_STATE, NodeState, network=self.network)
        self.nodes: list[subprocess.Popen[str]] = []

    def start(self, name: str, **parameters: object) -> subprocess.Popen[str]:
        manifest = str(NODES / "sensory" / f"{name}.toml")
        node = subprocess.Popen(
            [sys.executable, "-c", START, manifest, name, repr(parameters)],
            env={**os.environ, MASTER_VARIABLE: self.master},
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.nodes.append(node)
        return node

    def publisher(self, topic: str) -> Publisher:
        return Publisher(topic, network=self.network, wait_for_subscribers=1)

    def state(self, event: str, words: str = "", timeout_s: float = 10.0) -> NodeState:
        """The next state of this kind with these words in it."""
        return first(
            self.states, lambda s: s.event == event and words in s.description, timeout_s
        )

    def close(self) -> None:
        for node in self.nodes:
            node.terminate()
        for node in self.nodes:
            node.communicate(timeout=5)
        self.network.close()


def first(subscriber: Subscriber[T], wanted: Callable[[T], bool], timeout_s: float = 10.0) -> T:
    """The next message that is wanted; fails with all that came instead."""
    end_s, others = time.monotonic() + timeout_s, []
    while (left_s := end_s - time.monotonic()) > 0:
        message = subscriber.receive(left_s)
        if message is not None and wanted(message):
            return message
        others.append(message)
    pytest.fail(f"nothing that was wanted came, but {others[-5:]}")


@pytest.fixture
def listener() -> Iterator[Listener]:
    master = Master("tcp://127.0.0.1:*")
    listener = Listener(master.endpoint)
    yield listener
    listener.close()
    master.close()
