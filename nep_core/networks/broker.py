"""The central service of the broker network: a proxy for its messages, a master for its names."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator

import zmq

from faults import Fault, fault_of
from nep_core.errors import BrokerNotFound, MasterNotFound, NotLetIn
from nep_core.wire.inbox import Inbox
from nep_core.wire.outbox import HIGH_WATER_MARK, bind

from . import security
from .endpoints import broker_endpoints, broker_registry
from .master import Master
from .registry import Publishing
from .zmq_networks import PeerNetwork


class Broker:
    """Passes messages from every publisher to every subscriber; raises PortTaken.

    Its master, two ports on, knows who is there and lets each name be used once.
    """

    def __init__(self, endpoint: str | None = None) -> None:
        publishers_end, subscribers_end = broker_endpoints(endpoint)
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        self._security = security.from_environment(self._context)
        self._publishers = self._open(zmq.XSUB)
        self._subscribers = self._open(zmq.XPUB)
        try:
            bind(self._publishers, publishers_end, self._security)
            bind(self._subscribers, subscribers_end, self._security)
            self._master = Master(broker_registry(endpoint))
        except BaseException:
            self._publishers.close()
            self._subscribers.close()
            self._context.term()
            raise
        self.endpoint = publishers_end
        self._thread = threading.Thread(target=self._run, name="nep-broker", daemon=True)
        self._thread.start()

    def wait(self, timeout_s: float | None = None) -> None:
        """Wait until the broker is closed."""
        self._thread.join(timeout_s)

    def take_warning(self) -> Fault | None:
        """Who was refused since the last time, and what to do; None when nobody was."""
        first = self._security.take_warning() if self._security else None
        other = self._master.take_warning()
        if first is None or other is None or first == other:
            return first or other
        return fault_of("{first} {other}", code=first.code, first=first, other=other)

    def close(self) -> None:
        """Stop passing messages on."""
        self._master.close()
        self._context.term()  # ends the proxy, whose thread then closes the sockets
        self._thread.join()

    def _open(self, kind: int) -> zmq.Socket[bytes]:
        socket = self._context.socket(kind)
        socket.linger = 0
        socket.sndhwm = socket.rcvhwm = HIGH_WATER_MARK
        return socket

    def _run(self) -> None:
        with contextlib.suppress(zmq.ContextTerminated):
            zmq.proxy(self._publishers, self._subscribers)
        self._publishers.close()
        self._subscribers.close()


# The network with a central service: names go through its registry, messages through itself.


class BrokerNetwork(PeerNetwork):
    """Everybody connects to one central service (``nep broker``), which passes messages on.

    Joining raises BrokerNotFound when no broker answers, NameTaken as over p2p.
    """

    def __init__(self, broker: str | None = None, *, node: str = "") -> None:
        self._publishers_end, self._subscribers_end = broker_endpoints(broker)
        super().__init__(node, master=broker_registry(broker), is_far=True)

    def join(self) -> None:
        """Make the node's name known at once; the first topic would do it too."""
        with self._broker_found():
            super().join()

    def add_publisher(self, topic: str) -> set[str]:
        """Register the topic; the subscribers that are known."""
        with self._broker_found():
            return super().add_publisher(topic)

    def add_subscriber(self, topic: str, subscriber: str, inbox: Inbox) -> set[str]:
        """Connect to the broker and register; the publishers that are known."""
        inbox.connect(self._endpoints_of([]))
        with self._broker_found():
            return super().add_subscriber(topic, subscriber, inbox)

    def _open_outbox(self) -> str:
        self.outbox.connect(self._publishers_end)
        return self._publishers_end

    def _endpoints_of(self, publishers: list[Publishing]) -> dict[str, str]:
        return {self._subscribers_end: self._key_at(self._subscribers_end)}

    @contextlib.contextmanager
    def _broker_found(self) -> Iterator[None]:
        try:
            yield
        except NotLetIn:
            raise
        except MasterNotFound as error:
            raise no_broker(self._publishers_end) from error


def no_broker(endpoint: str) -> BrokerNotFound:
    """The error to raise when no broker answers at ``endpoint``."""
    return BrokerNotFound(
        "No NEP broker answers at {endpoint}.",
        checklist=(
            "Start one in another terminal: nep broker",
            "Is it at another place? Set NEP_BROKER to its endpoint.",
        ),
        endpoint=endpoint,
    )
