"""The messages of one topic on their way out.

Each message leaves at once. Only in a flood (more than 32 within a millisecond) the rest of that
millisecond travels in frames of up to 128 KB: a call of ZeroMQ costs more than the message itself.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import zmq

from nep_core.frames import (
    Encoding,
    Sendable,
    encode,
    encode_json,
    frame_start,
    join,
    natural_encoding,
)

_now = time.time

FLOOD = 32
FLOOD_S = 0.001
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
        self._send_bytes = socket.send
        self._lock = lock
        self._start = frame_start(topic, node)
        self._hurry = hurry
        self._sequence = 0
        self._window_s = 0.0
        self._in_window = 0
        self._waiting: list[bytes] = []
        self._room_bytes = SHARED_FRAME_BYTES
        self._waiting_since_s = 0.0

    def send(self, message: Sendable, latch: bool = False) -> None:
        """Send ``message``; with ``latch``, subscribers that join later get it too."""
        if latch or not self._is_json or isinstance(message, (str, bytes)):
            self._send_alone(message, latch)
            return
        payload = encode_json(message)
        with self._lock:
            if self._waiting:
                self._waiting.append(payload)
                self._room_bytes -= len(payload)
                if self._room_bytes <= 0:
                    self._flush()
                return
            now_s = _now()
            if self._is_flood(now_s):
                self._let_wait(payload, now_s)
            else:
                self._send_now([payload], b"json", now_s)

    def flush(self, older_than_s: float = 0.0) -> None:
        """Send what waits, if it has waited for so long."""
        if self._waiting and _now() - self._waiting_since_s >= older_than_s:
            with self._lock:
                self._flush()

    def _is_flood(self, now_s: float) -> bool:
        self._in_window += 1
        if not 0 <= now_s - self._window_s < FLOOD_S:
            self._window_s = now_s
            self._in_window = 1
        return self._in_window > FLOOD

    def _send_alone(self, message: Sendable, latch: bool) -> None:
        encoding = self.encoding or natural_encoding(message)
        payload = encode(message, encoding)
        with self._lock:
            self._flush()
            frame = self._send_now([payload], encoding.encode(), _now())
            if latch:
                self.latched = frame

    def _send_now(self, payloads: list[bytes], encoding: bytes, time_s: float) -> bytes:
        frame = join(self._start, self._sequence + 1, time_s, encoding, payloads)
        self._sequence += len(payloads)
        self._send_bytes(frame)
        return frame

    def _let_wait(self, payload: bytes, now_s: float) -> None:
        self._waiting.append(payload)
        self._room_bytes = SHARED_FRAME_BYTES - len(payload)
        self._waiting_since_s = now_s
        self._hurry()  # the I/O thread sends it if no more messages come

    def _flush(self) -> None:
        if self._waiting:
            waiting, self._waiting = self._waiting, []
            self._send_now(waiting, b"json", self._waiting_since_s)
            self._window_s, self._in_window = _now(), FLOOD  # it is a flood until a quiet moment
