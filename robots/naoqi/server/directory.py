"""Service 1: which services there are, where they are, who offers them."""

from __future__ import annotations

import contextlib
import itertools
import logging
import os
import threading
import uuid
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from robots.naoqi.wire.codec import Reader, encode, read_value, reader_of
from robots.naoqi.wire.errors import CallCancelled, CallFailed, ConnectionLost, NaoqiError
from robots.naoqi.wire.frames import Frame, Kind
from robots.naoqi.wire.metaobject import META_OBJECT, MetaObject
from robots.naoqi.wire.peer import MAIN, Peer
from robots.naoqi.wire.promise import Pending
from robots.naoqi.wire.remote import RemoteObject
from robots.naoqi.wire.service import (
    META,
    REGISTER,
    REGISTER_AS,
    UNREGISTER,
    Bound,
    caller,
    method,
    signal,
)

log = logging.getLogger(__name__)


INFORMATION = (
    "(sIsI[s]ss)<ServiceInfo,name,serviceId,machineId,processId,endpoints,sessionId,objectUid>"
)
MACHINE = str(uuid.UUID(int=uuid.getnode()))


@dataclass(frozen=True)
class Entry:
    """One service: as it is told, and either here or offered by a client."""

    name: str
    number: int
    machine: str = MACHINE
    process: int = 0
    endpoints: tuple[str, ...] = ()
    session: str = "0"
    bound: Bound | None = None
    peer: Peer | None = None
    is_ready: bool = True


class ServiceDirectory:
    """The directory of a robot's services."""

    added = signal("serviceAdded::(Is)", uid=106)
    removed = signal("serviceRemoved::(Is)", uid=107)

    def __init__(self, endpoints: Callable[[Peer | None], list[str]]) -> None:
        self._endpoints = endpoints
        self._numbers = itertools.count(1)
        self._lock = threading.RLock()
        self._entries: dict[int, Entry] = {}
        self.when_ready: Callable[[Entry], None] = lambda entry: None

    def offer(self, name: str, thing: object) -> int:
        """Add a service of this program. Raises CallFailed when the name is taken."""
        with self._lock:
            self._check_free(name)
            number = next(self._numbers)
            bound = Bound(thing, number)
            self._entries[number] = Entry(name, number, process=os.getpid(), bound=bound)
        self.added.emit(number, name)
        return number

    def entry(self, number: int) -> Entry | None:
        """Return a service by its number."""
        return self._entries.get(number)

    def named(self, name: str) -> Entry | None:
        """Return a service that is ready, by its name."""
        entries = list(self._entries.values())
        return next((it for it in entries if it.name == name and it.is_ready), None)

    def here(self) -> list[Bound]:
        """Return the services of this program."""
        return [entry.bound for entry in list(self._entries.values()) if entry.bound is not None]

    def forget(self, peer: Peer) -> None:
        """A client is gone, and its services with it."""
        for number, entry in list(self._entries.items()):
            if entry.peer is peer:
                self._remove(number)

    @method(f"service::{INFORMATION}(s)", uid=100)
    def service(self, name: str) -> Any:
        """Return where a service is. Raises CallFailed."""
        entry = self.named(name)
        if entry is None:
            raise CallFailed("Cannot find service '{name}' in index", name=name)
        return self._told(entry)

    @method(f"services::[{INFORMATION}]()", uid=101)
    def services(self) -> list[Any]:
        """Return all services that are ready."""
        return [self._told(entry) for entry in list(self._entries.values()) if entry.is_ready]

    @method(f"registerService::I({INFORMATION})", uid=102)
    def register(self, told: Any) -> int:
        """Begin to offer a service of a client; its number."""
        name, _, machine, process, endpoints, session, _ = told
        with self._lock:
            self._check_free(name)
            number = next(self._numbers)
            self._entries[number] = Entry(
                name,
                number,
                machine,
                process,
                tuple(endpoints),
                session,
                peer=caller(),
                is_ready=False,
            )
        return number

    @method("unregisterService::v(I)", uid=103)
    def unregister(self, number: int) -> None:
        """A client takes its service back."""
        entry = self._entries.get(number)
        if entry is None or entry.peer is None or entry.peer is not caller():
            raise CallFailed("Unregister Service: Can't find service #{number}", number=number)
        self._remove(number)

    @method("serviceReady::v(I)", uid=104)
    def ready(self, number: int) -> None:
        """A client can be asked now."""
        with self._lock:
            entry = self._entries.get(number)
            if entry is None or entry.is_ready:
                raise CallFailed("Can't find pending service #{number}", number=number)
            entry = self._entries[number] = replace(entry, is_ready=True)
        self.when_ready(entry)
        self.added.emit(number, entry.name)

    @method(f"updateServiceInfo::v({INFORMATION})", uid=105)
    def update(self, told: Any) -> None:
        """A client has moved."""
        _, number, machine, process, endpoints, session, _ = told
        entry = self._entries.get(number)
        if entry is None or entry.peer is not caller():
            raise CallFailed("updateServiceInfo: Can't find service #{number}", number=number)
        self._entries[number] = replace(
            entry, machine=machine, process=process, endpoints=tuple(endpoints), session=session
        )

    @method("machineId::s()", uid=108)
    def machine_id(self) -> str:
        """Return what tells this computer from others."""
        return MACHINE

    def remove(self, name: str) -> None:
        """Take a service of this program away."""
        entry = self.named(name)
        if entry is not None:
            self._remove(entry.number)

    def _remove(self, number: int) -> None:
        entry = self._entries.pop(number, None)
        if entry is not None and entry.is_ready:
            self.removed.emit(number, entry.name)

    def _told(self, entry: Entry) -> tuple[Any, ...]:
        is_here = entry.bound is not None or not entry.endpoints
        endpoints = self._endpoints(caller()) if is_here else list(entry.endpoints)
        return (
            entry.name,
            entry.number,
            entry.machine,
            entry.process,
            endpoints,
            entry.session,
            "",
        )

    def _check_free(self, name: str) -> None:
        entries = list(self._entries.values())
        taken = next((it for it in entries if it.name == name), None)
        if taken is not None:
            raise CallFailed(
                'Service "{name}" (#{number}) is already registered. Rejecting conflicting '
                "registration attempt.",
                name=name,
                number=taken.number,
            )


# A service that a client offers over its connection: this server calls it, others through it.


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
