"""What a session itself says on the network."""

from __future__ import annotations

import socket
import threading
import uuid

import msgspec

from nep_core import messages as m
from nep_core.launcher import LaunchedNode
from nep_core.outcome import Outcome
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Publisher


class Voice:
    """Speaks until it falls silent, which it must before the network is closed."""

    def __init__(self, network: PeerNetwork) -> None:
        self._lock = threading.Lock()
        self._is_silent = False
        self._states = Publisher(m.NODE_STATE, network=network)
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

    def tell_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        """Say for a node that cannot say it any more how it ended."""
        state = m.NodeState(
            node=launched.name,
            type=launched.manifest.type if launched.manifest else "cognitive",
            event="stopped" if outcome.asked else "crashed",
            description=f"{outcome}; it is started again" if again else str(outcome),
            pid=launched.pid,
            host=socket.gethostname(),
        )
        self._say(self._states, state)

    def fall_silent(self) -> None:
        """Say nothing any more: a node may still end when the network is closed."""
        with self._lock:
            self._is_silent = True

    def _say(self, publisher: Publisher, message: msgspec.Struct) -> None:
        with self._lock:
            if not self._is_silent:
                publisher.send(message)
