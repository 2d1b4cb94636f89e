"""The messages of one topic on their way out.

Each message leaves at once. Only in a flood (more than 32 within a millisecond) the rest of that
millisecond travels in frames of up to 128 KB: a call of ZeroMQ costs more than the message itself.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import zmq
from zmq.backend import Socket as BackendSocket

from nep_core.frames import (
    CANNOT_ENCODE,
    NUL,
    Encoding,
    Sendable,
    encode,
    join,
    natural_encoding,
    not_encodable,
    subscription,
    to_json,
)

_now_ns = time.time_ns
# The send of the C back end: pyzmq's own looks for options that we never use.
_send = BackendSocket.send

FLOOD = 32
FLOOD_NS = 1_000_000
MILLISECOND_BITS = 20
"""Nanoseconds without their last 20 bits count windows of about a millisecond."""
SHARED_FRAME_BYTES = 128_000


class Stream:
    """Numbers, encodes and sends; safe from any thread."""

    def __init__(
        self,
        socket: zmq.Socket[bytes],
        lock: threading.Lock,
        topic: str,
        node: str,
        encoding: Encoding | None,
        hurry: Callable[[], None],
    ) -> None:
        self.encoding = encoding
        self.latched = b""
        self._is_json = encoding in (None, "json")
        self._socket = socket
        self._lock = lock
        self._node = node
        self._start = subscription(topic)
        self._hurry = hurry
        self._sequence = 0
        self._window = 0
        self._in_window = 0
        self._waiting: list[bytes] = []
        self._room_bytes = SHARED_FRAME_BYTES
        self._waiting_since_ns = 0

    def send(self, message: Sendable, latch: bool = False) -> None:
        """Send ``message``; with ``latch``, subscribers that join later get it too.

        Written flat: each call here costs as much as encoding the message.
        """
        if latch or not self._is_json or isinstance(message, (str, bytes)):
            self._send_alone(message, latch)
            return
        try:
            payload = to_json(message)
        except CANNOT_ENCODE as error:
            raise not_encodable("json", error) from error
        with self._lock:
            if not self._waiting:
                now_ns = _now_ns()
                if now_ns >> MILLISECOND_BITS != self._window:
                    self._window, self._in_window = now_ns >> MILLISECOND_BITS, 0
                self._in_window += 1
                if self._in_window <= FLOOD:
                    self._sequence += 1
                    head = to_json((self._node, self._sequence, now_ns, "json"))
                    _send(self._socket, self._start + head + NUL + payload)
                    return
                self._begin_to_wait(now_ns)
            self._waiting.append(payload)
            self._room_bytes -= len(payload)
            if self._room_bytes <= 0:
                self._flush()

    def flush(self, older_than_ns: int = 0) -> None:
        """Send what waits, if it has waited for so long."""
        if self._waiting and _now_ns() - self._waiting_since_ns >= older_than_ns:
            with self._lock:
                self._flush()

    def _send_alone(self, message: Sendable, latch: bool) -> None:
        encoding = self.encoding or natural_encoding(message)
        payload = encode(message, encoding)
        with self._lock:
            self._flush()
            self._sequence += 1
            frame = join(self._start, self._node, self._sequence, _now_ns(), encoding, payload)
            _send(self._socket, frame)
            if latch:
                self.latched = frame

    def _begin_to_wait(self, now_ns: int) -> None:
        self._room_bytes = SHARED_FRAME_BYTES
        self._waiting_since_ns = now_ns
        self._hurry()  # the I/O thread sends it if no more messages come

    def _flush(self) -> None:
        if not self._waiting:
            return
        waiting, self._waiting = self._waiting, []
        first, since_ns = self._sequence + 1, self._waiting_since_ns
        payloads = NUL.join(waiting)
        frame = join(self._start, self._node, first, since_ns, "json", payloads)
        _send(self._socket, frame)
        self._sequence += len(waiting)
        # It stays a flood until a quiet moment.
        self._window, self._in_window = _now_ns() >> MILLISECOND_BITS, FLOOD
