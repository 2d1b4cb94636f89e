"""Makes a connection to an address, plain or TLS; says in a sentence why there is none."""

from __future__ import annotations

import contextlib
import hashlib
import ipaddress
import os
import socket
import ssl
import threading
import time
import uuid
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from faults import Text, text_of
from robots.naoqi.wire.codec import encode, reader_of
from robots.naoqi.wire.errors import (
    CallFailed,
    ConnectionLost,
    LoginRefused,
    NaoqiError,
    NoAnswer,
    NoTls,
    Refused,
)
from robots.naoqi.wire.frames import (
    AUTHENTICATE,
    CAPABILITIES,
    DONE,
    GOES_ON,
    NEW_TOKEN,
    STATE,
    TOKEN,
    USER,
    Frame,
    Kind,
    Login,
)
from robots.naoqi.wire.metaobject import META_OBJECT, MetaObject
from robots.naoqi.wire.peer import MAIN, Peer
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.remote import NO_ANSWER, RemoteObject
from robots.naoqi.wire.service import META

KEEP_ALIVE = {"TCP_KEEPIDLE": 5, "TCP_KEEPINTVL": 2, "TCP_KEEPCNT": 3, "TCP_USER_TIMEOUT": 8000}
"""A robot that is switched off says nothing: the system notices in about ten seconds."""
WRONG_PORT = (
    "Is this the address of a NAO? Press its chest button once: it says it.",
    "NAO listens at port 9559, or 9503 when it asks for user and password.",
    "A NAO that has just been switched on needs about two minutes.",
)
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
    for host in _numeric(address[0], until_s):
        try:
            left_s = max(0.01, until_s - time.monotonic())
            return socket.create_connection((host, address[1]), left_s)
        except OSError as failed:
            problem = failed
    raise problem


def _numeric(host: str, until_s: float) -> list[str]:
    """Return the numeric addresses of a name; looking it up may take longer than we wait."""
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
        raise NoAnswer(sentence, checklist=NO_ANSWER, details=str(problem)) from problem


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


def enter(peer: Peer, login: Login | None, until_s: float) -> None:
    """Say who we are. Raises LoginRefused, NoAnswer, ConnectionLost."""
    said: dict[str, Any] = dict(CAPABILITIES)
    if login is not None:
        said |= {USER: login.user, TOKEN: login.password}
    try:
        answer = _authenticate(peer, said, until_s)
        if answer.get(STATE) == GOES_ON and isinstance(answer.get(NEW_TOKEN), str):
            said[TOKEN] = answer[NEW_TOKEN]  # a robot may exchange the password for its token
            answer = _authenticate(peer, said, until_s)
    except CallFailed as problem:
        if "uthenticat" in str(problem):  # the robot's own words
            raise _refused(login, str(problem)) from problem
        _enter_old(peer)  # NAOqi up to 2.1 does not know the call
        return
    if answer.get(STATE) != DONE:
        raise _refused(login, str(answer.get(STATE)))
    peer.capabilities = answer


def _authenticate(peer: Peer, said: dict[str, Any], until_s: float) -> dict[str, Any]:
    payload = encode("{sm}", said)
    pending = peer.begin(0, 0, AUTHENTICATE, payload, reader_of("{sm}"))
    answer: dict[str, Any] = result_of(pending, until_s)
    return answer


def _enter_old(peer: Peer) -> None:
    peer.send(Frame(Kind.CAPABILITY, 0, 0, 0, 0, encode("{sm}", CAPABILITIES)))


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


__all__ = ["DIRECTORY", "ConnectionLost", "NaoqiError", "enter", "object_of", "result_of"]


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
    def of(cls, information: Sequence[Any]) -> Place:
        """Return what a robot's ServiceInfo says."""
        _, number, machine, _, endpoints, *_ = information
        return cls(number, machine, tuple(endpoints))


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
    if not mark or scheme not in ("tcp", "tcps") or not port.isdigit() or not host:
        return None
    return host.strip("[]"), int(port), scheme == "tcps"


def own_information(name: str) -> dict[str, Any]:
    """Return what this program tells a robot of a service that it offers."""
    return {
        "name": name,
        "serviceId": 0,
        "machineId": str(MACHINE),
        "processId": os.getpid(),
        "endpoints": [],
        "sessionId": str(MACHINE),
        "objectUid": "",
    }
