"""Service 1: which services there are, where they are, who offers them."""

from __future__ import annotations

import itertools
import os
import threading
import uuid
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from nodes.action.naoqi.wire.bound import Bound, caller
from nodes.action.naoqi.wire.errors import CallFailed
from nodes.action.naoqi.wire.peer import Peer
from nodes.action.naoqi.wire.service import method, signal

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
            raise CallFailed(f"Cannot find service '{name}' in index")
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
            raise CallFailed(f"Unregister Service: Can't find service #{number}")
        self._remove(number)

    @method("serviceReady::v(I)", uid=104)
    def ready(self, number: int) -> None:
        """A client can be asked now."""
        with self._lock:
            entry = self._entries.get(number)
            if entry is None or entry.is_ready:
                raise CallFailed(f"Can't find pending service #{number}")
            entry = self._entries[number] = replace(entry, is_ready=True)
        self.when_ready(entry)
        self.added.emit(number, entry.name)

    @method(f"updateServiceInfo::v({INFORMATION})", uid=105)
    def update(self, told: Any) -> None:
        """A client has moved."""
        _, number, machine, process, endpoints, session, _ = told
        entry = self._entries.get(number)
        if entry is None or entry.peer is not caller():
            raise CallFailed(f"updateServiceInfo: Can't find service #{number}")
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
                f'Service "{name}" (#{taken.number}) is already registered. '
                "Rejecting conflicting registration attempt."
            )
