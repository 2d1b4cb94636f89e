"""Runs nodes in processes of their own, and waits for what they say."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Subscriber

NODES = Path(__file__).resolve().parents[1] / "nodes"
WAIT_S = 20.0
# The command line carries text only; tests give values of every type.
START = """
import ast, sys
from pathlib import Path
from nep_core.processes.manifest import read_manifest
from nep_core.cli.node import run_node
sys.exit(run_node(read_manifest(Path(sys.argv[1])), sys.argv[2], ast.literal_eval(sys.argv[3])))
"""


class NodeRunner:
    """Starts nodes, hears their states, and ends them all."""

    def __init__(self, network: PeerNetwork) -> None:
        self.network = network
        self.states = Subscriber(NODE_STATE, NodeState, network=network)
        self.nodes: list[subprocess.Popen[str]] = []
        self.prepare = ""
        """Python that a process runs before its node: to make it slow, or to let it fail."""

    def start_node(self, node: str, name: str, **parameters: object) -> subprocess.Popen[str]:
        """Start "type/node" under a name."""
        manifest = str(NODES / f"{node}.toml")
        process = subprocess.Popen(
            [sys.executable, "-c", self.prepare + START, manifest, name, repr(parameters)],
            stdin=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.nodes.append(process)
        return process

    def state(self, event: str, words: str = "", node: str = "") -> NodeState:
        """The next state of this kind, with these words in it, of this node (or of any)."""
        return until(
            self.states,
            lambda s: s.event == event and words in s.description and node in ("", s.node),
        )[-1]

    def close(self) -> None:
        """End all nodes."""
        for node in self.nodes:
            node.terminate()
        for node in self.nodes:
            node.communicate(timeout=5)


def until(subscriber: Subscriber[Any], wanted: Callable[[Any], bool]) -> list[Any]:
    """All messages up to the first that is wanted; fails when it does not come."""
    end_s, heard = time.monotonic() + WAIT_S, []
    while (left_s := end_s - time.monotonic()) > 0:
        message = subscriber.receive(left_s)
        if message is not None:
            heard.append(message)
            if wanted(message):
                return heard
    pytest.fail(f"what was wanted did not come, but {heard[-5:]}")
