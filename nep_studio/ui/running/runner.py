"""Runs the open project in the window: what state it is in, and what is heard meanwhile."""

from __future__ import annotations

import logging
import queue
import tempfile
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import msgspec
from PySide6.QtCore import QObject, QThread, QTimer, Signal

from faults import reason_of, text_of
from nep_core.errors import NepError
from nep_core.networks.network import Network
from nep_core.processes.node_log import log_file_name
from nep_core.wire import messages as m
from nep_core.wire.pubsub import Publisher
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.generate.program import ProgramGenerator
from nep_studio.blocks.generate.source_map import Code
from nep_studio.blocks.program import Changes
from nep_studio.problems import Problem, problem_of
from nep_studio.run.local_network import MASTER, LocalNetwork
from nep_studio.run.node_board import Monitor, NodeBoard
from nep_studio.run.plan import PlannedNode
from nep_studio.run.session import Ending, Session, Watching
from nep_studio.ui.workbench.live_checks import SlicedCall

from .tap import Tap

log = logging.getLogger(__name__)


# One run of a program: its session, in a thread of its own.


@dataclass(frozen=True)
class Request:
    """What is to be run: the code, the nodes that it needs, and how it is watched."""

    code: Code
    nodes: tuple[PlannedNode, ...]
    watching: Watching = field(default_factory=Watching)


class Play(QThread):
    """Runs until the program ends or ``end`` is called; ``ending`` then tells how it went."""

    begun = Signal()

    def __init__(self, request: Request, network: LocalNetwork) -> None:
        super().__init__()
        self.request = request
        self.ending = Ending()
        self.session = Session(
            Path(), list(request.nodes), _ignore, network=network, watching=request.watching
        )

    def run(self) -> None:
        """Start everything, wait for the end, stop everything."""
        try:
            self.ending = self._play()
        except NepError as error:
            self.ending = Ending(problem_of(error))
        except OSError as error:
            self.ending = Ending(_disk_problem(error))
        except Exception as error:
            log.exception("the program could not be run")
            sentence = f"{type(error).__name__}: {error}"
            steps = ("Try it once more.", "Save the project, and start NEP Studio again.")
            self.ending = Ending(Problem("The program could not be started", sentence, steps))

    def _play(self) -> Ending:
        with tempfile.TemporaryDirectory(prefix="nep-", ignore_cleanup_errors=True) as folder:
            program = Path(folder) / "program.py"
            program.write_text(self.request.code.text, encoding="utf-8")
            self.session.use_program(program)
            with self.session as session:
                self.begun.emit()
                return session.wait()

    def end(self) -> None:
        """Stop the robots at once; the rest follows in the thread. Does not wait."""
        self.session.hush()
        self.session.end()


def _ignore(*_message: object) -> None:
    """The window hears the network itself."""


def _disk_problem(error: OSError) -> Problem:
    return Problem(
        "The program could not be written",
        text_of("The computer says: {reason}.", reason=reason_of(error)),
        (
            "Is there room on the disk?",
            "May this program write into the folder for temporary files?",
        ),
        details=str(error),
    )


# Messages that are sent by hand, from a thread of their own: a first one may have to wait.

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


State = Literal["idle", "starting", "running", "paused", "stopping"]
LOOK_MS = 250
"""How often it is looked whether a node has fallen silent."""
SLEPT_S = 2.0
"""When it was not looked for so long, the computer was asleep, and the nodes with it."""


class Runner(QObject):
    """The window's door to a running program and its nodes; nothing in here waits.

    ``arrived`` gives (topic, message) pairs of what was heard, at most 30 times a second;
    ``node_failed`` the NepError of a node that could not be started by hand; ``master_changed``
    what became of a master that ended unexpectedly (a MasterEvent), and how it ended; ``closing``
    that all is about to end.
    """

    state_changed = Signal(str)
    run_asked = Signal()
    connected = Signal()
    disconnected = Signal()
    arrived = Signal(list)
    nodes_changed = Signal(list)
    ended = Signal(object)
    node_failed = Signal(str, object)
    master_changed = Signal(str, object)
    closing = Signal()
    _came_up = Signal()

    def __init__(
        self,
        planned: Callable[[], list[PlannedNode]],
        parent: QObject,
        *,
        logs: Path | None = None,
    ) -> None:
        super().__init__(parent)
        self.planned = planned
        self.board = NodeBoard()
        self.state: State = "idle"
        self.local = LocalNetwork(logs=logs)
        self.local.listen(self._on_message)
        self.local.on_open = self._came_up.emit
        self.local.on_master = self.master_changed.emit
        self.told_elsewhere: set[str] = set()
        """Nodes of which a dialog tells what becomes of them: no message is needed."""
        self.play: Play | None = None
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
        return self.local.is_open

    def run(self) -> None:
        """Ask for the open project to be run, or run again; a paused one goes on."""
        if self.state == "paused":
            self.resume()
        elif self.state in ("idle", "running"):
            self.run_asked.emit()

    def start(self, request: Request) -> None:
        """Run this, which has been checked; ``ended`` tells how it went."""
        if self.state != "idle" or self._is_closed:
            return
        self._set_state("starting")
        play = self.play = Play(request, self.local)
        play.begun.connect(self._on_begun)
        play.finished.connect(self._on_over)
        play.start()

    def stop(self) -> None:
        """Stop the robots at once, then the program, then what was started for it."""
        if self.play is not None and self.state not in ("idle", "stopping"):
            self._set_state("stopping")
            self.play.end()

    def pause(self) -> None:
        """Let the program pause at its next lines."""
        if self.play is not None and self.state == "running":
            self.play.session.pause()
            self._set_state("paused")  # parts that are waiting only tell when they go on

    def resume(self) -> None:
        """Let a paused program go on."""
        if self.play is not None and self.state == "paused":
            self.play.session.resume()
            self._set_state("running")

    def step(self, thread: str = "") -> None:
        """Let a paused program run one line more."""
        if self.play is not None and self.state == "paused":
            self.play.session.step(thread)

    def watch(self, watching: Watching) -> None:
        """Pause elsewhere, or go at another pace, from now on."""
        if self.play is not None and self.state in ("starting", "running", "paused"):
            self.play.session.watch(watching)

    # The nodes

    def start_node(self, planned: PlannedNode) -> None:
        """Start a node; the network first, if it is not up."""

        def start() -> None:
            self.local.open()
            for launched in self.local.start([planned]):
                launched.wait_ready()

        self._aside(planned.name, start)

    def open_network(self) -> None:
        """Open the network, or start its master again when that is gone."""
        self._aside(MASTER, self.local.open)

    def stop_node(self, name: str) -> None:
        """Stop a node that was started here."""
        self._aside(name, lambda: self.local.stop(name))

    def restart_node(self, name: str) -> None:
        """Stop a node and start it again as it was."""
        if name in self.local.planned:
            self._aside(name, lambda: self.local.restart(name).wait_ready())

    def is_ours(self, name: str) -> bool:
        """Whether a node was started here, and can be stopped and started here."""
        return name in self.local.planned

    def log_of(self, name: str) -> list[str]:
        """The last lines that a node wrote; at most 200."""
        return self.local.log_of(name)

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
        tap.listen(self.local.network)
        return tap

    def send(self, topic: str, message: msgspec.Struct | dict[str, Any]) -> bool:
        """Send a message by hand; False when there is no network."""
        return self._sender.send(self.local.network, topic, message)

    def close(self) -> None:
        """Stop everything and wait for it; before the window goes. Nothing starts after it."""
        self._is_closed = True
        self.closing.emit()
        if self.play is not None:
            self.play.end()
            self.play.wait()
        self._looking.stop()
        for tap in list(self._taps):
            tap.close()
        self._sender.close()
        self.local.close()
        self._monitor.end()

    def _forget(self, tap: Tap) -> None:
        if tap in self._taps:
            self._taps.remove(tap)

    def _aside(self, name: str, do: Callable[[], None]) -> None:
        """Do what takes a while in a thread of its own."""

        def run() -> None:
            try:
                if not self._is_closed:
                    do()
            except NepError as error:
                if not self._is_closed:  # else nobody is there to be told
                    self.node_failed.emit(name, error)

        threading.Thread(target=run, name=f"nep-studio-{name}", daemon=True).start()

    # What happens

    def _on_message(self, topic: str, message: msgspec.Struct) -> None:
        self._monitor.hear((topic, message))  # in a thread of the network

    def _on_begun(self) -> None:
        if self.state == "starting":
            self._set_state("running")

    def _on_over(self) -> None:
        play = self.play
        if play is None:
            return
        play.wait()  # its very last breath: to throw a running thread away is fatal
        self.play = None
        self._set_state("idle")
        self.ended.emit(play.ending)

    def _on_came_up(self) -> None:
        self._looking.start()
        self._monitor.start()
        for tap in self._taps:
            tap.listen(self.local.network)
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
                    self._note(message)
            self.arrived.emit(batch)
        finally:
            self._monitor.taken()

    def _note(self, state: m.ProgramState) -> None:
        if state.event == "paused" and self.state == "running":
            self._set_state("paused")

    def _on_look(self) -> None:
        now_s, before_s = time.time(), self._looked_s
        self._looked_s = now_s
        if not 0 <= now_s - before_s < SLEPT_S:
            self.board.wake(now_s)
        if frozen := self.board.frozen(now_s):
            self.nodes_changed.emit(frozen)

    def _set_state(self, state: State) -> None:
        if state != self.state:
            self.state = state
            self.state_changed.emit(state)


# Makes the Python of a program between frames: for thousands of blocks it takes a while.

SLICE_S = 0.008
BETWEEN_SLICES_MS = 1


class Preparation(QObject):
    """``done`` gives the code, ``refused`` the BlocksError that says why there is none.

    When the program is changed meanwhile, it begins again with what has changed.
    """

    done = Signal(object)
    refused = Signal(object)

    def __init__(self, editor: Editor, parent: QObject) -> None:
        super().__init__(parent)
        self._editor = editor
        self._generator = ProgramGenerator(editor.project, editor.language)
        self._next = QTimer(self, singleShot=True, interval=BETWEEN_SLICES_MS)
        self._next.timeout.connect(self._on_next_slice)
        self._call = self._begin()
        editor.history.listen(self._on_changes)
        self._next.start()

    def cancel(self) -> None:
        """Give it up."""
        self._end()
        self._call.cancel()

    def _begin(self) -> SlicedCall[Code]:
        generator = self._generator

        def work(rest: Callable[[], None]) -> Code:
            return generator.generate(rest)

        return SlicedCall(work)

    def _end(self) -> None:
        self._next.stop()
        self._editor.history.unlisten(self._on_changes)
        self.deleteLater()

    def _on_changes(self, _changes: Changes) -> None:
        self._call.cancel()
        self._call = self._begin()

    def _on_next_slice(self) -> None:
        if not self._call.run(SLICE_S):
            self._next.start()
            return
        self._end()
        try:
            code = self._call.result()
        except BlocksError as error:
            self.refused.emit(error)
        else:
            self.done.emit(code)
