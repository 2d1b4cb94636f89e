"""The master of an opened network tells every program which computers are let in."""

from __future__ import annotations

from collections.abc import Callable

import zmq

from nep_core import master_messages as says
from nep_core.registry import Registration, Registry
from nep_core.security.curve import Security


class Admission:
    """Belongs to the master's thread; ``send`` gives an encoded answer to an address."""

    def __init__(
        self, security: Security, registry: Registry, send: Callable[[bytes, bytes], bool]
    ) -> None:
        self._file = security.file
        self._registry = registry
        self._send = send
        self._told = self._file.keys.allowed

    def hears(self, frame: zmq.Frame) -> bool:
        """Whether a request is listened to: a connection may be older than its refusal."""
        return frame.get("User-Id") in self._file.keys.allowed

    def admits(self, told: Registration, address: bytes) -> bool:
        """Whether a program may register; if so it is told who else may."""
        self.look()
        if told.key not in self._told:
            return False
        self._send(address, self._news())
        return True

    def look(self) -> list[Registration]:
        """Tell all programs when the key file has changed; those whose computer was forgotten."""
        allowed = self._file.keys.allowed
        if allowed == self._told:
            return []
        self._told = allowed
        entries = self._registry.entries.values()
        for entry in entries:
            self._send(entry.address, self._news())
        return [e.registration for e in entries if e.registration.key not in allowed]

    def _news(self) -> bytes:
        return says.encode(says.Computers(keys=sorted(self._told)))
