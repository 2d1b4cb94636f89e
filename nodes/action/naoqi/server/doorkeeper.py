"""Lets clients in: answers their first words, and nothing else before they are known."""

from __future__ import annotations

import hmac
import logging
from typing import Any

from nodes.action.naoqi.wire.decoding import Reader, read_value, reader_of
from nodes.action.naoqi.wire.encoding import encode
from nodes.action.naoqi.wire.errors import BadFrame
from nodes.action.naoqi.wire.frames import Frame, Kind
from nodes.action.naoqi.wire.login import (
    AUTHENTICATE,
    CAPABILITIES,
    DONE,
    STATE,
    TOKEN,
    USER,
    Login,
)
from nodes.action.naoqi.wire.peer import Peer

log = logging.getLogger(__name__)


class Doorkeeper:
    """Stands before one connection. ``knows_authenticate`` False plays a robot of 2013."""

    def __init__(self, peer: Peer, login: Login | None, *, knows_authenticate: bool) -> None:
        self._peer = peer
        self._login = login
        self._knows_authenticate = knows_authenticate
        self._is_greeted = False

    def lets_pass(self, frame: Frame) -> bool:
        """Whether a frame is for the services; what is for the door is answered here."""
        is_call = frame.kind == Kind.CALL and frame.service == 0 and frame.object == 0
        if is_call and frame.action == AUTHENTICATE and self._knows_authenticate:
            self._authenticate(frame)
            return False
        if self._login is not None:
            self._refuse(frame, "Expected authentication.")
            return False
        if frame.kind == Kind.CAPABILITY:
            self._peer.take_capabilities(frame)
            self._greet()
            return False
        if not is_call:
            self._greet()
            self._peer.gate = None
        return True

    def _authenticate(self, frame: Frame) -> None:
        try:
            said = read_value(reader_of("{sm}"), Reader(frame.payload))
        except BadFrame as problem:
            self._refuse(frame, f"Authentication failed: {problem.sentence}")
            return
        if not self._is_right(said):
            self._refuse(frame, "Authentication failed: user or token is wrong.")
            return
        self._peer.capabilities = said
        self._peer.gate = None
        answer = encode("{sm}", CAPABILITIES | {STATE: DONE})
        self._peer.answer(frame.answer(Kind.REPLY, answer))

    def _is_right(self, said: dict[str, Any]) -> bool:
        if self._login is None:
            return True
        given = (said.get(USER), said.get(TOKEN))
        wanted = (self._login.user, self._login.password)
        return all(
            isinstance(one, str) and hmac.compare_digest(one.encode(), right.encode())
            for one, right in zip(given, wanted, strict=True)
        )

    def _refuse(self, frame: Frame, text: str) -> None:
        self._peer.answer(frame.answer(Kind.ERROR, encode("m", text)))
        self._peer.close()

    def _greet(self) -> None:
        if not self._is_greeted:
            self._is_greeted = True
            payload = encode("{sm}", CAPABILITIES)
            self._peer.answer(Frame(Kind.CAPABILITY, 0, 0, 0, 0, payload))
