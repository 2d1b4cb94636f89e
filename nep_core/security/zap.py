"""The doorkeeper of one ZeroMQ context: which peers' keys are let in, and who was refused.

ZeroMQ asks it about each peer (ZAP, RFC 27), and its socket monitors tell of peers that do not
get as far as that: programs without any key.
"""

from __future__ import annotations

import errno
import logging
import socket as sockets
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

import zmq
from zmq.utils import z85
from zmq.utils.monitor import parse_monitor_message

from nep_core.io_thread import Wake
from nep_core.security.refusals import Refusals

log = logging.getLogger(__name__)

DOMAIN = b"nep"
GRACE_S = 0.3
"""How long an unknown key waits for a decision: its computer may just have been let in."""
LOOK_MS = 50
MOST_WAITING = 64
FAILURES = (
    zmq.EVENT_HANDSHAKE_FAILED_AUTH,
    zmq.EVENT_HANDSHAKE_FAILED_PROTOCOL,
    zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL,  # a plain peer that was quicker to leave than we
)
WATCHED = (
    sum(FAILURES)
    | zmq.EVENT_ACCEPTED
    | zmq.EVENT_CONNECTED
    | zmq.EVENT_DISCONNECTED
    | zmq.EVENT_MONITOR_STOPPED
)


@dataclass
class _Watched:
    """A socket's monitor: who is connected by which file, and what failed a moment ago."""

    events: zmq.Socket[bytes]
    addresses: dict[int, str] = field(default_factory=dict)
    failure: int = 0


@dataclass(frozen=True)
class _Asked:
    """A peer that ZeroMQ asks about, until when it may wait, and how to answer."""

    envelope: list[bytes]
    address: str
    key: str
    until_s: float


class Doorkeeper:
    """A thread that ends when its context does."""

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        allows: Callable[[str], bool],
        refusals: Refusals,
    ) -> None:
        self._context = context
        self._allows = allows
        self._refusals = refusals
        self._wake = Wake()
        self._new: deque[zmq.Socket[bytes]] = deque()
        self._watched: dict[zmq.Socket[bytes], _Watched] = {}
        self._waiting: list[_Asked] = []
        self._count = 0
        self._asked = context.socket(zmq.ROUTER)
        self._asked.linger = 0
        self._asked.bind("inproc://zeromq.zap.01")
        self._poller = zmq.Poller()
        self._poller.register(self._asked, zmq.POLLIN)
        self._poller.register(self._wake.fileno(), zmq.POLLIN)
        threading.Thread(target=self._run, name="nep-doorkeeper", daemon=True).start()

    def watch(self, socket: zmq.Socket[bytes]) -> None:
        """Tell of peers that ``socket`` does not come to terms with."""
        self._count += 1
        place = f"inproc://nep-watch-{id(self)}-{self._count}"
        events = self._context.socket(zmq.PAIR)
        events.linger = 0
        events.rcvhwm = 0  # a full queue of events would hold up ZeroMQ's own thread
        events.connect(place)
        socket.monitor(place, WATCHED)
        self._new.append(events)
        self._wake()

    def _run(self) -> None:
        try:
            while True:
                self._turn(dict(self._poller.poll(LOOK_MS if self._waiting else None)))
        except zmq.ZMQError:
            log.debug("the context has ended")
        finally:
            for events in (*self._watched, *self._new):
                events.close()
            self._asked.close()
            self._wake.close()

    def _turn(self, ready: dict[object, int]) -> None:
        try:
            self._work(ready)
        except zmq.ZMQError:
            raise
        except Exception:  # a fault of ours must not keep everybody out
            log.exception("the doorkeeper goes on after an error")
            time.sleep(LOOK_MS / 1000)  # never spin on an error that repeats

    def _work(self, ready: dict[object, int]) -> None:
        self._wake.clear()
        while self._new:
            events = self._new.popleft()
            self._watched[events] = _Watched(events)
            self._poller.register(events, zmq.POLLIN)
        for events in [events for events in self._watched if events in ready]:
            self._read_events(self._watched[events])
        if self._asked in ready:
            self._read_question(self._asked.recv_multipart())
        self._decide()

    def _read_question(self, frames: list[bytes]) -> None:
        """Take in one request: RFC 27 says which frames there are."""
        peer, empty, version, request, _domain, address, _identity, mechanism, *credentials = frames
        is_curve = mechanism == b"CURVE" and len(credentials) == 1
        key = z85.encode(credentials[0]).decode() if is_curve else ""
        has_time = is_curve and len(self._waiting) < MOST_WAITING
        until_s = time.monotonic() + (GRACE_S if has_time else 0.0)
        envelope = [peer, empty, version, request]
        self._waiting.append(_Asked(envelope, address.decode(errors="replace"), key, until_s))

    def _decide(self) -> None:
        waiting, self._waiting = self._waiting, []
        for asked in waiting:
            if self._allows(asked.key):
                self._answer(asked, b"200", b"OK")
            elif time.monotonic() < asked.until_s:
                self._waiting.append(asked)
            else:
                self._answer(asked, b"400", b"unknown key")
                self._refusals.refuse(asked.address)

    def _answer(self, asked: _Asked, code: bytes, text: bytes) -> None:
        self._asked.send_multipart([*asked.envelope, code, text, asked.key.encode(), b""])

    def _read_events(self, watched: _Watched) -> None:
        while watched.events.poll(0):
            event = parse_monitor_message(watched.events.recv_multipart())
            number, kind = event["value"], event["event"]
            if kind == zmq.EVENT_MONITOR_STOPPED:
                self._poller.unregister(watched.events)
                del self._watched[watched.events]
                watched.events.close()
                return
            if kind == zmq.EVENT_ACCEPTED:
                watched.addresses[number] = _address_behind(number)
            elif kind == zmq.EVENT_DISCONNECTED:
                self._on_disconnected(watched, number, event["endpoint"].decode())
            else:
                watched.failure = kind if kind in FAILURES and not _is_broken(kind, number) else 0

    def _on_disconnected(self, watched: _Watched, number: int, endpoint: str) -> None:
        # One thread of ZeroMQ makes all events: this is the connection that has just failed.
        was_accepted = number in watched.addresses
        address = watched.addresses.pop(number, "")
        failure, watched.failure = watched.failure, 0
        if failure and was_accepted:
            self._refusals.refuse(address)
        elif failure and failure != zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL:
            self._refusals.cannot_join(endpoint)  # without detail: it may just have ended


def _is_broken(kind: int, number: int) -> bool:
    """Whether a peer left without reading what we had said: it was killed, or just knocked.

    A plain program reads our greeting and leaves because of it.
    """
    return kind == zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL and number == errno.ECONNRESET


def _address_behind(number: int) -> str:
    """Who is at the other end of a connection; "" when it has already ended."""
    try:
        connection = sockets.socket(fileno=number)
    except OSError:
        return ""
    try:
        return str(connection.getpeername()[0])
    except OSError:
        return ""
    finally:
        connection.detach()  # it is ZeroMQ's
