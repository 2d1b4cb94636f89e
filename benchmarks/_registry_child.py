"""Nodes of the registry benchmark: ``MASTER KIND FIRST COUNT``; begins when a line comes."""

from __future__ import annotations

import contextlib
import sys
from typing import Any

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber

TOPICS_A_NODE = 5
SHARED_TOPIC = "/bench/shared"
LISTENS = 20
"""Every so many-th node hears the topic that all publish, as tools hear /node_state."""


def main(master: str, kind: str, first: int, count: int) -> None:
    """Register nodes: "topics" alone, with "subscribers", or with a "shared" topic of all."""
    print("there", flush=True)
    sys.stdin.readline()
    with contextlib.ExitStack() as stack:
        kept: list[Any] = []
        for number in range(first, first + count):
            network = stack.enter_context(PeerNetwork(f"node-{number}", master=master))
            topics = [f"/bench/{number}/{i}" for i in range(TOPICS_A_NODE)]
            if kind == "shared":
                topics[-1] = SHARED_TOPIC
            kept += [Publisher(topic, network=network) for topic in topics]
            if kind == "subscribers":
                kept.append(Subscriber(f"/bench/{number - 1}/0", network=network))
            elif kind == "shared" and number % LISTENS == 0:
                kept.append(Subscriber(SHARED_TOPIC, network=network))
        print("done", flush=True)
        sys.stdin.readline()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]))
