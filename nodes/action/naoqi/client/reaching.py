"""Makes a connection to an address, plain or TLS; says in a sentence why there is none."""

from __future__ import annotations

import contextlib
import hashlib
import ipaddress
import socket
import ssl
import threading
import time

from nodes.action.naoqi.wire.errors import NaoqiError, NoAnswer, NoTls, Refused
from nodes.action.naoqi.wire.promise import Promise
from nodes.action.naoqi.wire.remote import NO_ANSWER

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
        sentence = f"Nothing listens at {place}."
        raise Refused(sentence, checklist=WRONG_PORT, details=str(problem)) from problem
    except (OSError, OverflowError) as problem:
        sentence = f"Nobody answers at {place}."
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
        sentence = f"There is no computer or robot called {host} on this network."
        raise NoAnswer(sentence, checklist=NO_ANSWER, details=problem.sentence) from problem


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
        sentence = f"NAO at {place} does not answer."
        raise NoAnswer(sentence, checklist=NO_ANSWER, details=str(problem)) from problem
    except OSError as problem:
        plain.close()
        sentence = f"What listens at {place} does not speak the encrypted protocol."
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
