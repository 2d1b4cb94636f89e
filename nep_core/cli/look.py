"""``nep topics``, ``nep nodes`` and ``nep graph``: what there is in a network."""

from __future__ import annotations

import argparse
import contextlib
import socket
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import psutil

from nep_core.networks.network import Network
from nep_core.networks.registry import Registration
from nep_core.networks.transports import TopicEnds, topics_of
from nep_core.recordings.raw import RawSubscriber
from nep_core.wire.messages import BY_TOPIC, NODE_STATE, NodeState
from nep_core.wire.pubsub import Subscriber

from .console import add_json, join, registrations, say, say_json, seconds, table

RATES_S = 1.0
TURN_S = 0.2
"""So long one topic is read before the next has its turn."""
STATES_S = 0.3
"""The last states of nodes come with the handshake; this is for slow ones."""
MOST_STATES_S = 2.0
"""So long states are waited for when they come without end, as from hundreds of nodes."""
APART_S = 2.0
"""So far may the clocks of two computers be apart without a word."""


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    if name == "graph":
        parser.add_argument(
            "--dot", action="store_true", help="for Graphviz, such as the program dot"
        )
        parser.add_argument("--all", action="store_true", help=f"also {NODE_STATE}")
    if name != "nodes":
        parser.add_argument(
            "--rates",
            nargs="?",
            type=seconds,
            const=RATES_S,
            metavar="S",
            help="listen for S seconds (default 1) and tell messages a second",
        )
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    """Print what was asked for."""
    shows = {"topics": _show_topics, "nodes": _show_nodes, "graph": _show_graph}
    shows[options.command](options)
    return 0


def _show_topics(options: argparse.Namespace) -> None:
    topics = topics_of(registrations(options))
    rates = _rates(options, topics)
    if options.json:
        say_json(
            [
                {
                    "topic": ends.topic,
                    "message": struct_of(ends.topic),
                    "publishers": ends.publishers,
                    "subscribers": ends.subscribers,
                    **({"rate_hz": rates[ends.topic]} if rates else {}),
                }
                for ends in topics
            ]
        )
        return
    head = ("TOPIC", "MESSAGE", *(("HZ",) if rates else ()), "FROM", "TO")
    rows = [
        (
            ends.topic,
            struct_of(ends.topic) or "-",
            *((f"{rates[ends.topic]:.1f}",) if rates else ()),
            ", ".join(ends.publishers) or "nobody",
            ", ".join(ends.subscribers) or "nobody",
        )
        for ends in topics
    ]
    say(table(head, rows) if rows else "No topics yet.")


def struct_of(topic: str) -> str:
    """The name of the struct of a topic's messages; "" when NEP does not know it."""
    kind = BY_TOPIC.get(topic)
    return kind.__name__ if kind else ""


def _rates(options: argparse.Namespace, topics: list[TopicEnds]) -> dict[str, float]:
    """Messages a second of each topic, heard for as long as was asked for."""
    if options.rates is None:
        return {}
    counts = {ends.topic: 0 for ends in topics}
    with join(options) as network:
        heard = {topic: RawSubscriber(topic, network=network) for topic in counts}
        begin_s, begin_ns = time.monotonic(), time.time_ns()
        while (passed_s := time.monotonic() - begin_s) < options.rates:
            time.sleep(min(0.05, options.rates - passed_s))
            for topic, subscriber in heard.items():
                until_s = time.monotonic() + TURN_S  # a flood may come faster than it is read
                while time.monotonic() < until_s and (message := subscriber.receive(0)) is not None:
                    counts[topic] += message.arrived_ns >= begin_ns
        passed_s = max(time.monotonic() - begin_s, 1e-9)
    return {topic: round(count / passed_s, 2) for topic, count in counts.items()}


@dataclass(frozen=True)
class Program:
    """A program of the network, with its state when it is a node; ages in s, None: not known."""

    node: str
    type: str
    state: str
    description: str
    pid: int
    host: str
    endpoint: str
    heard_s: float | None
    uptime_s: float | None


def programs(told: list[Registration], states: dict[str, NodeState]) -> list[Program]:
    """What is known of each program, sorted by name."""
    return [_program(one, states.get(one.node)) for one in sorted(told, key=lambda one: one.node)]


def states_of(
    network: Network, told: Iterable[Registration] = (), wait_s: float = STATES_S
) -> dict[str, NodeState]:
    """The newest state of each node, its heartbeats aside; ``told`` is who is registered.

    Newest by its time, not by its arrival: what a launcher told of a crash may come after what the
    node, started again, says of itself. What is from the future was told before the clock was set
    back, and is older than all that is not. What was told of another process than the one that is
    registered says nothing of this one.
    """
    subscriber = Subscriber(NODE_STATE, NodeState, network=network)
    pids = {one.node: one.pid for one in told}
    states: dict[str, NodeState] = {}
    end_s = time.monotonic() + MOST_STATES_S
    while (state := subscriber.receive(wait_s)) is not None and time.monotonic() < end_s:
        before, wait_s = states.get(state.node), min(wait_s, 0.05)
        pid = pids.get(state.node, 0)
        is_of_another = 0 not in (pid, state.pid) and pid != state.pid
        if state.event == "alive" or is_of_another:
            continue
        if before is None or _turn(state) >= _turn(before):
            states[state.node] = state
    return states


def _turn(state: NodeState) -> tuple[bool, float]:
    """States in this order are from the oldest to the newest."""
    return state.time <= time.time() + APART_S, state.time


def _show_nodes(options: argparse.Namespace) -> None:
    told = registrations(options)
    states: dict[str, NodeState] = {}
    if any(NODE_STATE in one.publishes for one in told):
        with join(options) as network:
            states = states_of(network, told)
    found = programs(told, states)
    if options.json:
        say_json(found)
        return
    head = ("NODE", "TYPE", "STATE", "SINCE", "RUNS FOR", "PROCESS", "COMPUTER", "ENDPOINT")
    rows = [
        (
            one.node,
            one.type or "-",
            one.state or "-",
            _age(one.heard_s),
            _age(one.uptime_s),
            str(one.pid),
            one.host,
            one.endpoint,
        )
        for one in found
    ]
    say(table(head, rows) if rows else "No nodes yet.")


def _program(told: Registration, state: NodeState | None) -> Program:
    uptime_s = _uptime_s(told)
    return Program(
        told.node,
        state.type if state else "",
        state.event if state else "",
        str(state.fault) if state else "",
        told.pid,
        told.host,
        told.endpoint,
        _since_s(state, uptime_s if state.pid == told.pid else None) if state else None,
        uptime_s,
    )


def _since_s(state: NodeState, uptime_s: float | None) -> float | None:
    """How long ago a node told its state; None when a clock was set back since.

    Not longer ago than it runs (``uptime_s``, None: not known), which the system measures by no
    clock that people set.
    """
    age_s = time.time() - state.time
    if age_s < -APART_S:
        return None
    age_s = max(0.0, age_s)
    return _tenths(age_s) if uptime_s is None else min(_tenths(age_s), uptime_s)


def _tenths(seconds: float) -> float:
    """Rounded down: rounded up, a state would be older than its node."""
    return round(max(0.0, seconds - 0.05), 1)


def _uptime_s(told: Registration) -> float | None:
    if told.host != socket.gethostname():
        return None
    with contextlib.suppress(psutil.Error, ValueError):
        began_s = float(psutil.Process(told.pid).create_time())
        return _tenths(time.time() - began_s)
    return None


def _age(age_s: float | None) -> str:
    return "-" if age_s is None else f"{age_s:.0f} s"


# Who is connected with whom, as text, for Graphviz, or for machines.


def _show_graph(options: argparse.Namespace) -> None:
    told = registrations(options)
    topics = [ends for ends in topics_of(told) if options.all or ends.topic != NODE_STATE]
    nodes = sorted({one.node for one in told})
    rates = _rates(options, topics)
    if options.json:
        say_json({"nodes": nodes, "topics": topics, "rates_hz": rates})
    elif options.dot:
        say("\n".join(dot_lines(nodes, topics, rates)))
    else:
        say("\n".join(text_lines(nodes, topics, rates)) or "No nodes yet.")


def text_lines(nodes: list[str], topics: list[TopicEnds], rates: Mapping[str, float]) -> list[str]:
    """Each node with what it publishes and who hears that; then who only hears or is alone."""
    lines: list[str] = []
    for node in nodes:
        said = [ends for ends in topics if node in ends.publishers]
        heard = [ends for ends in topics if node in ends.subscribers]
        lines.append(node if said or heard else f"{node}   alone")
        for ends in said:
            hears = ", ".join(ends.subscribers) or "nobody"
            lines.append(f"  says   {ends.topic}{_rate(ends.topic, rates)} -> {hears}")
        lines += [
            f"  hears  {ends.topic}{'' if ends.publishers else ' (nobody publishes it)'}"
            for ends in heard
        ]
    return lines


def dot_lines(nodes: list[str], topics: list[TopicEnds], rates: Mapping[str, float]) -> list[str]:
    """The graph in the language of Graphviz: nodes are round, topics are boxes."""
    lines = ["digraph nep {", "  rankdir=LR;"]
    lines += [f"  {quoted('node ' + node)} [label={quoted(node)}];" for node in nodes]
    for ends in topics:
        topic, label = quoted("topic " + ends.topic), quoted(ends.topic + _rate(ends.topic, rates))
        lines.append(f"  {topic} [shape=box, label={label}];")
        lines += [f"  {quoted('node ' + node)} -> {topic};" for node in ends.publishers]
        lines += [f"  {topic} -> {quoted('node ' + node)};" for node in ends.subscribers]
    return [*lines, "}"]


def quoted(text: str) -> str:
    """A name as Graphviz reads it, whatever letters are in it."""
    plain = text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
    return f'"{plain}"'


def _rate(topic: str, rates: Mapping[str, float]) -> str:
    return f" {rates[topic]:.1f} Hz" if topic in rates else ""
