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
    Encoding,
    Sendable,
    encode,
    frame_start,
    join,
    natural_encoding,
    not_encodable,
    to_json,
)

_now_ns = time.time_ns
# The send of the C back end: pyzmq's own looks for options that we never use.
_send = BackendSocket.send

FLOOD = 32
FLOOD_NS = 1_000_000
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
        self._start = frame_start(topic, node)
        self._hurry = hurry
        self._sequence = 0
        self._window_ns = 0
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
                if not 0 <= now_ns - self._window_ns < FLOOD_NS:
                    self._window_ns, self._in_window = now_ns, 0
                self._in_window += 1
                if self._in_window <= FLOOD:
                    self._sequence += 1
                    head = (self._start, self._sequence, now_ns, payload)
                    _send(self._socket, b'%b%d,%d,"json"]\0%b' % head)
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
            frame = join(self._start, self._sequence, _now_ns(), encoding.encode(), payload)
            _send(self._socket, frame)
            if latch:
                self.latched = frame

    def _begin_to_wait(self, now_ns: int) -> None:
        self._room_bytes = SHARED_FRAME_BYTES
        self._waiting_since_ns = now_ns
        self._hurry()  # the I/O thread sends it if no more messages come

    def _flush(self) -> None:
        if self._waiting:
            waiting, self._waiting = self._waiting, []
            since_ns, payloads = self._waiting_since_ns, b"\0".join(waiting)
            _send(self._socket, join(self._start, self._sequence + 1, since_ns, b"json", payloads))
            self._sequence += len(waiting)
            self._window_ns, self._in_window = (
                _now_ns(),
                FLOOD,
            )  # until a quiet moment
