"""Starting nodes by type and name, keeping them running, and stopping them all."""

from __future__ import annotations

import logging
import os
import shutil
import threading
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from nep_core.endpoints import MASTER_VARIABLE, master_endpoint
from nep_core.errors import NameTaken, NepError
from nep_core.guard import GUARD
from nep_core.herald import Herald
from nep_core.launched import LaunchedNode
from nep_core.manifest import NodeCatalog, Restart, Value
from nep_core.messages import NODE_STATE, NodeState
from nep_core.network import Network
from nep_core.node_log import log_file_name
from nep_core.node_name import check_node_name
from nep_core.outcome import Outcome
from nep_core.places import log_folder, node_folders
from nep_core.process import ChildProcess, program_command
from nep_core.pubsub import Subscriber

__all__ = ["LaunchedNode", "Launcher", "Report"]

log = logging.getLogger(__name__)

SETTINGS = {"PYTHONUNBUFFERED": "1", "PYTHONUTF8": "1"}
"""What every node finds in its environment, beside the master's endpoint."""

FIRST_PAUSE_S = 0.25
TOLD_S = 1.0
"""How long closing waits until the end of each node has been told."""

Report = Callable[[LaunchedNode, Outcome, bool], None]
"""Called when a node ended: which, how, and whether it is started again."""


class Launcher:
    """Starts nodes as processes of their own and supervises them.

    A node that crashes is started again, at most 5 times in a row, each time after a longer
    pause; 10 s of health start the count anew. How a node ended that cannot say it itself is told
    on ``/node_state``. Leaving a ``with`` block stops all nodes.
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
        self._herald: Herald | None = None

    def hear(self, network: Network | None = None) -> None:
        """Hear on ``network`` (default: this program's) which nodes are ready, tell who ended."""
        with self._lock:
            if self._states is None:
                self._herald = Herald(network)
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
        restart: Restart | None = None,
    ) -> LaunchedNode:
        """Start "type/name" under ``name``; does not wait until it is ready.

        ``restart``: when it is started again (None: as its manifest says). Raises NodeNotFound,
        ManifestError, ParameterError, NameTaken, NodeStartError.
        """
        self.hear()
        manifest = self.catalog.find(node)
        name = name or manifest.name
        settings = _settings(manifest.read_parameters(dict(parameters or {})))
        if manifest.command:
            folder = Path(manifest.path).parent
            command = [part.replace("{folder}", str(folder)) for part in manifest.command]
            command = _guarded([*command, "--name", name, *settings])
        else:
            command = program_command("node", manifest.path, f"--name={name}", *settings)
        return self._launch(LaunchedNode(name, manifest, command, restart or manifest.restart))

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
        for launched in list(self.nodes.values()):
            launched.told.wait(TOLD_S)
        self.leave()

    def leave(self) -> None:
        """Hear and tell no more, as when the network is about to be closed."""
        if self._herald is not None:
            self._herald.close()
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
                launched.told.set()
                raise
        return launched

    def _start_process(self, launched: LaunchedNode) -> None:
        launched.ready.clear()
        launched.said_end.clear()
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
        if launched.was_ended(outcome):
            outcome = replace(outcome, asked=True)
        again = launched.deserves_another(outcome)
        self._tell_end(launched, outcome, again)
        if again:
            self._restart(launched, outcome)

    def _tell_end(self, launched: LaunchedNode, outcome: Outcome, again: bool) -> None:
        launched.outcome = outcome
        if not again:
            launched.ended.set()
        if self._herald is not None:
            self._herald.tell_end(launched, outcome, again)
        if self._on_end is not None:
            self._on_end(launched, outcome, again)
        if not again:
            launched.told.set()

    def _restart(self, launched: LaunchedNode, outcome: Outcome) -> None:
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
            steps = error.checklist if isinstance(error, NepError) else ()
            outcome = Outcome(launched.name, 1, last_words=str(error), checklist=steps)
        self._tell_end(launched, outcome, again=False)

    def _on_node_state(self, state: NodeState) -> None:
        launched = self.nodes.get(state.node)
        if launched is not None:
            launched.hear(state)


def _settings(parameters: Mapping[str, Value]) -> list[str]:
    """As words that every language reads: no True and False of Python."""
    words = {True: "true", False: "false"}
    return [
        f"{name}={words[value] if isinstance(value, bool) else value}"
        for name, value in parameters.items()
    ]


def _guarded(command: list[str]) -> list[str]:
    """Let a node that knows of no life line end with us; one that cannot be found fails at once."""
    return program_command(GUARD, *command) if shutil.which(command[0]) else command
