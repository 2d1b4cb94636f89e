"""The messages of one topic, brought from the network to the window."""

from __future__ import annotations

import contextlib
import logging
import threading
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QObject, Signal

from nep_core.errors import NepError
from nep_core.networks.network import Network
from nep_core.wire.pubsub import Subscriber
from nep_studio.run.node_board import Monitor

log = logging.getLogger(__name__)

BATCHES_HZ = 60


@dataclass(frozen=True, slots=True)
class Heard:
    """A message, when it was sent (time.time()), and by which node."""

    time_s: float
    message: Any
    sender: str


class Tap(QObject):
    """Hears a topic while the network is up, also after it went down and came up again.

    ``arrived`` gives a list of Heard, the newest last, at most 60 times a second. ``kind`` is the
    struct that messages are read into; without, what JSON gives.
    """

    arrived = Signal(list)

    def __init__(
        self, topic: str, kind: type[Any] | None = None, *, most: int, parent: QObject
    ) -> None:
        super().__init__(parent)
        self.topic, self.kind = topic, kind
        self._monitor = Monitor(BATCHES_HZ, most)
        self._monitor.arrived.connect(self._on_arrived)
        self._monitor.start()
        self._ears: list[_Ear] = []  # one, or none
        self._lost = 0
        self._is_closed = False
        monitor, ears = self._monitor, self._ears
        self.destroyed.connect(lambda: _end(monitor, ears))

    @property
    def dropped(self) -> int:
        """How many messages came too fast to be shown."""
        return self._monitor.dropped

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive."""
        return self._lost + sum(ear.lost for ear in self._ears)

    def listen(self, network: Network | None) -> None:
        """Hear this network from now on; None: nothing."""
        while self._ears:
            ear = self._ears.pop()
            self._lost += ear.lost
            ear.close()
        if network is not None and not self._is_closed:
            self._ears.append(_Ear(self.topic, self.kind, network, self._monitor))

    def close(self) -> None:
        """Hear no more."""
        if self._is_closed:
            return
        self.listen(None)
        self._is_closed = True
        self._monitor.end()
        self.deleteLater()

    def _on_arrived(self, batch: list[Heard]) -> None:
        try:
            if not self._is_closed:
                self.arrived.emit(batch)
        finally:
            self._monitor.taken()


def _end(monitor: Monitor, ears: list[_Ear]) -> None:
    """End what a tap leaves that went with its parent."""
    while ears:
        ears.pop().close()
    monitor.end()


class _Ear:
    """A subscriber in a thread of its own: to open it may take a second."""

    def __init__(
        self, topic: str, kind: type[Any] | None, network: Network, monitor: Monitor
    ) -> None:
        self._topic, self._kind, self._network, self._monitor = topic, kind, network, monitor
        self.lost = 0
        self._subscriber: Subscriber[Any] | None = None
        self._lock = threading.Lock()
        self._is_closed = False
        threading.Thread(target=self._run, name=f"nep-tap-{topic}", daemon=True).start()

    def close(self) -> None:
        """Hear no more."""
        with self._lock:
            self._is_closed = True
            if self._subscriber is not None:
                self._subscriber.close()

    def _run(self) -> None:
        with contextlib.suppress(NepError):  # the network was closed meanwhile
            self._hear()

    def _hear(self) -> None:
        subscriber = Subscriber[Any](self._topic, self._kind, network=self._network)
        with self._lock:
            self._subscriber = subscriber
            if self._is_closed:
                subscriber.close()
                return
        for message in subscriber:
            header = subscriber.header
            self.lost = subscriber.lost
            sent_s, sender = (header.time_ns / 1e9, header.node) if header else (0.0, "")
            self._monitor.hear(Heard(sent_s, message, sender))
