"""Hears the watch of a project: whose samples come, how fast, and what its node says of it."""

from __future__ import annotations

import time
from collections.abc import Sequence

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.messages import IMU, Imu
from nep_studio.node_board import NodeStatus
from nep_studio.plan import PlannedNode
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.running.tap import Heard, Tap

from .receiving import Flow, Receiving
from .ways import SMARTWATCH

TELL_MS = 250
FORGOTTEN_S = 60.0
"""A watch that was silent for so long is not spoken of any more."""


class WatchEar(QObject):
    """Hears ``/imu`` between ``start`` and ``stop``; of one node when ``node`` names it.

    ``changed`` tells 4 times a second how it is; ``heard`` gives the batches (Imu) of the watch
    that is followed: a real one before a simulated one, the newest of several.
    """

    changed = Signal()
    heard = Signal(list)

    def __init__(self, runner: Runner, parent: QObject | None = None, node: str = "") -> None:
        super().__init__(parent)
        self.node = node
        self._runner = runner
        self._tap: Tap | None = None
        self._by_node: dict[str, Receiving] = {}
        self._kept = ""
        self._telling = QTimer(self, interval=TELL_MS)
        self._telling.timeout.connect(self.changed)

    def start(self) -> None:
        """Hear from now on."""
        if self._tap is None:
            self._tap = self._runner.tap(IMU, kind=Imu, parent=self)
            self._tap.arrived.connect(self.hear)
            self._telling.start()

    def stop(self) -> None:
        """Hear no more."""
        self._telling.stop()
        if self._tap is not None:
            self._tap.close()
            self._tap = None

    def begin_anew(self, node: str) -> None:
        """Forget what was heard; follow this node."""
        self.node = node
        self._by_node.clear()

    def hear(self, batch: Sequence[Heard]) -> None:
        """Take batches of samples."""
        now_s = time.monotonic()
        mine: list[tuple[str, Imu]] = []
        for one in batch:
            if not self.node or one.sender == self.node:
                self._by_node.setdefault(one.sender, Receiving()).hear(one.message, now_s)
                mine.append((one.sender, one.message))
        followed = self.source
        if found := [message for sender, message in mine if sender == followed]:
            self.heard.emit(found)

    @property
    def source(self) -> str:
        """The node whose watch is followed; "" when none was heard lately."""
        if self.node:
            return self.node
        now_s = time.monotonic()
        known = {
            name: one for name, one in self._by_node.items() if now_s - one.heard_s < FORGOTTEN_S
        }

        def rank(name: str) -> tuple[bool, bool, bool, float]:
            one, is_kept = known[name], name == self._kept  # two that send do not take turns
            return one.is_sending(now_s), not one.is_simulated, is_kept, one.heard_s

        self._kept = max(known, key=rank, default="")
        return self._kept

    @property
    def receiving(self) -> Receiving:
        """What is heard of the watch that is followed."""
        return self._by_node.get(self.source) or Receiving()

    @property
    def is_sending(self) -> bool:
        """Whether samples come."""
        return self.receiving.is_sending(time.monotonic())

    @property
    def silent_s(self) -> float:
        """How long nothing has come; infinity before the first samples."""
        return time.monotonic() - self.receiving.heard_s

    @property
    def flow(self) -> Flow:
        """How the watch sends."""
        status = self.status
        measures = status.measures if status is not None and self.is_sending else {}
        return self.receiving.flow(time.monotonic(), measures)

    @property
    def status(self) -> NodeStatus | None:
        """How the node of the watch is doing."""
        return self._runner.board.nodes.get(self.source)

    @property
    def awaited(self) -> PlannedNode | None:
        """A node that runs here and waits for a watch; None when there is none."""
        nodes = self._runner.board.nodes
        return next(
            (
                planned
                for name, planned in self._runner.local.planned.items()
                if planned.node == SMARTWATCH and name in nodes and nodes[name].is_there
            ),
            None,
        )

    @property
    def planned(self) -> PlannedNode | None:
        """How the node of the watch was started, when that was here."""
        return self._runner.local.planned.get(self.source)
