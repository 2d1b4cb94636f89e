"""What a program that does not answer is: plain, or one that wants keys; ZMTP's greeting tells."""

from __future__ import annotations

import contextlib
import socket
import time

from nep_core.errors import NotLetIn
from nep_core.security import key_file_path
from nep_core.security.addresses import host_of

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
        with socket.create_connection(place, timeout=timeout_s) as connection:
            connection.sendall(SIGNATURE + VERSION)
            while len(heard) < MECHANISM.stop and time.monotonic() < end_s:
                part = connection.recv(GREETING_BYTES)
                if not part:
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
            f"The network at {endpoint} is open only to programs that have its keys.",
            checklist=(
                "Was this computer paired with it? Then set NEP_KEYS to its key file.",
                "Else pair it: nep open shows a code on the other computer, nep pair takes it "
                "here.",
                "For a network of this computer alone use another port: nep master "
                "--endpoint tcp://127.0.0.1:7200, and set NEP_MASTER to it.",
            ),
        )
    if mechanism == "CURVE":
        return NotLetIn(
            f"The master at {endpoint} does not take the keys of {path}.",
            checklist=(
                "Was this computer taken from its list? Pair it again: nep pair.",
                "Is it another network than the one of the key file? nep find shows which.",
            ),
        )
    if mechanism == "NULL" and path is not None:
        return NotLetIn(
            f"The master at {endpoint} has no keys, but this program was started with {path}.",
            checklist=(
                "To talk on this computer only, start this program without NEP_KEYS.",
                "To open the network, start the master with its keys: nep open.",
            ),
        )
    return None
