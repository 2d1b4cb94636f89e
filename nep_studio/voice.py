"""What a session itself says on the network."""

from __future__ import annotations

import threading
import uuid

import msgspec

from nep_core import messages as m
from nep_core.network import Network
from nep_core.pubsub import Publisher


class Voice:
    """Speaks until it falls silent, which it must before the network is closed."""

    def __init__(self, network: Network) -> None:
        self._lock = threading.Lock()
        self._is_silent = False
        self._requests = Publisher(m.ACTION_REQUEST, network=network)
        self._control = Publisher(m.PROGRAM_CONTROL, network=network)

    def stop_robots(self) -> None:
        """Stop all that the robots do; waits for nothing."""
        request = m.ActionRequest(id=uuid.uuid4().hex, robots=[], action="stop", priority=100)
        self._say(self._requests, request)

    def order(self, order: m.ProgramControl) -> None:
        """Ask the program for something."""
        self._say(self._control, order)

    def stop_program(self) -> None:
        """Ask the program to end."""
        self._say(self._control, m.ProgramControl(command="stop"))

    def fall_silent(self) -> None:
        """Say nothing any more: a session may still end when the network is closed."""
        with self._lock:
            self._is_silent = True

    def _say(self, publisher: Publisher, message: msgspec.Struct) -> None:
        with self._lock:
            if not self._is_silent:
                publisher.send(message)
