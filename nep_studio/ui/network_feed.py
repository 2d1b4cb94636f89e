"""What is seen of a network, brought to the panels that somebody looks at."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.ui.host import Host

if TYPE_CHECKING:
    from nep_core.networks.network import Network

    from .network_watch import NetworkWatch

# What is seen of a network at one moment: its nodes and topics, with what goes through.

Route = tuple[str, str]
"""The name of a node and a topic that it publishes."""


@dataclass(frozen=True)
class Use:
    """What a process and those that it started take: percent of one core, bytes of memory."""

    cpu_percent: float
    memory_bytes: int


@dataclass(frozen=True)
class Flow:
    """Messages of a node on a topic: how many a second now, how many since it is watched."""

    rate_hz: float = 0.0
    count: int = 0


@dataclass(frozen=True)
class NodeSeen:
    """A node that is registered; ``use`` is None for one on another computer."""

    name: str
    publishes: tuple[str, ...] = ()
    hears: tuple[str, ...] = ()
    pid: int = 0
    use: Use | None = None
    rate_hz: float = 0.0


@dataclass(frozen=True)
class TopicSeen:
    """A topic; ``lost`` counts what was sent but did not arrive in the studio.

    ``last_s`` is when its last message was sent (time.time()), 0 when none was heard yet.
    """

    name: str
    publishers: tuple[str, ...] = ()
    subscribers: tuple[str, ...] = ()
    rate_hz: float = 0.0
    count: int = 0
    lost: int = 0
    last_s: float = 0.0
    last: Any = None


@dataclass(frozen=True)
class Seen:
    """A whole network, by names; ``is_up`` is False when there is none."""

    is_up: bool = False
    nodes: Mapping[str, NodeSeen] = field(default_factory=dict)
    topics: Mapping[str, TopicSeen] = field(default_factory=dict)
    flows: Mapping[Route, Flow] = field(default_factory=dict)


# What is seen of the network, brought to the panels that are visible.

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
            from .network_watch import NetworkWatch  # loaded when somebody looks

            watch = self._watch = NetworkWatch(self._find_network)
            self.destroyed.connect(watch.stop)  # its thread ends with the window, too
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


def feed_of(host: Host) -> NetworkFeed:
    """The one feed, which all panels share."""
    running, runner = host.services.running, host.services.runner
    return host.shared(NetworkFeed, lambda: NetworkFeed(lambda: runner.network, running))
