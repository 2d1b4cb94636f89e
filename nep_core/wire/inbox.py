"""The receiving side of one subscriber: a SUB socket, the receive queue, and what was lost."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING

import zmq
from zmq.backend import Socket as BackendSocket

from nep_core.errors import BadMessage
from nep_core.networks.network import Policy
from nep_core.networks.security import connect

from . import outbox
from .frames import MOST, NUL, RUN_CHARACTERS, Header, read_header, subscription
from .outbox import HIGH_WATER_MARK, PRIVATE_BYTE, bind

if TYPE_CHECKING:
    from nep_core.networks.security.curve import Security


MOST_PUBLISHERS = 1_000
"""Starts of publishers that are remembered, those heard last: a topic may live for weeks."""
LONGEST_NAME = 200
"""So much of a publisher's name tells it from others: a stranger's may be of any length."""


# What has arrived for one subscriber and waits to be read, and how many messages did not arrive,
# publisher by publisher.
#
# It is bounded: of events the oldest are dropped and counted, of states only the newest is kept.

FRAMES = 10_000
"""Frames kept for a subscriber that does not read."""
BYTES = 64_000_000
"""Bytes kept for a subscriber that does not read; the newest frame is kept whatever its size."""


class Backlog:
    """The frames of a topic in the order of arrival; one thread at a time may use it.

    ``lost``: how many messages were sent but did not arrive, or were dropped here; any thread
    may ask. Of states nothing counts as lost: an old one is of no use.
    """

    def __init__(self, topic: str, policy: Policy = "events") -> None:
        self.policy = policy
        self._head_at = len(subscription(topic))
        self._lost = 0
        self._known: dict[tuple[str, str], list[int]] = {}
        """By node and run: the numbers of the first message received and the last one sent, at
        which note of ours it was heard last, and after which number none is uncounted."""
        self._notes = 0
        self._frames: deque[tuple[bytes, int]] = deque()
        """Each with its number of messages."""
        self._bytes = 0
        self._newest: dict[tuple[str, str], bytes] = {}
        self.passed = b""
        """A frame of events that its reader takes at once: it is counted at leisure."""

    def __len__(self) -> int:
        return len(self._frames) or len(self._newest)

    @property
    def lost(self) -> int:
        """How many messages are lost so far."""
        return min(self._lost, MOST) if self.policy == "events" else 0

    @property
    def notes(self) -> int:
        """How many frames and notices were counted so far."""
        return self._notes

    def heard_of_others(self, instances: Collection[str]) -> int:
        """At which note somebody was heard last who is none of these ``instances``."""
        runs = {instance[:RUN_CHARACTERS] for instance in instances}
        others = (known[2] for (_node, run), known in self._known.items() if run not in runs)
        return max(others, default=0)

    def put(self, frame: bytes) -> None:
        """Take in a frame or a notice."""
        self.count_passed()
        header, messages, is_new = self._count(frame)
        if not is_new:
            return
        if self.policy == "events":  # an unreadable one too: its reader tells what is wrong
            self._frames.append((frame, messages))
            self._bytes += len(frame)
            while len(self._frames) > 1 and (len(self._frames) > FRAMES or self._bytes > BYTES):
                dropped, messages = self._frames.popleft()
                self._bytes -= len(dropped)
                self._lost += messages
        elif header is not None:
            sender = _sender(header)
            if header.sent is None or sender not in self._newest:  # a notice brings what is old
                self._bytes += len(frame) - len(self._newest.get(sender, b""))
                self._newest[sender] = frame  # in its old turn: who says much waits no longer
                while len(self._newest) > 1 and (
                    len(self._newest) > MOST_PUBLISHERS or self._bytes > BYTES
                ):
                    self._pop_newest()

    def pop(self) -> bytes | None:
        """The oldest frame that is here."""
        if self._frames:
            frame, _messages = self._frames.popleft()
            self._bytes -= len(frame)
            return frame
        if self._newest:
            return self._pop_newest()
        return None

    def _pop_newest(self) -> bytes:
        """The newest of the publisher that has waited for longest."""
        frame = self._newest.pop(next(iter(self._newest)))
        self._bytes -= len(frame)
        return frame

    def count_passed(self) -> None:
        """Count the frame that was passed by, before the next one comes."""
        if self.passed:
            passed, self.passed = self.passed, b""
            self._count(passed)

    def _count(self, frame: bytes) -> tuple[Header | None, int, bool]:
        """The header (None: unreadable), how many messages, and whether they are new here."""
        end = frame.find(NUL, self._head_at)
        try:
            header = read_header(frame[self._head_at : end if end >= 0 else None])
        except BadMessage:
            return None, 0, True
        payloads = frame[end:] if end >= 0 else b""  # none: a mark
        messages = len(payloads) - len(payloads.replace(NUL, b""))  # count() is ten times slower
        if payloads and header.encoding != "json":
            messages = 1
        sender, sent, self._notes = _sender(header), header.sent, self._notes + 1
        last = header.sequence + messages - 1
        known = self._known.get(sender)
        if known is None:
            if len(self._known) >= MOST_PUBLISHERS:
                del self._known[min(self._known, key=lambda start: self._known[start][2])]
            ends = (header.sequence, last) if sent is None else (sent + 1, sent)
            self._known[sender] = [*ends, self._notes, ends[0] - 1]
            return header, messages, sent is None or messages > 0
        known[2] = self._notes
        if sent is None:
            self._lost += max(0, header.sequence - known[1] - 1)
            known[1] = last  # lower than before: a sender without a run has started again
            return header, messages, True
        if header.run and sent < known[3]:
            # It says only now where we should have begun: data may come before the first notice
            self._lost += known[3] - sent
            known[3] = sent
        was_lost = header.sequence > known[1]
        is_new = messages > 0 and (was_lost or header.sequence < known[0])
        self._lost += max(0, sent - known[1] - (messages if was_lost else 0))
        known[1] = max(known[1], sent)
        if is_new:
            self._lost -= known[3] < header.sequence < known[0]  # one of those is here after all
            known[0] = min(known[0], header.sequence)
        return header, messages, is_new


def _sender(header: Header) -> tuple[str, str]:
    return header.node[:LONGEST_NAME], header.run[:RUN_CHARACTERS]


# The C back end's own: socket.EVENTS takes eight times longer, for each of 1,000 subscribers.
_option = BackendSocket.get

LAST_WORDS_S = 3.0
"""How long a publisher that has left is still heard: disconnecting drops what is on its way. One
that says more meanwhile stays: the master may have lost sight of it, we have not."""

WAKE_ENDPOINT = "inproc://wake"
"""Where the I/O thread's socket is bound that ends another thread's wait for a message."""

LONGEST_WAIT_S = 1.0
"""A wait looks so often whether it should end, should a wake be lost."""

DRAIN_S = 0.01
"""How long the I/O thread empties one inbox before it turns to the others."""


class Inbox:
    """One SUB socket; at any time one thread holds its lock and uses it.

    ``wake`` asks the I/O thread to tend at once; ``waker`` is its socket at WAKE_ENDPOINT.

    ``context`` makes the socket; ``topic`` is heard by ``subscriber``, its id; ``policy`` says
    what is kept while nobody reads, ``high_water_mark`` how many frames ZeroMQ keeps;
    ``security`` has the keys of an opened network.
    """

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        topic: str,
        subscriber: str,
        policy: Policy = "events",
        *,
        wake: Callable[[], None],
        waker: zmq.Socket[bytes],
        high_water_mark: int = HIGH_WATER_MARK,
        security: Security | None = None,
    ) -> None:
        self._security = security
        self._private = outbox.private_subscription(topic, subscriber)
        self._socket = context.socket(zmq.SUB)
        self._socket.linger = 0
        self._socket.rcvhwm = high_water_mark
        self._socket.subscribe(subscription(topic))
        self._socket.subscribe(self._private)  # after the data: the handshake rests on it
        self._socket.connect(WAKE_ENDPOINT)
        self._wake = wake
        self._waker = waker
        self._timeout_ms = -1
        self._lock = threading.Lock()
        self._backlog = Backlog(topic, policy)
        self._are_events = policy == "events"
        self._told: deque[Mapping[str, str]] = deque()
        """Where the publishers are, as it was told since the socket was used last."""
        self._wanted: set[str] = set()
        self._leaving: dict[str, float] = {}
        self._heard_of_left = 0
        """Up to which note of the backlog those that leave were heard, when it was looked last."""
        self._publishers: set[str] = set()
        self._known: set[str] | None = None
        """The publishers that are there, where somebody keeps a list: all others are gone."""
        self.closed = False

    def connect(self, endpoints: Mapping[str, str], instances: set[str] | None = None) -> None:
        """Hear exactly the publishers at these endpoints, by their keys; safe from any thread.

        ``instances`` are those publishers, where somebody keeps a list: all others are gone.
        """
        if instances is not None:
            self._known = instances
        self._told.append(endpoints)
        if self._lock.acquire(blocking=False):
            try:
                self._connect_told()
            finally:
                self._lock.release()
        else:
            self._wake()

    def bind(self, endpoint: str) -> None:
        """Let publishers connect to ``endpoint``; raises PortTaken."""
        with self._lock:
            bind(self._socket, endpoint, self._security)

    def take(self, timeout_s: float | None) -> bytes | None:
        """The next frame; None after ``timeout_s`` (None: wait for ever), or when closed."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            with self._lock:
                if self.closed:
                    return None
                if self._told:
                    self._connect_told()
                if self._leaving:
                    self._disconnect_left()
                self._backlog.count_passed()  # before we wait: it must not delay the next one
                if (frame := self._backlog.pop()) is not None:
                    return frame
                left_s = None if deadline is None else max(0.0, deadline - time.monotonic())
                frame = self._receive(left_s)
                if frame is not None:
                    if self._are_events:
                        self._backlog.passed = frame
                        return frame
                    self._backlog.put(frame)
                    self._drain()
                    if (frame := self._backlog.pop()) is not None:
                        return frame
                if left_s == 0.0 and not self._backlog:
                    return None

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive, or were dropped; any thread may ask."""
        if self._lock.acquire(blocking=False):
            try:
                self._backlog.count_passed()
            finally:
                self._lock.release()
        return self._backlog.lost

    def tend(self) -> None:
        """Keep the newest messages while nobody reads, or wake the reader (the I/O thread)."""
        if not self._lock.acquire(blocking=False):
            if self._told or self.closed:
                self._waker.getsockopt(zmq.EVENTS)  # lets it see subscriptions made just now
                self._waker.send(self._private)
            return
        try:
            self._connect_told()
            self._drain()
            if self._leaving and not self.closed:
                self._disconnect_left()
        finally:
            self._lock.release()

    def wait_for(self, instances: set[str], count: int, timeout_s: float) -> bool:
        """Wait until all these publishers, and at least ``count``, have welcomed us.

        Those that are gone are not waited for.
        """
        deadline = time.monotonic() + timeout_s
        while not (
            (instances if self._known is None else instances & self._known) <= self._publishers
            and len(self._publishers) >= count
        ):
            left_s = deadline - time.monotonic()
            if left_s <= 0 or self.closed:
                return False
            if not self._lock.acquire(timeout=min(0.02, left_s)):
                continue  # a thread that waits in take() hears them for us
            try:
                self._connect_told()
                if not self.closed:
                    self._socket.poll(min(20, math.ceil(left_s * 1000)))
                    self._drain()
            finally:
                self._lock.release()
        return True

    def interrupt(self) -> None:
        """Make take() return None from now on; safe in a signal handler."""
        self.closed = True
        self._wake()

    def close(self) -> None:
        """End, also for a thread that waits in take(); the I/O thread must still tend."""
        self.interrupt()
        if not self._lock.acquire(timeout=2 * LONGEST_WAIT_S):
            # We are the handler of a signal that has interrupted our own take().
            threading.Thread(target=self._close_socket, name="nep-close", daemon=True).start()
            return
        self._lock.release()
        self._close_socket()

    def abandon(self) -> None:
        """In the child of a fork: nothing comes here any more."""
        self.closed, self._lock = True, threading.Lock()

    def _close_socket(self) -> None:
        with self._lock:
            self._socket.close()

    def _connect_told(self) -> None:
        """Connect to the publishers of which it was told; the lock is held."""
        while self._told and not self._socket.closed:
            endpoints, now_s = self._told.popleft(), time.monotonic()
            for endpoint in self._wanted - endpoints.keys():
                self._leaving[endpoint] = now_s + LAST_WORDS_S
                self._heard_of_left = self._backlog.notes
            for endpoint, key in endpoints.items():
                if endpoint not in self._wanted and self._leaving.pop(endpoint, None) is None:
                    if self._security is not None:
                        self._security.trust(self._socket, key)
                    connect(self._socket, endpoint)
            self._wanted = set(endpoints)
            if self._known is not None:
                self._publishers &= self._known

    def _disconnect_left(self) -> None:
        now_s = time.monotonic()
        if min(self._leaving.values()) < now_s:
            heard = self._backlog.heard_of_others(self._known or set())
            if heard > self._heard_of_left:
                self._heard_of_left = heard
                self._leaving = dict.fromkeys(self._leaving, now_s + LAST_WORDS_S)
                return
        for endpoint in [e for e, until_s in self._leaving.items() if until_s < now_s]:
            del self._leaving[endpoint]
            self._socket.disconnect(endpoint)

    def _receive(self, timeout_s: float | None) -> bytes | None:
        """A frame, or None: nothing came, or something private did (a notice, a wake)."""
        wait_s = LONGEST_WAIT_S if timeout_s is None else min(timeout_s, LONGEST_WAIT_S)
        timeout_ms = math.ceil(wait_s * 1000)
        if timeout_ms != self._timeout_ms:
            self._socket.rcvtimeo = self._timeout_ms = timeout_ms
        while True:
            try:
                frame = self._socket.recv()
            except zmq.Again:
                return None
            except zmq.ContextTerminated:  # whoever closes could not wait for us
                self.closed = True
                return None
            if not frame or frame[0] != PRIVATE_BYTE:
                return frame
            if frame.startswith(self._private) and frame != self._private:
                instance, notice = outbox.read_welcome(frame)
                self._publishers.add(instance)
                if notice:
                    self._backlog.put(notice)
            if timeout_s != 0.0 or self._backlog:
                return None  # perhaps it was a wake: the caller looks why

    def _drain(self) -> None:
        until_s = time.monotonic() + DRAIN_S
        while not self.closed and int(_option(self._socket, zmq.EVENTS)) & zmq.POLLIN:
            frame = self._receive(0.0)
            if frame is not None:
                self._backlog.put(frame)
            if time.monotonic() > until_s:
                self._wake()  # there may be more: the I/O thread comes back at once
                return
