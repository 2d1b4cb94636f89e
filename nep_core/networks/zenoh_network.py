"""A network that zenoh carries, for projects that outgrow one computer or one site.

The frames and the handshake are those of the other networks. Zenoh's liveliness tokens are the
registry: each program tells its name, its topics and its subscribers by tokens, which end with it.
"""

from __future__ import annotations

import atexit
import contextlib
import logging
import os
import random
import socket as sockets
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Iterable
from functools import partial
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Any

from nep_core.errors import NameTaken
from nep_core.wire import outbox
from nep_core.wire.inbox import Backlog
from nep_core.wire.outbox import Outbox, SendFrame, network_closed

from .master_client import Feed, OnChange
from .network import HANDSHAKE_S, Network, Policy
from .registry import Registration
from .zenoh_session import (
    ALL_TOKENS,
    frames_key,
    hears_token,
    last_part,
    node_token,
    node_tokens,
    open_client,
    registrations_of,
    router_endpoints,
    says_token,
    stop_key,
)

if TYPE_CHECKING:
    import zenoh

log = logging.getLogger(__name__)


# The receiving side of one subscriber on a zenoh network.
#
# Zenoh's own thread fills a ring, so that it never waits for a subscriber; a thread of the inbox
# moves what is there into the backlog, where the subscriber takes it.

RING_FRAMES = 1_000
"""Frames that zenoh keeps until our thread has its turn, beside the backlog; the newest stay."""


class ZenohInbox:
    """One zenoh subscription: data, and what is for this subscriber alone, in their order.

    ``session`` is the connection, ``topic`` what is heard, ``subscriber`` its id, ``policy``
    what is kept while nobody reads.
    """

    def __init__(self, session: zenoh.Session, topic: str, subscriber: str, policy: Policy) -> None:
        import zenoh

        self.closed = False
        self._lock = threading.Lock()
        self._closing, self._is_undeclared = threading.Lock(), False
        self._backlog = Backlog(topic, policy)
        self._private = outbox.private_subscription(topic, subscriber)
        self._publishers: set[str] = set()
        self._is_awaited = False
        self._wakes: SimpleQueue[None] = SimpleQueue()  # its put() is safe in a signal handler
        ring: zenoh.handlers.RingChannel[zenoh.Sample]
        ring = zenoh.handlers.RingChannel(RING_FRAMES)
        self._subscription = session.declare_subscriber(frames_key(topic, subscriber), ring)
        self._thread = threading.Thread(target=self._drain, name="nep-zenoh-inbox", daemon=True)
        self._thread.start()

    @property
    def lost(self) -> int:
        """How many messages are lost so far; any thread may ask."""
        return self._backlog.lost

    def take(self, timeout_s: float | None) -> bytes | None:
        """The next frame; None after ``timeout_s`` (None: wait for ever), or when closed."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            self._is_awaited = True  # before we look, so that nothing comes unseen
            if self.closed:
                return None
            with self._lock:
                if (frame := self._backlog.pop()) is not None:
                    return frame
            if not self._wait(deadline):
                return None

    def wait_for(self, instances: set[str], count: int, timeout_s: float) -> bool:
        """Wait until all these publishers, and at least ``count``, have welcomed us."""
        deadline = time.monotonic() + timeout_s
        while True:
            self._is_awaited = True
            with self._lock:
                if instances <= self._publishers and len(self._publishers) >= count:
                    return True
            if self.closed or not self._wait(deadline):
                return False

    def tend(self) -> None:
        """Nothing: the inbox has a thread of its own."""

    def interrupt(self) -> None:
        """Make take() return None from now on; safe in a signal handler."""
        self.closed = True
        self._wakes.put(None)

    def abandon(self) -> None:
        """In the child of a fork: nothing comes here any more."""
        self.closed, self._lock = True, threading.Lock()

    def close(self) -> None:
        """End, also for a thread that waits in take()."""
        self.interrupt()
        with self._closing:
            if not self._is_undeclared:
                self._is_undeclared = True
                self._subscription.undeclare()
        self._thread.join(1.0)

    def _wait(self, deadline: float | None) -> bool:
        """Whether something may have come before the deadline."""
        left_s = None if deadline is None else deadline - time.monotonic()
        if left_s is not None and left_s <= 0:
            return False
        try:
            self._wakes.get(timeout=left_s)
        except Empty:
            return False
        return True

    def _drain(self) -> None:
        for sample in self._subscription.handler:  # ends with the subscription
            frame = sample.payload.to_bytes()
            with self._lock:
                if frame.startswith(self._private):
                    instance, frame = outbox.read_welcome(frame)
                    self._publishers.add(instance)
                if frame:
                    self._backlog.put(frame)
            if self._is_awaited:
                self._is_awaited = False
                self._wakes.put(None)


class ZenohOutbox(Outbox):
    """Sends in the caller's thread; the I/O thread, which ``wake`` calls, welcomes who comes.

    ``session`` is the connection, ``node`` and ``instance`` are the program's, ``hurry`` asks
    for a flood to be sent at once.
    """

    def __init__(
        self,
        session: zenoh.Session,
        node: str,
        instance: str,
        *,
        hurry: Callable[[], None],
        wake: Callable[[], None],
    ) -> None:
        super().__init__(node, instance, hurry)
        self._session = session
        self._wake = wake
        self._watched: set[str] = set()
        self._seen: deque[outbox.Seen] = deque()

    def watch(self, topic: str) -> None:
        """Welcome the subscribers of ``topic``: those that are there and those that come."""
        import zenoh

        if topic in self._watched:
            return
        self._watched.add(topic)
        # In zenoh's own thread it may not wait for anything: the I/O thread does the rest.
        on_change = zenoh.handlers.Callback(partial(self._on_change, topic), indirect=False)
        self._session.liveliness().declare_subscriber(hears_token(topic), on_change, history=True)

    def tend(self) -> None:
        """Note who came and left, welcome the newcomers, send what waits."""
        while self._seen:
            seen = self._seen.popleft()
            self.note(seen.topic, seen.subscriber, seen.present)
            if seen.present:  # the router does not say who is slow
                self.note_slow(seen.topic, seen.subscriber)
        super().tend()

    def _sender(self, topic: str) -> SendFrame:
        import zenoh

        try:
            put = self._session.declare_publisher(
                frames_key(topic), congestion_control=zenoh.CongestionControl.DROP
            ).put
        except zenoh.ZError as error:
            raise network_closed(self._node) from error

        def send(frame: bytes) -> None:
            try:
                put(frame)
            except zenoh.ZError as error:
                raise network_closed(self._node) from error

        return send

    def _send_privately(self, topic: str, subscriber: str, notice: bytes) -> None:
        frame = outbox.private_frame(topic, subscriber, self._instance, notice)
        self._session.put(frames_key(topic, subscriber), frame)

    def _on_change(self, topic: str, sample: zenoh.Sample) -> None:
        import zenoh

        present = sample.kind == zenoh.SampleKind.PUT
        self._seen.append(outbox.Seen(present, topic, last_part(str(sample.key_expr))))
        self._wake()


NAME_TRIES = 4
NAME_PAUSE_S = 0.05


class ZenohNetwork(Network):
    """One program's place in a zenoh network.

    ``connect``: the routers, of which the first that answers is used (default: NEP_ZENOH).
    Raises NetworkError when none answers; joining raises NameTaken as over p2p.
    """

    outbox: ZenohOutbox

    def __init__(self, node: str = "", *, connect: Iterable[str] = ()) -> None:
        # Another site may have a process of the same number.
        super().__init__(node or f"program-{os.getpid()}-{sockets.gethostname()}")
        self.routers = list(connect) or router_endpoints()
        self.session = open_client(self.routers)
        atexit.register(self.close)  # zenoh's threads must end before the interpreter does
        self.outbox = ZenohOutbox(
            self.session, self.node, self.instance, hurry=self.io.hurry, wake=self.io.wake
        )
        self._name: zenoh.LivelinessToken | None = None
        self._says: dict[str, zenoh.LivelinessToken] = {}
        self._hears: dict[str, zenoh.LivelinessToken] = {}
        self._publishers: Counter[str] = Counter()
        self._is_asked_to_stop = False
        self.io.tend(self.outbox.tend)
        self.io.tend(self._stop_when_asked)
        self.io.start()

    def join(self) -> None:
        """Make the node's name known at once; the first topic would do it too."""
        with self._lock:
            if self._name is None:
                self._name = self._claim_name()
                import zenoh

                def on_stop(_sample: zenoh.Sample) -> None:
                    self._is_asked_to_stop = True
                    self.io.wake()

                asked = zenoh.handlers.Callback(on_stop, indirect=False)
                self.session.declare_subscriber(stop_key(self.instance), asked)

    def add_publisher(self, topic: str) -> set[str]:
        """Tell of the topic; the subscribers that are there."""
        self.join()
        self.outbox.watch(topic)
        with self._lock:
            self._publishers[topic] += 1
            if topic not in self._says:
                self._says[topic] = self._declare(says_token(topic, self.instance))
        return {last_part(token) for token in tokens_at(self.session, hears_token(topic))}

    def add_subscriber(self, topic: str, subscriber: str, inbox: Any) -> set[str]:
        """Tell of the subscriber, whose inbox hears already; the publishers that are there."""
        self.join()
        with self._lock:
            self._hears[subscriber] = self._declare(hears_token(topic, self.instance, subscriber))
        return {last_part(token) for token in tokens_at(self.session, says_token(topic))}

    def remove_publisher(self, topic: str) -> None:
        """Tell that the topic's last publisher here is closed."""
        with self._lock:
            self._publishers[topic] -= 1
            if not self._publishers[topic] and topic in self._says:
                self._says.pop(topic).undeclare()

    def remove_subscriber(self, subscriber: str) -> None:
        """End a subscriber and tell so."""
        with self._lock:
            token = self._hears.pop(subscriber, None)
        if token is not None:
            token.undeclare()
        super().remove_subscriber(subscriber)

    def _make_inbox(self, topic: str, subscriber: str, policy: Policy) -> ZenohInbox:
        return ZenohInbox(self.session, topic, subscriber, policy)

    def _end(self) -> None:
        self.session.close()
        atexit.unregister(self.close)

    def _declare(self, token: str) -> zenoh.LivelinessToken:
        return self.session.liveliness().declare_token(token)

    def _claim_name(self) -> zenoh.LivelinessToken:
        """Show the name's token, and withdraw when another has it.

        Of two that come at once both may withdraw, so each tries again a little later.
        """
        others: list[str] = []
        for attempt in range(NAME_TRIES):
            time.sleep(attempt * random.uniform(0.5, 1.0) * NAME_PAUSE_S)
            mine = node_token(self.node, self.instance, os.getpid(), sockets.gethostname())
            token = self._declare(mine)
            tokens = tokens_at(self.session, node_tokens(self.node))
            others = [other for other in tokens if f"/{self.instance}/" not in other]
            if not others:
                return token
            token.undeclare()
        told = registrations_of(others, "")[0]
        raise NameTaken(
            'A node named "{node}" is already running (process {pid} on {host}).',
            checklist=("Give the new node another name.", 'Or stop the running "{node}" first.'),
            node=self.node,
            pid=told.pid,
            host=told.host,
        )

    def _stop_when_asked(self) -> None:
        if self._is_asked_to_stop:
            self._is_asked_to_stop = False
            self.on_stop()


def tokens_at(session: zenoh.Session, key: str) -> list[str]:
    """The tokens that fit ``key`` now."""
    replies = session.liveliness().get(key, timeout=HANDSHAKE_S)
    return [str(reply.ok.key_expr) for reply in replies if reply.ok is not None]


def zenoh_registrations(connect: Iterable[str] = ()) -> list[Registration]:
    """Who is there; raises NetworkError when no router answers."""
    routers = list(connect) or router_endpoints()
    with open_client(routers) as session:
        return registrations_of(tokens_at(session, ALL_TOKENS), routers[0])


def zenoh_stop(node: str, connect: Iterable[str] = ()) -> bool:
    """Ask a node to stop; whether there is one. Raises NetworkError when no router answers."""
    with open_client(list(connect) or router_endpoints()) as session:
        told = registrations_of(tokens_at(session, node_tokens(node)), "")
        for registration in told:
            session.put(stop_key(registration.instance), b"")
    return bool(told)


class ZenohFeed(Feed):
    """Calls ``on_change``, in a thread of its own, with all registrations whenever they change.

    While no router answers the last registrations stay, as those of a master's feed do. Raises
    RouterNotFound when none answers at the beginning.
    """

    def __init__(self, on_change: OnChange, connect: Iterable[str] = ()) -> None:
        super().__init__(on_change)
        self._router, *_ = routers = list(connect) or router_endpoints()
        self._session = open_client(routers)
        atexit.register(self.close)  # zenoh's threads must end before the interpreter does
        self._tokens: set[str] = set()
        self.is_answered = True
        self._changes = self._session.liveliness().declare_subscriber(ALL_TOKENS, history=True)
        self._thread.start()

    def close(self) -> None:
        """Follow no more."""
        self._session.close()
        atexit.unregister(self.close)
        super().close()

    def _run(self) -> None:
        import zenoh

        with contextlib.suppress(zenoh.ZError):  # the session was closed
            for change in self._changes.handler:
                self._take_in(change)
                while (more := self._changes.try_recv()) is not None:
                    self._take_in(more)
                self.is_answered = bool(self._session.info.routers_zid())
                if self.is_answered:
                    self.registrations = registrations_of(self._tokens, self._router)
                self._tell()

    def _take_in(self, change: zenoh.Sample) -> None:
        import zenoh

        note = self._tokens.add if change.kind == zenoh.SampleKind.PUT else self._tokens.discard
        note(str(change.key_expr))
