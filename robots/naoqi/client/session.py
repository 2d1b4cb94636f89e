"""One connection to a NAOqi robot: how it is made, and made again when it was lost.

It is plain or TLS; where there is none, a sentence says why.
"""

from __future__ import annotations

import contextlib
import hashlib
import ipaddress
import itertools
import os
import socket
import ssl
import threading
import time
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from faults import Text, text_of
from robots.naoqi.wire.codec import encode, reader_of
from robots.naoqi.wire.errors import (
    BadFrame,
    CallFailed,
    ConnectionLost,
    LoginRefused,
    NaoqiError,
    NeedsTls,
    NoAnswer,
    NoRoom,
    NoSuchService,
    NoTls,
    NotNaoqi,
    Refused,
    StrangeCertificate,
    UnknownAddress,
)
from robots.naoqi.wire.line import (
    AUTHENTICATE,
    CAPABILITIES,
    DONE,
    GOES_ON,
    NEW_TOKEN,
    REASON,
    STATE,
    TOKEN,
    USER,
    Frame,
    Kind,
    Line,
    Login,
)
from robots.naoqi.wire.metaobject import META_OBJECT, MetaObject
from robots.naoqi.wire.peer import MAIN, Peer
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.remote import NO_ANSWER, PATIENCE_S, RemoteObject
from robots.naoqi.wire.service import META, Bound

KEEP_ALIVE = {"TCP_KEEPIDLE": 5, "TCP_KEEPINTVL": 2, "TCP_KEEPCNT": 3, "TCP_USER_TIMEOUT": 8000}
"""A robot that is switched off says nothing: the system notices in about ten seconds."""
WRONG_PORT = (
    "Is this the address of a NAO? Press its chest button once: it says it.",
    "NAO listens at port 9559, or 9503 when it asks for user and password.",
    "A NAO that has just been switched on needs about two minutes.",
)
STRANGE = "What arrived is not a NAOqi message."
TRY_PLAIN = (
    "Connect without encryption: a NAO of this kind asks for no user and no password.",
    "Is the port right? 9503 is the encrypted one, 9559 the other.",
)


def place_of(address: tuple[str, int]) -> str:
    """Return an address as people write it."""
    host, port = address
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"


def reach(address: tuple[str, int], until_s: float) -> socket.socket:
    """Return a connected socket. Raises Refused, NoAnswer."""
    place = place_of(address)
    try:
        connected = _connected(address, until_s)
    except ConnectionRefusedError as problem:
        sentence = text_of("Nothing listens at {place}.", place=place)
        raise Refused(sentence, checklist=WRONG_PORT, details=str(problem)) from problem
    except (OSError, OverflowError) as problem:
        sentence = text_of("Nobody answers at {place}.", place=place)
        raise NoAnswer(sentence, checklist=NO_ANSWER, details=str(problem)) from problem
    with contextlib.suppress(OSError):
        connected.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    for name, value in KEEP_ALIVE.items():
        with contextlib.suppress(OSError):
            if hasattr(socket, name):
                connected.setsockopt(socket.IPPROTO_TCP, getattr(socket, name), value)
    return connected


def _connected(address: tuple[str, int], until_s: float) -> socket.socket:
    """Connect to the first of a name's addresses that answers. Raises OSError, NoAnswer."""
    problem: OSError = TimeoutError("no address answered")
    for host in numeric_hosts(address[0], until_s):
        try:
            left_s = max(0.01, until_s - time.monotonic())
            return socket.create_connection((host, address[1]), left_s)
        except OSError as failed:
            problem = failed
    raise problem


def numeric_hosts(host: str, until_s: float) -> list[str]:
    """Return the numeric addresses of a name. Raises UnknownAddress.

    Looking it up may take the system longer than we wait, and cannot be ended.
    """
    with contextlib.suppress(ValueError):
        ipaddress.ip_address(host)
        return [host]
    promise = Promise()

    def look_up() -> None:
        try:
            found = socket.getaddrinfo(host, None, type=socket.SOCK_STREAM)
            promise.set([str(one[4][0]) for one in found])
        except (OSError, UnicodeError) as problem:
            promise.fail(str(problem))

    threading.Thread(target=look_up, name="naoqi-look-up", daemon=True).start()
    try:
        hosts: list[str] = promise.future.result(max(0.01, until_s - time.monotonic()))
        return hosts
    except NaoqiError as problem:
        sentence = text_of(
            "There is no computer or robot called {host} on this network.", host=host
        )
        raise UnknownAddress(sentence, checklist=NO_ANSWER, details=str(problem)) from problem


def encrypt(plain: socket.socket, address: tuple[str, int], until_s: float) -> ssl.SSLSocket:
    """Return the encrypted socket over a connected one. Raises NoTls, NoAnswer.

    Robots sign their certificates themselves: who they are is told by ``fingerprint_of``.
    """
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE
    plain.settimeout(max(0.01, until_s - time.monotonic()))
    place = place_of(address)
    try:
        return context.wrap_socket(plain)
    except TimeoutError as problem:
        plain.close()
        sentence = text_of("NAO at {place} does not answer.", place=place)
        raise NoAnswer(sentence, checklist=NO_ANSWER, details=str(problem)) from problem
    except OSError as problem:
        plain.close()
        sentence = text_of(
            "What listens at {place} does not speak the encrypted protocol.", place=place
        )
        raise NoTls(sentence, checklist=TRY_PLAIN, details=str(problem)) from problem


def fingerprint_of(encrypted: ssl.SSLSocket) -> str:
    """Return the SHA-256 of the other side's certificate, as pairs of hexadecimal digits."""
    certificate = encrypted.getpeercert(binary_form=True) or b""
    return hashlib.sha256(certificate).digest().hex(":").upper() if certificate else ""


def speaks_tls(address: tuple[str, int], until_s: float) -> bool:
    """Whether an address answers to TLS: asked when it does not answer to the plain protocol."""
    with contextlib.suppress(NoAnswer, NoTls, Refused):
        encrypt(reach(address, until_s), address, until_s).close()
        return True
    return False


# The first words of a connection: who the client is, what both can do, old robots too.

DIRECTORY = 1
CHECK_LOGIN = (
    "Are user and password right? The user is “nao” unless somebody changed it.",
    "The password is the one of the robot's web page.",
)
MAKE_ROOM = (
    "Close programs that use the robot on the screen and are not needed.",
    "Does a program connect again and again without closing the connection?",
)


def enter(peer: Peer, login: Login | None, until_s: float) -> None:
    """Say who we are. Raises LoginRefused, NoRoom, NoAnswer, ConnectionLost."""
    said: dict[str, Any] = dict(CAPABILITIES)
    if login is not None:
        said |= {USER: login.user, TOKEN: login.password}
    try:
        answer = _authenticate(peer, said, until_s)
        if answer.get(STATE) == GOES_ON and isinstance(answer.get(NEW_TOKEN), str):
            said[TOKEN] = answer[NEW_TOKEN]  # a robot may exchange the password for its token
            answer = _authenticate(peer, said, until_s)
    except CallFailed as problem:
        if is_about_login(str(problem)):
            raise _refused(login, str(problem)) from problem
        # NAOqi up to 2.1 does not know the call
        peer.send(Frame(Kind.CAPABILITY, 0, 0, 0, 0, encode("{sm}", CAPABILITIES)))
        return
    if answer.get(STATE) != DONE:
        raise _refused(login, str(answer.get(STATE)))
    if REASON in answer:
        sentence = text_of("The robot serves as many programs as it can.")
        raise NoRoom(sentence, checklist=MAKE_ROOM, details=str(answer[REASON]))
    peer.capabilities = answer


LOGIN_ANSWERS = ("Authentication failed", "Expected authentication")


def is_about_login(said: str) -> bool:
    """Whether a robot refuses the login by these words, and not the call that it does not know.

    NAOqi answers both with a frame of the kind ERROR that carries a sentence and nothing else; in
    every version since 2.1 those about the login begin so. Source: libqi, messaging/server.cpp.
    """
    return said.startswith(LOGIN_ANSWERS)


def _authenticate(peer: Peer, said: dict[str, Any], until_s: float) -> dict[str, Any]:
    payload = encode("{sm}", said)
    pending = peer.begin(0, 0, AUTHENTICATE, payload, reader_of("{sm}"))
    answer = result_of(pending, until_s)
    if not isinstance(answer, dict):  # a robot says itself of which type its answer is
        raise BadFrame(STRANGE)
    return answer


def _refused(login: Login | None, details: str) -> LoginRefused:
    what = "does not accept this user and password" if login else "wants a user and a password"
    return LoginRefused("NAO {what}.", checklist=CHECK_LOGIN, details=details, what=Text(what))


def result_of(pending: Any, until_s: float) -> Any:
    """Wait for an answer until a time. Raises NoAnswer and what the answer says."""
    try:
        return pending.result(max(0.0, until_s - time.monotonic()))
    except NoAnswer as problem:
        raise NoAnswer("NAO does not answer.", checklist=NO_ANSWER) from problem


def object_of(peer: Peer, service: int, until_s: float) -> RemoteObject:
    """Return the object of a service, with all that it says it can do. Raises NaoqiError."""
    payload = encode("(I)", (MAIN,))
    pending = peer.begin(service, MAIN, META, payload, reader_of(META_OBJECT))
    meta = MetaObject.from_wire(result_of(pending, until_s))
    return RemoteObject(peer, meta, service)


# Where services are: which of the addresses that a robot tells can be reached from here.

MACHINE = uuid.uuid4()
LOOPBACK = ("127.", "localhost", "[::1]", "::1")


@dataclass(frozen=True)
class Place:
    """The number of a service, the machine it is on, and the addresses that lead there."""

    number: int
    machine: str
    endpoints: tuple[str, ...]

    @classmethod
    def of(cls, information: Any) -> Place:
        """Return what a robot's ServiceInfo says. Raises BadFrame."""
        try:
            _, number, machine, _, endpoints, *_ = information
            place = cls(number, machine, tuple(endpoints))
        except (TypeError, ValueError) as problem:
            raise BadFrame(STRANGE) from problem
        texts = (machine, *place.endpoints)
        if type(number) is not int or not all(isinstance(text, str) for text in texts):
            raise BadFrame(STRANGE)
        return place


def best_place(place: Place, here: Place, address: tuple[str, int]) -> tuple[str, int, bool] | None:
    """Return host, port and TLS of a service; None when the open connection leads there.

    Loopback addresses of a robot are its own; they lead there only from the same machine.
    """
    if not place.endpoints or set(place.endpoints) & set(here.endpoints):
        return None
    is_near = address[0].startswith(LOOPBACK)
    found = [parsed for one in place.endpoints if (parsed := _parsed(one))]
    if any(one[1] == address[1] and (one[0] == address[0] or is_near) for one in found):
        return None
    same_host = [one for one in found if one[0] == address[0]]
    reachable = [one for one in found if is_near or not one[0].startswith(LOOPBACK)]
    return next(iter(same_host or reachable), None)


def _parsed(endpoint: str) -> tuple[str, int, bool] | None:
    """Read ``tcp://host:port`` or ``tcps://host:port``."""
    scheme, mark, rest = endpoint.partition("://")
    host, _, port = rest.rpartition(":")
    # int() knows no signs as "²", which str.isdigit() does, and no number of 5,000 digits
    is_port = port.isascii() and port.isdigit() and len(port) <= 5
    if not mark or scheme not in ("tcp", "tcps") or not is_port or not host:
        return None
    return host.strip("[]"), int(port), scheme == "tcps"


# One connection to a NAOqi robot, which can be made again when it was lost.

TLS_PORT = 9503
_numbers = itertools.count(1)


class Session:
    """One connection to a robot; safe to use from any thread.

    ``tls`` None means: as the robot has it, encrypted first when there is a ``login``. ``trusted``
    is the fingerprint that an encrypted robot must have, None for any; ``fingerprint`` tells it
    after connecting. ``on_lost`` is called once for each connection that is lost, from a thread,
    with a sentence; not after ``close``. Services, objects and signals belong to one connection:
    ask for them again after connecting again.

    ``address`` is host and port; ``timeout_s`` is how long an answer may take.
    """

    def __init__(
        self,
        address: tuple[str, int],
        *,
        login: Login | None = None,
        tls: bool | None = None,
        timeout_s: float = PATIENCE_S,
        trusted: str | None = None,
    ) -> None:
        self.address = address
        self.on_lost: Callable[[str], None] | None = None
        self.fingerprint = ""
        self._login = login
        self._tls = tls
        self._timeout_s = timeout_s
        self._trusted = trusted
        self._lock = threading.RLock()
        self._peer: Peer | None = None
        self._directory: RemoteObject | None = None
        self._here: Place | None = None
        self._services: dict[str, RemoteObject] = {}
        self._others: dict[tuple[str, int], Peer] = {}
        self._own: dict[int, Bound] = {}

    @property
    def is_connected(self) -> bool:
        """Whether the connection is there, as far as anybody knows."""
        return self._peer is not None and not self._peer.is_closed

    def connect(self) -> None:
        """Connect, also again after the connection was lost. Raises NaoqiError."""
        with self._lock:
            if self.is_connected:
                return
            self.close()
            until_s = time.monotonic() + self._timeout_s
            peer = self._peer = self._open_somehow(until_s)
            try:
                self._directory = object_of(peer, DIRECTORY, until_s)
                left_s = max(0.01, until_s - time.monotonic())
                information = self._directory.call("service", "ServiceDirectory", timeout_s=left_s)
                self._here = Place.of(information)
                self._directory.connect("serviceRemoved", self._forget)
            except CallFailed:
                self._here = Place(DIRECTORY, "", ())
            except NaoqiError:
                peer.close()
                raise
            peer.when_closed.append(lambda why: self._note_lost(peer, why))
            if peer.is_closed:
                raise ConnectionLost("NAO has closed the connection.", checklist=WRONG_PORT)

    def service(self, name: str) -> RemoteObject:
        """Return a service of the robot. Raises NoSuchService, NaoqiError."""
        with self._lock:
            self._asked()
            known = self._services.get(name)
            if known is None or known.is_lost:
                known = self._services[name] = self._find(name)
            return known

    def services(self) -> list[str]:
        """Return the names of all services that are there now. Raises NaoqiError."""
        told = self._asked().call("services")
        try:
            return [str(name) for name, *_ in told]
        except (TypeError, ValueError) as problem:
            raise BadFrame(STRANGE) from problem

    def register(self, name: str, service: object) -> int:
        """Offer a service of this program to the robot; its number. Raises NaoqiError."""
        directory = self._asked()
        # by name, for robots differ in how many parts of it they know
        information = {
            "name": name,
            "machineId": str(MACHINE),
            "processId": os.getpid(),
            "endpoints": [],
            "sessionId": str(MACHINE),
            "serviceId": 0,
            "objectUid": "",
        }
        number: int = directory.call("registerService", information)
        self._own[number] = Bound(service, number)
        directory.call("serviceReady", number)
        return number

    def unregister(self, number: int) -> None:
        """Take back a service of this program. Raises NaoqiError."""
        self._asked().call("unregisterService", number)
        self._own.pop(number, None)

    def on_service(
        self, added: Callable[[int, str], None] | None, removed: Callable[[int, str], None] | None
    ) -> None:
        """Tell when services come and go, with number and name. Raises NaoqiError."""
        for signal, heard in (("serviceAdded", added), ("serviceRemoved", removed)):
            if heard is not None:
                self._asked().connect(signal, heard)

    def close(self) -> None:
        """End the connection; ``connect`` makes it again."""
        with self._lock:
            peers = [self._peer, *self._others.values()]
            self._peer = self._directory = self._here = None
            self._services.clear()
            self._others.clear()
            self._own.clear()
        for peer in peers:
            if peer is not None:
                peer.close()

    def _asked(self) -> RemoteObject:
        """Return the directory of services. Raises ConnectionLost."""
        directory = self._directory
        if directory is None or not self.is_connected:
            raise ConnectionLost(
                "There is no connection to {place_of}.", place_of=place_of(self.address)
            )
        return directory

    def _find(self, name: str) -> RemoteObject:
        until_s = time.monotonic() + self._timeout_s
        try:
            information = self._asked().call("service", name, timeout_s=self._timeout_s)
        except CallFailed as problem:
            raise NoSuchService(
                "NAO has no service {name}.", details=str(problem), name=name
            ) from problem
        place = Place.of(information)
        return object_of(self._peer_at(place, until_s), place.number, until_s)

    def _peer_at(self, place: Place, until_s: float) -> Peer:
        """Return the connection to where a service is; most are where their directory is."""
        here, peer = self._here, self._peer
        if peer is None or here is None:
            raise ConnectionLost(
                "There is no connection to {place_of}.", place_of=place_of(self.address)
            )
        address = best_place(place, here, self.address)
        if address is None:
            return peer
        other = self._others.get(address[:2])
        if other is None or other.is_closed:
            other = self._open(address[:2], address[2], until_s)
            self._others[address[:2]] = other
        return other

    def _open_somehow(self, until_s: float) -> Peer:
        """Return an entered connection, encrypted or not, as the robot has it.

        A password goes encrypted wherever the robot can do that. Raises NaoqiError.
        """
        first = self._login is not None or bool(self._trusted) or self.address[1] == TLS_PORT
        tls = first if self._tls is None else self._tls
        has_other = self._tls is None and not self._trusted
        first_until_s = until_s - self._timeout_s / 2 if has_other and tls else until_s
        try:
            return self._open(self.address, tls, first_until_s)
        except (NeedsTls, NoTls, NoAnswer) as problem:
            if not has_other or (isinstance(problem, NoAnswer) and not tls):
                raise
        return self._open(self.address, not tls, until_s)

    def _open(self, address: tuple[str, int], tls: bool, until_s: float) -> Peer:
        """Return an entered connection. Raises NaoqiError."""
        one = reach(address, until_s)
        if tls:
            one = encrypt(one, address, until_s)
            self._check(one, address)
        peer = Peer(Line(one), name=f"naoqi-client-{next(_numbers)}")
        peer.find = self._bound
        peer.start()
        try:
            enter(peer, self._login, until_s)
        except (BadFrame, ConnectionLost) as problem:
            peer.close()
            raise self._strange(address, tls, until_s, problem) from problem
        except NaoqiError:
            peer.close()
            raise
        return peer

    def _bound(self, number: int, thing: int) -> Bound | None:
        return self._own.get(number) if thing == MAIN else None

    def _check(self, one: ssl.SSLSocket, address: tuple[str, int]) -> None:
        self.fingerprint = fingerprint_of(one)
        if self._trusted and self._trusted.upper() != self.fingerprint:
            one.close()
            raise StrangeCertificate(
                "What answers at {place_of} is not the robot that was trusted before.",
                checklist=("Was this NAO set up anew? Then trust it again.",),
                details=self.fingerprint,
                place_of=place_of(address),
            )

    def _strange(
        self, address: tuple[str, int], tls: bool, until_s: float, problem: NaoqiError
    ) -> NaoqiError:
        """Say what it is that does not answer as NAOqi does."""
        place = place_of(address)
        if not tls and speaks_tls(address, until_s):
            return NeedsTls(
                "NAO at {place} speaks only the encrypted protocol.",
                checklist=("Give the user and the password of this NAO.",),
                details=str(problem),
                place=place,
            )
        return NotNaoqi(
            "What answers at {place} is not a NAO.",
            checklist=WRONG_PORT,
            details=str(problem),
            place=place,
        )

    def _forget(self, _number: int, name: str) -> None:
        """A service is gone; if it comes again it has another number."""
        self._services.pop(name, None)

    def _note_lost(self, peer: Peer, why: str) -> None:
        if self._peer is peer and self.on_lost is not None:  # else closed by this program
            threading.Thread(target=self.on_lost, args=(why,), daemon=True).start()
