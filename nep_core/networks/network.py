"""One program's place in a NEP network; all its publishers and subscribers share it.

This is what publishers, subscribers and nodes need of a network, whatever carries its messages.
"""

from __future__ import annotations

import os
import threading
import uuid
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, Literal, Protocol, TypeVar
from weakref import WeakSet

from faults import LONGEST, Fault, fault_of
from nep_core.closing import Closing
from nep_core.errors import NetworkError
from nep_core.wire.io_thread import IoThread
from nep_core.wire.outbox import Outbox, network_closed

T = TypeVar("T")

HANDSHAKE_S = 1.0
"""How long a constructor waits for a peer that it knows of; then it goes on with a warning."""

Policy = Literal["events", "state"]
"""What a subscriber keeps while it does not read: events, or of each publisher the newest state."""


MOST_TROUBLES = 100
"""So many kinds of trouble are remembered until they are told."""

TroubleKind = Literal["messages_unreadable", "callback_failed"]


class Troubles:
    """What went wrong with messages, counted by kind and topic until a node tells it; any thread.

    One bad message, or a thousand, is one telling: a flood of faults is no flood of words.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._counts: dict[tuple[TroubleKind, str], tuple[int, str]] = {}

    def note(self, kind: TroubleKind, topic: str, error: object) -> None:
        """Remember that something of this kind happened at ``topic``, and the last reason."""
        with self._lock:
            count, _last = self._counts.get((kind, topic), (0, ""))
            if count or len(self._counts) < MOST_TROUBLES:
                self._counts[kind, topic] = count + 1, str(error)[:LONGEST]

    def take(self) -> Fault | None:
        """The one that is known longest, as a warning of a node; None when all is well."""
        with self._lock:
            if not self._counts:
                return None
            kind, topic = next(iter(self._counts))
            count, error = self._counts.pop((kind, topic))
        if kind == "callback_failed":
            return fault_of(
                "What to do with a message of {topic} failed: {count} times. The last error: "
                "{error}",
                code=kind,
                checklist=("Look into its log.",),
                topic=topic,
                count=count,
                error=error,
            )
        return fault_of(
            "Messages of {topic} could not be read: {count}. The last reason: {error}",
            code=kind,
            checklist=("Use the same version of NEP Studio on all computers.",),
            topic=topic,
            count=count,
            error=error,
        )


class Receiving(Protocol):
    """The receiving side of one subscriber."""

    closed: bool

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive, or were dropped; any thread may ask."""

    def take(self, timeout_s: float | None) -> bytes | None:
        """The next frame; None after ``timeout_s`` (None: wait for ever), or when closed."""

    def wait_for(self, instances: set[str], count: int, timeout_s: float) -> bool:
        """Wait until all these publishers, and at least ``count``, are heard."""

    def tend(self) -> None:
        """Take in what has arrived while nobody reads (the I/O thread)."""

    def interrupt(self) -> None:
        """Make take() return None from now on; safe in a signal handler."""

    def abandon(self) -> None:
        """In the child of a fork: nothing comes here any more."""

    def close(self) -> None:
        """End, also for a thread that waits in take()."""


class Network(Closing, ABC):
    """What publishers and subscribers need of a network.

    ``node`` is the name that others see; ``on_stop`` is called when somebody asks this program
    to stop. Whoever extends it makes ``outbox`` and starts ``io``.
    """

    outbox: Outbox

    def __init__(self, node: str = "") -> None:
        self.node = node or f"program-{os.getpid()}"
        self.instance = uuid.uuid4().hex
        self.io = IoThread(self.node)
        self.on_stop: Callable[[], None] = lambda: None
        self.troubles = Troubles()
        """What went wrong with messages here, until take_warning() gives it."""
        self.closed = False
        self._lock = threading.RLock()
        self._shared_lock = threading.RLock()
        self._inboxes: dict[str, Any] = {}
        self._shared: dict[Callable[[Network], Any], Any] = {}
        _networks.add(self)

    @abstractmethod
    def add_publisher(self, topic: str) -> set[str]:
        """Make ``topic`` known; the ids of the subscribers that are known to wait for it."""

    @abstractmethod
    def add_subscriber(self, topic: str, subscriber: str, inbox: Any) -> set[str]:
        """Bring ``inbox`` to its publishers; the instances that are known to be there."""

    @abstractmethod
    def _make_inbox(self, topic: str, subscriber: str, policy: Policy) -> Receiving:
        """The inbox of a new subscriber; ``_lock`` is held."""

    def remove_publisher(self, topic: str) -> None:
        """Tell that ``topic`` is no longer published here."""

    def remove_subscriber(self, subscriber: str) -> None:
        """End a subscriber."""
        inbox = self._inboxes.get(subscriber)
        if inbox is not None:
            inbox.close()
            self.io.forget(inbox.tend)
            with self._lock:  # only now: what is interrupted before, close() still closes
                self._inboxes.pop(subscriber, None)

    def open_inbox(self, topic: str, policy: Policy = "events") -> tuple[str, Receiving]:
        """A new subscriber's id and inbox; raises NetworkError when the network is closed."""
        subscriber = uuid.uuid4().hex
        with self._lock:
            if self.closed:  # an inbox that close() does not know of would keep it waiting
                raise network_closed(self.node)
            inbox = self._make_inbox(topic, subscriber, policy)
            self._inboxes[subscriber] = inbox
        self.io.tend(inbox.tend)
        return subscriber, inbox

    def shared(self, make: Callable[[Network], T]) -> T:
        """The one object that ``make`` has made of this network, at its first use."""
        with self._shared_lock:  # not _lock: making it may wait for the I/O thread
            if make not in self._shared:
                self._shared[make] = make(self)
            made: T = self._shared[make]
            return made

    def take_warning(self) -> Fault | None:
        """What a person should know about the network since the last time; None for nothing."""
        return self.troubles.take()

    def interrupt(self) -> None:
        """End every wait for messages; safe in a signal handler."""
        for inbox in list(self._inboxes.values()):
            inbox.interrupt()

    def close(self) -> None:
        """Leave the network: what waits is sent (half a second at most), all is closed."""
        with self._lock:
            if self.closed:
                return
            self.closed = True
            inboxes, self._inboxes = self._inboxes, {}
        for inbox in inboxes.values():
            inbox.interrupt()  # all of them first, so that no close() waits for a reader
        for inbox in inboxes.values():
            inbox.close()
        self.io.close()
        self._leave()
        self.outbox.close()
        self._end()

    def _abandon(self) -> None:
        """In the child of a fork there is no I/O thread: what is sent would vanish."""
        self.closed = True
        self._lock, self._shared_lock = threading.RLock(), threading.RLock()
        self.outbox.abandon(self._refuse)
        for inbox in self._inboxes.values():
            inbox.abandon()

    def _refuse(self, _frame: bytes) -> None:
        raise NetworkError(
            "The network of {node} belongs to the process that this one was forked from.",
            checklist=("Make publishers, subscribers and nodes in the process that uses them.",),
            node=self.node,
        )

    def _leave(self) -> None:
        """Say good-bye to whoever keeps a list; the I/O thread has ended."""

    def _end(self) -> None:
        """Give back what is left after the outbox is closed."""


_networks: WeakSet[Network] = WeakSet()


def _abandon_all() -> None:
    for network in list(_networks):
        network._abandon()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_abandon_all)
