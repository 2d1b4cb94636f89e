"""The one thread of a network that tends its sockets while the program does other things."""

from __future__ import annotations

import logging
import socket
import struct
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import zmq

log = logging.getLogger(__name__)

TICK_MS = 20
HURRIED_TICK_MS = 1
HURRY_S = 0.05


class SocketEvent(NamedTuple):
    """What happened to a connection of a socket: zmq's number of it, and what zmq adds."""

    kind: int
    value: int
    endpoint: str


def socket_event(frames: list[bytes]) -> SocketEvent:
    """Read what the monitor of a socket tells; zmq's own reader would load asyncio and ssl."""
    numbers, endpoint = frames
    kind, value = struct.unpack("=Hi", numbers)
    return SocketEvent(kind, value, endpoint.decode())


class Wake:
    """Ends another thread's poll at once; safe to call in a signal handler."""

    def __init__(self) -> None:
        self._reader, self._writer = socket.socketpair()
        self._reader.setblocking(False)
        self._writer.setblocking(False)
        self.fileno = self._reader.fileno
        """What to poll for reading."""

    def __call__(self) -> None:
        """End the poll."""
        try:
            self._writer.send(b"!")
        except BlockingIOError:
            pass  # it is awake already
        except OSError:
            log.debug("woken after close")

    def clear(self) -> None:
        """Forget the calls so far."""
        try:
            while self._reader.recv(4096):
                pass
        except OSError:
            pass  # nothing left

    def close(self) -> None:
        """Give the sockets back."""
        self._reader.close()
        self._writer.close()

    __del__ = close


class IoThread:
    """Calls each tending function at least every TICK_MS, and when a socket has something."""

    def __init__(self, name: str) -> None:
        self.wake = Wake()
        """Lets it tend at once."""
        self._poller = zmq.Poller()
        self._poller.register(self.wake.fileno(), zmq.POLLIN)
        self._lock = threading.Lock()
        self._tending: list[Callable[[], object]] = []
        self._hurry_until_s = 0.0
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"nep-io-{name}", daemon=True)
        self.start = self._thread.start
        """Begins; to be called once."""
        self.watch = partial(self._poller.register, flags=zmq.POLLIN)
        """Wakes when this socket of ours, or file number, has something; before start()."""

    def tend(self, function: Callable[[], object]) -> None:
        """Call ``function`` again and again from this thread."""
        with self._lock:
            self._tending = [*self._tending, function]

    def forget(self, function: Callable[[], object]) -> None:
        """Stop calling ``function``."""
        with self._lock:
            self._tending = [kept for kept in self._tending if kept != function]

    def hurry(self) -> None:
        """Tend every millisecond for a while: something waits to be sent."""
        now_s = time.monotonic()
        if now_s > self._hurry_until_s:
            self.wake()
        self._hurry_until_s = now_s + HURRY_S

    def close(self) -> None:
        """End the thread; waits for it unless it is the caller."""
        self._stopping.set()
        self.wake()
        if self._thread.is_alive() and threading.current_thread() is not self._thread:
            self._thread.join(2.0)
        self.wake.close()

    def _run(self) -> None:
        waker = self.wake.fileno()
        while not self._stopping.is_set():
            try:
                hurried = time.monotonic() < self._hurry_until_s
                ready = self._poller.poll(HURRIED_TICK_MS if hurried else TICK_MS)
            except zmq.ZMQError:
                return  # the context ended
            if (waker, zmq.POLLIN) in ready:
                self.wake.clear()
            for function in self._tending:
                try:
                    function()
                except Exception:
                    log.exception("the I/O thread goes on after an error")
                    time.sleep(TICK_MS / 1000)  # never spin on an error that repeats
