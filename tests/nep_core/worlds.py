"""A network of each kind, with the central service that it needs, for tests of all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from importlib.util import find_spec
from typing import Protocol

import pytest

from nep_core.networks.master import Master
from nep_core.networks.network import Network
from nep_core.networks.zenoh_network import ZenohNetwork
from nep_core.networks.zenoh_session import ZenohRouter
from nep_core.networks.zmq_networks import Broker, BrokerNetwork, DirectNetwork, PeerNetwork

WITH_ZENOH = pytest.param(
    "zenoh", marks=pytest.mark.skipif(find_spec("zenoh") is None, reason="zenoh is not installed")
)
NAMED = ["p2p", "broker", WITH_ZENOH]
"""The kinds with a registry of names."""
EVERY = ["direct", *NAMED]


class Service(Protocol):
    def close(self) -> None: ...


class World:
    """A network of one kind at a free port; all that joined it leave at the end."""

    def __init__(self, kind: str, port: int) -> None:
        self.kind = kind
        self._endpoint = f"{'tcp/' if kind == 'zenoh' else 'tcp://'}127.0.0.1:{port}"
        self._leaving = ExitStack()
        self._service: Service | None = None
        self.begin()

    @property
    def environment(self) -> dict[str, str]:
        """What makes programs join it."""
        variable = {"p2p": "NEP_MASTER", "broker": "NEP_BROKER", "zenoh": "NEP_ZENOH"}[self.kind]
        return {"NEP_NETWORK": self.kind, variable: self._endpoint}

    def join(self, node: str) -> Network:
        """Another program's place in it."""
        make: dict[str, Callable[[], Network]] = {
            "direct": lambda: DirectNetwork(self._endpoint, node=node),
            "p2p": lambda: PeerNetwork(node, master=self._endpoint),
            "broker": lambda: BrokerNetwork(self._endpoint, node=node),
            "zenoh": lambda: ZenohNetwork(node, connect=[self._endpoint]),
        }
        return self._leaving.enter_context(make[self.kind]())

    def begin(self) -> None:
        """Start its central service."""
        match self.kind:
            case "p2p":
                self._service = Master(self._endpoint)
            case "broker":
                self._service = Broker(self._endpoint)
            case "zenoh":
                self._service = ZenohRouter([self._endpoint])

    def end(self) -> None:
        """Stop its central service."""
        if self._service is not None:
            self._service.close()
            self._service = None

    def close(self) -> None:
        self._leaving.close()
        self.end()


@contextmanager
def a_world(kind: str, port: int) -> Iterator[World]:
    world = World(kind, port)
    try:
        yield world
    finally:
        world.close()
