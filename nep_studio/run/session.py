"""A running project: nodes and program started, watched and stopped; no Qt in here."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path

import msgspec

from faults import Text, fault_of, text_of
from nep_core.processes.launcher import LaunchedNode
from nep_core.processes.manifest import Value
from nep_core.processes.node_log import BUSY_S, busy_line
from nep_core.processes.process import Outcome
from nep_core.wire import messages as m
from nep_studio.problems import Problem

from .local_network import LocalNetwork
from .plan import PROGRAM, REPLAY, Ending, PlannedNode, Watching

ASK_TO_END_S = 1.0
LAST_RULES_S = 2.0
"""How long a rule that a recording's end set off may still take."""
HANG_LOOK_S = 0.5
LAST_WORDS_S = 0.3
"""How long a program's last message may take, which is not always quicker than its end."""


class Session:
    """Starts the parts of a project and keeps them running until the program ends.

    Use it in a ``with`` statement, once the file of its ``program`` is known: entering raises
    NepError when a part cannot start, leaving stops the robots first and then everything that it
    started; the network stays open. With ``watching`` the program tells of each of its lines.
    """

    def __init__(
        self,
        nodes: Sequence[PlannedNode],
        network: LocalNetwork,
        *,
        program: Path = Path(),
        kept: Path | None = None,
        watching: Watching | None = None,
    ) -> None:
        self.network = network
        self.program = program
        """The file that it runs; it may be another until the session is entered."""
        self._kept = kept
        self._nodes = nodes
        self._watching = watching
        self._ending: Ending | None = None
        self._failure: m.ProgramState | None = None
        self._may_begin = False
        self._changed = threading.Condition()
        self._is_over = threading.Event()
        self._started: list[str] = []

    def wait(self, seconds: float | None = None) -> Ending:
        """Wait until the program ends, or for so long; how it ended."""
        self._is_over.wait(seconds)
        return self._ending or Ending()

    def end(self, ending: Ending | None = None) -> None:
        """Let wait() return, and a start that is under way be given up; the first ending counts."""
        with self._changed:
            self._ending = self._ending or ending or Ending()
            self._is_over.set()  # wait() may go on: the ending is there
            self._changed.notify_all()

    def stop_robots(self) -> None:
        """Stop the robots and ask the program to end; waits for nothing."""
        voice = self.network.voice
        if voice is not None:
            voice.stop_robots()
            voice.say(m.ProgramControl(command="stop"))

    def stop(self) -> None:
        """Stop the robots at once, then the program, then all nodes."""
        try:
            self.stop_robots()
            program = self.network.launcher.nodes.get(PROGRAM)
            if program is not None and program.process is not None:
                program.stopping = True
                program.process.wait(ASK_TO_END_S)
        finally:
            started, self._started = self._started, []
            self.network.launcher.stop(*reversed(started))
            self.network.unlisten(self._on_message, self._on_end)

    def watch(self, watching: Watching) -> None:
        """Pause at other lines, or go at another pace, from now on."""
        self._watching = watching
        self.order("set")

    def order(self, command: m.ProgramCommand, thread: str = "") -> None:
        """Let the program, or one part of it, do something: pause, resume, step."""
        voice, watching = self.network.voice, self._watching or Watching()
        if voice is not None:
            order = m.ProgramControl(
                command=command,
                program=PROGRAM,
                thread=thread,
                breakpoints=list(watching.breakpoints),
                line_s=watching.line_s,
            )
            voice.say(order)

    def __enter__(self) -> Session:
        for planned in self._nodes:
            self.network.gate.check_node(planned)
        self.network.gate.check_program(self.program)
        self.network.listen(self._on_message, self._on_end)
        try:
            self.network.open()
            self._start_nodes([node for node in self._nodes if not node.is_sensory])
            if not self._is_over.is_set():
                # It listens, but does not act yet: no robot moves before every node is there
                settings: dict[str, Value] = {"file": str(self.program), "hold": True}
                if self._kept is not None:
                    settings["kept"] = str(self._kept)
                if self._watching is not None:
                    settings["trace"] = True
                launcher, kind = self.network.launcher, "cognitive/program"
                launched = launcher.launch(kind, PROGRAM, settings, restart="on-kill")
                self._started.append(PROGRAM)
                launched.wait_ready(given_up=self._is_over)
            self._start_nodes([node for node in self._nodes if node.is_sensory])
            self._begin_program()
            threading.Thread(target=self._look_for_hangs, name="nep-hangs", daemon=True).start()
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_error: object) -> None:
        self.stop()

    def _start_nodes(self, nodes: Sequence[PlannedNode]) -> None:
        if self._is_over.is_set():
            return
        running = {
            name for name, one in self.network.launcher.nodes.items() if not one.ended.is_set()
        }
        self._started += [node.name for node in nodes if node.name not in running]
        for launched in self.network.start(nodes):
            launched.wait_ready(given_up=self._is_over)

    def _begin_program(self) -> None:
        if self._is_over.is_set():
            return
        self._may_begin = True
        if self._watching is not None:
            self.order("set")
        self.order("start")

    def _look_for_hangs(self) -> None:
        """Tell of a call in the program that holds it up, which it cannot tell by itself."""
        told = 0
        while not self._is_over.wait(HANG_LOOK_S):
            line = busy_line(self.network.log_of(PROGRAM), str(self.program))
            if line and line != told:
                fault = fault_of(
                    "The program has been busy with this block for {seconds} s, and does nothing "
                    "else.",
                    code="busy",
                    checklist=(
                        "Stop it, or wait: perhaps the computation comes to an end.",
                        "Are the numbers very large, or the list or text very long?",
                    ),
                    seconds=f"{BUSY_S:g}",
                )
                state = m.ProgramState(program=PROGRAM, event="warning", line=line, **m.told(fault))
                self.network.tell(m.PROGRAM_STATE, state)
            told = line

    def _on_message(self, _topic: str, message: msgspec.Struct) -> None:
        match message:
            case m.ProgramState(event="failed") if message.program == PROGRAM:
                with self._changed:
                    self._failure = message
                    self._changed.notify_all()
            case m.NodeState(event="ready") if message.node == PROGRAM and self._may_begin:
                self._begin_program()  # it was killed and started again, and waits to be told

    def _on_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if launched.name == PROGRAM and again and self.network.voice is not None:
            self.network.voice.stop_robots()  # it begins anew, and they with it
        if again or outcome.asked:
            return
        if launched.name == PROGRAM:
            self.end(self._program_ending(outcome))
        elif launched.manifest is not None and launched.manifest.id == REPLAY:
            timer = threading.Timer(LAST_RULES_S, self.end, [_replay_ending(outcome)])
            timer.daemon = True
            timer.start()

    def _program_ending(self, outcome: Outcome) -> Ending:
        if outcome.was_successful:
            return Ending()
        with self._changed:
            self._changed.wait_for(lambda: self._failure is not None, LAST_WORDS_S)
            failure = self._failure
        title = "The program stopped with an error"
        if failure is None:
            return Ending(Problem(title, _sentence(outcome), outcome.checklist))
        fault = failure.fault
        steps = fault.checklist or outcome.checklist
        return Ending(Problem(title, fault.sentence, steps), failure.line)


def _replay_ending(outcome: Outcome) -> Ending:
    if outcome.was_successful:
        return Ending()
    return Ending(Problem("The recording stopped", _sentence(outcome), outcome.checklist))


def _sentence(outcome: Outcome) -> Text:
    return text_of("{outcome}.", outcome=outcome.text)
