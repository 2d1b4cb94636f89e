"""Starting nodes by type and name, keeping them running, and stopping them all."""

from __future__ import annotations

import logging
import os
import shutil
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from nep_core.endpoints import MASTER_VARIABLE, master_endpoint
from nep_core.errors import NameTaken, NepError, NodeStartError
from nep_core.guard import GUARD
from nep_core.manifest import Manifest, NodeCatalog, Value
from nep_core.messages import NODE_STATE, NodeState
from nep_core.network import Network
from nep_core.node_log import log_file_name
from nep_core.node_name import check_node_name
from nep_core.outcome import Outcome
from nep_core.places import log_folder, node_folders
from nep_core.process import ChildProcess, program_command
from nep_core.process_tree import is_in_tree
from nep_core.pubsub import Subscriber

log = logging.getLogger(__name__)

SETTINGS = {"PYTHONUNBUFFERED": "1", "PYTHONUTF8": "1"}
"""What every node finds in its environment, beside the master's endpoint."""

MOST_RESTARTS = 5
FIRST_PAUSE_S = 0.25
HEALTHY_S = 10.0
READY_S = 10.0
AT_WORK = frozenset(("ready", "running", "busy", "connected", "connection_failed", "disconnected"))
"""What only a node tells that is ready: who hears it late hears the newest of its states alone."""


@dataclass
class LaunchedNode:
    """A node that the launcher keeps running."""

    name: str
    manifest: Manifest | None
    command: list[str]
    restart_on_error: bool = True
    process: ChildProcess | None = None
    outcome: Outcome | None = None
    started_s: float = 0.0
    restarts: int = 0
    stopping: bool = False
    ready: threading.Event = field(default_factory=threading.Event)
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def pid(self) -> int:
        """The process id now; it changes when the node is restarted."""
        return self.process.pid if self.process else 0

    def owns(self, pid: int) -> bool:
        """Whether the process ``pid`` is its own, perhaps started by a wrapper or a launch stub."""
        return self.process is not None and is_in_tree(pid, self.process.pid)

    def wait_ready(
        self, timeout_s: float = READY_S, *, given_up: threading.Event | None = None
    ) -> None:
        """Wait until the node says that it is ready, or has done its work and ended well.

        ``given_up``: wait no longer once this is set. Raises NodeStartError with its last words,
        or when the time is over.
        """
        deadline = time.monotonic() + timeout_s
        while not self.ready.wait(0.05):
            if given_up is not None and given_up.is_set():
                return
            if self.ended.is_set() and self.outcome is not None:
                if self.outcome.was_successful:
                    return
                steps = self.outcome.checklist or ("Correct its settings.",)
                raise NodeStartError(f"{self.outcome}.", checklist=steps)
            if time.monotonic() > deadline:
                raise NodeStartError(
                    f"{self.name} did not say that it is ready within {timeout_s:.0f} s.",
                    checklist=("Look into its log.", "Start it again."),
                )


Report = Callable[[LaunchedNode, Outcome, bool], None]
"""Called when a node ended: which, how, and whether it is started again."""


class Launcher:
    """Starts nodes as processes of their own and supervises them.

    A node that crashes is started again, at most 5 times in a row, each time after a longer
    pause; 10 s of health start the count anew. Leaving a ``with`` block stops all nodes.
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
        self._states: Subscriber[NodeState] | None = None

    def hear(self, network: Network | None = None) -> None:
        """Hear on ``network`` (default: this program's) which nodes are ready."""
        if self._states is None:
            self._states = Subscriber(
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
        restart_on_error: bool = True,
    ) -> LaunchedNode:
        """Start "type/name" under ``name``; does not wait until it is ready.

        ``restart_on_error=False``: start it again only when it was killed. Raises NodeNotFound,
        ManifestError, ParameterError, NameTaken, NodeStartError.
        """
        self.hear()
        manifest = self.catalog.find(node)
        name = name or manifest.name
        given = dict(parameters or {})
        manifest.read_parameters(given)  # a wrong one is told here, not in the node's log
        settings = [f"{key}={value}" for key, value in given.items()]
        if manifest.command:
            folder = Path(manifest.path).parent
            command = [part.replace("{folder}", str(folder)) for part in manifest.command]
            command = _guarded([*command, "--name", name, *settings])
        else:
            command = program_command("node", manifest.path, f"--name={name}", *settings)
        return self._launch(LaunchedNode(name, manifest, command, restart_on_error))

    def start_command(self, name: str, command: list[str]) -> LaunchedNode:
        """Start and supervise a program that has no manifest, such as the master."""
        return self._launch(LaunchedNode(name, None, command))

    def stop(self, name: str) -> None:
        """Stop one node and all the processes that it started."""
        with self._lock:  # a restart may be starting another process at this moment
            launched = self.nodes.get(name)
            if launched is None:
                return
            launched.stopping = True
            launched.ended.set()
            process = launched.process
        if process is not None:
            process.stop()

    def stop_all(self, names: Iterable[str]) -> None:
        """Stop several nodes, all at once."""
        with self._lock:
            stopped = [self.nodes[name] for name in names if name in self.nodes]
            for launched in stopped:
                launched.stopping = True
            processes = [launched.process for launched in stopped]
        for process in processes:
            if process is not None and process.poll() is None:
                process.ask_to_stop()
        for launched in stopped:
            self.stop(launched.name)

    def close(self) -> None:
        """Stop every node, all at once."""
        self.stop_all(list(self.nodes))
        if self._states is not None:
            self._states.close()

    def __enter__(self) -> Launcher:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _launch(self, launched: LaunchedNode) -> LaunchedNode:
        check_node_name(launched.name)
        with self._lock:
            other = self.nodes.get(launched.name)
            if other is not None and not other.ended.is_set():
                raise NameTaken(
                    f'There are two nodes with the name "{launched.name}".',
                    checklist=("Give each node a name of its own.",),
                )
            self.nodes[launched.name] = launched
            try:
                self._start_process(launched)
            except BaseException:
                launched.ended.set()  # its name is free again
                raise
        return launched

    def _start_process(self, launched: LaunchedNode) -> None:
        launched.ready.clear()
        launched.started_s = time.monotonic()
        launched.process = ChildProcess(
            launched.name,
            launched.command,
            environment={**os.environ, **SETTINGS, MASTER_VARIABLE: self.master},
            log_file=self.logs / log_file_name(launched.name),
            goes_on=launched.restarts > 0,
            on_end=lambda outcome: self._ended(launched, outcome),
        )

    def _ended(self, launched: LaunchedNode, outcome: Outcome) -> None:
        if time.monotonic() - launched.started_s > HEALTHY_S:
            launched.restarts = 0
        again = self._deserves_another(launched, outcome)
        self._tell_end(launched, outcome, again)
        if again:
            self._restart(launched)

    def _tell_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        launched.outcome = outcome
        if not again:
            launched.ended.set()
        if self._on_end is not None:
            self._on_end(launched, outcome, again)

    def _deserves_another(self, launched: LaunchedNode, outcome: Outcome) -> bool:
        if launched.stopping or outcome.was_successful or launched.restarts >= MOST_RESTARTS:
            return False
        # A node that ends with an error before it was ever ready has wrong settings.
        has_run = launched.ready.is_set() or launched.restarts > 0
        return outcome.code < 0 or (has_run and launched.restart_on_error)

    def _restart(self, launched: LaunchedNode) -> None:
        time.sleep(FIRST_PAUSE_S * 2**launched.restarts)
        launched.restarts += 1
        try:
            with self._lock:
                if not launched.stopping:
                    self._start_process(launched)
        except (NepError, OSError) as error:
            log.warning("%s", error)
            steps = error.checklist if isinstance(error, NepError) else ()
            outcome = Outcome(launched.name, 1, last_words=str(error), checklist=steps)
            self._tell_end(launched, outcome, again=False)

    def _on_node_state(self, state: NodeState) -> None:
        launched = self.nodes.get(state.node)
        if launched is not None and state.event in AT_WORK and launched.owns(state.pid):
            launched.ready.set()


def _guarded(command: list[str]) -> list[str]:
    """Let a node that knows of no life line end with us; one that cannot be found fails at once."""
    return program_command(GUARD, *command) if shutil.which(command[0]) else command
