"""Messages that are sent by hand, from a thread of their own: a first one may have to wait."""

from __future__ import annotations

import logging
import queue
import threading
from typing import Any

import msgspec

from nep_core.errors import NepError
from nep_core.network import Network
from nep_core.pubsub import Publisher

log = logging.getLogger(__name__)

Sent = tuple[Network, str, msgspec.Struct | dict[str, Any]]


class Sender:
    """Sends to any topic; it keeps a publisher for each that was used."""

    def __init__(self) -> None:
        self._network: Network | None = None
        self._publishers: dict[str, Publisher] = {}
        self._waiting: queue.SimpleQueue[Sent | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None

    def send(
        self, network: Network | None, topic: str, message: msgspec.Struct | dict[str, Any]
    ) -> bool:
        """Send a message, soon and in order; False when there is no network."""
        if network is None or network.closed:
            return False
        self._waiting.put((network, topic, message))
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="nep-studio-send", daemon=True)
            self._thread.start()
        return True

    def close(self) -> None:
        """Send no more."""
        self._waiting.put(None)

    def _run(self) -> None:
        while (sent := self._waiting.get()) is not None:
            try:
                self._publisher(sent[0], sent[1]).send(sent[2])
            except (NepError, ValueError, TypeError) as error:  # also what JSON cannot carry
                log.warning("%s was not sent: %s", sent[1], error)

    def _publisher(self, network: Network, topic: str) -> Publisher:
        if network is not self._network:
            self._network, self._publishers = network, {}
        if topic not in self._publishers:
            self._publishers[topic] = Publisher(topic, network=network)
        return self._publishers[topic]
