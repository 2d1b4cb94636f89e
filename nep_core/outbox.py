"""The sending side of a network: one XPUB socket, the subscribers seen on it, its streams."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

import zmq
from zmq.backend import Socket as BackendSocket

from nep_core import handshake
from nep_core.errors import NetworkError, PortTaken
from nep_core.frames import Encoding
from nep_core.hearers import Hearers
from nep_core.security.addresses import require_loopback
from nep_core.stream import Stream

if TYPE_CHECKING:
    from nep_core.security.curve import Security

HIGH_WATER_MARK = 4_000
"""Frames that wait for a subscriber whose program is frozen, on each side.

A frame holds one message, or in a flood several of up to 16 KB together: at most 64 MB wait for
each subscriber while messages are below 16 KB. Larger ones are not bounded by that: 4,000 times
their size may wait. Whoever sends images gives the network a lower high-water mark.

What comes when all that is full is lost, and counted: ZeroMQ keeps the oldest here. It is the
subscriber's own backlog (backlog.py) that keeps the newest while its program is merely busy.
"""

# The send of the C back end: pyzmq's own looks for options that we never use.
_send = BackendSocket.send


class Outbox:
    """Sends in the caller's thread, under a lock; the I/O thread reads the subscriptions.

    ``is_far``: a broker is between us and the subscribers, so that we never see who is slow.
    """

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        node: str,
        instance: str,
        hurry: Callable[[], None],
        high_water_mark: int = HIGH_WATER_MARK,
        *,
        is_far: bool = False,
        security: Security | None = None,
    ) -> None:
        self._security = security
        self._node = node
        self._instance = instance
        self._is_far = is_far
        self._socket = context.socket(zmq.XPUB)
        self._socket.linger = 500
        self._socket.sndhwm = high_water_mark
        self._socket.setsockopt(zmq.XPUB_NODROP, 1)  # tells when somebody cannot take a frame
        if is_far:  # a broker that comes back brings the same subscribers: welcome them again
            self._socket.setsockopt(zmq.XPUB_VERBOSE, 1)
        self._lock = threading.Lock()
        self._hearers = Hearers(
            node,
            instance,
            lock=self._lock,
            sender=lambda _topic: self._send,
            send_privately=self._send_privately,
            hurry=hurry,
        )
        self.stream: Callable[[str, Encoding | None], Stream] = self._hearers.stream
        self.subscribers = self._hearers.subscribers
        self.wait_for = self._hearers.wait_for
        self.abandon = self._hearers.abandon

    def bind(self, endpoint: str) -> str:
        """Bind to ``endpoint``, say where; raises PortTaken."""
        with self._lock:
            bind(self._socket, endpoint, self._security)
            return self._socket.getsockopt_string(zmq.LAST_ENDPOINT)

    def connect(self, endpoint: str) -> None:
        """Send to ``endpoint``, where a broker or a subscriber is bound."""
        with self._lock:
            if self._security is not None:
                self._security.trust(self._socket, self._security.key_at(endpoint))
            self._socket.connect(endpoint)

    @property
    def file_number(self) -> int:
        """Readable when the I/O thread should tend."""
        return int(self._socket.FD)

    def tend(self) -> None:
        """Read who subscribed and who left, welcome the newcomers, send what waits."""
        while (event := self._next_event()) is not None:
            seen = handshake.read_subscription(event)
            if seen is not None:
                self._hearers.note(seen.topic, seen.subscriber, seen.present)
                if seen.present and self._is_far:
                    self._hearers.note_slow(seen.topic, seen.subscriber)
        if not self._socket.closed:
            self._hearers.tend()

    def close(self) -> None:
        """Send what waits (half a second at most) and close."""
        if not self._socket.closed:
            self._hearers.flush()
        with self._lock:
            self._socket.close()

    def _send(self, frame: bytes) -> None:
        """Send without waiting; the lock is held."""
        try:
            _send(self._socket, frame, zmq.NOBLOCK)
        except zmq.Again:
            self._send_to_whoever_has_room(frame)
        except zmq.ZMQError as error:
            raise NetworkError(
                f"The network of {self._node} is closed.", checklist=("Start it again.",)
            ) from error

    def _send_to_whoever_has_room(self, frame: bytes) -> None:
        """Note who has none; from then on ZeroMQ leaves those out until they have read."""
        for topic, subscriber in self._hearers.everyone():
            try:
                _send(self._socket, self._private_frame(topic, subscriber), zmq.NOBLOCK)
            except zmq.Again:
                self._hearers.note_slow(topic, subscriber)
        self._socket.setsockopt(zmq.XPUB_NODROP, 0)
        try:
            _send(self._socket, frame, zmq.NOBLOCK)
        finally:
            self._socket.setsockopt(zmq.XPUB_NODROP, 1)

    def _send_privately(self, topic: str, subscriber: str, notice: bytes) -> None:
        if not self._socket.closed:
            self._send(self._private_frame(topic, subscriber, notice))

    def _private_frame(self, topic: str, subscriber: str, notice: bytes = b"") -> bytes:
        return handshake.private_frame(topic, subscriber, self._instance, notice)

    def _next_event(self) -> bytes | None:
        with self._lock:
            if self._socket.closed:
                return None
            try:
                return self._socket.recv(zmq.NOBLOCK)
            except zmq.Again:
                return None


def bind(socket: zmq.Socket[bytes], endpoint: str, security: Security | None = None) -> None:
    """Bind, or raise PortTaken with a sentence when the endpoint cannot be had.

    Without keys it must be one that only this computer reaches, else NetworkError is raised.
    """
    if security is None:
        require_loopback(endpoint)
    else:
        security.guard(socket)
    try:
        socket.setsockopt(zmq.IPV6, int("[" in endpoint))
        socket.bind(endpoint)
    except zmq.ZMQError as error:
        raise PortTaken(
            f"{endpoint} cannot be used: {os.strerror(error.errno or 0).lower()}.",
            checklist=(
                "Is the same program running twice? Stop the other one.",
                "Choose another port.",
                "Is that an address of this computer?",
            ),
        ) from error
