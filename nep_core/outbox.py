"""The sending side of a network: one XPUB socket, the subscribers seen on it, its streams."""

from __future__ import annotations

import os
import threading
from collections import defaultdict
from collections.abc import Callable

import zmq

from nep_core import handshake
from nep_core.errors import NetworkError, PortTaken
from nep_core.frames import Encoding
from nep_core.stream import FLOOD_NS, Stream

HIGH_WATER_MARK = 10_000
"""Frames that wait for a slow subscriber before ZeroMQ drops them; the subscriber sees the gap."""


class Outbox:
    """Sends in the caller's thread, under a lock; the I/O thread reads the subscriptions."""

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        node: str,
        instance: str,
        hurry: Callable[[], None],
        high_water_mark: int = HIGH_WATER_MARK,
    ) -> None:
        self._node = node
        self._instance = instance
        self._hurry = hurry
        self._socket = context.socket(zmq.XPUB)
        self._socket.linger = 500
        self._socket.sndhwm = high_water_mark
        self._lock = threading.Lock()
        self._seen_changed = threading.Condition()
        self._seen: dict[str, set[str]] = defaultdict(set)
        self._streams: dict[str, Stream] = {}

    def bind(self, endpoint: str) -> str:
        """Bind to ``endpoint``, say where; raises PortTaken."""
        with self._lock:
            bind(self._socket, endpoint)
            return self._socket.getsockopt_string(zmq.LAST_ENDPOINT)

    def connect(self, endpoint: str) -> None:
        """Send to ``endpoint``, where a broker or a subscriber is bound."""
        with self._lock:
            self._socket.connect(endpoint)

    @property
    def file_number(self) -> int:
        """Readable when the I/O thread should tend."""
        return int(self._socket.FD)

    def stream(self, topic: str, encoding: Encoding | None) -> Stream:
        """The one stream of ``topic``; raises NetworkError when it has another encoding."""
        with self._lock:
            stream = self._streams.get(topic)
            if stream is None:
                stream = Stream(self._socket, self._lock, topic, self._node, encoding, self._hurry)
                self._streams[topic] = stream
        if encoding not in (None, stream.encoding):
            raise NetworkError(
                f"{topic} is already published as {stream.encoding or 'it comes'} here.",
                checklist=("Use one encoding for all publishers of a topic.",),
            )
        return stream

    def tend(self) -> None:
        """Read who subscribed and who left, welcome the newcomers, send what waits."""
        while (event := self._next_event()) is not None:
            seen = handshake.read_subscription(event)
            if seen is not None:
                self._note(seen)
        for stream in list(self._streams.values()):
            stream.flush(older_than_ns=FLOOD_NS)

    def subscribers(self, topic: str) -> set[str]:
        """The ids of the subscribers that hear ``topic`` now."""
        with self._seen_changed:
            return set(self._seen[topic])

    def wait_for(self, topic: str, ids: set[str], count: int, timeout_s: float) -> bool:
        """Wait until all ``ids`` and at least ``count`` subscribers hear ``topic``."""
        with self._seen_changed:
            return self._seen_changed.wait_for(
                lambda: ids <= self._seen[topic] and len(self._seen[topic]) >= count, timeout_s
            )

    def close(self) -> None:
        """Send what waits (half a second at most) and close."""
        for stream in self._streams.values():
            stream.flush()
        with self._lock:
            self._socket.close()

    def _next_event(self) -> bytes | None:
        with self._lock:
            if self._socket.closed:
                return None
            try:
                return self._socket.recv(zmq.NOBLOCK)
            except zmq.Again:
                return None

    def _note(self, seen: handshake.Seen) -> None:
        if seen.present:
            self._welcome(seen)
        with self._seen_changed:
            change = set.add if seen.present else set.discard
            change(self._seen[seen.topic], seen.subscriber)
            self._seen_changed.notify_all()

    def _welcome(self, seen: handshake.Seen) -> None:
        with self._lock:
            stream = self._streams.get(seen.topic)
            latched = stream.latched if stream else b""
            self._socket.send(handshake.welcome(seen, self._instance, latched))


def bind(socket: zmq.Socket[bytes], endpoint: str) -> None:
    """Bind, or raise PortTaken with a sentence when the endpoint cannot be had."""
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
