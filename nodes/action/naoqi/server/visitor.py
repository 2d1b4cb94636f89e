"""A service that a client offers over its connection: this server calls it, others through it."""

from __future__ import annotations

import contextlib
import logging
from typing import Any

from nodes.action.naoqi.wire.decoding import Reader, read_value, reader_of
from nodes.action.naoqi.wire.encoding import encode
from nodes.action.naoqi.wire.errors import CallCancelled, ConnectionLost, NaoqiError
from nodes.action.naoqi.wire.frames import Frame, Kind
from nodes.action.naoqi.wire.metaobject import META_OBJECT, MetaObject
from nodes.action.naoqi.wire.peer import MAIN, Peer
from nodes.action.naoqi.wire.promise import Pending
from nodes.action.naoqi.wire.remote import RemoteObject
from nodes.action.naoqi.wire.service import META, REGISTER, REGISTER_AS, UNREGISTER

log = logging.getLogger(__name__)


class Visitor:
    """One service of a client. Its own description is asked for once, without waiting."""

    def __init__(self, peer: Peer, number: int) -> None:
        self.peer = peer
        self.number = number
        payload = encode("(I)", (MAIN,))
        self._asked = peer.begin(number, MAIN, META, payload, reader_of(META_OBJECT))
        self._links: dict[tuple[Peer, int], int] = {}

    def tell(self, method: str, values: tuple[Any, ...]) -> None:
        """Call a method without waiting for its end."""

        def post(asked: Pending) -> None:
            try:
                meta = MetaObject.from_wire(asked.result(0.0))
                RemoteObject(self.peer, meta, self.number).post(method, *values)
            except NaoqiError as problem:
                log.warning("%s could not be called: %s", method, problem.sentence)

        self._asked.when_done(post)

    def take(self, frame: Frame, peer: Peer) -> None:
        """Pass a call of another client on, and the answer back, both as they are."""
        is_listening = frame.action in (REGISTER, REGISTER_AS, UNREGISTER)
        if is_listening and frame.kind == Kind.CALL and frame.object == MAIN:
            self._take_listening(frame, peer)
            return
        if frame.kind == Kind.POST:
            self.peer.post(frame.service, frame.object, frame.action, frame.payload)
            return
        try:
            pending = self.peer.begin(
                frame.service, frame.object, frame.action, frame.payload, _all_bytes, frame.flags
            )
        except ConnectionLost as problem:
            peer.answer_error(frame, problem.sentence)
            return
        peer.running[frame.number] = pending

        def answer(done: Pending) -> None:
            peer.running.pop(frame.number, None)
            if isinstance(done.failure, CallCancelled):
                peer.answer(frame.answer(Kind.CANCELLED))
            elif done.failure is not None:
                peer.answer_error(frame, done.failure.sentence)
            else:
                peer.answer(frame.answer(Kind.REPLY, done.value))

        pending.when_done(answer)

    def leave(self, peer: Peer) -> None:
        """A client that listened is gone."""
        for key in [key for key in list(self._links) if key[0] is peer]:
            self._end(key)

    def _take_listening(self, frame: Frame, peer: Peer) -> None:
        """Listen once for all who want to hear a signal of this service, or no more."""
        try:
            _, uid, link = read_value(reader_of("(IIL)"), Reader(frame.payload))
            if frame.action == UNREGISTER:
                self._end((peer, link))
                peer.answer(frame.answer(Kind.REPLY))
                return
            is_first = uid not in list(self._links.values())
            self._links[peer, link] = uid
            if is_first:
                self.peer.hearing[self.number, MAIN, uid] = _Passing(self._links, uid)
                self._ask(REGISTER, uid)
            peer.answer(frame.answer(Kind.REPLY, encode("L", link)))
        except NaoqiError as problem:
            peer.answer_error(frame, problem.sentence)

    def _end(self, key: tuple[Peer, int]) -> None:
        uid = self._links.pop(key, None)
        if uid is not None and uid not in list(self._links.values()):
            self.peer.hearing.pop((self.number, MAIN, uid), None)
            with contextlib.suppress(ConnectionLost):
                self._ask(UNREGISTER, uid)

    def _ask(self, action: int, uid: int) -> None:
        payload = encode("(IIL)", (MAIN, uid, uid))
        self.peer.begin(self.number, MAIN, action, payload, _all_bytes)


class _Passing:
    """Passes the events of one signal on to the clients that listen."""

    def __init__(self, links: dict[tuple[Peer, int], int], uid: int) -> None:
        self._links = links
        self._uid = uid

    def take(self, frame: Frame) -> None:
        for peer, link in list(self._links):
            if self._links.get((peer, link)) == self._uid:
                peer.answer(frame)


def _all_bytes(reader: Reader) -> bytes:
    return reader.data
