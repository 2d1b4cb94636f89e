"""Which transport a project uses, by one environment variable, and what tools ask over any of them.

``NEP_NETWORK`` is p2p (the default), broker or zenoh; whatever a program starts inherits it.
"""

from __future__ import annotations

import os
from typing import Protocol

from nep_core import master_probe
from nep_core.endpoints import NETWORK_VARIABLE, broker_endpoints, master_endpoint
from nep_core.errors import MasterNotFound, NetworkError
from nep_core.master_feed import MasterFeed, OnChange
from nep_core.network import Network
from nep_core.p2p import PeerNetwork
from nep_core.registry import Registration

TRANSPORTS = ("p2p", "broker", "zenoh")


class Feed(Protocol):
    """Follows who is there; ``is_answered`` is false while nobody tells."""

    is_answered: bool

    @property
    def registrations(self) -> list[Registration]:
        """Who is there, or was when it was last told."""

    def close(self) -> None:
        """Follow no more."""


def transport() -> str:
    """The variable NEP_NETWORK; raises NetworkError when it is none of TRANSPORTS."""
    named = os.environ.get(NETWORK_VARIABLE) or TRANSPORTS[0]
    if named not in TRANSPORTS:
        raise NetworkError(
            f'{NETWORK_VARIABLE} is "{named}", which is no kind of network.',
            checklist=(f"Set it to one of: {', '.join(TRANSPORTS)}.",),
        )
    return named


def network_for(node: str = "", *, master: str | None = None) -> Network:
    """A program's place in the project's network; ``master`` is where p2p finds its own."""
    match transport():
        case "broker":
            from nep_core.broker_network import BrokerNetwork

            return BrokerNetwork(node=node)
        case "zenoh":
            from nep_core.over_zenoh.network import ZenohNetwork

            return ZenohNetwork(node)
        case _:
            return PeerNetwork(node, master=master)


def registrations(master: str | None = None) -> list[Registration]:
    """Who is there; raises MasterNotFound when nobody can tell."""
    if transport() == "zenoh":
        from nep_core.over_zenoh.network import zenoh_registrations

        return zenoh_registrations()
    listing = master_probe.ask_master(_registry(master))
    if listing is None:
        raise nobody_answers(master)
    return listing.registrations


def ask_to_stop(node: str, master: str | None = None) -> bool:
    """Ask a node to stop; whether there is one. Raises MasterNotFound when nobody can tell."""
    if transport() == "zenoh":
        from nep_core.over_zenoh.network import zenoh_stop

        return zenoh_stop(node)
    known = master_probe.ask_to_stop(_registry(master), node)
    if known is None:
        raise nobody_answers(master)
    return known


def follow(on_change: OnChange, master: str | None = None) -> Feed:
    """Call ``on_change``, in a thread of its own, with all that are there whenever it changes."""
    if transport() == "zenoh":
        from nep_core.over_zenoh.feed import ZenohFeed

        return ZenohFeed(on_change)
    return MasterFeed(_registry(master), on_change)


def follow_in(network: Network, on_change: OnChange) -> Feed:
    """The same in a network that this program has joined."""
    if isinstance(network, PeerNetwork):
        return MasterFeed(network.master, on_change)
    from nep_core.over_zenoh.feed import ZenohFeed
    from nep_core.over_zenoh.network import ZenohNetwork

    if isinstance(network, ZenohNetwork):
        return ZenohFeed(on_change, network.routers)
    raise NetworkError(
        f"The network of {network.node} keeps no list of who is there.",
        checklist=(f"Use one of: {', '.join(TRANSPORTS)}.",),
    )


def nobody_answers(master: str | None = None) -> MasterNotFound:
    """The error to raise when the network's registry does not answer."""
    if transport() == "broker":
        from nep_core.broker_network import no_broker

        return no_broker(broker_endpoints()[0])
    return master_probe.no_master(_registry(master))


def _registry(master: str | None) -> str:
    return master_endpoint() if transport() == "broker" else master or master_endpoint()
