"""One JSON message a line over a TCP connection, with a limit to bytes and time."""

from __future__ import annotations

import socket
import time

import msgspec

from nep_core.errors import PairingError
from nep_core.security.pairing import MOST_BYTES, Message, decode, encode


class Lines:
    """A talk that ends after ``seconds``, however slowly the other side sends."""

    def __init__(self, connection: socket.socket, seconds: float) -> None:
        self._connection = connection
        self.go_on(seconds)
        self._arrived = b""

    def go_on(self, seconds: float) -> None:
        """Let the talk end after so long from now."""
        self._end_s = time.monotonic() + seconds

    def say(self, message: Message) -> None:
        """Send; raises PairingError."""
        self._wait_at_most_the_rest()
        try:
            self._connection.sendall(encode(message) + b"\n")
        except OSError as error:
            raise _broken() from error

    def hear(self) -> Message:
        """The next message; raises PairingError."""
        while b"\n" not in self._arrived:
            self._wait_at_most_the_rest()
            try:
                part = self._connection.recv(MOST_BYTES)
            except OSError as error:
                raise _broken() from error
            self._arrived += part
            if not part or len(self._arrived) > MOST_BYTES:
                raise _broken()
        line, _, self._arrived = self._arrived.partition(b"\n")
        try:
            return decode(line)  # type: ignore[no-any-return]
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
            raise _broken() from error

    def _wait_at_most_the_rest(self) -> None:
        left_s = self._end_s - time.monotonic()
        if left_s <= 0:
            raise _broken()
        self._connection.settimeout(left_s)


def _broken() -> PairingError:
    return PairingError(
        "The talk with the other computer ended too early.",
        checklist=(
            "Is that the address of the computer that opened the network?",
            "Try again.",
        ),
    )
