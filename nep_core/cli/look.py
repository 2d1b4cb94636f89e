"""``nep topics``, ``nodes``, ``echo`` and ``hz``: what goes on in a network."""

from __future__ import annotations

import argparse
import itertools
import statistics
import time
from typing import Any

import msgspec

from nep_core.cli.arguments import seconds
from nep_core.endpoints import master_endpoint
from nep_core.master_probe import ask_master, no_master
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Subscriber
from nep_core.registry import Registration
from nep_core.topics import topics_of


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    if name in ("echo", "hz"):
        parser.add_argument("topic", help="such as /human_behavior")
        parser.add_argument("--count", type=int, default=0, help="stop after so many messages")
        parser.add_argument("--seconds", type=seconds, help="stop when nothing came for so long")


def run(options: argparse.Namespace) -> int:
    """Print what was asked for."""
    endpoint = options.master or master_endpoint()
    match options.command:
        case "topics":
            print("\n".join(topic_lines(_registrations(endpoint))) or "No topics yet.")
        case "nodes":
            print("\n".join(node_lines(_registrations(endpoint))) or "No nodes yet.")
        case "echo":
            _echo(endpoint, options)
        case "hz":
            _hz(endpoint, options)
    return 0


def topic_lines(registrations: list[Registration]) -> list[str]:
    """One line a topic: who publishes and who hears it."""
    return [
        f"{ends.topic}   from {', '.join(ends.publishers) or 'nobody'}"
        f"   to {', '.join(ends.subscribers) or 'nobody'}"
        for ends in topics_of(registrations)
    ]


def node_lines(registrations: list[Registration]) -> list[str]:
    """One line a node: its name, process and computer."""
    return [
        f"{told.node}   process {told.pid} on {told.host}   {told.endpoint}"
        for told in sorted(registrations, key=lambda told: told.node)
    ]


def _registrations(endpoint: str) -> list[Registration]:
    listing = ask_master(endpoint)
    if listing is None:
        raise no_master(endpoint)
    return listing.registrations


def _messages(endpoint: str, options: argparse.Namespace) -> Any:
    with PeerNetwork(master=endpoint) as network:
        subscriber: Subscriber[Any] = Subscriber(options.topic, network=network)
        count = 0
        while (message := subscriber.receive(options.seconds)) is not None:
            yield message
            count += 1
            if count == options.count:
                return


def _echo(endpoint: str, options: argparse.Namespace) -> None:
    for message in _messages(endpoint, options):
        text = message if isinstance(message, str) else msgspec.json.encode(message).decode()
        print(text, flush=True)


def _hz(endpoint: str, options: argparse.Namespace) -> None:
    times: list[float] = []
    for _message in _messages(endpoint, options):
        times = [*times, time.monotonic()][-100:]
        gaps = [later - earlier for earlier, later in itertools.pairwise(times)]
        if gaps:
            print(f"{1 / max(statistics.fmean(gaps), 1e-9):.1f} messages a second", flush=True)
