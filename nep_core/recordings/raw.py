"""Messages as they travel, unread: for tools that show, count or keep whatever is sent."""

from __future__ import annotations

import logging
import time
from dataclasses import dataclass

from nep_core.errors import BadMessage
from nep_core.networks.network import HANDSHAKE_S, Network
from nep_core.wire.frames import (
    MOST_TOGETHER,
    NUL,
    Encoding,
    check_topic,
    holds_too_many,
    read_header,
)
from nep_core.wire.pubsub import MOST_LOGGED

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class RawMessage:
    """One message: its payload, how that is encoded, who sent it, when, and when it arrived.

    ``sequence`` counts the sender's messages of the topic from 1. Times are ns since 1970, each
    by the clock of its own computer.
    """

    topic: str
    node: str
    sequence: int
    sent_ns: int
    arrived_ns: int
    encoding: Encoding
    payload: bytes


class SteadyClock:
    """Nanoseconds since 1970 that never jump, whatever happens to this computer's clock."""

    def __init__(self) -> None:
        self._offset_ns = time.time_ns() - time.monotonic_ns()

    def now_ns(self) -> int:
        """The time now."""
        return time.monotonic_ns() + self._offset_ns


class RawSubscriber:
    """Receives a topic's messages unread; only one thread may receive at a time."""

    def __init__(self, topic: str, *, network: Network, clock: SteadyClock | None = None) -> None:
        check_topic(topic)
        self.topic = topic
        self._network = network
        self._clock = clock or SteadyClock()
        self._waiting: list[RawMessage] = []
        self._logged, self._log_until_s = 0, 0.0
        self._id, self._inbox = network.open_inbox(topic)
        try:
            known = network.add_subscriber(topic, self._id, self._inbox)
        except BaseException:
            self.close()
            raise
        if known:
            self._inbox.wait_for(known, 0, HANDSHAKE_S)

    def receive(self, timeout_s: float | None = None) -> RawMessage | None:
        """The next message; None when nothing came for ``timeout_s``, or when closed."""
        until_s = None if timeout_s is None else time.monotonic() + timeout_s
        while not self._waiting:
            # A flood of frames that cannot be read must not keep the caller here
            frame = self._inbox.take(until_s and max(0.0, until_s - time.monotonic()))
            if frame is None:
                return None
            self._waiting = self._read(frame)[::-1]
        return self._waiting.pop()

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive."""
        return self._inbox.lost

    @property
    def closed(self) -> bool:
        """Whether nothing more can come: it was closed, or its network was."""
        return self._inbox.closed

    def close(self) -> None:
        """Hear no more; a thread that waits in receive() gets None."""
        self._network.remove_subscriber(self._id)

    def _skip(self, why: str) -> None:
        """Note that a frame could not be read, and log it, but not for each of a flood."""
        self._network.troubles.note("messages_unreadable", self.topic, why)
        if (now_s := time.monotonic()) >= self._log_until_s:
            self._logged, self._log_until_s = 0, now_s + 1.0
        self._logged += 1
        if self._logged <= MOST_LOGGED:
            log.warning("%s: %s", self.topic, why)

    def _read(self, frame: bytes) -> list[RawMessage]:
        arrived_ns = self._clock.now_ns()
        parts = frame.split(NUL, 2)
        if len(parts) < 3:
            self._skip("a frame has no header: its sender does not speak NEP")
            return []
        try:
            header = read_header(parts[1])
        except BadMessage as error:
            self._skip(str(error))
            return []
        if header.encoding == "json" and holds_too_many(parts[2]):
            self._skip(f"a frame of {header.node} holds more than {MOST_TOGETHER} messages")
            return []
        payloads = parts[2].split(NUL) if header.encoding == "json" else [parts[2]]
        return [
            RawMessage(
                self.topic,
                header.node,
                header.sequence + at,
                header.time_ns,
                arrived_ns,
                header.encoding,
                payload,
            )
            for at, payload in enumerate(payloads)
        ]
