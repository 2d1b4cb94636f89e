"""The example nodes count what is missing as docs/wire.md says, and take nothing twice."""

from __future__ import annotations

import re

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.launcher import Launcher
from nep_core.wire.messages import HUMAN_BEHAVIOR, NODE_STATE, HumanBehavior, NodeState
from nep_core.wire.pubsub import Subscriber
from tests.examples.raw_publisher import RawPublisher
from tests.node_running import until

pytestmark = pytest.mark.long


def shaken(source: str, t: float) -> dict[str, object]:
    """A sample that is strong enough by itself, at its own time: it is told of once."""
    return {"source": source, "rate_hz": 1, "t": [t], "acc": [[50, 0, 0]]}


def test_what_is_missing_is_counted_also_at_the_end_and_nothing_is_taken_twice(
    launcher: Launcher, network: PeerNetwork
) -> None:
    behavior = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=network)
    launcher.start("perceptual/shake").wait_ready(20)
    states = Subscriber(NODE_STATE, NodeState, network=network)
    with RawPublisher(network.master) as raw:
        raw.register()

        raw.send_notice(3, 4, shaken("latched", 0))  # sent before we came: new, nothing lost
        raw.send(5, shaken("five", 10), shaken("six", 20))
        raw.send(10, shaken("ten", 30))  # 7, 8 and 9 are missing
        raw.send_notice(5, 10, shaken("five", 40))  # we have had that one
        raw.send_notice(12, 12)  # 11 and 12 are missing
        raw.send(13, shaken("thirteen", 50))

        told = until(behavior, lambda behavior: behavior.source == "thirteen")
        lost = 0
        while lost < 5:
            warning = until(states, lambda state: state.event == "warning")[-1].description
            lost += int(re.findall(r"\d+", warning)[-1])
        until(states, lambda state: state.node == "shake" and state.event == "alive")
        until_alive = until(states, lambda s: s.node == "shake" and s.event == "alive")

    assert [behavior.source for behavior in told] == ["latched", "five", "six", "ten", "thirteen"]
    assert lost == 5
    assert [state.event for state in until_alive] == ["alive"]
