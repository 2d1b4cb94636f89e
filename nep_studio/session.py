"""A running project: master, nodes and program started, watched and stopped; no Qt in here."""

from __future__ import annotations

import contextlib
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec

from nep_core import messages as m
from nep_core.launcher import LaunchedNode, Launcher
from nep_core.manifest import Value
from nep_core.outcome import Outcome
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Subscriber
from nep_studio.own_master import start_master
from nep_studio.plan import REPLAY, PlannedNode
from nep_studio.problems import Problem
from nep_studio.signals import postponed, undisturbed
from nep_studio.voice import Voice

PROGRAM = "program"
STUDIO = "studio"
ASK_TO_END_S = 1.0
LAST_RULES_S = 2.0
"""How long a rule that a recording's end set off may still take."""
SIGNALS_S = 0.2
"""How long Python may wait at once: a signal can miss a wait that is just beginning."""
LAST_WORDS_S = 0.3
"""How long a program's last message may take, which is not always quicker than its end."""

HEARD = (
    m.NODE_STATE,
    m.HUMAN_BEHAVIOR,
    m.ACTION_REQUEST,
    m.ACTION_RESULT,
    m.PROGRAM_STATE,
)

Listener = Callable[[str, msgspec.Struct], None]
"""Called with each message of the network and its topic, from several threads."""


@dataclass(frozen=True)
class Ending:
    """How a session ended: well, or with a problem; ``line`` of the program, 0 where none is."""

    problem: Problem | None = None
    line: int = 0


class Session:
    """Starts the parts of a project and keeps them running until the program ends.

    Use it in a ``with`` statement: entering raises NepError when a part cannot start, leaving
    stops the robots first and then everything else.
    """

    def __init__(
        self,
        program: Path,
        nodes: list[PlannedNode],
        listener: Listener,
        *,
        logs: Path | None = None,
        master: str | None = None,
    ) -> None:
        self._wanted_master = master
        self._program = program
        self._nodes = nodes
        self._listener = listener
        self._ending: Ending | None = None
        self._failure: m.ProgramState | None = None
        self._may_begin = False
        self._changed = threading.Condition()
        self._stack = contextlib.ExitStack()
        self._voice: Voice | None = None
        self._launcher = Launcher(logs=logs, on_end=self._on_end)
        self._master_launcher = Launcher(logs=logs, on_end=self._on_end)

    def wait(self, seconds: float | None = None) -> Ending:
        """Wait until the program ends, or for so long; how it ended."""
        deadline = math.inf if seconds is None else time.monotonic() + seconds
        with self._changed:
            while self._ending is None and (left_s := deadline - time.monotonic()) > 0:
                self._changed.wait(min(left_s, SIGNALS_S))
            return self._ending or Ending()

    def end(self, ending: Ending | None = None) -> None:
        """Let wait() return; only the first ending counts."""
        with self._changed:
            self._ending = self._ending or ending or Ending()
            self._changed.notify_all()

    def stop(self) -> None:
        """Stop the robots at once, then the program, then all nodes; the master goes last."""
        try:
            with undisturbed():
                self._stop_program()
        finally:
            with undisturbed():
                self._stack.close()

    def __enter__(self) -> Session:
        try:
            self._open_network()
            self._start_nodes([node for node in self._nodes if not node.is_sensory])
            self._start_program()
            self._start_nodes([node for node in self._nodes if node.is_sensory])
            self._begin_program()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_error: object) -> None:
        self.stop()

    def _open_network(self) -> None:
        """Start the master and join it; what is opened first is closed last."""
        self._stack.callback(self._master_launcher.close)
        self._launcher.master = start_master(self._master_launcher, self._wanted_master)
        network = self._stack.enter_context(PeerNetwork(STUDIO, master=self._launcher.master))
        self._voice = Voice(network)
        self._stack.callback(self._voice.fall_silent)
        self._stack.callback(self._launcher.close)
        self._launcher.hear(network)
        for topic in HEARD:
            self._hear(topic, network)

    def _start_nodes(self, nodes: list[PlannedNode]) -> None:
        with postponed():
            started = [self._launcher.launch(one.node, one.name, one.parameters) for one in nodes]
        for launched in started:
            launched.wait_ready()

    def _start_program(self) -> None:
        """Let the program listen, but not act yet: no robot moves before every node is there."""
        settings: dict[str, Value] = {"file": str(self._program), "hold": True}
        with postponed():
            launched = self._launcher.launch(
                "cognitive/program", PROGRAM, settings, restart_on_error=False
            )
        launched.wait_ready()

    def _begin_program(self) -> None:
        self._may_begin = True
        if self._voice is not None:
            self._voice.start_program()

    def _stop_program(self) -> None:
        if self._voice is not None:
            self._voice.stop_robots()
            self._voice.stop_program()
        program = self._launcher.nodes.get(PROGRAM)
        if program is not None and program.process is not None:
            program.stopping = True
            program.process.wait(ASK_TO_END_S)

    def _hear(self, topic: str, network: PeerNetwork) -> None:
        def callback(message: msgspec.Struct) -> None:
            if isinstance(message, m.ProgramState):
                self._note_failure(message)
            elif isinstance(message, m.NodeState):
                self._note_restart(message)
            self._listener(topic, message)

        Subscriber(topic, m.BY_TOPIC[topic], network=network, callback=callback)

    def _note_restart(self, state: m.NodeState) -> None:
        """A program that was killed and started again waits to be told to begin."""
        if self._may_begin and (state.node, state.event) == (PROGRAM, "ready"):
            self._begin_program()

    def _note_failure(self, state: m.ProgramState) -> None:
        if state.event == "failed" and state.program == PROGRAM:
            with self._changed:
                self._failure = state
                self._changed.notify_all()

    def _on_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if self._voice is not None and not outcome.was_successful:
            self._voice.tell_end(launched, outcome, again)
        if again or outcome.asked:
            return
        if launched.name == PROGRAM:
            self.end(self._program_ending(outcome))
        elif launched.manifest is not None and launched.manifest.id == REPLAY:
            self._end_soon(_replay_ending(outcome))

    def _program_ending(self, outcome: Outcome) -> Ending:
        if outcome.was_successful:
            return Ending()
        with self._changed:
            self._changed.wait_for(lambda: self._failure is not None, LAST_WORDS_S)
            failure = self._failure
        sentence, line = (failure.description, failure.line) if failure else (f"{outcome}.", 0)
        title = "The program stopped with an error"
        return Ending(Problem(title, sentence, outcome.checklist), line)

    def _end_soon(self, ending: Ending) -> None:
        timer = threading.Timer(LAST_RULES_S, self.end, [ending])
        timer.daemon = True
        timer.start()


def _replay_ending(outcome: Outcome) -> Ending:
    if outcome.was_successful:
        return Ending()
    return Ending(Problem("The recording stopped", f"{outcome}.", outcome.checklist))
