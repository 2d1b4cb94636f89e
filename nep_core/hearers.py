"""Who hears the topics of one program, and what each hearer is told in private.

It knows no socket: whatever carries the messages tells who comes and goes.
"""

from __future__ import annotations

import threading
import time
from collections import defaultdict
from collections.abc import Callable

from nep_core import frames
from nep_core.errors import NetworkError
from nep_core.frames import RUN_CHARACTERS, Encoding
from nep_core.stream import FLOOD_NS, Stream

MARK_S = 0.5
"""How often a slow subscriber is told how many messages were sent."""

SendFrame = Callable[[bytes], object]
SendPrivately = Callable[[str, str, bytes], object]
"""Sends a notice to the subscriber (topic, id); called under the lock, must not wait."""


class Hearers:
    """The streams of a network and their subscribers; safe from any thread.

    ``sender`` gives, by topic, what sends a frame. ``lock`` is held whenever something is sent.
    """

    def __init__(
        self,
        node: str,
        instance: str,
        *,
        lock: threading.Lock,
        sender: Callable[[str], SendFrame],
        send_privately: SendPrivately,
        hurry: Callable[[], None],
    ) -> None:
        self._node = node
        self._run = instance[:RUN_CHARACTERS]
        self._lock = lock
        self._sender = sender
        self._send_privately = send_privately
        self._hurry = hurry
        self._changed = threading.Condition()
        self._ids: dict[str, set[str]] = defaultdict(set)
        self._slow: set[tuple[str, str]] = set()
        self._streams: dict[str, Stream] = {}
        self._next_mark_s = 0.0

    def stream(self, topic: str, encoding: Encoding | None) -> Stream:
        """The one stream of ``topic``; raises NetworkError when it has another encoding."""
        with self._lock:
            stream = self._streams.get(topic)
            if stream is None:
                send = self._sender(topic)
                stream = Stream(
                    send, self._lock, topic, self._node, encoding, self._hurry, self._run
                )
                self._streams[topic] = stream
        if encoding not in (None, stream.encoding):
            raise NetworkError(
                f"{topic} is already published as {stream.encoding or 'it comes'} here.",
                checklist=("Use one encoding for all publishers of a topic.",),
            )
        return stream

    def subscribers(self, topic: str) -> set[str]:
        """The ids of the subscribers that hear ``topic`` now."""
        with self._changed:
            return set(self._ids[topic])

    def everyone(self) -> list[tuple[str, str]]:
        """All that hear something: topic and id."""
        with self._changed:
            return [(topic, who) for topic, ids in self._ids.items() for who in ids]

    def wait_for(self, topic: str, ids: set[str], count: int, timeout_s: float) -> bool:
        """Wait until all ``ids`` and at least ``count`` subscribers hear ``topic``."""
        with self._changed:
            return self._changed.wait_for(
                lambda: ids <= self._ids[topic] and len(self._ids[topic]) >= count, timeout_s
            )

    def note(self, topic: str, subscriber: str, present: bool) -> None:
        """Welcome a subscriber that has come, or forget one that has left."""
        if present:
            with self._lock:
                stream = self._streams.get(topic)
                welcome = stream.welcome() if stream else self.mark(topic)
                self._send_privately(topic, subscriber, welcome)
        with self._changed:
            change = set.add if present else set.discard
            change(self._ids[topic], subscriber)
            if not self._ids[topic]:
                del self._ids[topic]
            self._slow.discard((topic, subscriber))
            self._changed.notify_all()

    def mark(self, topic: str) -> bytes:
        """The notice of how many messages of ``topic`` were sent; call under the lock."""
        stream = self._streams.get(topic)
        return stream.mark() if stream else frames.mark(topic, self._node, self._run, 0)

    def note_slow(self, topic: str, subscriber: str) -> None:
        """Somebody could not take a message: from now on it hears how many there were.

        It hears so again and again, since a mark can be lost as well.
        """
        with self._changed:
            self._slow.add((topic, subscriber))

    def tend(self) -> None:
        """Send what has waited in a flood, and the marks that are due (the I/O thread)."""
        for stream in list(self._streams.values()):
            stream.flush(older_than_ns=FLOOD_NS)
        if self._slow and time.monotonic() >= self._next_mark_s:
            self._next_mark_s = time.monotonic() + MARK_S
            with self._changed:
                slow = [(topic, who) for topic, who in self._slow if topic in self._streams]
            for topic, subscriber in slow:
                with self._lock:
                    self._send_privately(topic, subscriber, self.mark(topic))

    def abandon(self, send: SendFrame) -> None:
        """In the child of a fork: ``send`` gets what its streams send, nobody holds a lock."""
        for stream in self._streams.values():
            stream.abandon(send)

    def flush(self) -> None:
        """Send all that waits."""
        for stream in list(self._streams.values()):
            stream.flush()
