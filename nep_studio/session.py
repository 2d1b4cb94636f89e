"""A running project: master, nodes and program started, watched and stopped; no Qt in here."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import msgspec

from nep_core import messages as m
from nep_core.endpoints import master_endpoint
from nep_core.errors import NodeStartError
from nep_core.launcher import LaunchedNode, Launcher
from nep_core.master_probe import ask_master
from nep_core.outcome import Outcome
from nep_core.p2p import PeerNetwork
from nep_core.process import program_command
from nep_core.pubsub import Publisher, Subscriber
from nep_studio.plan import REPLAY, PlannedNode

PROGRAM = "program"
MASTER = "master"
STUDIO = "studio"
MASTER_READY_S = 10.0
MASTER_TRIES = 5
ASK_TO_END_S = 1.0
LAST_RULES_S = 2.0
"""How long a rule that a recording's end set off may still take."""

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
    """How a session ended; ``line`` is a line of the program, 0 where there is none."""

    failed: bool = False
    sentence: str = ""
    line: int = 0
    checklist: tuple[str, ...] = ()


class _Voice:
    """What the session itself says on the network."""

    def __init__(self, network: PeerNetwork) -> None:
        self._states = Publisher(m.NODE_STATE, network=network)
        self._requests = Publisher(m.ACTION_REQUEST, network=network)
        self._control = Publisher(m.PROGRAM_CONTROL, network=network)

    def stop_robots(self) -> None:
        """Stop all that the robots do; waits for nothing."""
        request = m.ActionRequest(id=uuid.uuid4().hex, robots=[], action="stop", priority=100)
        self._requests.send(request)

    def stop_program(self) -> None:
        """Ask the program to end."""
        self._control.send(m.ProgramControl(command="stop"))

    def tell_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        """Say for a node that cannot say it any more how it ended."""
        self._states.send(
            m.NodeState(
                node=launched.name,
                type=launched.manifest.type if launched.manifest else "cognitive",
                event="crashed",
                description=f"{outcome}{'; it is started again' if again else ''}",
                pid=launched.pid,
                host=socket.gethostname(),
            )
        )


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
        self._changed = threading.Condition()
        self._stack = contextlib.ExitStack()
        self._voice: _Voice | None = None
        self._launcher = Launcher(logs=logs, on_end=self._on_end)

    def wait(self, seconds: float | None = None) -> Ending:
        """Wait until the program ends, or for so long; how it ended."""
        with self._changed:
            self._changed.wait_for(lambda: self._ending is not None, seconds)
            return self._ending or Ending()

    def stop(self) -> None:
        """Stop the robots at once, then the program, then all nodes; the master goes last."""
        if self._voice is not None:
            self._voice.stop_robots()
            self._voice.stop_program()
            program = self._launcher.nodes.get(PROGRAM)
            if program is not None and program.process is not None:
                program.stopping = True
                program.process.wait(ASK_TO_END_S)
        self._stack.close()

    def __enter__(self) -> Session:
        self._stack.callback(self._launcher.close)
        try:
            self._start_master()
            network = self._stack.enter_context(PeerNetwork(STUDIO, master=self._launcher.master))
            self._voice = _Voice(network)
            self._launcher.hear(network)
            for topic in HEARD:
                self._hear(topic, network)
            self._start_nodes([node for node in self._nodes if not node.is_sensory])
            self._start_program()
            self._start_nodes([node for node in self._nodes if node.is_sensory])
        except BaseException:
            self.stop()
            raise
        return self

    def __exit__(self, *_error: object) -> None:
        self.stop()

    def _start_master(self) -> None:
        """Start a master of our own; another program may take the port at the same moment."""
        for _ in range(MASTER_TRIES):
            self._launcher.master = self._wanted_master or free_endpoint(master_endpoint())
            command = program_command("master", "--endpoint", self._launcher.master)
            launched = self._launcher.start_command(MASTER, command)
            if self._is_up(launched):
                return
            self._launcher.stop(MASTER)
            if self._wanted_master:
                break
        lines = launched.process.last_lines if launched.process else []
        raise NodeStartError(
            f"The NEP master did not start at {self._launcher.master}.",
            checklist=("Is another program using that port?", "Try again."),
            details="\n".join(lines),
        )

    def _is_up(self, launched: LaunchedNode) -> bool:
        deadline = time.monotonic() + MASTER_READY_S
        while time.monotonic() < deadline and not launched.ended.is_set():
            listing = ask_master(self._launcher.master, timeout_s=0.1)
            if listing is not None and listing.pid == launched.pid:
                return True
        return False

    def _start_nodes(self, nodes: list[PlannedNode]) -> None:
        started = [self._launcher.launch(node.node, node.name, node.parameters) for node in nodes]
        for launched in started:
            launched.wait_ready()

    def _start_program(self) -> None:
        launched = self._launcher.launch(
            "cognitive/program", PROGRAM, {"file": str(self._program)}, restart_on_error=False
        )
        launched.wait_ready()

    def _hear(self, topic: str, network: PeerNetwork) -> None:
        def callback(message: msgspec.Struct) -> None:
            if isinstance(message, m.ProgramState) and message.event == "failed":
                self._failure = message
            self._listener(topic, message)

        Subscriber(topic, m.BY_TOPIC[topic], network=network, callback=callback)

    def _on_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        if self._voice is not None and not outcome.was_successful:
            self._voice.tell_end(launched, outcome, again)
        if again or outcome.asked:
            return
        if launched.name == PROGRAM:
            self._end(self._program_ending(outcome))
        elif launched.manifest is not None and launched.manifest.id == REPLAY:
            threading.Timer(LAST_RULES_S, self._end, [Ending()]).start()

    def _program_ending(self, outcome: Outcome) -> Ending:
        if outcome.was_successful:
            return Ending()
        if self._failure is None:
            return Ending(failed=True, sentence=f"{outcome}.")
        return Ending(failed=True, sentence=self._failure.description, line=self._failure.line)

    def _end(self, ending: Ending) -> None:
        with self._changed:
            self._ending = self._ending or ending
            self._changed.notify_all()


def free_endpoint(wanted: str) -> str:
    """``wanted``, or the same address with a free port when its port is in use."""
    host, _, port = wanted.removeprefix("tcp://").rpartition(":")
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((host, int(port)))
        except OSError:
            probe.bind((host, 0))
        return f"tcp://{host}:{probe.getsockname()[1]}"
