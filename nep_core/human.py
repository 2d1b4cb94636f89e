"""What the person does, as the program last heard it."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import cast

from nep_core.default_network import default_network
from nep_core.messages import HUMAN_BEHAVIOR, HumanBehavior
from nep_core.network import Network
from nep_core.pubsub import Subscriber

REMEMBER_S = 3.0
"""How long a state such as a gesture stays the human's state after it was seen."""


Listener = Callable[[HumanBehavior], None]


class HumanListener:
    """Hears ``/human_behavior`` for a whole program.

    What comes before the first listener is there is kept for it (the last 100 messages).
    """

    def __init__(self, network: Network) -> None:
        self._state = ""
        self._heard_s = 0.0
        self._lock = threading.RLock()
        self._listeners: list[Listener] = []
        self._kept: deque[HumanBehavior] = deque(maxlen=100)
        self._states = Subscriber(
            HUMAN_BEHAVIOR, HumanBehavior, network=network, callback=self._on_behavior
        )

    def listen(self, listener: Listener) -> None:
        """Call ``listener`` with every message, in their order, from another thread."""
        with self._lock:
            self._listeners.append(listener)
            while self._kept:
                listener(self._kept.popleft())

    def unlisten(self, listener: Listener) -> None:
        """Call ``listener`` no more."""
        with self._lock:
            self._listeners.remove(listener)

    def state(self) -> str:
        """The last state, "" when nothing was seen for 3 s."""
        return self._state if time.monotonic() - self._heard_s <= REMEMBER_S else ""

    def _on_behavior(self, behavior: HumanBehavior) -> None:
        with self._lock:
            self._state, self._heard_s = behavior.human_state, time.monotonic()
            if not self._listeners:
                self._kept.append(behavior)
            for listener in list(self._listeners):
                listener(behavior)


def human_listener(network: Network | None = None) -> HumanListener:
    """The listener of this program's network."""
    place = network or default_network()
    return cast(HumanListener, place.shared("human", lambda: HumanListener(place)))


def human_state() -> str:
    """What the person did last, such as "gesture_karate"; "" when nothing for 3 s."""
    return human_listener().state()
