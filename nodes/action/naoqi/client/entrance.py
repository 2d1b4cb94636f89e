"""The first words of a connection: who the client is, what both can do, old robots too."""

from __future__ import annotations

import time
from typing import Any

from nodes.action.naoqi.wire.decoding import reader_of
from nodes.action.naoqi.wire.encoding import encode
from nodes.action.naoqi.wire.errors import (
    CallFailed,
    ConnectionLost,
    LoginRefused,
    NaoqiError,
    NoAnswer,
)
from nodes.action.naoqi.wire.frames import Frame, Kind
from nodes.action.naoqi.wire.login import (
    AUTHENTICATE,
    CAPABILITIES,
    DONE,
    GOES_ON,
    NEW_TOKEN,
    STATE,
    TOKEN,
    USER,
    Login,
)
from nodes.action.naoqi.wire.metaobject import META_OBJECT, MetaObject
from nodes.action.naoqi.wire.peer import MAIN, Peer
from nodes.action.naoqi.wire.remote import NO_ANSWER, RemoteObject
from nodes.action.naoqi.wire.service import META

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
        if "uthenticat" in problem.sentence:
            raise _refused(login, problem.sentence) from problem
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
    return LoginRefused(f"NAO {what}.", checklist=CHECK_LOGIN, details=details)


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
