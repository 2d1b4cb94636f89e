"""The frames of NAOqi's protocol: 28 bytes of header, then the values of a message."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from typing import NamedTuple

from .errors import BadFrame

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
