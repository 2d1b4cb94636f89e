"""How every node of the network is doing, from what they tell; for the panel What runs."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from PySide6.QtCore import QThread, Signal

from faults import Fault, Text
from nep_core.wire.messages import LONGEST_NAME, NodeEvent, NodeState, NodeType

FROZEN_S = 3.0
"""A node that has said nothing for so long, three heartbeats, is frozen."""

MOST_NODES = 300
"""So many nodes are shown, more than a network has: a stranger may make up a name each time, and a
window draws them all."""

Health = Literal["planned", "starting", "ready", "busy", "warning", "frozen", "crashed", "stopped"]

HEALTH: dict[NodeEvent, Health] = {
    "starting": "starting",
    "connecting": "starting",
    "ready": "ready",
    "running": "ready",
    "connected": "ready",
    "busy": "busy",
    "warning": "warning",
    "disconnected": "warning",
    "connection_failed": "warning",
    "crashed": "crashed",
    "stopped": "stopped",
}
"""What an event says of a node's health; a heartbeat says that it is as it was."""

ENDED: frozenset[Health] = frozenset({"planned", "crashed", "stopped"})


NOTHING = Fault("", Text(""))
"""What a node has told that has told nothing."""


@dataclass(frozen=True)
class NodeStatus:
    """A node as it was heard last; ``node`` is "type/name" of its manifest, "" when not known.

    ``fault`` is what it said of its state, which may be that all is well.
    ``since_s`` is when it took this state, ``heard_s`` when it was heard last (time.time()).
    ``measures`` are the last that it sent; new ones alone are no change of its status.
    """

    name: str
    type: NodeType
    node: str = ""
    event: NodeEvent | None = None
    fault: Fault = NOTHING
    pid: int = 0
    since_s: float = 0.0
    heard_s: float = 0.0
    restarts: int = 0
    health: Health = "planned"
    measures: Mapping[str, float] = field(default_factory=dict, compare=False)

    @property
    def is_there(self) -> bool:
        """Whether it runs, as far as is known."""
        return self.health not in ENDED


class NodeBoard:
    """The nodes by name; one thread at a time."""

    def __init__(self) -> None:
        self.nodes: dict[str, NodeStatus] = {}

    def plan(self, name: str, type: NodeType, node: str) -> bool:
        """Note a node that a project needs; whether that is news."""
        known = self.nodes.get(name)
        if known is not None and (known.node, known.type) == (node, type):
            return False
        base = known or NodeStatus(name, type)
        self.nodes[name] = replace(base, type=type, node=node)
        return True

    def forget(self, name: str) -> bool:
        """Drop a node that nobody needs and that does not run; whether it was there."""
        known = self.nodes.get(name)
        if known is None or known.is_there:
            return False
        del self.nodes[name]
        return True

    def update(self, state: NodeState, heard_s: float | None = None) -> bool:
        """Take in what a node told, or somebody for it; whether its status has changed.

        ``heard_s``: when it was heard; another computer's clock may be wrong.
        """
        if not self._has_room(state.node):
            return False
        known = before = self.nodes.get(state.node) or NodeStatus(state.node, state.type)
        pid, heard_s = state.pid or before.pid, state.time if heard_s is None else heard_s
        if state.measures or state.event == "starting":
            before = replace(before, measures=state.measures)
        if state.event == "alive":
            health = before.health
            is_another = health in ("crashed", "stopped") and state.pid != before.pid
            if is_another or health in ("frozen", "planned"):
                health = "ready"
            after = replace(before, health=health, heard_s=heard_s, pid=pid)
        else:
            is_new = state.event == "starting" and state.pid != before.pid
            after = replace(
                before,
                type=state.type,
                event=state.event,
                fault=state.fault,
                pid=pid,
                since_s=state.time,
                heard_s=heard_s,
                restarts=before.restarts + (is_new and before.event == "crashed"),
                health=HEALTH[state.event],
            )
        self.nodes[state.node] = after
        return replace(after, heard_s=known.heard_s) != known

    def _has_room(self, name: str) -> bool:
        """Whether a node can be shown; where there are too many, one gives way that is silent."""
        if name in self.nodes:
            return True
        if len(name) > LONGEST_NAME:
            return False
        if len(self.nodes) >= MOST_NODES:
            strangers = (one for one in self.nodes.values() if not one.node)
            silent = (one for one in strangers if not one.is_there or one.health == "frozen")
            if (gone := next(silent, None)) is None:
                return False
            del self.nodes[gone.name]
        return True

    def frozen(self, now_s: float) -> list[str]:
        """Mark the nodes that have fallen silent; those that have just become so."""
        found = [
            one.name
            for one in self.nodes.values()
            if one.is_there and one.health != "frozen" and now_s - one.heard_s > FROZEN_S
        ]
        for name in found:
            self.nodes[name] = replace(self.nodes[name], health="frozen", since_s=now_s)
        return found

    def wake(self, now_s: float) -> None:
        """Nobody could be heard until now, as after the computer's sleep: begin anew to wait."""
        for name, one in self.nodes.items():
            if one.is_there and one.health != "frozen":
                self.nodes[name] = replace(one, heard_s=now_s)


# Brings what several threads hear into one thread of Qt, in batches that it can take.

BATCHES_HZ = 30
LARGEST_BATCH = 300
"""So many messages are passed on at once: a window can deal with them between two frames."""

MOST_WAITING = 5000
"""So many messages wait for a thread that is busy; the oldest of more are dropped and counted."""


class Monitor(QThread):
    """Passes on what was heard: ``arrived`` gives a list, at most 30 times a second.

    The next batch is only sent when the last one was taken, so that a busy window is not flooded:
    who is connected to ``arrived`` calls ``taken()`` when it is done.
    """

    arrived = Signal(list)

    def __init__(self, batches_hz: float = BATCHES_HZ, most_waiting: int = MOST_WAITING) -> None:
        super().__init__()
        self.dropped = 0
        self._pause_s = 1 / batches_hz
        self._waiting: deque[Any] = deque()
        self._most = most_waiting
        self._lock = threading.Lock()
        self._came = threading.Event()
        self.may_send = threading.Event()
        """Set by whoever has dealt with the last batch."""
        self.may_send.set()
        self._is_ending = False

    def hear(self, item: object) -> None:
        """Take in one item; from any thread."""
        with self._lock:
            self._waiting.append(item)
            if len(self._waiting) > self._most:
                self._waiting.popleft()
                self.dropped += 1
        self._came.set()

    def end(self) -> None:
        """End the thread, and wait for it."""
        if self._is_ending:
            return
        self._is_ending = True
        self._came.set()
        self.may_send.set()
        self.wait()

    def run(self) -> None:
        """Send batches until the end."""
        while not self._is_ending:
            self._came.wait()
            self.may_send.wait()
            self._came.clear()
            with self._lock:
                count = min(len(self._waiting), LARGEST_BATCH)
                batch = [self._waiting.popleft() for _ in range(count)]
                if self._waiting:
                    self._came.set()
            if batch and not self._is_ending:
                self.may_send.clear()
                self.arrived.emit(batch)
                time.sleep(self._pause_s)
