"""The messages of one topic on their way out.

Each message leaves at once. Only in a flood (more than 32 within a millisecond) the rest of that
millisecond travels in frames of up to 16 KB: a call of ZeroMQ costs more than the message itself.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable

from nep_core import frames
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

FLOOD = 32
FLOOD_NS = 1_000_000
MILLISECOND_BITS = 20
"""Nanoseconds without their last 20 bits count windows of about a millisecond."""
SHARED_FRAME_BYTES = 16_000
"""Messages share a frame up to here; times the high-water mark: what may wait for a subscriber."""
HELD_S = 1.0
"""Nobody holds the lock so long, but who waits for us: a signal's handler has interrupted it."""


class Stream:
    """Numbers, encodes and sends; safe from any thread.

    ``send`` takes a frame and does not wait; it is called under ``lock``.
    """

    def __init__(
        self,
        send: Callable[[bytes], object],
        lock: threading.Lock,
        topic: str,
        node: str,
        encoding: Encoding | None,
        hurry: Callable[[], None],
        run: str = "",
    ) -> None:
        self.encoding = encoding
        self.sent = 0
        self._latched = b""
        self._is_json = encoding in (None, "json")
        self._send_frame = send
        self._lock = lock
        self._topic = topic
        self._node = node
        self._run = run
        self._start = subscription(topic)
        self._head = self._start + b"[" + to_json(node) + b","
        self._head_end = b',"json",' + to_json(run) + b"]" + NUL
        self._hurry = hurry
        self._window = 0
        self._in_window = 0
        self._waiting: list[bytes] = []
        self._room_bytes = SHARED_FRAME_BYTES
        self._waiting_since_ns = 0
        self._late: deque[tuple[bytes, Encoding, bool]] = deque()

    def send(self, message: Sendable, latch: bool = False) -> None:
        """Send ``message``; with ``latch``, subscribers that join later get it too.

        In a signal's handler that interrupts another sending it goes out a little later.
        Written flat: each call here costs as much as encoding the message.
        """
        if latch or not self._is_json or isinstance(message, (str, bytes)):
            self._send_alone(message, latch)
            return
        try:
            payload = to_json(message)
        except CANNOT_ENCODE as error:
            raise not_encodable("json", error) from error
        if not self._lock.acquire(True, HELD_S):
            self._send_later(payload, "json", latch)
            return
        try:
            if not self._waiting:
                now_ns = _now_ns()
                if now_ns >> MILLISECOND_BITS != self._window:
                    self._window, self._in_window = now_ns >> MILLISECOND_BITS, 0
                self._in_window += 1
                if self._in_window <= FLOOD:
                    self.sent += 1
                    self._send_frame(
                        b"%b%d,%d%b%b" % (self._head, self.sent, now_ns, self._head_end, payload)
                    )
                    return
                self._begin_to_wait(now_ns)
            self._waiting.append(payload)
            self._room_bytes -= len(payload)
            if self._room_bytes <= 0:
                self._flush()
        finally:
            self._lock.release()

    def flush(self, older_than_ns: int = 0) -> None:
        """Send what waits, if it has waited for so long."""
        if self._waiting:
            waited_ns = _now_ns() - self._waiting_since_ns
            if waited_ns >= older_than_ns or waited_ns < 0:  # the clock may be set back
                with self._lock:
                    self._flush()
        while self._late:
            self._send_payload(*self._late.popleft())

    def abandon(self, send: Callable[[bytes], object]) -> None:
        """From now on ``send`` gets the frames, and whoever held the lock is not there any more."""
        self._send_frame, self._lock = send, threading.Lock()

    def welcome(self) -> bytes:
        """The notice for a newcomer: what is latched, how many were sent; call under the lock."""
        return frames.notice(self._latched, self.sent) if self._latched else self.mark()

    def mark(self) -> bytes:
        """The notice of how many were sent; call under the lock."""
        return frames.mark(self._topic, self._node, self._run, self.sent)

    def _send_alone(self, message: Sendable, latch: bool) -> None:
        encoding = self.encoding or natural_encoding(message)
        self._send_payload(encode(message, encoding), encoding, latch)

    def _send_payload(self, payload: bytes, encoding: Encoding, latch: bool) -> None:
        if not self._lock.acquire(True, HELD_S):
            self._send_later(payload, encoding, latch)
            return
        try:
            self._flush()
            self.sent += 1
            frame = join(
                self._start, self._node, self.sent, _now_ns(), encoding, payload, self._run
            )
            if latch:
                self._latched = frame
            self._send_frame(frame)
        finally:
            self._lock.release()

    def _send_later(self, payload: bytes, encoding: Encoding, latch: bool) -> None:
        self._late.append((payload, encoding, latch))
        self._hurry()  # the I/O thread sends it

    def _begin_to_wait(self, now_ns: int) -> None:
        self._room_bytes = SHARED_FRAME_BYTES
        self._waiting_since_ns = now_ns
        self._hurry()  # the I/O thread sends it if no more messages come

    def _flush(self) -> None:
        if not self._waiting:
            return
        waiting, self._waiting = self._waiting, []
        first, since_ns = self.sent + 1, self._waiting_since_ns
        frame = join(self._start, self._node, first, since_ns, "json", NUL.join(waiting), self._run)
        self.sent += len(waiting)
        self._send_frame(frame)
        # It stays a flood until a quiet moment.
        self._window, self._in_window = _now_ns() >> MILLISECOND_BITS, FLOOD
