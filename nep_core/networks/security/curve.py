"""CURVE on the sockets of one program: encryption, and keys that say who may talk."""

from __future__ import annotations

import contextlib
import errno
import logging
import socket as sockets
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from weakref import WeakSet

import zmq
from zmq.utils import z85

from faults import Fault, Text, text_of, verbatim
from nep_core.errors import NetworkError, NotLetIn
from nep_core.wire.io_thread import Wake, socket_event

from . import key_file_path
from .addresses import host_of, is_loopback, is_ours, own_addresses
from .keys import KeyFile, Keys

log = logging.getLogger(__name__)


# Who was refused, and whom we could not talk to, gathered into one sentence at a time.

MOST_TOLD = 3
MOST_PLACES = 20
"""So many are told apart; somebody who knocks from everywhere fills no memory."""


NOT_LET_IN = "not_let_in"
"""The code of what is told. Its values say who: ``stranger``, ``own_program`` and ``unable``, of
which each is a text with a list of ``addresses``."""

REPEAT_S = 4.0
"""The same sentence is told again after so long: who is refused goes on knocking."""


class Refusals:
    """Filled by the thread that guards, emptied by whoever tells people."""

    def __init__(self, key_file: str) -> None:
        self._key_file = key_file
        self._lock = threading.Lock()
        self._refused: set[str] = set()
        self._unable: set[str] = set()
        self._last: Fault | None = None
        self._repeat_s = 0.0

    def refuse(self, address: str) -> None:
        """Note that a program at ``address`` ("" when not known) was not let in."""
        with self._lock:
            if len(self._refused) < MOST_PLACES:
                self._refused.add(address)

    def cannot_join(self, endpoint: str) -> None:
        """Note that whoever is at ``endpoint`` does not take us, or has no keys."""
        with self._lock:
            if len(self._unable) < MOST_PLACES:
                self._unable.add(endpoint)

    def take(self) -> Fault | None:
        """What happened since the last time and what to do; None when nothing did."""
        with self._lock:
            refused, self._refused = self._refused, set()
            unable, self._unable = self._unable, set()
        told = self._about_refused(refused)
        if unable:
            told["unable"] = text_of(
                "The program at {places} does not have the keys of this network, or does not know "
                "ours. Start it with NEP_KEYS, or pair the two computers.",
                places=_places(unable),
                addresses=sorted(unable),
            )
        now_s = time.monotonic()
        if not told:
            return None
        fault = Fault(NOT_LET_IN, text_of(" ".join(f"{{{kind}}}" for kind in told), **told))
        if fault == self._last and now_s < self._repeat_s:
            return None
        self._last, self._repeat_s = fault, now_s + REPEAT_S
        return fault

    def _about_refused(self, addresses: set[str]) -> dict[str, Text]:
        own = set(own_addresses())
        ours = {address for address in addresses if address in own or is_loopback(address)}
        others = addresses - ours
        if addresses != {""}:  # one that left too early to be seen adds nothing
            others.discard("")
        told = {}
        if others:
            told["stranger"] = text_of(
                "A program at {places} showed no key of this network and was refused. Pair "
                "that computer (nep pair), or stop the program there.",
                places=_places(others),
                addresses=sorted(others),
            )
        if ours:
            told["own_program"] = text_of(
                "A program of this computer showed no key of this network and was refused. Set "
                "NEP_KEYS to {key_file} before you start it.",
                key_file=self._key_file,
                addresses=[""],
            )
        return told


def _places(places: Iterable[str]) -> Text:
    known = sorted(filter(None, places))
    if not known:
        return text_of("an unknown address")
    if len(known) <= MOST_TOLD:
        return verbatim(", ".join(known))
    more = len(known) - MOST_TOLD
    return text_of("{places} and {more} more", places=known[:MOST_TOLD], more=more)


# The doorkeeper of one ZeroMQ context: which peers' keys are let in, and who was refused.
#
# ZeroMQ asks it about each peer (ZAP, RFC 27), and its socket monitors tell of peers that do not
# get as far as that: programs without any key.

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
                ready = dict(self._poller.poll(LOOK_MS if self._waiting else None))
                try:
                    self._work(ready)
                except zmq.ZMQError:
                    raise
                except Exception:  # a fault of ours must not keep everybody out
                    log.exception("the doorkeeper goes on after an error")
                    time.sleep(LOOK_MS / 1000)  # never spin on an error that repeats
        except zmq.ZMQError:
            log.debug("the context has ended")
        finally:
            for events in (*self._watched, *self._new):
                events.close()
            self._asked.close()
            self._wake.close()

    def _work(self, ready: dict[object, int]) -> None:
        self._wake.clear()
        while self._new:
            events = self._new.popleft()
            self._watched[events] = _Watched(events)
            self._poller.register(events, zmq.POLLIN)
        for events in [events for events in self._watched if events in ready]:
            self._read_events(self._watched[events])
        if self._asked in ready:
            # Take in one request: RFC 27 says which frames there are
            peer, empty, version, request, _domain, address, _identity, mechanism, *credentials = (
                self._asked.recv_multipart()
            )
            is_curve = mechanism == b"CURVE" and len(credentials) == 1
            key = z85.encode(credentials[0]).decode() if is_curve else ""
            has_time = is_curve and len(self._waiting) < MOST_WAITING
            until_s = time.monotonic() + (GRACE_S if has_time else 0.0)
            envelope = [peer, empty, version, request]
            self._waiting.append(_Asked(envelope, address.decode(errors="replace"), key, until_s))
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
            kind, number, endpoint = socket_event(watched.events.recv_multipart())
            if kind == zmq.EVENT_MONITOR_STOPPED:
                self._poller.unregister(watched.events)
                del self._watched[watched.events]
                watched.events.close()
                return
            if kind == zmq.EVENT_ACCEPTED:
                watched.addresses[number] = _address_behind(number)
            elif kind == zmq.EVENT_DISCONNECTED:
                self._on_disconnected(watched, number, endpoint)
            else:
                # Not one that left without reading what we had said: it was killed, or just
                # knocked. A plain program reads our greeting and leaves because of it.
                hung_up = number == errno.ECONNRESET
                is_broken = kind == zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL and hung_up
                watched.failure = kind if kind in FAILURES and not is_broken else 0

    def _on_disconnected(self, watched: _Watched, number: int, endpoint: str) -> None:
        # One thread of ZeroMQ makes all events: this is the connection that has just failed.
        was_accepted = number in watched.addresses
        address = watched.addresses.pop(number, "")
        failure, watched.failure = watched.failure, 0
        if failure and was_accepted:
            self._refusals.refuse(address)
        elif failure and failure != zmq.EVENT_HANDSHAKE_FAILED_NO_DETAIL:
            self._refusals.cannot_join(endpoint)  # without detail: it may just have ended


def _address_behind(number: int) -> str:
    """Who is at the other end of a connection; "" when it has already ended."""
    with contextlib.suppress(OSError):
        connection = sockets.socket(fileno=number)
        try:
            return str(connection.getpeername()[0])
        finally:
            connection.detach()  # it is ZeroMQ's
    return ""


HANDSHAKE_MS = 5_000
"""A peer that has not shown its key for so long is disconnected."""

LARGEST_SUBSCRIPTION = 65_536
"""How many bytes an XPUB takes at once: it hears subscriptions only."""


class Security:
    """What guards the sockets of one context; any thread."""

    def __init__(self, file: KeyFile, context: zmq.Context[zmq.Socket[bytes]]) -> None:
        self.file = file
        self._allowed_by_master: frozenset[str] = frozenset()
        self._refusals = Refusals(str(file.path))
        self.take_warning = self._refusals.take
        """Who was refused since the last time, and what to do; None when nobody was."""
        self._doorkeeper = Doorkeeper(context, self.allows, self._refusals)
        self._trusting: WeakSet[zmq.Socket[bytes]] = WeakSet()

    @property
    def key(self) -> str:
        """This program's public key: the one of its computer."""
        return self.file.keys.public

    def guard(self, socket: zmq.Socket[bytes]) -> None:
        """Let only known keys come to ``socket``; before it is bound."""
        show_keys(socket, self.file.keys)
        socket.curve_server = True
        socket.zap_domain = DOMAIN
        socket.handshake_ivl = HANDSHAKE_MS
        if socket.type == zmq.XPUB:
            socket.maxmsgsize = LARGEST_SUBSCRIPTION
        with contextlib.suppress(AttributeError, zmq.ZMQError):  # older ZeroMQ: as it was
            socket.setsockopt(zmq.ZAP_ENFORCE_DOMAIN, 1)  # nobody comes in without our answer
        self._doorkeeper.watch(socket)

    def trust(self, socket: zmq.Socket[bytes], server_key: str) -> None:
        """Talk only to a server with this key; before each connect.

        Raises NetworkError when it is no key: the program there was started without.
        """
        expect_key(socket, server_key)
        show_keys(socket, self.file.keys)
        if socket not in self._trusting:
            self._trusting.add(socket)
            self._doorkeeper.watch(socket)

    def key_at(self, endpoint: str) -> str:
        """The key of the computer at a fixed endpoint; raises NetworkError when none is known."""
        host, keys = host_of(endpoint), self.file.keys
        if is_ours(host):
            return keys.public
        by_address = {computer.address: computer.key for computer in keys.computers}
        if host in by_address:
            return by_address[host]
        if not keys.is_owner:
            return keys.master_key
        if len(keys.computers) == 1:
            return keys.computers[0].key
        raise NetworkError(
            "The computer at {host} has not been paired with this one.",
            checklist=("Pair it: nep pair.", "Was it paired at another address? Pair it again."),
            host=host,
        )

    def allows(self, key: str) -> bool:
        """Whether a program with this public key may talk with us."""
        return key in self._allowed_by_master or key in self.file.keys.allowed

    def allow(self, keys: Iterable[str]) -> None:
        """Let in these keys from now on: the master tells which computers there are."""
        self._allowed_by_master = frozenset(keys)


def show_keys(socket: zmq.Socket[bytes], keys: Keys) -> None:
    """Let a socket prove that it is this computer's."""
    socket.curve_publickey = keys.public.encode()
    socket.curve_secretkey = keys.secret.encode()


def expect_key(socket: zmq.Socket[bytes], server_key: str) -> None:
    """Talk only to a server with this key; raises NetworkError when it is none."""
    try:
        socket.curve_serverkey = server_key.encode()
    except (zmq.ZMQError, ValueError) as error:
        raise NetworkError(
            "A program of this network has no key.",
            checklist=("Start it again with NEP_KEYS set to the key file.",),
        ) from error


# What a program that does not answer is: plain, or one that wants keys; ZMTP's greeting tells.

SIGNATURE = b"\xff" + bytes(8) + b"\x7f"
VERSION = b"\x03"
MECHANISM = slice(12, 32)
GREETING_BYTES = 64


def mechanism_at(endpoint: str, timeout_s: float = 1.0) -> str:
    """The mechanism of a ZeroMQ socket: NULL or CURVE; "" when there is none (ZMTP, RFC 23)."""
    heard = b""
    end_s = time.monotonic() + timeout_s
    with contextlib.suppress(OSError, ValueError):
        place = (host_of(endpoint), int(endpoint.rpartition(":")[2]))
        with sockets.create_connection(place, timeout=timeout_s) as connection:
            connection.sendall(SIGNATURE + VERSION)
            while len(heard) < MECHANISM.stop and time.monotonic() < end_s:
                if not (part := connection.recv(GREETING_BYTES)):
                    break
                heard += part
        if heard[:1] == SIGNATURE[:1] and len(heard) >= MECHANISM.stop:
            return heard[MECHANISM].rstrip(b"\0").decode("ascii")
    return ""


def not_let_in(endpoint: str) -> NotLetIn | None:
    """Why the master that is there does not answer us; None when keys are not the reason."""
    path, mechanism = key_file_path(), mechanism_at(endpoint)
    if mechanism == "CURVE" and path is None:
        return NotLetIn(
            "The network at {endpoint} is open only to programs that have its keys.",
            checklist=(
                "Was this computer paired with it? Then set NEP_KEYS to its key file.",
                "Else pair it: nep open shows a code on the other computer, nep pair takes it "
                "here.",
                "For a network of this computer alone use another port: nep master "
                "--endpoint tcp://127.0.0.1:7200, and set NEP_MASTER to it.",
            ),
            endpoint=endpoint,
        )
    if mechanism == "CURVE":
        return NotLetIn(
            "The master at {endpoint} does not take the keys of {path}.",
            checklist=(
                "Was this computer taken from its list? Pair it again: nep pair.",
                "Is it another network than the one of the key file? nep find shows which.",
            ),
            endpoint=endpoint,
            path=path,
        )
    if mechanism == "NULL" and path is not None:
        return NotLetIn(
            "The master at {endpoint} has no keys, but this program was started with {path}.",
            checklist=(
                "To talk on this computer only, start this program without NEP_KEYS.",
                "To open the network, start the master with its keys: nep open.",
            ),
            endpoint=endpoint,
            path=path,
        )
    return None
