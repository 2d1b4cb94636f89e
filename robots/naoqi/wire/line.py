"""NAOqi's frames, 28 bytes of header and the values of a message, and the socket they go over.

The socket is plain or TLS: sending never waits, receiving has a thread.
"""

from __future__ import annotations

import contextlib
import select
import socket
import ssl
import struct
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

from .errors import BadFrame, ConnectionLost

MAGIC = 0x42ADDE42
VERSION = 0
HEADER = struct.Struct("<IIIHBBIII")
LARGEST_PAYLOAD = 64 * 1024 * 1024
DYNAMIC_PAYLOAD, RETURN_TYPE = 1, 2
"""Flags: the values are one dynamic value; the type of the wanted result follows the values."""


class Kind(IntEnum):
    """What a frame is for."""

    CALL = 1
    REPLY = 2
    ERROR = 3
    POST = 4
    EVENT = 5
    CAPABILITY = 6
    CANCEL = 7
    CANCELLED = 8


class Frame(NamedTuple):
    """One message: what it is, whom it is for, and the bytes of its values."""

    kind: int
    number: int
    service: int
    object: int
    action: int
    payload: bytes = b""
    flags: int = 0

    def encoded(self) -> bytes:
        """Return the bytes of this frame."""
        kind, number, service, thing, action, payload, flags = self
        return (
            HEADER.pack(MAGIC, number, len(payload), VERSION, kind, flags, service, thing, action)
            + payload
        )

    def answer(self, kind: Kind, payload: bytes = b"", flags: int = 0) -> Frame:
        """Return the frame that answers this one."""
        return Frame(kind, self.number, self.service, self.object, self.action, payload, flags)


class FrameReader:
    """Cuts the bytes that arrive into frames."""

    def __init__(self, largest: int = LARGEST_PAYLOAD) -> None:
        self._kept = bytearray()
        self._largest = largest

    def take(self, data: bytes) -> list[Frame]:
        """Return the frames that are complete now. Raises BadFrame, after which all is lost."""
        kept = self._kept
        kept += data
        frames = []
        start = 0
        while len(kept) - start >= HEADER.size:
            head = HEADER.unpack_from(kept, start)
            magic, number, size, version, kind, flags, service, thing, action = head
            self._check(magic, size, version)
            end = start + HEADER.size + size
            if len(kept) < end:
                break
            payload = bytes(kept[start + HEADER.size : end])
            frames.append(Frame(kind, number, service, thing, action, payload, flags))
            start = end
        del kept[:start]
        if 0 < len(kept) < HEADER.size and not MAGIC.to_bytes(4, "little").startswith(kept[:4]):
            self._check(0, 0, 0)
        return frames

    def _check(self, magic: int, size: int, version: int) -> None:
        if magic != MAGIC:
            raise BadFrame("What arrived is not a NAOqi message.")
        if version > VERSION:
            raise BadFrame(
                "This is version {version} of the protocol, which is not known.", version=version
            )
        if size > self._largest:
            raise BadFrame(
                "A message of {size} MB was announced; {largest} MB is the most.",
                size=size >> 20,
                largest=self._largest >> 20,
            )


# How a client says who it is, and what both sides say they can do.

AUTHENTICATE = 8
"""The number of the call, to service 0 and object 0."""
STATE, USER, TOKEN, NEW_TOKEN = "__qi_auth_state", "auth_user", "auth_token", "auth_newToken"
FAILED, GOES_ON, DONE = 1, 2, 3
REASON = "__qi_auth_err_reason"
"""The key under which a server says why it lets nobody in: ours beside DONE where it has no room.

Source: libqi, authprovider.cpp.
"""
CAPABILITIES = {
    "ClientServerSocket": True,
    "MessageFlags": True,
    "MetaObjectCache": False,
    "RemoteCancelableCalls": True,
}


@dataclass(frozen=True)
class Login:
    """User and password of a robot."""

    user: str
    password: str = field(repr=False)


@dataclass(frozen=True)
class TlsFiles:
    """The certificate of a server and its private key, both as PEM files."""

    certificate: Path
    key: Path


# A socket with frames in and out, plain or TLS: sending never waits, receiving has a thread.

MOST_AT_ONCE = 256 * 1024
MOST_UNSENT = 64 * 1024 * 1024
"""Who does not read this many bytes is not there any more."""
DRAIN_S = 30.0
LATER = (BlockingIOError, ssl.SSLWantReadError, ssl.SSLWantWriteError, InterruptedError)


def wait_for(one: socket.socket, *, writing: bool, timeout_s: float | None) -> bool:
    """Wait until a socket can be read or written; False when it could not in this time."""
    if hasattr(select, "poll"):  # select() has none of the sockets above number 1023
        poll = select.poll()
        poll.register(one, select.POLLOUT if writing else select.POLLIN)
        return bool(poll.poll(None if timeout_s is None else timeout_s * 1000.0))
    reading, writable, broken = ([], [one], [one]) if writing else ([one], [], [])
    return any(select.select(reading, writable, broken, timeout_s))


class Line:
    """One connection; ``read`` is the loop of its thread, ``send`` is for all threads."""

    def __init__(self, connected: socket.socket) -> None:
        connected.setblocking(False)
        with contextlib.suppress(OSError):
            connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._socket = connected
        self._is_tls = isinstance(connected, ssl.SSLSocket)
        self._frames = FrameReader()
        self._lock = threading.Lock()
        self._unsent = bytearray()
        self._is_draining = False
        self.is_closed = False

    @property
    def local_address(self) -> tuple[str, int]:
        """This side's address."""
        host, port, *_ = self._socket.getsockname()
        return str(host), int(port)

    def send(self, frame: Frame) -> None:
        """Send a frame, soon if not now. Raises ConnectionLost."""
        data = frame.encoded()
        with self._lock:
            if self.is_closed:
                raise ConnectionLost("The connection to NAO has ended.")
            if not self._unsent:
                data = data[self._sent(data) :]
            if not data:
                return
            self._unsent += data
            if len(self._unsent) > MOST_UNSENT:
                self._shut()
                raise ConnectionLost("The other side has stopped reading.")
            if not self._is_draining:
                self._is_draining = True
                threading.Thread(target=self._drain, name="naoqi-drain", daemon=True).start()

    def read(self, take: Callable[[Frame], None]) -> None:
        """Give every frame that arrives, until the connection ends. Raises BadFrame, OSError."""
        one = self._socket
        while not self.is_closed:
            if not self._has_pending():
                wait_for(one, writing=False, timeout_s=None)
            data = self._received()
            if data is None:
                continue
            if not data:
                return
            for frame in self._frames.take(data):
                take(frame)

    def close(self) -> None:
        """End the connection; the reading loop ends too."""
        with self._lock:
            self._shut()

    def release(self) -> None:
        """Give the socket back, when nobody reads any more."""
        self.close()
        self._socket.close()

    def _has_pending(self) -> bool:
        return self._is_tls and bool(self._socket.pending())  # type: ignore[attr-defined]

    def _received(self) -> bytes | None:
        """Return what is there now, None when it is nothing yet."""
        try:
            if not self._is_tls:
                return self._socket.recv(MOST_AT_ONCE)
            with self._lock:  # OpenSSL does not read and write at the same time
                return self._socket.recv(MOST_AT_ONCE)
        except LATER:
            return None

    def _sent(self, data: bytes | bytearray) -> int:
        """Send what can be sent now; return how many bytes that was. Raises ConnectionLost."""
        try:
            return self._socket.send(data)
        except LATER:
            return 0
        except (OSError, ValueError) as problem:
            self._shut()
            raise ConnectionLost("The connection to NAO has ended.") from problem

    def _drain(self) -> None:
        """Send what could not be sent at once."""
        until_s = time.monotonic() + DRAIN_S
        while time.monotonic() < until_s and not self.is_closed:
            try:
                if not wait_for(self._socket, writing=True, timeout_s=1.0):
                    continue
            except (OSError, ValueError):  # closed meanwhile
                return
            with self._lock, contextlib.suppress(ConnectionLost):
                # TLS must be given the same bytes again after a send that could not be
                del self._unsent[: self._sent(bytes(self._unsent[:MOST_AT_ONCE]))]
                until_s = time.monotonic() + DRAIN_S
                if not self._unsent:
                    self._is_draining = False
                    return
        self.close()

    def _shut(self) -> None:
        if not self.is_closed:
            self.is_closed = True
            with contextlib.suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
