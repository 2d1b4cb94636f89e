"""Publisher and Subscriber: how nodes talk."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any, Generic, TypeVar

import msgspec

from nep_core.errors import BadMessage
from nep_core.networks.network import HANDSHAKE_S, Network, Policy
from nep_core.networks.transports import default_network

from .frames import (
    CANNOT_DECODE,
    JSON_HEAD,
    JSON_MARK,
    MOST_TOGETHER,
    NUL,
    Decode,
    Encoding,
    Header,
    Sendable,
    check_topic,
    decoders,
    holds_too_many,
    read_header,
)
from .messages import LATCHED

log = logging.getLogger(__name__)

T = TypeVar("T")

MOST_LOGGED = 10
"""So many lines a second are logged of what is wrong with a topic's messages."""
PENDING_S = 0.1
"""So long what has arrived is read at once: in a flood it would go on for ever."""
AFTER_ERROR_S = 0.02
"""So long a thread that hears rests after an error of ours: never spin on one that repeats."""


class Publisher:
    """Sends messages on one topic.

    ``network``: where (default: this program's p2p network). ``wait_for_subscribers``: return
    only when so many hear the topic, or after ``timeout_s``. ``latched``: subscribers that join
    later get the last message. Subscribers that the master knows of never miss the first one.

    ``encoding``: JSON, text or bytes (None: as the first message is).
    """

    def __init__(
        self,
        topic: str,
        *,
        network: Network | None = None,
        encoding: Encoding | None = None,
        latched: bool | None = None,
        wait_for_subscribers: int = 0,
        timeout_s: float = 5.0,
    ) -> None:
        check_topic(topic)
        self.topic = topic
        self.network = network or default_network()
        self._latched = topic in LATCHED if latched is None else latched
        self._send = self.network.outbox.stream(topic, encoding).send
        self._closed = False
        try:
            expected = self.network.add_publisher(topic)
        except BaseException:
            self.close()
            raise
        outbox = self.network.outbox
        outbox.expect(topic, expected)
        if expected and not outbox.wait_for(topic, expected, 0, HANDSHAKE_S):
            log.warning("a subscriber of %s has not connected yet", topic)
        if wait_for_subscribers:
            self.wait_for_subscribers(wait_for_subscribers, timeout_s)

    def send(self, message: Sendable, *, latch: bool = True) -> None:
        """Send a struct, dictionary, text or bytes; raises BadMessage.

        JSON has no NaN and no infinity: they arrive as null (None); encoding="msgpack" has them.
        ``latch=False`` keeps the message of a latched topic that later subscribers get.
        """
        self._send(message, latch and self._latched)

    def subscribers(self) -> int:
        """How many subscribers hear this topic now."""
        return len(self.network.outbox.subscribers(self.topic))

    def wait_for_subscribers(self, count: int, timeout_s: float) -> bool:
        """Wait until ``count`` subscribers hear this topic; False when the time is over."""
        return self.network.outbox.wait_for(self.topic, set(), count, timeout_s)

    def close(self) -> None:
        """Publish no more."""
        if not self._closed:
            self._closed = True
            self.network.remove_publisher(self.topic)


class Subscriber(Generic[T]):
    """Receives the messages of one topic.

    ``kind``: the struct that messages are read into (default: what JSON gives). ``callback``:
    called with each message, in a thread of its own, until the subscriber is closed: what it
    raises is logged, and told by the node of this network, and the next message comes. A message
    that cannot be read, or is not of that kind, is skipped with a warning that names the key, and
    so is null, which would look like no message. Only one thread may receive at a time.

    ``policy``: what is kept while nobody receives. "events" (the default): up to 10,000 frames,
    or 64 MB; then the oldest are dropped, and counted in ``lost``. "state": the newest message
    of each publisher, and nothing counts as lost. While this whole program is frozen, its
    publishers keep the oldest (outbox.py), and what they cannot keep is counted all the same.

    ``network``: where (default: this program's own).
    """

    def __init__(
        self,
        topic: str,
        kind: type[T] | None = None,
        *,
        network: Network | None = None,
        callback: Callable[[T], None] | None = None,
        policy: Policy | None = None,
    ) -> None:
        check_topic(topic)
        self.topic = topic
        self.network = network or default_network()
        self._header: Header | None = None
        self._head = b""
        self._keeps_newest = policy == "state"
        self._logged, self._log_until_s = 0, 0.0
        self._decoders = decoders(kind)
        self._from_json = self._decoders["json"]
        wanted: Any = Any if kind is None else kind
        self._from_lines = msgspec.json.Decoder(wanted).decode_lines
        self._waiting: deque[T] = deque()
        self._id, self._inbox = self.network.open_inbox(topic, policy or "events")
        try:
            known = self.network.add_subscriber(topic, self._id, self._inbox)
        except BaseException:
            self.close()
            raise
        if known and not self._inbox.wait_for(known, 0, HANDSHAKE_S):
            log.warning("a publisher of %s does not answer", topic)
        if callback is not None:
            name, args = f"nep-hear-{topic}", (callback,)
            threading.Thread(target=self._tell, args=args, name=name, daemon=True).start()

    @property
    def header(self) -> Header | None:
        """Who sent the last message, when, and which number it (or the first beside it) has."""
        if self._head:
            head, self._head = self._head, b""
            try:
                self._header = read_header(head)
            except BadMessage as error:
                self._header = None
                self._skip("a header cannot be read", error)
        return self._header

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive, or were dropped; any thread may ask.

        It is known within a second, also when nothing more is sent.
        """
        return self._inbox.lost

    def receive(self, timeout_s: float | None = None) -> T | None:
        """The next message; waits ``timeout_s`` (None: for ever). None: nothing came, or closed.

        What cannot be read is passed over.
        """
        until_s: float | None = None
        while True:
            if self._waiting:
                return self._waiting.popleft()
            frame = self._inbox.take(timeout_s)
            if frame is None:
                return None
            parts = frame.split(NUL, 2)
            decode: Decode | None
            if len(parts) == 3 and parts[1][JSON_HEAD] == JSON_MARK:
                self._head = parts[1]
                decode = self._from_json
            elif (decode := self._decoder_of(parts)) is None:
                if timeout_s is not None:  # a flood of such frames must not keep the caller here
                    until_s = until_s or time.monotonic() + timeout_s
                    timeout_s = max(0.0, until_s - time.monotonic())
                continue
            payload = parts[2]
            try:  # a lone message, the commonest: no call more than it needs
                message: T | None = decode(payload)
            except CANNOT_DECODE:
                message = None
            if message is not None:
                return message
            if decode is self._from_json and NUL in payload:
                self._take_in(payload)
            else:
                self._read(decode, payload)  # tells why there is none
            if timeout_s is not None:
                until_s = until_s or time.monotonic() + timeout_s
                timeout_s = max(0.0, until_s - time.monotonic())

    def pending(self) -> list[T]:
        """All that has arrived, without waiting.

        In a flood, which may come faster than it can be read, the rest has to wait.
        """
        messages: list[T] = []
        until_s = time.monotonic() + PENDING_S
        while (message := self.receive(0)) is not None:
            messages.append(message)
            if time.monotonic() >= until_s:
                break
        return messages

    def wait_for_publishers(self, count: int, timeout_s: float) -> bool:
        """Wait until ``count`` publishers are heard; False when the time is over."""
        return self._inbox.wait_for(set(), count, timeout_s)

    def close(self) -> None:
        """Hear no more; a thread that waits in receive() gets None."""
        self.network.remove_subscriber(self._id)

    def __iter__(self) -> Iterator[T]:
        """Each message as it comes, until the subscriber is closed or the node stops."""
        while (message := self.receive()) is not None:
            yield message

    def _tell(self, callback: Callable[[T], None]) -> None:
        """Call back for each message until the subscriber is closed, whatever happens meanwhile."""
        while not self._inbox.closed:
            try:
                message = self.receive()
            except Exception as error:  # a fault of ours, which must not make anybody deaf
                self._skip("a message could not be taken", error)
                time.sleep(AFTER_ERROR_S)
                continue
            if message is None:
                continue
            try:
                callback(message)
            except SystemExit:
                log.warning("%s: the callback ended itself, and hears no more", self.topic)
                self.close()  # else it would look as if it heard
            except BaseException as error:  # also one that is no Exception, as the end of a rule
                self.network.troubles.note("callback_failed", self.topic, _named(error))
                if self._may_log():
                    log.exception("%s: the callback failed", self.topic)

    def _decoder_of(self, parts: list[bytes]) -> Decode | None:
        """How to decode a frame that begins in an unusual way; None: it cannot be read."""
        self._header, self._head = None, b""
        if len(parts) < 3:
            self._skip("a frame has no header: its sender does not speak NEP")
            return None
        try:
            self._header = read_header(parts[1])
        except BadMessage as error:
            self._skip("a header cannot be read", error)
            return None
        decode = self._decoders.get(self._header.encoding)
        if decode is None:
            self._skip(f"a message of {self._sender()} is not JSON")
        return decode

    def _take_in(self, payloads: bytes) -> None:
        """Decode several messages at once, which is faster, or else one by one."""
        if holds_too_many(payloads):
            self._skip(f"a frame of {self._sender()} holds more than {MOST_TOGETHER} messages")
            return
        if self._keeps_newest:
            payloads = payloads.rpartition(NUL)[2]
        try:
            messages = self._from_lines(payloads.replace(NUL, b"\n"))
        except CANNOT_DECODE:
            messages = [None]
        there = [message for message in messages if message is not None]
        if len(there) < len(messages):
            one_by_one = (self._read(self._from_json, one) for one in payloads.split(NUL))
            there = [message for message in one_by_one if message is not None]
        self._waiting.extend(there)

    def _read(self, decode: Decode, payload: bytes) -> T | None:
        """One message; None, with a warning, when it cannot be read or is null."""
        try:
            message: T | None = decode(payload)
        except CANNOT_DECODE as error:
            self._skip(f"a message of {self._sender()}", error)
            return None
        if message is None:
            self._skip(f"a message of {self._sender()} is null: it is skipped")
        return message

    def _skip(self, what: str, error: Exception | None = None) -> None:
        """Note that something could not be read; the node of this network tells it."""
        why = what if error is None else f"{what}: {error}"
        self.network.troubles.note("messages_unreadable", self.topic, why)
        if self._may_log():
            log.warning("%s: %s", self.topic, why)

    def _may_log(self) -> bool:
        """Whether there may be another line in the log: a flood of faults is no flood of words."""
        if (now_s := time.monotonic()) >= self._log_until_s:
            self._logged, self._log_until_s = 0, now_s + 1.0
        self._logged += 1
        return self._logged <= MOST_LOGGED

    def _sender(self) -> str:
        return header.node if (header := self.header) else "somebody"


def _named(error: BaseException) -> str:
    """An error with its kind: many have no words of their own, or only a key."""
    try:
        words = str(error)
    except Exception:  # one whose words cannot be made
        words = ""
    return f"{type(error).__name__}: {words}" if words else type(error).__name__
