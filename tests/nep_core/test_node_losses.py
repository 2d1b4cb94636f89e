"""A node that cannot keep up says so, and says when it is over."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes import node as node_module
from nep_core.processes.node import Node
from nep_core.wire import inbox
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.master_process import until

Join = Callable[[str], PeerNetwork]


def told_until(states: Subscriber[NodeState], event: str) -> list[NodeState]:
    told: list[NodeState] = []
    for _ in range(200):
        state = states.receive(5)
        assert state is not None
        told.append(state)
        if state.event == event:
            return told
    raise AssertionError(f"it never said {event}")


def test_lost_messages_are_a_warning_until_the_node_keeps_up_again(
    join: Join, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inbox, "FRAMES", 10)
    monkeypatch.setattr(node_module, "HEARTBEAT_S", 0.1)
    states = Subscriber(NODE_STATE, NodeState, network=join("watcher"))
    with Node("slow", "perceptual", network=join("slow")) as slow:
        samples = Subscriber[object]("/samples", network=slow.network)
        slow.follow(samples)
        publisher = Publisher("/samples", network=join("fast"), wait_for_subscribers=1)
        publisher.send({"number": -1})
        samples.receive(5)
        for number in range(30):
            publisher.send({"number": number})  # nobody reads them

        warning = told_until(states, "warning")[-1]
        calm = told_until(states, "running")[-1]

    assert samples.lost == 20  # of 30, 10 were kept
    assert warning.description.startswith("Messages of /samples were lost: ")
    assert calm.description == "It keeps up again."


def test_subscribers_that_a_node_gave_up_take_no_memory(
    join: Join, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(node_module, "HEARTBEAT_S", 0.02)
    with Node("restless", "perceptual", network=join("restless")) as node:
        for _ in range(3):
            node.subscriber("/samples").close()

        assert until(lambda: not node._listening)
