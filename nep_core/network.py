"""One program's place in a NEP network; all its publishers and subscribers share it.

The paper's three kinds: DirectNetwork (fixed endpoints), BrokerNetwork (a central service), and
PeerNetwork (p2p.py, the default: the NEP Master tells who is where).
"""

from __future__ import annotations

import os
import threading
import uuid
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Literal, Self

import zmq

from nep_core.endpoints import broker_endpoints, check_endpoint
from nep_core.errors import NetworkError
from nep_core.inbox import WAKE_ENDPOINT, Inbox
from nep_core.io_thread import IoThread
from nep_core.outbox import HIGH_WATER_MARK, Outbox

HANDSHAKE_S = 1.0
"""How long a constructor waits for a peer that it knows of; then it goes on with a warning."""


class Network(ABC):
    """What publishers and subscribers need of a network.

    ``node`` is the name that others see; ``high_water_mark`` how many frames may wait for a slow
    subscriber, on each side (0: no limit).
    """

    def __init__(self, node: str = "", *, high_water_mark: int = HIGH_WATER_MARK) -> None:
        self._high_water_mark = high_water_mark
        self.node = node or f"program-{os.getpid()}"
        self.instance = uuid.uuid4().hex
        self.context: zmq.Context[zmq.Socket[bytes]] = zmq.Context(io_threads=1)
        self.io = IoThread(self.node)
        self._waker = self.context.socket(zmq.PUB)
        self._waker.bind(WAKE_ENDPOINT)
        self.outbox = Outbox(self.context, self.node, self.instance, self.io.hurry, high_water_mark)
        self.io.watch(self.outbox.file_number)
        self.io.tend(self.outbox.tend)
        self.closed = False
        self._lock = threading.RLock()
        self._shared_lock = threading.RLock()
        self._inboxes: dict[str, Inbox] = {}
        self._shared: dict[str, Any] = {}

    @abstractmethod
    def add_publisher(self, topic: str) -> set[str]:
        """Make ``topic`` known; the ids of the subscribers that are known to wait for it."""

    @abstractmethod
    def add_subscriber(self, topic: str, subscriber: str, inbox: Inbox) -> set[str]:
        """Bring ``inbox`` to its publishers; the instances that are known to be there."""

    def remove_publisher(self, topic: str) -> None:  # noqa: B027  only p2p has one to tell
        """Tell that ``topic`` is no longer published here."""

    def remove_subscriber(self, subscriber: str) -> None:
        """End a subscriber."""
        with self._lock:
            inbox = self._inboxes.pop(subscriber, None)
        if inbox is not None:
            inbox.close()
            self.io.forget(inbox.tend)

    def open_inbox(self, topic: str) -> tuple[str, Inbox]:
        """A new subscriber's id and inbox; raises NetworkError when the network is closed."""
        subscriber = uuid.uuid4().hex
        with self._lock:
            if self.closed:  # a socket that close() does not know of would keep it waiting
                raise NetworkError(
                    f"The network of {self.node} is closed.", checklist=("Start it again.",)
                )
            inbox = Inbox(
                self.context,
                topic,
                subscriber,
                wake=self.io.wake,
                waker=self._waker,
                high_water_mark=self._high_water_mark,
            )
            self._inboxes[subscriber] = inbox
        self.io.tend(inbox.tend)
        return subscriber, inbox

    def shared(self, key: str, make: Callable[[], Any]) -> Any:
        """The one object of this network under ``key``, made at first use."""
        with self._shared_lock:  # not _lock: making it may wait for the I/O thread
            if key not in self._shared:
                self._shared[key] = make()
            return self._shared[key]

    def interrupt(self) -> None:
        """End every wait for messages; safe in a signal handler."""
        for inbox in list(self._inboxes.values()):
            inbox.interrupt()

    def close(self) -> None:
        """Leave the network: what waits is sent (half a second at most), sockets are closed."""
        with self._lock:
            if self.closed:
                return
            self.closed = True
            subscribers = list(self._inboxes)
        for subscriber in subscribers:
            self.remove_subscriber(subscriber)
        self.io.close()
        self._leave()
        self._waker.close()
        self.outbox.close()
        self.context.term()

    def _leave(self) -> None:  # noqa: B027  only p2p has one to tell
        """Say good-bye to whoever keeps a list; the I/O thread has ended."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


class DirectNetwork(Network):
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

    def add_subscriber(self, topic: str, subscriber: str, inbox: Inbox) -> set[str]:
        """Connect or bind; nobody is known to be there."""
        if self._binds == "subscriber":
            inbox.bind(self.endpoint)
        else:
            inbox.connect({self.endpoint})
        return set()


class BrokerNetwork(Network):
    """Everybody connects to one central service (``nep broker``), which passes messages on."""

    def __init__(self, broker: str | None = None, *, node: str = "") -> None:
        self._publishers_end, self._subscribers_end = broker_endpoints(broker)
        super().__init__(node)
        self.outbox.connect(self._publishers_end)
        self.io.start()

    def add_publisher(self, topic: str) -> set[str]:
        """Wait until a subscription of our own has come back to us: then all others have."""
        nobodys_topic = f"/probe/{uuid.uuid4().hex}"
        probe, inbox = self.open_inbox(nobodys_topic)
        inbox.connect({self._subscribers_end})
        self.outbox.wait_for(nobodys_topic, {probe}, 1, HANDSHAKE_S)
        self.remove_subscriber(probe)
        return set()

    def add_subscriber(self, topic: str, subscriber: str, inbox: Inbox) -> set[str]:
        """Connect, and wait until our own outbox has seen the subscription through the broker."""
        inbox.connect({self._subscribers_end})
        self.outbox.wait_for(topic, {subscriber}, 1, HANDSHAKE_S)
        return set()
