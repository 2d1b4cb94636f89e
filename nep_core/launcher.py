"""Starting nodes by type and name, keeping them running, and stopping them all."""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from nep_core.endpoints import MASTER_VARIABLE, master_endpoint
from nep_core.errors import NameTaken, NodeStartError
from nep_core.manifest import Manifest, NodeCatalog, Value
from nep_core.messages import NODE_STATE, NodeState
from nep_core.network import Network
from nep_core.outcome import Outcome
from nep_core.places import log_folder, node_folders
from nep_core.process import ChildProcess, program_command
from nep_core.pubsub import Subscriber

log = logging.getLogger(__name__)

SETTINGS = {"PYTHONUNBUFFERED": "1", "PYTHONUTF8": "1"}
"""What every node finds in its environment, beside the master's endpoint."""

MOST_RESTARTS = 5
FIRST_PAUSE_S = 0.25
HEALTHY_S = 10.0
READY_S = 10.0


@dataclass
class LaunchedNode:
    """A node that the launcher keeps running."""

    name: str
    manifest: Manifest | None
    command: list[str]
    restart_on_error: bool = True
    process: ChildProcess | None = None
    started_s: float = 0.0
    restarts: int = 0
    stopping: bool = False
    ready: threading.Event = field(default_factory=threading.Event)
    ended: threading.Event = field(default_factory=threading.Event)

    @property
    def pid(self) -> int:
        """The process id now; it changes when the node is restarted."""
        return self.process.pid if self.process else 0

    def wait_ready(self, timeout_s: float = READY_S) -> None:
        """Wait until the node says that it is ready; raises NodeStartError with its last words."""
        deadline = time.monotonic() + timeout_s
        while not self.ready.wait(0.05):
            outcome = self.process.outcome if self.process else None
            if self.ended.is_set() and outcome is not None:
                steps = outcome.checklist or ("Correct its settings.",)
                raise NodeStartError(f"{outcome}.", checklist=steps)
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
            command += ["--name", name, *settings]
        else:
            command = program_command("node", manifest.path, "--name", name, *settings)
        return self._launch(LaunchedNode(name, manifest, command, restart_on_error))

    def start_command(self, name: str, command: list[str]) -> LaunchedNode:
        """Start and supervise a program that has no manifest, such as the master."""
        return self._launch(LaunchedNode(name, None, command))

    def stop(self, name: str) -> None:
        """Stop one node and all the processes that it started."""
        launched = self.nodes.get(name)
        if launched is not None:
            launched.stopping = True
            launched.ended.set()
            if launched.process is not None:
                launched.process.stop()

    def close(self) -> None:
        """Stop every node, all at once."""
        for launched in self.nodes.values():
            launched.stopping = True
            if launched.process is not None and launched.process.poll() is None:
                launched.process.ask_to_stop()
        for name in list(self.nodes):
            self.stop(name)
        if self._states is not None:
            self._states.close()

    def __enter__(self) -> Launcher:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def _launch(self, launched: LaunchedNode) -> LaunchedNode:
        with self._lock:
            other = self.nodes.get(launched.name)
            if other is not None and not other.ended.is_set():
                raise NameTaken(
                    f'There are two nodes with the name "{launched.name}".',
                    checklist=("Give each node a name of its own.",),
                )
            self.nodes[launched.name] = launched
            self._start_process(launched)
        return launched

    def _start_process(self, launched: LaunchedNode) -> None:
        launched.ready.clear()
        launched.started_s = time.monotonic()
        launched.process = ChildProcess(
            launched.name,
            launched.command,
            environment={**os.environ, **SETTINGS, MASTER_VARIABLE: self.master},
            log_file=self.logs / f"{_file_name(launched.name)}.log",
            on_end=lambda outcome: self._ended(launched, outcome),
        )

    def _ended(self, launched: LaunchedNode, outcome: Outcome) -> None:
        if time.monotonic() - launched.started_s > HEALTHY_S:
            launched.restarts = 0
        again = self._deserves_another(launched, outcome)
        if not again:
            launched.ended.set()
        if self._on_end is not None:
            self._on_end(launched, outcome, again)
        if again:
            self._restart(launched)

    def _deserves_another(self, launched: LaunchedNode, outcome: Outcome) -> bool:
        if launched.stopping or outcome.was_successful or launched.restarts >= MOST_RESTARTS:
            return False
        # A node that ends with an error before it was ever ready has wrong settings.
        has_run = launched.ready.is_set() or launched.restarts > 0
        return outcome.code < 0 or (has_run and launched.restart_on_error)

    def _restart(self, launched: LaunchedNode) -> None:
        time.sleep(FIRST_PAUSE_S * 2**launched.restarts)
        launched.restarts += 1
        with self._lock:
            if not launched.stopping:
                self._start_process(launched)

    def _on_node_state(self, state: NodeState) -> None:
        launched = self.nodes.get(state.node)
        if launched is not None and state.event == "ready" and state.pid == launched.pid:
            launched.ready.set()


def _file_name(name: str) -> str:
    return "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in name)
