"""The sending side of a network: an XPUB socket, the streams of its topics, and who hears them.

A subscriber also makes a private subscription (the handshake): when the publisher sees it, the
data subscription is in force, so that nothing is lost at the start."""

from __future__ import annotations

import threading
import time
from collections import defaultdict, deque
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import zmq
from zmq.backend import Socket as BackendSocket

from faults import reason_of
from nep_core.errors import NetworkError, PortTaken
from nep_core.networks.security import connect, watch_over
from nep_core.networks.security.addresses import require_loopback

from . import frames
from .frames import (
    CANNOT_ENCODE,
    NUL,
    RUN_CHARACTERS,
    Encoding,
    Sendable,
    encode,
    join,
    natural_encoding,
    not_encodable,
    subscription,
    to_json,
)

if TYPE_CHECKING:
    from nep_core.networks.security.curve import Security


# The messages of one topic on their way out.
#
# Each message leaves at once. Only in a flood (more than 32 within a millisecond) the rest of that
# millisecond travels in frames of up to 16 KB: a call of ZeroMQ costs more than the message itself.

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

    ``topic``, ``node`` and ``run`` stand in its frames; ``encoding`` None is found by the first
    message; ``hurry`` asks for a flood to be sent at once.
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
        self.latched = b""
        self._is_json = encoding in (None, "json")
        self._send_frame = send
        self._lock = lock
        self._node = node
        self._run = run
        self._start = subscription(topic)
        self._head = self._start + b"[" + to_json(node) + b","
        self._head_end = b',"json",' + to_json(run) + b"]" + NUL
        self._hurry = hurry
        self._window = 0
        self._in_window = 0
        self.waiting: list[bytes] = []
        """What is left of a flood."""
        self._room_bytes = SHARED_FRAME_BYTES
        self._waiting_since_ns = 0
        self.late: deque[tuple[bytes, Encoding, bool]] = deque()
        """What a signal's handler could not send."""

    def send(self, message: Sendable, latch: bool = False) -> None:
        """Send ``message``; with ``latch``, subscribers that join later get it too.

        In a signal's handler that interrupts another sending it goes out a little later.
        Written flat: each call here costs as much as encoding the message.
        """
        if latch or not self._is_json or isinstance(message, (str, bytes)):
            encoding = self.encoding or natural_encoding(message)
            self._send_payload(encode(message, encoding), encoding, latch)
            return
        try:
            payload = to_json(message)
        except CANNOT_ENCODE as error:
            raise not_encodable("json", error) from error
        if not self._lock.acquire(True, HELD_S):
            self._send_later(payload, "json", latch)
            return
        try:
            if not self.waiting:
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
                self._room_bytes = SHARED_FRAME_BYTES
                self._waiting_since_ns = now_ns
                self._hurry()  # the I/O thread sends it if no more messages come
            self.waiting.append(payload)
            self._room_bytes -= len(payload)
            if self._room_bytes <= 0:
                self._flush()
        finally:
            self._lock.release()

    def flush(self, older_than_ns: int = 0) -> None:
        """Send what waits, if it has waited for so long."""
        if self.waiting:
            waited_ns = _now_ns() - self._waiting_since_ns
            if waited_ns >= older_than_ns or waited_ns < 0:  # the clock may be set back
                with self._lock:
                    if self.waiting:
                        self._flush()
        while self.late:
            self._send_payload(*self.late.popleft())

    def abandon(self, send: Callable[[bytes], object]) -> None:
        """From now on ``send`` gets the frames, and whoever held the lock is not there any more."""
        self._send_frame, self._lock = send, threading.Lock()

    def _send_payload(self, payload: bytes, encoding: Encoding, latch: bool) -> None:
        if not self._lock.acquire(True, HELD_S):
            self._send_later(payload, encoding, latch)
            return
        try:
            if self.waiting:
                self._flush()
            self.sent += 1
            frame = join(
                self._start, self._node, self.sent, _now_ns(), encoding, payload, self._run
            )
            if latch:
                self.latched = frame
            self._send_frame(frame)
        finally:
            self._lock.release()

    def _send_later(self, payload: bytes, encoding: Encoding, latch: bool) -> None:
        self.late.append((payload, encoding, latch))
        self._hurry()  # the I/O thread sends it

    def _flush(self) -> None:
        waiting, self.waiting = self.waiting, []
        first, since_ns = self.sent + 1, self._waiting_since_ns
        frame = join(self._start, self._node, first, since_ns, "json", NUL.join(waiting), self._run)
        self.sent += len(waiting)
        self._send_frame(frame)
        # It stays a flood until a quiet moment.
        self._window, self._in_window = _now_ns() >> MILLISECOND_BITS, FLOOD


# Who hears the topics of one program, and what each hearer is told in private.
#
# It knows no socket: whatever carries the messages tells who comes and goes.

MARK_S = 0.5
"""How often a slow subscriber is told how many messages were sent."""

MOST_SUBSCRIBERS = 10_000
"""Of so many, those that came last, it is kept where they began: a program may run for weeks."""

SendFrame = Callable[[bytes], object]


class Outbox:
    """The streams of a network and their subscribers; safe from any thread.

    A network says how a frame is sent; its lock is held whenever something is.
    """

    def __init__(self, node: str, instance: str, hurry: Callable[[], None]) -> None:
        self._node = node
        self._instance = instance
        self._run = instance[:RUN_CHARACTERS]
        self._lock = threading.Lock()
        self._hurry = hurry
        self._changed = threading.Condition()
        self._ids: dict[str, set[str]] = defaultdict(set)
        self._slow: set[tuple[str, str]] = set()
        self._streams: dict[str, Stream] = {}
        self._began: dict[tuple[str, str], int] = {}
        """How many messages had been sent when a subscriber came first, or should have come."""
        self._next_mark_s = 0.0

    def _sender(self, topic: str) -> SendFrame:
        """What sends the frames of a topic."""
        raise NotImplementedError

    def _send_privately(self, topic: str, subscriber: str, notice: bytes) -> None:
        """Send a notice to one subscriber; called under the lock, must not wait."""
        raise NotImplementedError

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
                "{topic} is already published as {encoding} here.",
                checklist=("Use one encoding for all publishers of a topic.",),
                topic=topic,
                encoding=stream.encoding or "it comes",
            )
        return stream

    def subscribers(self, topic: str) -> set[str]:
        """The ids of the subscribers that hear ``topic`` now."""
        with self._changed:
            return set(self._ids[topic])

    def wait_for(self, topic: str, ids: set[str], count: int, timeout_s: float) -> bool:
        """Wait until all ``ids`` and at least ``count`` subscribers hear ``topic``.

        Whether they did within ``timeout_s``.
        """
        with self._changed:
            return self._changed.wait_for(
                lambda: ids <= self._ids[topic] and len(self._ids[topic]) >= count, timeout_s
            )

    def expect(self, topic: str, ids: set[str]) -> None:
        """Whoever of these comes only later has lost what is sent from now on, and is told so."""
        with self._lock:
            stream = self._streams.get(topic)
            sent = stream.sent if stream else 0
            for subscriber in ids:
                self._began_at(topic, subscriber, sent)

    def note(self, topic: str, subscriber: str, present: bool) -> None:
        """Welcome a subscriber that has come, or forget one that has left."""
        if present:
            with self._lock:
                stream = self._streams.get(topic)
                due = self._began_at(topic, subscriber, stream.sent if stream else 0)
                if stream is not None and due < stream.sent:
                    # Its own count begins there, so that it counts what it came too late for, and
                    # what was lost with a connection that broke before it heard anything
                    began = frames.mark(topic, self._node, self._run, due)
                    self._send_privately(topic, subscriber, began)
                if stream is not None and stream.latched:
                    welcome = frames.notice(stream.latched, stream.sent)
                else:
                    sent = stream.sent if stream else 0
                    welcome = frames.mark(topic, self._node, self._run, sent)
                self._send_privately(topic, subscriber, welcome)
        with self._changed:
            change = set.add if present else set.discard
            change(self._ids[topic], subscriber)
            if not self._ids[topic]:
                del self._ids[topic]
            self._slow.discard((topic, subscriber))
            self._changed.notify_all()

    def _began_at(self, topic: str, subscriber: str, sent: int) -> int:
        """Where a subscriber's count begins: now, unless it is known from before."""
        began = self._began.setdefault((topic, subscriber), sent)
        if len(self._began) > MOST_SUBSCRIBERS:
            del self._began[next(iter(self._began))]
        return began

    def note_slow(self, topic: str, subscriber: str) -> None:
        """Somebody could not take a message: from now on it hears how many there were.

        It hears so again and again, since a mark can be lost as well.
        """
        with self._changed:
            self._slow.add((topic, subscriber))

    def tend(self) -> None:
        """Send what has waited in a flood, and the marks that are due (the I/O thread)."""
        for stream in list(self._streams.values()):
            if stream.waiting or stream.late:
                stream.flush(older_than_ns=FLOOD_NS)
        if self._slow and time.monotonic() >= self._next_mark_s:
            self._next_mark_s = time.monotonic() + MARK_S
            with self._changed:
                slow = [(topic, who) for topic, who in self._slow if topic in self._streams]
            for topic, subscriber in slow:
                with self._lock:
                    sent = self._streams[topic].sent
                    mark = frames.mark(topic, self._node, self._run, sent)
                    self._send_privately(topic, subscriber, mark)

    def abandon(self, send: SendFrame) -> None:
        """In the child of a fork: ``send`` gets what its streams send, nobody holds a lock."""
        for stream in self._streams.values():
            stream.abandon(send)

    def close(self) -> None:
        """Send what waits (half a second at most) and close."""
        for stream in list(self._streams.values()):
            stream.flush()


# The private subscriptions by which two peers know that they hear each other.
#
# After its data subscription a subscriber makes a private one. When a publisher sees the private
# one, the data subscription is in force, and it answers with a *welcome* on the private topic,
# which no other subscriber gets: its instance and a notice (frames.py) of what was sent so far.
#
# The order holds because ZeroMQ sends what is already subscribed in the order of the bytes when a
# connection is made: private topics begin with 0xFF, which no UTF-8 text holds, and come last.

PRIVATE = b"\xffs"
PRIVATE_BYTE = 0xFF


class Seen(NamedTuple):
    """A private subscription as its publisher sees it; ``present`` is False when it is gone."""

    present: bool
    topic: str
    subscriber: str


def private_subscription(topic: str, subscriber: str) -> bytes:
    """The private subscription of ``subscriber`` (an id of its own) for ``topic``."""
    return PRIVATE + topic.encode() + NUL + subscriber.encode() + NUL


def read_subscription(event: bytes) -> Seen | None:
    """What an XPUB event tells of a subscriber; None for ordinary subscriptions and rubbish."""
    if not event[1:].startswith(PRIVATE) or event[:1] not in (b"\0", b"\1"):
        return None
    parts = event[1 + len(PRIVATE) :].split(NUL)
    if len(parts) != 3:
        return None
    topic, subscriber = (part.decode(errors="replace") for part in parts[:2])
    return Seen(event[:1] == b"\1", topic, subscriber)


def private_frame(topic: str, subscriber: str, instance: str, notice: bytes = b"") -> bytes:
    """What one subscriber is told: by whom, and a notice (empty: only that it is heard).

    ``topic`` is what ``subscriber``, its id, hears; ``instance`` is who tells it.
    """
    return private_subscription(topic, subscriber) + instance.encode() + NUL + notice


def read_welcome(frame: bytes) -> tuple[str, bytes]:
    """The instance that sent a private frame, and its notice."""
    _topic, _subscriber, rest = frame[len(PRIVATE) :].split(NUL, 2)
    instance, _, notice = rest.partition(NUL)
    return instance.decode(errors="replace"), notice


HIGH_WATER_MARK = 4_000
"""Frames that wait for a subscriber whose program is frozen, on each side.

A frame holds one message, or in a flood several of up to 16 KB together. A larger one is followed
by a *filler* for each UNIT_BYTES of it, a private frame without content, so that ZeroMQ, which
counts frames, keeps at most 4,000 times UNIT_BYTES, 80 MB, of messages of whatever size.

What comes when all that is full is lost, and counted: ZeroMQ keeps the oldest here. It is the
subscriber's own backlog (inbox.py) that keeps the newest while its program is merely busy.
"""

UNIT_BYTES = 20_000
"""So many bytes count as one frame of the high-water mark."""

# The send of the C back end: pyzmq's own looks for options that we never use.
_send = BackendSocket.send


class ZmqOutbox(Outbox):
    """Sends in the caller's thread, under a lock; the I/O thread reads the subscriptions.

    ``is_far``: a broker is between us and the subscribers, so that we never see who is slow.

    ``context`` makes the socket; ``node`` and ``instance`` are the program's; ``hurry`` asks
    for a flood to be sent at once; ``high_water_mark`` is how many frames may wait for a
    subscriber; ``security`` has the keys of an opened network.
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
        super().__init__(node, instance, hurry)
        self._security = security
        self._is_far = is_far
        self._socket = context.socket(zmq.XPUB)
        self._socket.linger = 500
        self._socket.sndhwm = high_water_mark
        self._socket.setsockopt(zmq.XPUB_NODROP, 1)  # tells when somebody cannot take a frame
        if is_far:  # a broker that comes back brings the same subscribers: welcome them again
            self._socket.setsockopt(zmq.XPUB_VERBOSE, 1)
        self.file_number = int(self._socket.FD)
        """Readable when the I/O thread should tend."""

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
            connect(self._socket, endpoint)

    def tend(self) -> None:
        """Read who subscribed and who left, welcome the newcomers, send what waits."""
        while True:
            with self._lock:
                if self._socket.closed:
                    return
                try:
                    event = self._socket.recv(zmq.NOBLOCK)
                except zmq.Again:
                    break
            seen = read_subscription(event)
            if seen is not None:
                self.note(seen.topic, seen.subscriber, seen.present)
                if seen.present and self._is_far:
                    self.note_slow(seen.topic, seen.subscriber)
        super().tend()

    def close(self) -> None:
        """Send what waits (half a second at most) and close."""
        if not self._socket.closed:
            super().close()
        with self._lock:
            self._socket.close()

    def _sender(self, topic: str) -> SendFrame:
        return self._send

    def _send(self, frame: bytes) -> None:
        """Send without waiting; the lock is held."""
        try:
            _send(self._socket, frame, zmq.NOBLOCK)
            if len(frame) >= UNIT_BYTES:
                self._weigh(frame)
        except zmq.Again:
            # Note who has none; from then on ZeroMQ leaves those out until they have read
            with self._changed:
                everyone = [(topic, who) for topic, ids in self._ids.items() for who in ids]
            for topic, subscriber in everyone:
                try:
                    told = private_frame(topic, subscriber, self._instance)
                    _send(self._socket, told, zmq.NOBLOCK)
                except zmq.Again:
                    self.note_slow(topic, subscriber)
            self._socket.setsockopt(zmq.XPUB_NODROP, 0)
            try:
                _send(self._socket, frame, zmq.NOBLOCK)
            finally:
                self._socket.setsockopt(zmq.XPUB_NODROP, 1)
        except zmq.ZMQError as error:
            raise network_closed(self._node) from error

    def _weigh(self, frame: bytes) -> None:
        """Let a large frame take as much of each subscriber's high-water mark as it has bytes."""
        if frame[0] == PRIVATE_BYTE:
            return  # a latched message in a welcome: one at a time
        topic = frame[: frame.index(NUL)].decode()
        with self._changed:
            ids = list(self._ids.get(topic, ()))
        for subscriber in ids:
            filler = private_frame(topic, subscriber, self._instance)
            try:
                for _ in range(min(len(frame) // UNIT_BYTES, HIGH_WATER_MARK)):
                    _send(self._socket, filler, zmq.NOBLOCK)
            except zmq.Again:
                self.note_slow(topic, subscriber)

    def _send_privately(self, topic: str, subscriber: str, notice: bytes) -> None:
        if not self._socket.closed:
            self._send(private_frame(topic, subscriber, self._instance, notice))


def network_closed(node: str) -> NetworkError:
    """The error to raise when somebody sends or joins after ``node`` has left its network."""
    return NetworkError(
        "The network of {node} is closed.", checklist=("Start it again.",), node=node
    )


def bind(
    socket: zmq.Socket[bytes],
    endpoint: str,
    security: Security | None = None,
    *,
    is_watched: bool = True,
) -> None:
    """Bind, or raise PortTaken with a sentence when the endpoint cannot be had.

    Without keys it must be one that only this computer reaches, else NetworkError is raised.
    ``is_watched``: who does not answer heartbeats is disconnected; programs with a ZeroMQ before
    4.2 know none.
    """
    if is_watched:
        watch_over(socket)
    if security is None:
        require_loopback(endpoint)
    else:
        security.guard(socket)
    try:
        socket.setsockopt(zmq.IPV6, int("[" in endpoint))
        socket.bind(endpoint)
    except zmq.ZMQError as error:
        raise PortTaken(
            "{endpoint} cannot be used: {reason}.",
            checklist=(
                "Is the same program running twice? Stop the other one.",
                "Choose another port.",
                "Is that an address of this computer?",
            ),
            endpoint=endpoint,
            reason=reason_of(error),
        ) from error
