"""The receiving side of one subscriber on a zenoh network.

Zenoh's own thread fills a ring, so that it never waits for a subscriber; a thread of the inbox
moves what is there into the backlog, where the subscriber takes it.
"""

from __future__ import annotations

import threading
import time
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING

from nep_core import handshake
from nep_core.backlog import Backlog
from nep_core.network import Policy
from nep_core.over_zenoh.keys import frames_key

if TYPE_CHECKING:
    import zenoh

RING_FRAMES = 1_000
"""Frames that zenoh keeps until our thread has its turn, beside the backlog; the newest stay."""


class ZenohInbox:
    """One zenoh subscription: data, and what is for this subscriber alone, in their order."""

    def __init__(self, session: zenoh.Session, topic: str, subscriber: str, policy: Policy) -> None:
        import zenoh

        self.closed = False
        self._lock = threading.Lock()
        self._closing, self._is_undeclared = threading.Lock(), False
        self._backlog = Backlog(topic, policy)
        self._private = handshake.private_subscription(topic, subscriber)
        self._publishers: set[str] = set()
        self._is_awaited = False
        self._wakes: SimpleQueue[None] = SimpleQueue()  # its put() is safe in a signal handler
        ring: zenoh.handlers.RingChannel[zenoh.Sample]
        ring = zenoh.handlers.RingChannel(RING_FRAMES)
        self._subscription = session.declare_subscriber(frames_key(topic, subscriber), ring)
        self._thread = threading.Thread(target=self._drain, name="nep-zenoh-inbox", daemon=True)
        self._thread.start()

    @property
    def lost(self) -> int:
        """How many messages are lost so far; any thread may ask."""
        return self._backlog.lost

    def take(self, timeout_s: float | None) -> bytes | None:
        """The next frame; None after ``timeout_s`` (None: wait for ever), or when closed."""
        deadline = None if timeout_s is None else time.monotonic() + timeout_s
        while True:
            self._is_awaited = True  # before we look, so that nothing comes unseen
            if self.closed:
                return None
            with self._lock:
                if (frame := self._backlog.pop()) is not None:
                    return frame
            if not self._wait(deadline):
                return None

    def wait_for(self, instances: set[str], count: int, timeout_s: float) -> bool:
        """Wait until all these publishers, and at least ``count``, have welcomed us."""
        deadline = time.monotonic() + timeout_s
        while True:
            self._is_awaited = True
            with self._lock:
                if instances <= self._publishers and len(self._publishers) >= count:
                    return True
            if self.closed or not self._wait(deadline):
                return False

    def tend(self) -> None:
        """Nothing: the inbox has a thread of its own."""

    def interrupt(self) -> None:
        """Make take() return None from now on; safe in a signal handler."""
        self.closed = True
        self._wakes.put(None)

    def abandon(self) -> None:
        """In the child of a fork: nothing comes here any more."""
        self.closed, self._lock = True, threading.Lock()

    def close(self) -> None:
        """End, also for a thread that waits in take()."""
        self.interrupt()
        with self._closing:
            if not self._is_undeclared:
                self._is_undeclared = True
                self._subscription.undeclare()
        self._thread.join(1.0)

    def _wait(self, deadline: float | None) -> bool:
        """Whether something may have come before the deadline."""
        left_s = None if deadline is None else deadline - time.monotonic()
        if left_s is not None and left_s <= 0:
            return False
        try:
            self._wakes.get(timeout=left_s)
        except Empty:
            return False
        return True

    def _drain(self) -> None:
        for sample in self._subscription.handler:  # ends with the subscription
            frame = sample.payload.to_bytes()
            with self._lock:
                self._put(frame)
            if self._is_awaited:
                self._is_awaited = False
                self._wakes.put(None)

    def _put(self, frame: bytes) -> None:
        if frame.startswith(self._private):
            instance, frame = handshake.read_welcome(frame)
            self._publishers.add(instance)
        if frame:
            self._backlog.put(frame)
