"""Runs the open project in the window: what state it is in, and what is heard meanwhile."""

from __future__ import annotations

import logging
import queue
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.errors import NepError
from nep_core.processes.node_log import log_file_name
from nep_core.wire import messages as m
from nep_studio.run.controller import (
    PREPARING,
    Ended,
    Event,
    Request,
    RunController,
    State,
    StateChanged,
    Subject,
)
from nep_studio.run.gate import Gate, NotApproved, node_concern
from nep_studio.run.node_board import Monitor, NodeBoard
from nep_studio.run.plan import MASTER, PlannedNode
from nep_studio.ui.background import Background

if TYPE_CHECKING:
    from nep_core.networks.network import Network
    from nep_core.processes.launcher import LaunchedNode
    from nep_core.wire.pubsub import Publisher, Subscriber
    from nep_studio.run.local_network import LocalNetwork

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
        self._inlets: list[_Inlet] = []  # one, or none
        self._lost = 0
        self._is_closed = False
        monitor, inlets = self._monitor, self._inlets
        self.destroyed.connect(lambda: _end(monitor, inlets))

    @property
    def dropped(self) -> int:
        """How many messages came too fast to be shown."""
        return self._monitor.dropped

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive."""
        return self._lost + sum(ear.lost for ear in self._inlets)

    def listen(self, network: Network | None) -> None:
        """Hear this network from now on; None: nothing."""
        while self._inlets:
            ear = self._inlets.pop()
            self._lost += ear.lost
            ear.close()
        if network is not None and not self._is_closed:
            self._inlets.append(_Inlet(self.topic, self.kind, network, self._monitor))

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
            self._monitor.may_send.set()


def _end(monitor: Monitor, inlets: list[_Inlet]) -> None:
    """End what a tap leaves that went with its parent."""
    while inlets:
        inlets.pop().close()
    monitor.end()


class _Inlet:
    """A subscriber in a thread of its own: to open it may take a second."""

    def __init__(
        self, topic: str, kind: type[Any] | None, network: Network, monitor: Monitor
    ) -> None:
        self._topic, self._kind, self._network, self._monitor = topic, kind, network, monitor
        self._subscriber: Subscriber[Any] | None = None
        self._lock = threading.Lock()
        self._is_closed = False
        threading.Thread(target=self._hear, name=f"nep-tap-{topic}", daemon=True).start()

    @property
    def lost(self) -> int:
        """How many messages were sent but did not arrive."""
        return self._subscriber.lost if self._subscriber is not None else 0

    def close(self) -> None:
        """Hear no more."""
        with self._lock:
            self._is_closed = True
            if self._subscriber is not None:
                self._subscriber.close()

    def _hear(self) -> None:
        from nep_core.wire.pubsub import Subscriber  # loaded with the network

        try:
            subscriber = Subscriber[Any](self._topic, self._kind, network=self._network)
        except NepError:
            return  # the network was closed meanwhile
        with self._lock:
            self._subscriber = subscriber
            if self._is_closed:
                subscriber.close()
                return
        for message in subscriber:
            header = subscriber.header
            sent_s, sender = (header.time_ns / 1e9, header.node) if header else (0.0, "")
            self._monitor.hear(Heard(sent_s, message, sender))


# Messages that are sent by hand, from a thread of their own: a first one may have to wait.

Sent = tuple["Network", str, msgspec.Struct | dict[str, Any]]


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
            from nep_core.wire.pubsub import Publisher  # loaded with the network

            self._publishers[topic] = Publisher(topic, network=network)
        return self._publishers[topic]


SLICE_S = 0.006
"""How long the checks, or the code, may take of one frame of the screen."""

BETWEEN_SLICES_MS = 1
LOOK_MS = 250
"""How often it is looked whether a node has fallen silent."""
SLEPT_S = 2.0
"""When it was not looked for so long, the computer was asleep, and the nodes with it."""


class Runner(QObject):
    """The window's door to a running program and its nodes; nothing in here waits.

    What it does with the program is the RunController's doing; ``told`` gives its Events.
    ``arrived`` gives (topic, message) pairs of what was heard, at most 30 times a second: of nodes,
    of human states, of actions and of the program; a ``tap`` hears any other topic.
    ``nodes_changed`` gives the names of nodes of which ``board`` knows something new, also that
    they ended. ``connected`` comes when the network is up; ``disconnected`` only when it is
    about to be started anew, to be shared or joined: not at the end of a run.
    ``node_failed`` gives the NepError of a node that could not be started by hand;
    ``approval_needed`` the Concerns of one that nobody has approved, and what starts it then;
    ``master_changed`` what became of a master that ended unexpectedly (a MasterEvent), and how it
    ended; ``network_made`` that ``local`` is there, which is made when it is first needed: its
    modules take a while to load. ``closing`` tells that all is about to end.
    """

    state_changed = Signal(str)
    told = Signal(object)
    run_asked = Signal()
    connected = Signal()
    disconnected = Signal()
    arrived = Signal(list)
    nodes_changed = Signal(list)
    ended = Signal(object)
    node_failed = Signal(str, object)
    approval_needed = Signal(object, object)
    master_changed = Signal(str, object)
    network_made = Signal(object)
    closing = Signal()
    _came_up = Signal()

    def __init__(
        self,
        planned: Callable[[], list[PlannedNode]],
        parent: QObject,
        *,
        subject: Callable[[], Subject | None] = lambda: None,
        logs: Path | None = None,
    ) -> None:
        super().__init__(parent)
        self.planned = planned
        self.board = NodeBoard()
        self._background = Background(self)
        self.gate = Gate()
        """What passes it may be started."""
        self._local: LocalNetwork | None = None
        self._logs = logs
        self.keep_own: Callable[[], None] = lambda: None
        """Approves what the person has written in the open project, before any of it starts."""
        self.told_elsewhere: set[str] = set()
        """Nodes of which a dialog tells what becomes of them: no message is needed."""
        self.controller = RunController(
            lambda: self.local, subject, self._background.post, self._on_told
        )
        self._preparing = QTimer(self, interval=BETWEEN_SLICES_MS)
        self._preparing.timeout.connect(lambda: self.controller.work(SLICE_S))
        self.state: State = "idle"
        """What the program does; while it is only checked and written, it does nothing yet."""
        self._is_closed = False
        self._looked_s = 0.0
        self._sender = Sender()
        self._taps: list[Tap] = []
        self._monitor = Monitor()
        self._monitor.arrived.connect(self._on_arrived)
        self._came_up.connect(self._on_came_up)
        self._looking = QTimer(self, interval=LOOK_MS)
        self._looking.timeout.connect(self._on_look)

    # The program

    @property
    def is_connected(self) -> bool:
        """Whether messages can be sent and heard."""
        return self.network is not None

    @property
    def network(self) -> Network | None:
        """The network while it is open."""
        return None if self._local is None else self._local.network

    @property
    def local(self) -> LocalNetwork:
        """The network of this window, open or not, and the nodes it started."""
        if self._local is None:
            from nep_studio.run.local_network import LocalNetwork

            self._local = LocalNetwork(logs=self._logs, gate=self.gate)
            self._local.listen(self._on_message)
            self._local.on_open = self._came_up.emit
            self._local.on_master = self.master_changed.emit
            if self._is_closed:
                self._local.close(for_good=True)
            self.network_made.emit(self._local)
        return self._local

    @property
    def started(self) -> Mapping[str, PlannedNode]:
        """The nodes that were asked for here, by name."""
        return {} if self._local is None else self._local.planned

    @property
    def running(self) -> list[PlannedNode]:
        """Those of them that run now, as they were started."""
        return [] if self._local is None else self._local.running

    def run(self) -> None:
        """Run what is open, or run it again; a paused program goes on."""
        if self.state in ("idle", "running"):
            self.run_asked.emit()
        self.controller.run()

    def begin(self, subject: Subject, request: Request) -> bool:
        """Run this, which was made of a project; False while a person has to approve it first."""
        self.keep_own()
        return self.controller.begin(subject, request)

    def stop(self) -> None:
        """Stop the robots at once, then the program, then what was started for it."""
        self.controller.stop()

    def pause(self) -> None:
        """Let the program pause at its next lines."""
        self.controller.pause()

    def step(self, thread: str = "") -> None:
        """Let a paused program run one line more."""
        self.controller.step(thread)

    # The nodes

    def start_node(self, planned: PlannedNode, *, is_wanted: bool = False) -> None:
        """Start a node; the network first, if it is not up.

        One that ``is_wanted`` has its settings from the person, just now, and not from a project.
        """
        self.keep_own()
        if is_wanted:
            self.gate.vouch_for(planned)
        local = self.local

        def start() -> None:
            local.open()
            for launched in local.start([planned]):
                launched.wait_ready()

        self._aside(planned.name, start)

    def strange(self, nodes: Iterable[PlannedNode]) -> frozenset[str]:
        """The names of those that nobody has approved: even a look at them would be a start."""
        self.keep_own()
        found = ((node.name, node_concern(node)) for node in nodes)
        return frozenset(
            name for name, one in found if one is not None and self.gate.unapproved([one])
        )

    def is_as_in_project(self, wanted: PlannedNode) -> bool:
        """Whether it reaches just what a node of the project does that nobody has approved."""
        self.keep_own()
        one = node_concern(wanted)
        if one is None or not self.gate.unapproved([one]):
            return False
        found = map(node_concern, self.planned())
        return any(other is not None and other.key == one.key for other in found)

    def open_network(self) -> None:
        """Open the network, or start its master again when that is gone."""
        self._aside(MASTER, self.local.open)

    def stop_node(self, name: str) -> None:
        """Stop a node that was started here."""
        local = self.local
        self._aside(name, lambda: local.stop(name))

    def restart_node(self, name: str) -> None:
        """Stop a node and start it again as it was."""
        local = self.local
        if name in local.planned:
            self._aside(name, lambda: local.restart(name).wait_ready())

    def launched(self, name: str) -> LaunchedNode | None:
        """A node that the studio has started, also one that has ended; None for any other."""
        return None if self._local is None else self._local.launcher.nodes.get(name)

    def log_of(self, name: str) -> list[str]:
        """The last lines that a node wrote; at most 200."""
        return [] if self._local is None else self._local.log_of(name)

    def log_file(self, name: str) -> Path:
        """Where all that a node writes is kept."""
        return self.local.logs / log_file_name(name)

    # Messages

    def tap(
        self, topic: str, *, kind: type[Any] | None = None, most: int = 2000, parent: QObject
    ) -> Tap:
        """Hear a topic as long as ``parent`` lives, or until the tap is closed."""
        tap = Tap(topic, kind, most=most, parent=parent)
        self._taps.append(tap)
        tap.destroyed.connect(lambda: self._forget(tap))
        tap.listen(self.network)
        return tap

    def send(self, topic: str, message: msgspec.Struct | dict[str, Any]) -> bool:
        """Send a message by hand; False when there is no network."""
        return self._sender.send(self.network, topic, message)

    def close(self) -> None:
        """Stop everything and wait for it; before the window goes. Nothing starts after it."""
        self._is_closed = True
        self.closing.emit()
        self.controller.close()
        self._looking.stop()
        for tap in list(self._taps):
            tap.close()
        self._sender.close()
        if self._local is not None:
            self._local.close(for_good=True)
        self._monitor.end()

    def _forget(self, tap: Tap) -> None:
        if tap in self._taps:
            self._taps.remove(tap)

    def _aside(self, name: str, do: Callable[[], None]) -> None:
        """Do what takes a while in a thread of its own."""

        def work() -> NepError | None:
            try:
                if not self._is_closed:
                    do()
            except NepError as error:
                return error
            return None

        def tell(error: NepError | None) -> None:
            if error is None or self._is_closed:  # nobody is there to be told
                return
            if isinstance(error, NotApproved) and error.concerns:
                self.approval_needed.emit(error.concerns, lambda: self._aside(name, do))
            else:
                self.node_failed.emit(name, error)

        self._background.start(work, tell, name=name)

    # What happens

    def _on_message(self, topic: str, message: msgspec.Struct) -> None:
        self._monitor.hear((topic, message))  # in a thread of the network

    def _on_told(self, event: Event) -> None:
        """Pass on what the controller tells; those who look hear of no state before the start."""
        before = self.state
        if isinstance(event, StateChanged):
            if event.state in PREPARING:
                self.state = "idle"
                self._preparing.start()
            else:
                self.state = event.state
                self._preparing.stop()
        if self.state != before:
            self.state_changed.emit(self.state)
        self.told.emit(event)
        if isinstance(event, Ended):
            self.ended.emit(event.ending)

    def _on_came_up(self) -> None:
        self._looked_s = time.time()
        self._looking.start()
        self._monitor.start()
        for tap in self._taps:
            tap.listen(self.network)
        self.connected.emit()

    def _on_arrived(self, batch: list[tuple[str, msgspec.Struct]]) -> None:
        try:
            changed = {
                message.node: None
                for _, message in batch
                if isinstance(message, m.NodeState) and message.node != MASTER
                if self.board.update(message, time.time())
            }
            if changed:
                self.nodes_changed.emit(list(changed))
            for _, message in batch:
                if isinstance(message, m.ProgramState):
                    self.controller.heard(message)
            self.arrived.emit(batch)
        finally:
            self._monitor.may_send.set()

    def _on_look(self) -> None:
        now_s, before_s = time.time(), self._looked_s
        self._looked_s = now_s
        if not 0 <= now_s - before_s < SLEPT_S:
            self.board.wake(now_s)
        if frozen := self.board.frozen(now_s):
            self.nodes_changed.emit(frozen)
