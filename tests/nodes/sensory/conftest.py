"""Sensory nodes in processes of their own, and a program that hears what they say."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import IMU, Imu, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.node_running import NodeRunner, until


class Listener(NodeRunner):
    """Starts sensory nodes, and hears their samples and states."""

    def __init__(self, network: PeerNetwork) -> None:
        super().__init__(network)
        self.imu = Subscriber(IMU, Imu, network=network)

    def start(self, name: str, **parameters: object) -> subprocess.Popen[str]:
        return self.start_node(f"sensory/{name}", f"{name}_{len(self.nodes)}", **parameters)

    def publisher(self, topic: str) -> Publisher:
        return Publisher(topic, network=self.network, wait_for_subscribers=1)

    def batches_until(self, wanted: Callable[[Imu], bool]) -> list[Imu]:
        """All batches up to the first that is wanted."""
        return until(self.imu, wanted)

    def batches_for(self, seconds: float) -> list[Imu]:
        """What arrives in this time; what came before is left out."""
        return heard_for(self.imu, seconds)

    def states_for(self, seconds: float) -> list[NodeState]:
        return heard_for(self.states, seconds)


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
