"""Sensory nodes in processes of their own, and a program that hears what they say."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from nep_core.messages import IMU, NODE_STATE, Imu, NodeState
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Publisher, Subscriber

NODES = Path(__file__).resolve().parents[3] / "nodes"
START = """
import ast, sys
from pathlib import Path
from nep_core.manifest import read_manifest
from nep_core.run_node import run_node
sys.exit(run_node(read_manifest(Path(sys.argv[1])), sys.argv[2], ast.literal_eval(sys.argv[3])))
"""


class Listener:
    """Starts sensory nodes, and hears their samples and states."""

    def __init__(self, network: PeerNetwork) -> None:
        self.network = network
        self.imu = Subscriber(IMU, Imu, network=network)
        self.states = Subscriber(NODE_STATE, NodeState, network=network)
        self.nodes: list[subprocess.Popen[str]] = []

    def start(self, name: str, **parameters: object) -> subprocess.Popen[str]:
        manifest = str(NODES / "sensory" / f"{name}.toml")
        own_name = f"{name}_{len(self.nodes)}"
        node = subprocess.Popen(
            [sys.executable, "-c", START, manifest, own_name, repr(parameters)],
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.nodes.append(node)
        return node

    def publisher(self, topic: str) -> Publisher:
        return Publisher(topic, network=self.network, wait_for_subscribers=1)

    def state(self, event: str, words: str = "") -> NodeState:
        """The next state of this kind with these words in it."""
        states = until(self.states, lambda s: s.event == event and words in s.description)
        return states[-1]

    def batches_until(self, wanted: Callable[[Imu], bool]) -> list[Imu]:
        """All batches up to the first that is wanted."""
        return until(self.imu, wanted)

    def batches_for(self, seconds: float) -> list[Imu]:
        """What arrives in this time; what came before is left out."""
        return heard_for(self.imu, seconds)

    def states_for(self, seconds: float) -> list[NodeState]:
        return heard_for(self.states, seconds)

    def close(self) -> None:
        for node in self.nodes:
            node.terminate()
        for node in self.nodes:
            node.communicate(timeout=5)


def until(subscriber: Subscriber[Any], wanted: Callable[[Any], bool]) -> list[Any]:
    """All messages up to the first that is wanted; fails when it does not come."""
    end_s, heard = time.monotonic() + 10, []
    while (left_s := end_s - time.monotonic()) > 0:
        message = subscriber.receive(left_s)
        if message is not None:
            heard.append(message)
            if wanted(message):
                return heard
    pytest.fail(f"what was wanted did not come, but {heard[-5:]}")


def heard_for(subscriber: Subscriber[Any], seconds: float) -> list[Any]:
    subscriber.pending()
    end_s, heard = time.monotonic() + seconds, []
    while (left_s := end_s - time.monotonic()) > 0:
        if (message := subscriber.receive(left_s)) is not None:
            heard.append(message)
    return heard


@pytest.fixture
def listener(join: Callable[[str], PeerNetwork]) -> Iterator[Listener]:
    listener = Listener(join("listener"))
    yield listener
    listener.close()
