"""Starting nodes by type and name, keeping them running, and stopping them all."""

from __future__ import annotations

import contextlib
import logging
import math
import os
import shutil
import socket
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import psutil

from faults import fault_in
from nep_core.closing import Closing
from nep_core.errors import NameTaken, NepError, NodeStartError
from nep_core.networks.endpoints import MASTER_VARIABLE, master_endpoint
from nep_core.networks.network import Network
from nep_core.places import log_folder, node_folders
from nep_core.wire.messages import NODE_STATE, NodeState, described
from nep_core.wire.pubsub import Publisher, Subscriber

from . import handover
from .guard import GUARD
from .manifest import READY_S, STOP_S, Manifest, NodeCatalog, Restart, Value
from .node import check_node_name
from .node_log import log_file_name
from .process import ASKED, ChildProcess, Outcome, program_command

log = logging.getLogger(__name__)


MOST_RESTARTS = 5
HEALTHY_S = 10.0
LAST_WORD_S = 0.2
QUIET_S = 4.0
"""A node tells each second that it lives: one that was not heard for so long stands still."""
AT_WORK = frozenset(("ready", "running", "busy", "connected", "connection_failed", "disconnected"))
"""What only a node tells that is ready: who hears it late hears the newest of its states alone."""


SLOW_TIMES = 3.0
"""A node that works all the while may take so many times as long: the computer is busy."""
LOOK_S, WORKING_PART = 1.0, 0.03
"""It works when it has used this part of a processor since the last look; waiting takes less."""


class _Patience:
    """How long a node is waited for: longer while it loads on a computer that is busy."""

    def __init__(self, node: LaunchedNode, timeout_s: float) -> None:
        now_s = time.monotonic()
        self._node = node
        self._end_s, self._last_s = now_s + timeout_s, now_s + SLOW_TIMES * timeout_s
        self._used_s: float | None = None

    def is_over(self) -> bool:
        """Whether the time is over, and the node has not worked since the last look."""
        now_s = time.monotonic()
        if now_s < self._end_s:
            return False
        before_s, self._used_s = self._used_s, self._used()
        if before_s is not None and self._used_s - before_s < WORKING_PART * LOOK_S:
            return True
        self._end_s = now_s + LOOK_S
        return now_s >= self._last_s

    def _used(self) -> float:
        """Seconds of a processor; 0 when the process is gone."""
        with contextlib.suppress(psutil.Error):
            times = psutil.Process(self._node.pid).cpu_times()
            return float(times.user + times.system)
        return 0.0


@dataclass
class LaunchedNode:
    """A node that the launcher keeps running."""

    name: str
    manifest: Manifest | None
    command: list[str]
    restart: Restart = "on-crash"
    process: ChildProcess | None = None
    outcome: Outcome | None = None
    started_s: float = 0.0
    restarts: int = 0
    heard_s: float = -math.inf
    """When it told something last (time.monotonic())."""
    stopping: bool = False
    ready: threading.Event = field(default_factory=threading.Event)
    ended: threading.Event = field(default_factory=threading.Event)
    said_end: threading.Event = field(default_factory=threading.Event)
    end_reported: threading.Event = field(default_factory=threading.Event)
    """Set when whoever wants to know has been told of its end."""
    environment: dict[str, str] = field(default_factory=dict, repr=False)
    """What it is told beside what all are: its secrets."""

    @property
    def pid(self) -> int:
        """The process id now; it changes when the node is restarted."""
        return self.process.pid if self.process else 0

    def owns(self, pid: int) -> bool:
        """Whether the process ``pid`` is its own, perhaps started by a wrapper or a launch stub."""
        if self.process is None or pid == self.process.pid:
            return self.process is not None
        with contextlib.suppress(psutil.Error, ValueError):
            return self.process.pid in [parent.pid for parent in psutil.Process(pid).parents()]
        return False

    def is_heard(self) -> bool:
        """Whether it told something a moment ago, if only that it lives."""
        return time.monotonic() - self.heard_s < QUIET_S

    def deserves_another(self, outcome: Outcome) -> bool:
        """Whether it is to be started again; 10 s of health start the count anew."""
        if time.monotonic() - self.started_s > HEALTHY_S:
            self.restarts = 0
        is_over = self.stopping or outcome.asked or outcome.code == ASKED
        if is_over or self.restarts >= MOST_RESTARTS:
            return False
        match self.restart:
            case "always":
                return True
            case "on-crash":
                # A node that ends with an error before it was ever ready has wrong settings.
                has_run = self.ready.is_set() or self.restarts > 0
                return outcome.code < 0 or (has_run and not outcome.was_successful)
            case "on-kill":
                return outcome.code < 0
        return False

    def wait_ready(
        self, timeout_s: float | None = None, *, given_up: threading.Event | None = None
    ) -> None:
        """Wait until the node says that it is ready, or has done its work and ended well.

        ``timeout_s``: None takes ``ready_s`` of its manifest; a node that works all the while has
        up to three times as long. ``given_up``: wait no longer once this is set. Raises
        NodeStartError with its last words, or when the time is over.
        """
        if timeout_s is None:
            timeout_s = self.manifest.ready_s if self.manifest else READY_S
        patience = _Patience(self, timeout_s)
        while not self.ready.wait(0.05):
            if given_up is not None and given_up.is_set():
                return
            if self.ended.is_set() and self.outcome is not None:
                if self.outcome.was_successful:
                    return
                steps = self.outcome.checklist or ("Look into its log.", "Correct its settings.")
                raise NodeStartError("{outcome}.", checklist=steps, outcome=self.outcome.text)
            if patience.is_over():
                raise NodeStartError(
                    "{name} did not say that it is ready within {timeout_s} s.",
                    checklist=("Look into its log.", "Start it again."),
                    name=self.name,
                    timeout_s=f"{timeout_s:g}",
                )


SETTINGS = {"PYTHONUNBUFFERED": "1", "PYTHONUTF8": "1"}
"""What every node finds in its environment, beside the master's endpoint."""

FIRST_PAUSE_S = 0.25
TOLD_S = 1.0
"""How long closing waits until the end of each node has been told."""

Report = Callable[[LaunchedNode, Outcome, bool], None]
"""Called when a node ended: which, how, and whether it is started again."""


class Launcher(Closing):
    """Starts nodes as processes of their own and supervises them.

    A node that crashes is started again, at most 5 times in a row, each time after a longer
    pause; 10 s of health start the count anew. How a node ended that cannot say it itself is told
    on ``/node_state``. Leaving a ``with`` block stops all nodes.

    ``folders`` are where manifests are (None: the shipped ones), ``logs`` where logs go (None:
    this user's), ``master`` the endpoint that nodes join; ``on_end`` is called with a node, its
    Outcome, and whether it is started again.
    """

    def __init__(
        self,
        *,
        folders: tuple[Path, ...] | None = None,
        logs: Path | None = None,
        master: str | None = None,
        on_end: Report | None = None,
    ) -> None:
        self.catalog = NodeCatalog(folders or node_folders())
        self.logs = logs or log_folder()
        self.nodes: dict[str, LaunchedNode] = {}
        self.master = master or master_endpoint()
        self._on_end = on_end
        self._lock = threading.RLock()
        self._heard: Subscriber[NodeState] | None = None
        self._speaking = threading.Lock()
        self._said: Publisher | None = None
        """Says how nodes ended that cannot say it any more; silent before the network is closed."""

    def hear(self, network: Network | None = None) -> None:
        """Hear on ``network`` (default: this program's) which nodes are ready, tell who ended."""
        with self._lock:
            if self._heard is None:
                self._said = Publisher(NODE_STATE, network=network)
                self._heard = Subscriber(
                    NODE_STATE, NodeState, network=network, callback=self._on_node_state
                )

    def start(self, node: str, name: str = "", **parameters: Value) -> LaunchedNode:
        """Start "type/name" under ``name``, as launch()."""
        return self.launch(node, name, parameters)

    def launch(
        self,
        node: str,
        name: str = "",
        parameters: Mapping[str, Value] | None = None,
        *,
        restart: Restart | None = None,
    ) -> LaunchedNode:
        """Start "type/name" under ``name``; does not wait until it is ready.

        ``restart``: when it is started again (None: as its manifest says). Raises NodeNotFound,
        ManifestError, ParameterError, NameTaken, NodeStartError.

        ``node`` is its type and name, ``parameters`` are by name, without those that stay
        as the manifest says.
        """
        self.hear()
        manifest = self.catalog.find(node)
        name = name or manifest.name
        words = {True: "true", False: "false"}  # that every language reads, as Python's are not
        read = {
            key: words[value] if isinstance(value, bool) else f"{value}"
            for key, value in manifest.read_parameters(dict(parameters or {})).items()
        }
        secret = {key: read.pop(key) for key in [*read] if manifest.parameters[key].secret}
        settings = [f"{key}={value}" for key, value in read.items()]
        if manifest.command:
            folder = Path(manifest.path).parent
            command = [part.replace("{folder}", str(folder)) for part in manifest.command]
            command += ["--name", name, *settings]
            if shutil.which(command[0]):  # one that cannot be found fails at once
                # It knows of no life line: the guard lets it end with us
                command = program_command(GUARD, *command)
        else:
            command = program_command("node", manifest.path, f"--name={name}", *settings)
        launched = LaunchedNode(name, manifest, command, restart=restart or manifest.restart)
        launched.environment = handover.secrets_in({key: one for key, one in secret.items() if one})
        return self._launch(launched)

    def start_command(self, name: str, command: list[str]) -> LaunchedNode:
        """Start and supervise a program that has no manifest, such as the master."""
        return self._launch(LaunchedNode(name, None, command))

    def stop(self, *names: str) -> None:
        """Stop nodes, all at once, and all the processes that they started."""
        with self._lock:  # a restart may be starting another process at this moment
            stopped = [self.nodes[name] for name in names if name in self.nodes]
            for launched in stopped:
                launched.stopping = True
                launched.ended.set()
            running = [(one, one.process) for one in stopped if one.process is not None]
        for _, process in running:
            if process.poll() is None:
                process.ask_to_stop()
        for launched, process in running:
            stop_s = launched.manifest.stop_s if launched.manifest else STOP_S
            # One that stands still will not finish: only who is heard gets more than usual
            process.stop(min(stop_s, STOP_S), longest_s=stop_s, lives=launched.is_heard)

    def close(self) -> None:
        """Stop every node, all at once."""
        self.stop(*self.nodes)
        for launched in list(self.nodes.values()):
            launched.end_reported.wait(TOLD_S)
        self.leave()

    def leave(self) -> None:
        """Hear and tell no more, as when the network is about to be closed."""
        with self._speaking:  # a node may still end when the network is closed
            self._said = None  # not closed: a node of this network may speak on
        if self._heard is not None:
            self._heard.close()

    def _launch(self, launched: LaunchedNode) -> LaunchedNode:
        check_node_name(launched.name)
        with self._lock:
            other = self.nodes.get(launched.name)
            if other is not None and not other.ended.is_set():
                raise NameTaken(
                    'There are two nodes with the name "{name}".',
                    checklist=("Give each node a name of its own.",),
                    name=launched.name,
                )
            self.nodes[launched.name] = launched
            try:
                self._start_process(launched)
            except BaseException:
                launched.ended.set()  # its name is free again
                launched.end_reported.set()
                raise
        return launched

    def _start_process(self, launched: LaunchedNode) -> None:
        launched.ready.clear()
        launched.said_end.clear()
        launched.started_s = time.monotonic()
        launched.process = ChildProcess(
            launched.name,
            launched.command,
            environment={
                **os.environ,
                **SETTINGS,
                MASTER_VARIABLE: self.master,
                **launched.environment,
            },
            log_file=self.logs / log_file_name(launched.name),
            goes_on=launched.restarts > 0,
            on_end=partial(self._ended, launched),
        )

    def _ended(self, launched: LaunchedNode, outcome: Outcome) -> None:
        if outcome.code < 0 and launched.said_end.is_set():
            # It was killed on purpose: ``nep kill --force`` tells so before it does it
            outcome = replace(outcome, asked=True)
        again = launched.deserves_another(outcome)
        self._tell_end(launched, outcome, again)
        if not again:
            return
        launched.ended.wait(FIRST_PAUSE_S * 2**launched.restarts)  # unless it is stopped meanwhile
        launched.restarts += 1
        try:
            with self._lock:
                if not launched.stopping:
                    self._start_process(launched)
                    return
            outcome = replace(outcome, asked=True)
        except (NepError, OSError) as error:
            log.warning("%s", error)
            outcome = Outcome(launched.name, 1, refusal=fault_in(error))
        self._tell_end(launched, outcome, again=False)

    def _tell_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        launched.outcome = outcome
        if not again:
            launched.ended.set()
        if outcome.asked:  # the node may have told that itself; its last message may be on its way
            could_tell = outcome.code == 0 and launched.ready.is_set()
            is_told = could_tell and launched.said_end.wait(LAST_WORD_S)
        else:
            is_told = outcome.was_successful
        if not is_told:
            state = NodeState(
                node=launched.name,
                type=launched.manifest.type if launched.manifest else "cognitive",
                event="stopped" if outcome.asked else "crashed",
                pid=launched.pid,
                host=socket.gethostname(),
                **described(outcome.fault(again=again)),
            )
            with self._speaking:
                if self._said is not None and not self._said.network.closed:
                    self._said.send(state)
        if self._on_end is not None:
            self._on_end(launched, outcome, again)
        if not again:
            launched.end_reported.set()

    def _on_node_state(self, state: NodeState) -> None:
        """Take note of what a node of ours told, or another of its name."""
        launched = self.nodes.get(state.node)
        if launched is None:
            return
        if not launched.owns(state.pid):
            return
        launched.heard_s = time.monotonic()
        if state.event in AT_WORK:
            launched.ready.set()
        elif state.event == "stopped":
            launched.said_end.set()
