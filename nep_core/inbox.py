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
from nep_core.io_thread import Wake
from nep_core.outbox import HIGH_WATER_MARK, bind

BACKLOG = 10_000
"""Frames kept for a subscriber that does not read; the oldest are dropped."""


LAST_WORDS_S = 1.0
"""How long a publisher that has left is still heard: disconnecting drops what is on its way."""


class Inbox:
    """One SUB socket; at any time one thread holds its lock and uses it."""

    def __init__(
        self, context: zmq.Context[zmq.Socket[bytes]], topic: str, subscriber: str
    ) -> None:
        self._private = handshake.private_subscription(topic, subscriber)
        self._socket = context.socket(zmq.SUB)
        self._socket.linger = 0
        self._socket.rcvhwm = HIGH_WATER_MARK
        self._socket.subscribe(subscription(topic))
        self._socket.subscribe(self._private)  # after the data: the handshake rests on it
        self._lock = threading.Lock()
        self._wake = Wake()
        self._poller = zmq.Poller()
        self._poller.register(self._socket, zmq.POLLIN)
        self._poller.register(self._wake.fileno(), zmq.POLLIN)
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
                frame = self._receive()
                if frame is not None:
                    return frame
                left_s = None if deadline is None else deadline - time.monotonic()
                if left_s is not None and left_s <= 0:
                    return None
                self._wait(left_s)

    def tend(self) -> None:
        """Keep the newest messages while nobody reads (the I/O thread)."""
        if not self._lock.acquire(blocking=False):
            return  # somebody reads
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
                self._wait(left_s)
                self._drain()
        return True

    def interrupt(self) -> None:
        """Make take() return None from now on; safe in a signal handler."""
        self.closed = True
        self._wake()

    def close(self) -> None:
        """End, also for a thread that waits in take()."""
        self.interrupt()
        with self._lock:
            self._socket.close()
            self._wake.close()

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

    def _receive(self) -> bytes | None:
        while True:
            try:
                frame = self._socket.recv(zmq.NOBLOCK)
            except zmq.Again:
                return None
            if frame[0:1] != b"\0":
                return frame
            if frame.startswith(self._private) and (latched := self._greet(frame)):
                return latched

    def _greet(self, frame: bytes) -> bytes:
        instance, latched = handshake.read_welcome(frame)
        self._publishers.add(instance)
        return latched

    def _drain(self) -> None:
        while not self.closed and (frame := self._receive()) is not None:
            if len(self._backlog) >= BACKLOG:
                self._backlog.popleft()  # its subscriber sees the gap in the sequence
            self._backlog.append(frame)

    def _wait(self, left_s: float | None) -> None:
        ready = self._poller.poll(None if left_s is None else math.ceil(left_s * 1000))
        if any(what != self._socket for what, _ in ready):
            self._wake.clear()
