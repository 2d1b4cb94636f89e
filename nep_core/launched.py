"""A node that the launcher keeps running, and whether it deserves another life."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field

from nep_core.errors import NodeStartError
from nep_core.manifest import READY_S, Manifest, Restart
from nep_core.messages import NodeState
from nep_core.outcome import ASKED, Outcome
from nep_core.process import ChildProcess
from nep_core.process_tree import is_in_tree

MOST_RESTARTS = 5
HEALTHY_S = 10.0
LAST_WORD_S = 0.2
AT_WORK = frozenset(("ready", "running", "busy", "connected", "connection_failed", "disconnected"))
"""What only a node tells that is ready: who hears it late hears the newest of its states alone."""


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
    stopping: bool = False
    ready: threading.Event = field(default_factory=threading.Event)
    ended: threading.Event = field(default_factory=threading.Event)
    said_end: threading.Event = field(default_factory=threading.Event)
    told: threading.Event = field(default_factory=threading.Event)
    """Set when whoever wants to know has been told of its end."""

    @property
    def pid(self) -> int:
        """The process id now; it changes when the node is restarted."""
        return self.process.pid if self.process else 0

    def owns(self, pid: int) -> bool:
        """Whether the process ``pid`` is its own, perhaps started by a wrapper or a launch stub."""
        return self.process is not None and is_in_tree(pid, self.process.pid)

    def hear(self, state: NodeState) -> None:
        """Take note of what a node of its name told."""
        if not self.ready.is_set() and state.event in AT_WORK and self.owns(state.pid):
            self.ready.set()
        elif state.event == "stopped" and self.owns(state.pid):
            self.said_end.set()

    def was_ended(self, outcome: Outcome) -> bool:
        """Whether it was killed on purpose: ``nep kill --force`` tells so before it does it."""
        return outcome.code < 0 and self.said_end.is_set()

    def has_said_end(self, outcome: Outcome) -> bool:
        """Whether the node itself told that it stopped; waits a moment for its last message."""
        if outcome.code != 0 or not self.ready.is_set():
            return False
        return self.said_end.wait(LAST_WORD_S)

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

        ``timeout_s``: None takes ``ready_s`` of its manifest. ``given_up``: wait no longer once
        this is set. Raises NodeStartError with its last words, or when the time is over.
        """
        if timeout_s is None:
            timeout_s = self.manifest.ready_s if self.manifest else READY_S
        deadline = time.monotonic() + timeout_s
        while not self.ready.wait(0.05):
            if given_up is not None and given_up.is_set():
                return
            if self.ended.is_set() and self.outcome is not None:
                if self.outcome.was_successful:
                    return
                steps = self.outcome.checklist or ("Look into its log.", "Correct its settings.")
                raise NodeStartError(f"{self.outcome}.", checklist=steps)
            if time.monotonic() > deadline:
                raise NodeStartError(
                    f"{self.name} did not say that it is ready within {timeout_s:g} s.",
                    checklist=("Look into its log.", "Start it again."),
                )
