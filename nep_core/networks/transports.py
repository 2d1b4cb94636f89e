"""Which transport a project uses, by one environment variable, and what tools ask over any of them.

``NEP_NETWORK`` is p2p (the default), broker or zenoh; whatever a program starts inherits it.
"""

from __future__ import annotations

import atexit
import os
import threading
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass

from nep_core.errors import MasterNotFound, NetworkError

from . import master_messages
from .endpoints import NETWORK_VARIABLE, broker_endpoints, broker_registry, master_endpoint
from .master_client import Feed, MasterFeed, OnChange
from .network import Network
from .registry import Registration
from .zmq_networks import BrokerNetwork, PeerNetwork

TRANSPORTS = ("p2p", "broker", "zenoh")


def transport() -> str:
    """The variable NEP_NETWORK; raises NetworkError when it is none of TRANSPORTS."""
    named = os.environ.get(NETWORK_VARIABLE) or TRANSPORTS[0]
    if named not in TRANSPORTS:
        raise NetworkError(
            '{network_variable} is "{named}", which is no kind of network.',
            checklist=("Set it to one of: {transports}.",),
            network_variable=NETWORK_VARIABLE,
            named=named,
            transports=", ".join(TRANSPORTS),
        )
    return named


def network_for(node: str = "", *, master: str | None = None) -> Network:
    """A program's place in the project's network; ``master`` is where p2p finds its own."""
    match transport():
        case "broker":
            return BrokerNetwork(node=node)
        case "zenoh":
            from .zenoh_network import ZenohNetwork

            return ZenohNetwork(node)
        case _:
            return PeerNetwork(node, master=master)


def registrations(master: str | None = None) -> list[Registration]:
    """Who is there; raises MasterNotFound when nobody can tell."""
    if transport() == "zenoh":
        from .zenoh_network import zenoh_registrations

        return zenoh_registrations()
    listing = master_messages.ask_master(_registry(master))
    if listing is None:
        raise nobody_answers(master)
    return listing.registrations


def ask_to_stop(node: str, master: str | None = None) -> bool:
    """Ask a node to stop; whether there is one. Raises MasterNotFound when nobody can tell."""
    if transport() == "zenoh":
        from .zenoh_network import zenoh_stop

        return zenoh_stop(node)
    known = master_messages.ask_to_stop(_registry(master), node)
    if known is None:
        raise nobody_answers(master)
    return known


def follow(on_change: OnChange, master: str | None = None) -> Feed:
    """Call ``on_change``, in a thread of its own, with all that are there whenever it changes."""
    if transport() == "zenoh":
        from .zenoh_network import ZenohFeed

        return ZenohFeed(on_change)
    return MasterFeed(_registry(master), on_change)


def follow_in(network: Network, on_change: OnChange) -> Feed:
    """The same in a network that this program has joined."""
    if isinstance(network, PeerNetwork):
        return MasterFeed(network.master, on_change)
    from .zenoh_network import ZenohFeed, ZenohNetwork

    if isinstance(network, ZenohNetwork):
        return ZenohFeed(on_change, network.routers)
    raise NetworkError(
        "The network of {node} keeps no list of who is there.",
        checklist=("Use one of: {transports}.",),
        node=network.node,
        transports=", ".join(TRANSPORTS),
    )


def nobody_answers(master: str | None = None) -> MasterNotFound:
    """The error to raise when the network's registry does not answer."""
    if transport() == "broker":
        return master_messages.no_master(broker_registry(), broker_endpoints()[0])
    return master_messages.no_master(master or master_endpoint())


def _registry(master: str | None) -> str:
    return master_endpoint() if transport() == "broker" else master or master_endpoint()


# The network that publishers and subscribers join when they are told no other.

_lock = threading.Lock()
_network: Network | None = None


def default_network() -> Network:
    """This program's network: the one that was set, else one of NEP_NETWORK's kind."""
    global _network
    with _lock:
        if _network is None or _network.closed:
            if _network is not None:
                atexit.unregister(_network.close)
            _network = network_for()
            atexit.register(_network.close)
        return _network


def set_default_network(network: Network | None) -> None:
    """Let publishers and subscribers join ``network`` (None: make a new one at next use)."""
    global _network
    with _lock:
        _network = network


# Which topics a network has, and who publishes and hears each, as its master knows it.


@dataclass(frozen=True)
class TopicEnds:
    """A topic, and the names of the nodes at its two ends, sorted."""

    topic: str
    publishers: tuple[str, ...] = ()
    subscribers: tuple[str, ...] = ()


def topics_of(registrations: Iterable[Registration]) -> list[TopicEnds]:
    """All topics that somebody publishes or hears, sorted by name."""
    says: dict[str, set[str]] = defaultdict(set)
    hears: dict[str, set[str]] = defaultdict(set)
    for told in registrations:
        for topic in told.publishes:
            says[topic].add(told.node)
        for topic in told.subscribes.values():
            hears[topic].add(told.node)
    return [
        TopicEnds(topic, tuple(sorted(says[topic])), tuple(sorted(hears[topic])))
        for topic in sorted({*says, *hears})
    ]
