"""The receiving side of one subscriber: a SUB socket read in the caller's thread.

Reading where the message is wanted saves a thread hop (a third of the latency). While nobody
reads, the I/O thread moves what arrives into a bounded backlog, so that a slow subscriber keeps
the newest messages and knows how many it lost.
"""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import zmq
from zmq.backend import Socket as BackendSocket

from nep_core import handshake
from nep_core.backlog import Backlog
from nep_core.frames import subscription
from nep_core.handshake import PRIVATE_BYTE
from nep_core.network import Policy
from nep_core.outbox import HIGH_WATER_MARK, bind

if TYPE_CHECKING:
    from nep_core.security.curve import Security

# The C back end's own: socket.EVENTS takes eight times longer, for each of 1,000 subscribers.
_option = BackendSocket.get

LAST_WORDS_S = 1.0
"""How long a publisher that has left is still heard: disconnecting drops what is on its way."""

WAKE_ENDPOINT = "inproc://wake"
"""Where the I/O thread's socket is bound that ends another thread's wait for a message."""

LONGEST_WAIT_S = 1.0
"""A wait looks so often whether it should end, should a wake be lost."""

DRAIN_S = 0.01
"""How long the I/O thread empties one inbox before it turns to the others."""


class Inbox:
    """One SUB socket; at any time one thread holds its lock and uses it.

    ``wake`` asks the I/O thread to tend at once; ``waker`` is its socket at WAKE_ENDPOINT.
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
        self._private = handshake.private_subscription(topic, subscriber)
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
        self._commands: deque[Callable[[], None]] = deque()
        self._wanted: set[str] = set()
        self._leaving: dict[str, float] = {}
        self._publishers: set[str] = set()
        self._gone: Callable[[set[str]], set[str]] = lambda _: set()
        self.closed = False

    def connect(self, endpoints: Mapping[str, str], instances: set[str] | None = None) -> None:
        """Hear exactly the publishers at these endpoints, by their keys; safe from any thread.

        ``instances`` are those publishers, where somebody keeps a list: all others are gone.
        """
        if instances is not None:
            self._gone = lambda some: some - instances
        self._do(lambda: self._connect_now(endpoints))

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
                if self._commands:
                    self._run_commands()
                if self._leaving:
                    self._disconnect_left()
                self._backlog.count_passed()  # before we wait: it must not delay the next one
                if self._backlog:
                    return self._backlog.pop()
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
            if self._commands or self.closed:
                self._waker.getsockopt(zmq.EVENTS)  # lets it see subscriptions made just now
                self._waker.send(self._private)
            return
        try:
            self._run_commands()
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
            instances - self._gone(instances) <= self._publishers and len(self._publishers) >= count
        ):
            left_s = deadline - time.monotonic()
            if left_s <= 0 or self.closed:
                return False
            if not self._lock.acquire(timeout=min(0.02, left_s)):
                continue  # a thread that waits in take() hears them for us
            try:
                self._run_commands()
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

    def _do(self, command: Callable[[], None]) -> None:
        self._commands.append(command)
        if self._lock.acquire(blocking=False):
            try:
                self._run_commands()
            finally:
                self._lock.release()
        else:
            self._wake()

    def _run_commands(self) -> None:
        while self._commands and not self._socket.closed:
            self._commands.popleft()()

    def _connect_now(self, endpoints: Mapping[str, str]) -> None:
        now_s = time.monotonic()
        for endpoint in self._wanted - endpoints.keys():
            self._leaving[endpoint] = now_s + LAST_WORDS_S
        for endpoint, key in endpoints.items():
            if endpoint not in self._wanted and self._leaving.pop(endpoint, None) is None:
                if self._security is not None:
                    self._security.trust(self._socket, key)
                self._socket.connect(endpoint)
        self._wanted = set(endpoints)
        self._publishers -= self._gone(self._publishers)

    def _disconnect_left(self) -> None:
        now_s = time.monotonic()
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
            self._hear_privately(frame)
            if timeout_s != 0.0 or self._backlog:
                return None  # perhaps it was a wake: the caller looks why

    def _hear_privately(self, frame: bytes) -> None:
        if not frame.startswith(self._private) or frame == self._private:
            return
        instance, notice = handshake.read_welcome(frame)
        self._publishers.add(instance)
        if notice:
            self._backlog.put(notice)

    def _drain(self) -> None:
        until_s = time.monotonic() + DRAIN_S
        while not self.closed and int(_option(self._socket, zmq.EVENTS)) & zmq.POLLIN:
            frame = self._receive(0.0)
            if frame is not None:
                self._backlog.put(frame)
            if time.monotonic() > until_s:
                self._wake()  # there may be more: the I/O thread comes back at once
                return
