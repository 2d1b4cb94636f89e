"""The networks that ZeroMQ carries, and the broker, which is the central service of one of them.

DirectNetwork has fixed endpoints; PeerNetwork (the default) asks the NEP Master who is where;
BrokerNetwork sends its messages through the broker.
"""

from __future__ import annotations

import contextlib
import os
import socket
import threading
from functools import partial
from typing import Any, Literal

import zmq

from faults import Fault, fault_of, reason_of
from nep_core.errors import NetworkError
from nep_core.wire.inbox import WAKE_ENDPOINT, Inbox
from nep_core.wire.outbox import HIGH_WATER_MARK, ZmqOutbox, bind

from . import security
from .endpoints import (
    broker_endpoints,
    broker_registry,
    check_endpoint,
    fixed_endpoint,
    master_endpoint,
)
from .master import Master
from .master_client import MasterClient
from .network import Network, Policy
from .registry import Publishing, Registration
from .security.addresses import endpoint_at, own_address

MOST_SOCKETS = 16_000
"""ZeroMQ's own limit, 1,023, is less than the topics of a large robot."""


class ZmqNetwork(Network):
    """A network with one ZeroMQ context.

    ``high_water_mark``: how many frames may wait for a slow subscriber, on each side (0: no
    limit); see outbox.py. ``is_far``: a broker is between publishers and subscribers.
    """

    outbox: ZmqOutbox

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
        self.outbox = ZmqOutbox(
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
        # The inboxes that were closed are given back: they end only when the waker looks up
        self.io.tend(partial(self._waker.getsockopt, zmq.EVENTS))

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
                "{topic} cannot be heard too: {reason}.",
                checklist=("Allow more open files before you start it: ulimit -n 8192",),
                topic=topic,
                reason=reason_of(error),
            ) from error

    def take_warning(self) -> Fault | None:
        """Who was refused since the last time, and what to do; or what could not be read."""
        refused = self.security.take_warning() if self.security else None
        return refused or super().take_warning()

    def _key_at(self, endpoint: str) -> str:
        return self.security.key_at(endpoint) if self.security else ""

    def _end(self) -> None:
        self._waker.close()
        self.context.term()


class DirectNetwork(ZmqNetwork):
    """A fixed endpoint that one side binds: no master, no broker.

    ``binds="publisher"`` is one publisher to many subscribers; ``binds="subscriber"`` the
    reverse. Raises PortTaken when the endpoint is in use.

    ``endpoint`` is where, ``node`` the name that others see, ``high_water_mark`` how many
    frames may wait.
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


class PeerNetwork(ZmqNetwork):
    """One program's place in a p2p network: the master tells subscribers where publishers are.

    Joining raises MasterNotFound when no master answers, NameTaken when a node of this name is
    already running.

    ``node`` is the name that others see, ``master`` an endpoint (None: as NEP_MASTER says),
    ``high_water_mark`` how many frames may wait; ``through``: the ends of a broker, where
    messages are sent and heard.
    """

    def __init__(
        self,
        node: str = "",
        *,
        master: str | None = None,
        high_water_mark: int = HIGH_WATER_MARK,
        through: tuple[str, str] | None = None,
    ) -> None:
        self.master = fixed_endpoint(master or master_endpoint())
        is_far = through is not None
        super().__init__(node, high_water_mark=high_water_mark, is_far=is_far)
        self._heard_at = through[1] if through is not None else ""
        """Where a broker is heard, if all goes through one."""
        self._topics: dict[str, int] = {}
        """How many publishers of each topic there are here."""
        self._heard: dict[str, str] = {}
        """The topic of each subscriber here."""
        self._inboxes_by_topic: dict[str, list[Inbox]] = {}
        try:  # where subscribers find the messages
            if through is None:
                # On this computer alone, or with keys where other computers reach it
                host = "127.0.0.1" if self.security is None else own_address(self.master)
                endpoint = self.outbox.bind(endpoint_at(host, "*"))
            else:
                endpoint = through[0]
                self.outbox.connect(endpoint)
        except NetworkError:
            self.outbox.close()
            self._end()
            raise
        told = Registration(
            instance=self.instance,
            node=self.node,
            pid=os.getpid(),
            host=socket.gethostname(),
            endpoint=endpoint,
            key=self.security.key if self.security is not None else "",
        )
        self._client = MasterClient(
            self.context,
            self.io,
            self.master,
            told,
            self._connect_subscribers,
            lambda: self.on_stop(),  # a node sets it later
            self.security.allow if self.security else lambda keys: None,
            through[0] if through is not None else "",
        )
        self.io.start()

    def join(self) -> None:
        """Make the node's name known at once; the first topic would do it too."""
        self._client.change(self._tell_topics)

    def add_publisher(self, topic: str) -> set[str]:
        """Register the topic; the subscribers that the master knows."""
        with self._lock:
            self._topics[topic] = self._topics.get(topic, 0) + 1
        _publishers, subscribers = self._client.change(self._tell_topics, topic)
        return set(subscribers)

    def add_subscriber(self, topic: str, subscriber: str, inbox: Inbox) -> set[str]:
        """Register the subscriber; the publishers that the master knows."""
        if self._heard_at:
            inbox.connect({self._heard_at: self._key_at(self._heard_at)})
        with self._lock:
            self._inboxes_by_topic.setdefault(topic, []).append(inbox)
            self._heard[subscriber] = topic
        publishers, _subscribers = self._client.change(self._tell_topics, topic)
        return {publisher.instance for publisher in publishers}

    def remove_publisher(self, topic: str) -> None:
        """Tell the master, without waiting, when the topic's last publisher here is closed."""
        with self._lock:
            self._topics[topic] = self._topics.get(topic, 0) - 1
        self._client.change_later(self._tell_topics)

    def remove_subscriber(self, subscriber: str) -> None:
        """End a subscriber and tell the master, without waiting."""
        with self._lock:
            self._heard.pop(subscriber, None)
            inbox = self._inboxes.get(subscriber)
            for inboxes in self._inboxes_by_topic.values():
                if inbox in inboxes:
                    inboxes.remove(inbox)
        super().remove_subscriber(subscriber)
        self._client.change_later(self._tell_topics)

    def _tell_topics(self, told: Registration) -> None:
        topics = self._topics.copy()  # other threads may change it meanwhile
        told.publishes = sorted(topic for topic, count in topics.items() if count > 0)
        told.subscribes = self._heard.copy()

    def _connect_subscribers(self, topic: str, publishers: list[Publishing]) -> None:
        if self._heard_at:
            endpoints = {self._heard_at: self._key_at(self._heard_at)}
        else:
            endpoints = {publisher.endpoint: publisher.key for publisher in publishers}
        with self._lock:
            inboxes = list(self._inboxes_by_topic.get(topic, []))
        for inbox in inboxes:
            inbox.connect(endpoints, {publisher.instance for publisher in publishers})

    def _leave(self) -> None:
        self._client.close()


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


class BrokerNetwork(PeerNetwork):
    """Everybody connects to one central service (``nep broker``), which passes messages on.

    Joining raises BrokerNotFound when no broker answers, NameTaken as over p2p.
    """

    def __init__(self, broker: str | None = None, *, node: str = "") -> None:
        super().__init__(node, master=broker_registry(broker), through=broker_endpoints(broker))
