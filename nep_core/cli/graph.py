"""``nep graph``: which node talks to which, as text, for Graphviz, or for machines."""

from __future__ import annotations

import argparse
from collections.abc import Mapping

from nep_core.cli.look import add_rates, rates_of
from nep_core.networks.transports import TopicEnds, topics_of
from nep_core.wire.messages import NODE_STATE

from .console import add_json, join, registrations, say, say_json


def add_arguments(_name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    parser.add_argument("--dot", action="store_true", help="for Graphviz, such as the program dot")
    parser.add_argument("--all", action="store_true", help=f"also {NODE_STATE}")
    add_rates(parser)
    add_json(parser)


def run(options: argparse.Namespace) -> int:
    """Print the graph."""
    told = registrations(options)
    topics = [ends for ends in topics_of(told) if options.all or ends.topic != NODE_STATE]
    nodes = sorted({one.node for one in told})
    rates: dict[str, float] = {}
    if options.rates is not None:
        with join(options) as network:
            rates = rates_of(network, [ends.topic for ends in topics], options.rates)
    if options.json:
        say_json({"nodes": nodes, "topics": topics, "rates_hz": rates})
    elif options.dot:
        say("\n".join(dot_lines(nodes, topics, rates)))
    else:
        say("\n".join(text_lines(nodes, topics, rates)) or "No nodes yet.")
    return 0


def text_lines(nodes: list[str], topics: list[TopicEnds], rates: Mapping[str, float]) -> list[str]:
    """Each node with what it publishes and who hears that; then who only hears or is alone."""
    lines: list[str] = []
    for node in nodes:
        said = [ends for ends in topics if node in ends.publishers]
        heard = [ends.topic for ends in topics if node in ends.subscribers]
        lines.append(node if said or heard else f"{node}   alone")
        for ends in said:
            hears = ", ".join(ends.subscribers) or "nobody"
            lines.append(f"  says   {ends.topic}{_rate(ends.topic, rates)} -> {hears}")
        lines += [f"  hears  {topic}{_nobodys(topic, topics)}" for topic in heard]
    return lines


def _nobodys(topic: str, topics: list[TopicEnds]) -> str:
    has_publisher = any(ends.publishers for ends in topics if ends.topic == topic)
    return "" if has_publisher else " (nobody publishes it)"


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
