"""The networks that ZeroMQ carries.

DirectNetwork has fixed endpoints; PeerNetwork (p2p.py, the default) asks the NEP Master who is
where; BrokerNetwork (broker_network.py) has a central service.
"""

from __future__ import annotations

import os
from typing import Any, Literal

import zmq

from nep_core import security
from nep_core.endpoints import check_endpoint
from nep_core.errors import NetworkError
from nep_core.inbox import WAKE_ENDPOINT, Inbox
from nep_core.network import Network, Policy
from nep_core.outbox import HIGH_WATER_MARK, Outbox

MOST_SOCKETS = 16_000
"""ZeroMQ's own limit, 1,023, is less than the topics of a large robot."""


class ZmqNetwork(Network):
    """A network with one ZeroMQ context.

    ``high_water_mark``: how many frames may wait for a slow subscriber, on each side (0: no
    limit); see outbox.py. ``is_far``: a broker is between publishers and subscribers.
    """

    outbox: Outbox

    def __init__(
        self, node: str = "", *, high_water_mark: int = HIGH_WATER_MARK, is_far: bool = False
    ) -> None:
        super().__init__(node)
        self._high_water_mark = high_water_mark
        self.context: zmq.Context[zmq.Socket[bytes]] = zmq.Context(io_threads=1)
        self.context.set(zmq.MAX_SOCKETS, MOST_SOCKETS)  # each subscriber has one
        self.security = security.from_environment(self.context)
        self._waker = self.context.socket(zmq.PUB)
        self._waker.bind(WAKE_ENDPOINT)
        self.outbox = Outbox(
            self.context,
            self.node,
            self.instance,
            self.io.hurry,
            high_water_mark,
            is_far=is_far,
            security=self.security,
        )
        self.io.watch(self.outbox.file_number)
        self.io.tend(self.outbox.tend)
        self.io.tend(self._let_go)

    def _make_inbox(self, topic: str, subscriber: str, policy: Policy) -> Inbox:
        try:
            return Inbox(
                self.context,
                topic,
                subscriber,
                policy,
                wake=self.io.wake,
                waker=self._waker,
                high_water_mark=self._high_water_mark,
                security=self.security,
            )
        except zmq.ZMQError as error:
            raise NetworkError(
                f"{topic} cannot be heard too: {os.strerror(error.errno or 0).lower()}.",
                checklist=("Allow more open files before you start it: ulimit -n 8192",),
            ) from error

    def _let_go(self) -> None:
        """Give back the inboxes that were closed: they end only when the waker looks up."""
        self._waker.getsockopt(zmq.EVENTS)

    def take_warning(self) -> str:
        """Who was refused since the last time, and what to do."""
        return self.security.take_warning() if self.security else ""

    def _key_at(self, endpoint: str) -> str:
        return self.security.key_at(endpoint) if self.security else ""

    def _end(self) -> None:
        self._waker.close()
        self.context.term()


class DirectNetwork(ZmqNetwork):
    """A fixed endpoint that one side binds: no master, no broker.

    ``binds="publisher"`` is one publisher to many subscribers; ``binds="subscriber"`` the
    reverse. Raises PortTaken when the endpoint is in use.
    """

    def __init__(
        self,
        endpoint: str,
        *,
        binds: Literal["publisher", "subscriber"] = "publisher",
        node: str = "",
        high_water_mark: int = HIGH_WATER_MARK,
    ) -> None:
        self.endpoint = check_endpoint(endpoint)
        self._binds = binds
        self._has_outbox = False
        super().__init__(node, high_water_mark=high_water_mark)
        self.io.start()

    def add_publisher(self, topic: str) -> set[str]:
        """Bind or connect at the first topic; nobody is known to wait."""
        with self._lock:
            if not self._has_outbox:
                open_end = self.outbox.bind if self._binds == "publisher" else self.outbox.connect
                open_end(self.endpoint)
                self._has_outbox = True
        return set()

    def add_subscriber(self, topic: str, subscriber: str, inbox: Any) -> set[str]:
        """Connect or bind; nobody is known to be there."""
        if self._binds == "subscriber":
            inbox.bind(self.endpoint)
        else:
            inbox.connect({self.endpoint: self._key_at(self.endpoint)})
        return set()
