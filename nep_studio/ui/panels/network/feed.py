"""What is seen of the network, brought to the panels that are visible."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.network import Network

from .seen import Seen
from .watch import NetworkWatch

LOOK_MS = 200
LINGER_MS = 1500
"""Between two panels it goes on watching: to begin takes longer."""


class NetworkFeed(QObject):
    """Watches while somebody looks; ``changed`` gives a Seen, at most five times a second."""

    changed = Signal(object)

    def __init__(self, find_network: Callable[[], Network | None], parent: QObject) -> None:
        super().__init__(parent)
        self._find_network = find_network
        self._watchers: set[int] = set()
        self._watch: NetworkWatch | None = None
        self.seen = Seen()
        self._timer = QTimer(self, interval=LOOK_MS)
        self._timer.timeout.connect(self._on_look)
        self._lingering = QTimer(self, singleShot=True, interval=LINGER_MS)
        self._lingering.timeout.connect(self._on_lingered)

    @property
    def is_watching(self) -> bool:
        """Whether the network is being looked at."""
        return self._watch is not None

    def watch(self, watcher: QObject) -> None:
        """Look at the network for this panel, until ``unwatch`` or its end."""
        key = id(watcher)
        if key in self._watchers:
            return
        self._watchers.add(key)
        watcher.destroyed.connect(lambda: self._drop(key))
        if self._watch is None:
            self._watch = NetworkWatch(self._find_network)
            self._watch.start()
        self._timer.start()

    def unwatch(self, watcher: QObject) -> None:
        """This panel is hidden: look no more for it."""
        self._drop(id(watcher))

    def _drop(self, key: int) -> None:
        self._watchers.discard(key)
        if not self._watchers and self._watch is not None:
            try:
                self._timer.stop()
                self._lingering.start()
            except RuntimeError:  # the window went, and its timers before us
                self._watch.stop()

    def _on_lingered(self) -> None:
        if not self._watchers and self._watch is not None:
            self._watch.stop()
            self._watch = None

    def _on_look(self) -> None:
        if self._watch is not None and self._watch.latest is not self.seen:
            self.seen = self._watch.latest
            self.changed.emit(self.seen)


def feed_of(owner: QObject, find_network: Callable[[], Network | None]) -> NetworkFeed:
    """The one feed of a window, which both its panels share."""
    found = owner.findChild(NetworkFeed)
    return found if found is not None else NetworkFeed(find_network, owner)
