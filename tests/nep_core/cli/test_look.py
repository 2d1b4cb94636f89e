"""``nep topics``, ``nodes`` and ``graph``: what they show of a network."""

from __future__ import annotations

import os
import re
import time
from collections.abc import Callable

import msgspec
import psutil
import pytest

from nep_core.cli.look import dot_lines, states_of, text_lines
from nep_core.networks.transports import TopicEnds
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.processes.node import Node
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.cli.conftest import Call


@pytest.fixture
def hearer(join: Callable[[str], PeerNetwork]) -> PeerNetwork:
    network = join("hearer")
    Subscriber("/imu", network=network)
    return network


def test_topics_are_shown_with_their_struct_and_both_ends(
    busy: PeerNetwork, hearer: PeerNetwork, call: Call
) -> None:
    answer = call("nep topics")

    lines = [line.split() for line in answer.out.splitlines()]
    assert lines[0] == ["TOPIC", "MESSAGE", "FROM", "TO"]
    assert ["/imu", "Imu", "watch", "hearer"] in lines
    assert ["/speed", "-", "watch", "nobody"] in lines


def test_topics_tell_rates_to_machines(busy: PeerNetwork, call: Call) -> None:
    answer = call("nep topics --rates 0.3 --json")

    [imu] = [one for one in msgspec.json.decode(answer.out) if one["topic"] == "/imu"]
    assert imu["publishers"] == ["watch"]
    assert imu["message"] == "Imu"
    assert 0 < imu["rate_hz"] < 200


@pytest.mark.parametrize(
    ("command", "told"), [("topics", "No topics yet."), ("nodes", "No nodes"), ("graph", "No")]
)
def test_an_empty_network_is_told(master: object, call: Call, command: str, told: str) -> None:
    answer = call(f"nep {command}")

    assert answer.code == 0
    assert told in answer.out


def test_nodes_are_shown_with_their_last_state(
    busy: PeerNetwork, hearer: PeerNetwork, join: Callable[[str], PeerNetwork], call: Call
) -> None:
    with Node("lamp", "action", network=join("lamp")) as lamp:
        lamp.state("connecting", "to the lamp")

        answer = call("nep nodes --json")

    nodes = {one["node"]: one for one in msgspec.json.decode(answer.out)}
    assert nodes["lamp"]["state"] == "connecting"
    assert nodes["lamp"]["description"] == "to the lamp"
    assert nodes["lamp"]["type"] == "action"
    assert nodes["lamp"]["uptime_s"] > 0
    assert nodes["hearer"]["state"] == ""


@pytest.mark.parametrize("set_by_s", [3600.0, -3600.0, 1.0])
def test_a_clock_that_was_set_makes_no_age_that_cannot_be(
    join: Callable[[str], PeerNetwork], call: Call, set_by_s: float
) -> None:
    network = join("lamp")
    states = Publisher(NODE_STATE, network=network)
    told_s = time.time() + set_by_s
    states.send(NodeState(node="lamp", type="action", event="ready", time=told_s, pid=os.getpid()))

    answer = call("nep nodes --json")

    [lamp] = [one for one in msgspec.json.decode(answer.out) if one["node"] == "lamp"]
    uptime_s = time.time() - psutil.Process().create_time()
    if set_by_s > 60:
        assert lamp["heard_s"] is None
    else:
        assert 0 <= lamp["heard_s"] <= uptime_s
    assert " -3" not in call("nep nodes").out


def test_what_was_told_before_the_clock_was_set_back_is_older_than_what_was_told_since(
    join: Callable[[str], PeerNetwork],
) -> None:
    for name, event, ahead_s in (("launcher", "crashed", 3600.0), ("again", "ready", 0.0)):
        states = Publisher(NODE_STATE, network=join(name))
        time_s = time.time() + ahead_s
        states.send(NodeState(node="lamp", type="action", event=event, time=time_s))

    assert states_of(join("looker"))["lamp"].event == "ready"


def test_the_graph_for_people_says_who_hears_what(
    busy: PeerNetwork, hearer: PeerNetwork, call: Call
) -> None:
    answer = call("nep graph")

    assert "watch\n" in answer.out
    assert "  says   /imu -> hearer\n" in answer.out
    assert "  hears  /imu\n" in answer.out
    assert "/node_state" not in answer.out


def test_a_topic_that_nobody_publishes_and_a_node_that_is_alone_are_told() -> None:
    lines = text_lines(["a", "b"], [TopicEnds("/x", (), ("a",))], {})

    assert lines == ["a", "  hears  /x (nobody publishes it)", "b   alone"]


def test_the_graph_for_graphviz_is_quoted_whatever_the_names_are() -> None:
    nasty = 'a"b\\c\nd'

    lines = dot_lines([nasty], [TopicEnds(f"/{nasty}", (nasty,), (nasty,))], {f"/{nasty}": 2.0})

    quoted = r'"(?:[^"\\\n]|\\.)*"'
    attributes = rf"(?: \[(?:shape=box, )?label={quoted}\])?"
    statement = re.compile(rf"  {quoted}(?: -> {quoted})?{attributes};")
    assert lines[0] == "digraph nep {"
    assert lines[-1] == "}"
    assert [line for line in lines[2:-1] if not statement.fullmatch(line)] == []
    assert len(lines) == 7
