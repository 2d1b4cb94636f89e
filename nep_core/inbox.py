"""The receiving side of one subscriber: a SUB socket read in the caller's thread.

Reading where the message is wanted saves a thread hop (a third of the latency). While nobody
reads, the I/O thread moves what arrives into a bounded backlog, so that a slow subscriber keeps
the newest messages; sequence numbers tell how many it lost.
"""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable

import zmq

from nep_core import handshake
from nep_core.frames import subscription
from nep_core.outbox import HIGH_WATER_MARK, bind

BACKLOG = 10_000
"""Frames kept for a subscriber that does not read; the oldest are dropped."""

LAST_WORDS_S = 1.0
"""How long a publisher that has left is still heard: disconnecting drops what is on its way."""

WAKE_ENDPOINT = "inproc://wake"
"""Where the I/O thread's socket is bound that ends another thread's wait for a message."""

FOR_EVER_MS = -1


class Inbox:
    """One SUB socket; at any time one thread holds its lock and uses it.

    ``wake`` asks the I/O thread to tend at once; ``waker`` is its socket at WAKE_ENDPOINT.
    """

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        topic: str,
        subscriber: str,
        *,
        wake: Callable[[], None],
        waker: zmq.Socket[bytes],
        high_water_mark: int = HIGH_WATER_MARK,
    ) -> None:
        self._private = handshake.private_subscription(topic, subscriber)
        self._socket = context.socket(zmq.SUB)
        self._socket.linger = 0
        self._socket.rcvhwm = high_water_mark
        self._socket.subscribe(subscription(topic))
        self._socket.subscribe(self._private)  # after the data: the handshake rests on it
        self._socket.connect(WAKE_ENDPOINT)
        self._wake = wake
        self._waker = waker
        self._timeout_ms = FOR_EVER_MS
        self._lock = threading.Lock()
        self._backlog: deque[bytes] = deque()
        self._commands: deque[Callable[[], None]] = deque()
        self._wanted: set[str] = set()
        self._leaving: dict[str, float] = {}
        self._publishers: set[str] = set()
        self.closed = False

    def connect(self, endpoints: set[str]) -> None:
        """Hear exactly these publishers from now on; safe from any thread."""
        self._do(lambda: self._connect_now(endpoints))

    def bind(self, endpoint: str) -> None:
        """Let publishers connect to ``endpoint``; raises PortTaken."""
        with self._lock:
            bind(self._socket, endpoint)

    def take(self, timeout_s: float | None) -> bytes | None:
        """The next frame; None after ``timeout_s`` (None: wait for ever), or when closed."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            with self._lock:
                if self._commands:
                    self._run_commands()
                if self._backlog:
                    return self._backlog.popleft()
                if self.closed:
                    return None
                left_s = None if deadline is None else max(0.0, deadline - time.monotonic())
                frame = self._receive(left_s)
                if frame is not None or left_s == 0.0:
                    return frame

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
        """Wait until all these publishers, and at least ``count``, have welcomed us."""
        deadline = time.monotonic() + timeout_s
        while not (instances <= self._publishers and len(self._publishers) >= count):
            left_s = deadline - time.monotonic()
            if left_s <= 0 or self.closed:
                return False
            with self._lock:
                self._run_commands()
                if not self.closed:
                    self._socket.poll(min(20, math.ceil(left_s * 1000)))
                    self._drain()
        return True

    def interrupt(self) -> None:
        """Make take() return None from now on; safe in a signal handler."""
        self.closed = True
        self._wake()

    def close(self) -> None:
        """End, also for a thread that waits in take(); the I/O thread must still tend."""
        self.interrupt()
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

    def _connect_now(self, endpoints: set[str]) -> None:
        now_s = time.monotonic()
        for endpoint in self._wanted - endpoints:
            self._leaving[endpoint] = now_s + LAST_WORDS_S
        for endpoint in endpoints:
            if endpoint not in self._wanted and self._leaving.pop(endpoint, None) is None:
                self._socket.connect(endpoint)
        self._wanted = set(endpoints)

    def _disconnect_left(self) -> None:
        now_s = time.monotonic()
        for endpoint in [e for e, until_s in self._leaving.items() if until_s < now_s]:
            del self._leaving[endpoint]
            self._socket.disconnect(endpoint)

    def _receive(self, timeout_s: float | None) -> bytes | None:
        """A message, or None: nothing came, or a private frame did (a welcome, a wake)."""
        timeout_ms = FOR_EVER_MS if timeout_s is None else math.ceil(timeout_s * 1000)
        if timeout_ms != self._timeout_ms:
            self._socket.rcvtimeo = self._timeout_ms = timeout_ms
        while True:
            try:
                frame = self._socket.recv()
            except zmq.Again:
                return None
            if frame[0] != handshake.PRIVATE_BYTE:
                return frame
            latched = self._greet(frame)
            if latched is not None or timeout_s != 0.0:
                return latched  # None: perhaps a wake, so look at the commands

    def _greet(self, frame: bytes) -> bytes | None:
        if not frame.startswith(self._private) or frame == self._private:
            return None
        instance, latched = handshake.read_welcome(frame)
        self._publishers.add(instance)
        return latched or None

    def _drain(self) -> None:
        while not self.closed and int(self._socket.EVENTS) & zmq.POLLIN:
            frame = self._receive(0.0)
            if frame is not None:
                if len(self._backlog) >= BACKLOG:
                    self._backlog.popleft()  # its subscriber sees the gap in the sequence
                self._backlog.append(frame)
