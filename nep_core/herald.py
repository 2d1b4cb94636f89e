"""Tells on the network how nodes ended that cannot say it any more."""

from __future__ import annotations

import socket
import threading

from nep_core.launched import LaunchedNode
from nep_core.messages import NODE_STATE, NodeState
from nep_core.network import Network
from nep_core.outcome import Outcome
from nep_core.pubsub import Publisher


class Herald:
    """Speaks until it is closed, which it must be before the network is."""

    def __init__(self, network: Network | None) -> None:
        self._lock = threading.Lock()
        self._host = socket.gethostname()
        self._states: Publisher | None = Publisher(NODE_STATE, network=network)

    def tell_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        """Say how a node ended, unless it ended well by itself, or has said it."""
        is_well = outcome.was_successful and not outcome.asked
        if is_well or (outcome.asked and launched.has_said_end(outcome)):
            return
        state = NodeState(
            node=launched.name,
            type=launched.manifest.type if launched.manifest else "cognitive",
            event="stopped" if outcome.asked else "crashed",
            description=f"{outcome}; it is started again" if again else str(outcome),
            pid=launched.pid,
            host=self._host,
        )
        with self._lock:
            if self._states is not None and not self._states.network.closed:
                self._states.send(state)

    def close(self) -> None:
        """Say nothing any more: a node may still end when the network is closed."""
        with self._lock:
            self._states = None  # not closed: a node of this network may speak on
