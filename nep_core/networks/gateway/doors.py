"""The sockets at which programs of the original meet the gateway, and who is connected to them."""

from __future__ import annotations

import contextlib
import logging
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import zmq
from zmq.utils.monitor import parse_monitor_message

from nep_core.wire.outbox import bind

from .formats import Shape, write

log = logging.getLogger(__name__)


# Waits on many sockets and calls what belongs to the one that has something.


class Watch:
    """Belongs to one thread."""

    def __init__(self) -> None:
        self._poller = zmq.Poller()
        self._calls: dict[Any, Callable[[], None]] = {}

    def add(self, readable: zmq.Socket[bytes] | int, call: Callable[[], None]) -> None:
        """Call ``call`` whenever this socket or file number has something.

        It must not wait: a REP socket has something when a request without a head has come, which
        ZeroMQ then keeps to itself.
        """
        self._poller.register(readable, zmq.POLLIN)
        self._calls[readable] = call

    def forget(self, readable: zmq.Socket[bytes] | int) -> None:
        """Watch it no more."""
        self._poller.unregister(readable)
        del self._calls[readable]

    def once(self, timeout_s: float) -> None:
        """Wait for something, and call what belongs to it."""
        for readable, _ in self._poller.poll(round(timeout_s * 1000)):
            call = self._calls.get(readable)
            if call is not None:  # an earlier call may have closed it
                with contextlib.suppress(zmq.Again):  # it was nothing that ZeroMQ gives us
                    call()


ARRIVALS = zmq.Event.ACCEPTED | zmq.Event.CONNECTED
DEPARTURES = zmq.Event.DISCONNECTED | zmq.Event.CLOSED
AT_A_TIME = 100
"""So many frames are taken from one door before the others have their turn."""

Context = zmq.Context[zmq.Socket[bytes]]


class Door(ABC):
    """One socket; ``connections`` are the file numbers of those who are connected to it.

    ``on_change`` is called when somebody came or left.
    """

    kind: int

    def __init__(self, context: Context, watch: Watch, on_change: Callable[[], None]) -> None:
        self.connections: set[int] = set()
        self._on_change = on_change
        self._watch = watch
        self._socket = context.socket(self.kind)
        self._socket.linger = 0
        self._socket.reconnect_ivl_max = 1000
        self._monitor = self._socket.get_monitor_socket(ARRIVALS | DEPARTURES)
        watch.add(self._socket, self._receive)
        watch.add(self._monitor, self._note)

    def bind(self, endpoint: str) -> None:
        """Let programs connect; raises PortTaken."""
        bind(self._socket, endpoint)

    def connect(self, endpoint: str) -> None:
        """Go to a program that binds."""
        self._socket.connect(endpoint)

    def close(self) -> None:
        """Free the port."""
        self._watch.forget(self._monitor)
        self._watch.forget(self._socket)
        self._socket.disable_monitor()
        self._monitor.close()
        self._socket.close()

    @abstractmethod
    def _receive(self) -> None:
        """Take what the socket has."""

    def _note(self) -> None:
        event = parse_monitor_message(self._monitor.recv_multipart(zmq.NOBLOCK))
        change = set.add if event["event"] & ARRIVALS else set.discard
        change(self.connections, int(event["value"]))
        self._on_change()


class WayIn(Door):
    """Takes what programs publish."""

    kind = zmq.SUB

    def __init__(
        self,
        context: Context,
        watch: Watch,
        on_change: Callable[[], None],
        on_frame: Callable[[bytes], None],
    ) -> None:
        super().__init__(context, watch, on_change)
        self._on_frame = on_frame
        self._socket.subscribe(b"")

    def _receive(self) -> None:
        for _ in range(AT_A_TIME):
            try:
                frames = self._socket.recv_multipart(zmq.NOBLOCK)
            except zmq.Again:
                return
            self._on_frame(b" ".join(frames))


class WayOut(Door):
    """Gives programs what they subscribe to; ``wanted`` are their subscriptions.

    They tell what their program reads: bare frames if it takes everything, else prefixed ones.
    """

    kind = zmq.XPUB

    def __init__(
        self,
        context: Context,
        watch: Watch,
        on_change: Callable[[], None],
        topic: str,
        shape: Shape,
    ) -> None:
        super().__init__(context, watch, on_change)
        self.wanted: set[bytes] = set()
        self.shape = shape
        self._topic = topic

    def send(self, value: object) -> None:
        """Give all who are here a value; raises BadMessage."""
        self._socket.send(write(value, self._topic, self.shape.kind, self._prefixed))

    def takes(self, frame: bytes, shape: Shape) -> bool:
        """Send on, as it is, a frame that the programs here read; else False."""
        is_read = shape == self.shape
        if is_read and shape.kind == "json":  # 0.5.4.6 asks like later ones, but has prefixes
            is_read = frame.startswith(self._topic.encode() + b" ") == self._prefixed
        if is_read:
            self._socket.send(frame)
        return is_read

    @property
    def _prefixed(self) -> bool:
        return b"" not in self.wanted

    def _receive(self) -> None:
        event = self._socket.recv(zmq.NOBLOCK)
        if event[:1] in (b"\0", b"\1"):
            (set.add if event[0] else set.discard)(self.wanted, event[1:])
            self._on_change()


# Warns at most once a second, so that a flood of faults is no flood of words.

WARN_S = 1.0


class Warner:
    """Any thread."""

    def __init__(self) -> None:
        self._next_s = 0.0

    def __call__(self, sentence: str) -> None:
        """Warn, unless it is too soon."""
        if time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + WARN_S
            log.warning("%s", sentence)
