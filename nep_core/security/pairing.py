"""How two computers get to know each other's keys by a short code: the messages, no sockets.

SPAKE2 makes a common secret of the code. Who listens, or sits between, learns nothing by which
codes could be tried later: each try takes a talk of its own, and three wrong ones end a code.
With the secret both prove to each other what they tell: their keys and where the master is.
"""

from __future__ import annotations

import hashlib
import hmac
from typing import Any

import msgspec

from nep_core.errors import PairingError
from nep_core.security.keys import Key, Name

VERSION = 1
MOST_BYTES = 4096
"""A longer message is refused."""
_SPAKE_BYTES = 33
_GUEST, _DOOR = b"nep pairing: guest", b"nep pairing: door"


class Hello(msgspec.Struct, tag="pair", tag_field="do", kw_only=True):
    """The guest begins; ``spake`` is hexadecimal."""

    version: int
    spake: str


class Offer(msgspec.Struct, tag="offer", tag_field="do", kw_only=True):
    """The door's half of SPAKE2."""

    spake: str


class Proof(msgspec.Struct, tag="proof", tag_field="do", kw_only=True):
    """The guest knows the code: a Guest as JSON text, and its HMAC-SHA256."""

    told: str
    mac: str


class Welcome(msgspec.Struct, tag="welcome", tag_field="do", kw_only=True):
    """The door knows the code too: a Host as JSON text, and the HMAC-SHA256 of both texts."""

    told: str
    mac: str


class No(msgspec.Struct, tag="no", tag_field="do", kw_only=True):
    """The door refuses: a sentence for the person at the guest, and what to do."""

    sentence: str
    checklist: list[str] = []


Message = Hello | Offer | Proof | Welcome | No

encode = msgspec.json.Encoder().encode
decode = msgspec.json.Decoder(Message).decode


class Guest(msgspec.Struct, kw_only=True):
    """What the guest tells of itself."""

    name: Name
    key: Key


class Host(msgspec.Struct, kw_only=True):
    """What the computer that opened the network tells."""

    network: str
    title: Name
    computer: Name
    key: Key
    master: str


class GuestTalk:
    """The guest's side of one talk."""

    def __init__(self, code: str, guest: Guest) -> None:
        from spake2 import SPAKE2_A

        self._spake = SPAKE2_A(_password(code), idA=_GUEST, idB=_DOOR)
        self._told = encode(guest).decode()
        self._secret = b""

    def hello(self) -> Hello:
        """The first message."""
        return Hello(version=VERSION, spake=self._spake.start().hex())

    def prove(self, offer: Offer) -> Proof:
        """Answer the door's offer; raises PairingError."""
        self._secret = _finish(self._spake, offer.spake, b"B")
        return Proof(told=self._told, mac=_mac(self._secret, _GUEST, self._told))

    def read(self, welcome: Welcome) -> Host:
        """What the door told, if it knows the code as well; raises PairingError."""
        _check(welcome.mac, _mac(self._secret, _DOOR, self._told, welcome.told))
        return msgspec.json.decode(welcome.told, type=Host)


class DoorTalk:
    """The door's side of one talk."""

    def __init__(self, code: str) -> None:
        from spake2 import SPAKE2_B

        self._spake = SPAKE2_B(_password(code), idA=_GUEST, idB=_DOOR)
        self._secret = b""

    def offer(self, hello: Hello) -> Offer:
        """Answer the guest's hello; raises PairingError."""
        started = self._spake.start()
        self._secret = _finish(self._spake, hello.spake, b"A")
        return Offer(spake=started.hex())

    def read(self, proof: Proof) -> Guest:
        """Who the guest is, if it knows the code; raises PairingError."""
        _check(proof.mac, _mac(self._secret, _GUEST, proof.told))
        return msgspec.json.decode(proof.told, type=Guest)

    def welcome(self, proof: Proof, host: Host) -> Welcome:
        """The last message."""
        told = encode(host).decode()
        return Welcome(told=told, mac=_mac(self._secret, _DOOR, proof.told, told))


def wrong_code() -> PairingError:
    """The error when the two codes differ."""
    return PairingError(
        "That is not the code.",
        checklist=(
            "Read the code again on the computer that opened the network: six digits.",
            "After three wrong tries it holds no more: let that computer show a new one.",
        ),
    )


def _password(code: str) -> bytes:
    """A code as people write it: "482 913" and "482913" are the same."""
    return "".join(filter(str.isalnum, code)).encode()


def _finish(spake: Any, told: str, side: bytes) -> bytes:
    try:
        theirs = bytes.fromhex(told)
        if len(theirs) != _SPAKE_BYTES or theirs[:1] != side:
            raise ValueError("not a message of SPAKE2")
        return bytes(spake.finish(theirs))
    except Exception as error:  # the library tells by many kinds that a message is wrong
        raise PairingError(
            "The other side sent something that cannot be read.",
            checklist=("Is that the address of a computer that opened a NEP network?",),
            details=str(error),
        ) from error


def _mac(secret: bytes, role: bytes, *texts: str) -> str:
    key = hmac.digest(secret, role, hashlib.sha256)
    return hmac.new(key, "\n".join(texts).encode(), hashlib.sha256).hexdigest()


def _check(told: str, right: str) -> None:
    if not hmac.compare_digest(told.encode(), right.encode()):
        raise wrong_code()
