"""What is known of a watch that sends, from its own samples and from what its node measures."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core.wire.messages import IMU, Imu
from nep_studio.blocks.operations.fixes import WATCH
from nep_studio.run.node_board import NodeStatus
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.running.tap import Heard, Tap

RATE_OVER_S = 2.0
MOVED_OVER_S = 1.0
REMEMBERED_S = 60.0
SILENT_S = 2.0
"""After so long without a sample it is said that nothing comes."""
MOVED_M_S2 = 2.5
"""Noise and a pulse stay far below; a wave of the hand, or turning the device, is above."""
_GAP_STEPS = 2.5
_MOST_LOST = 10_000
"""A sensor's clock that jumps does not mean that a million samples were lost."""


@dataclass(frozen=True)
class Flow:
    """How a watch sends; None where nobody can tell. ``gaps`` are those of the last minute."""

    rate_hz: float = 0.0
    loss: float | None = None
    gaps: int = 0
    drift_ppm: float | None = None
    delay_ms: float | None = None


class Receiving:
    """Follows the samples of one watch; times are ``time.monotonic()``."""

    def __init__(self) -> None:
        self.source = ""
        self.is_simulated = False
        self.has_rotation = False
        self.has_gravity = True
        self.has_moved = False
        """Whether it was moved since it began to send."""
        self.movement_m_s2 = 0.0
        """How far its acceleration reached in the last second."""
        self.heard_s = -math.inf
        self._counts: deque[tuple[float, int]] = deque(maxlen=1000)
        self._latest: deque[tuple[float, tuple[float, float, float]]] = deque(maxlen=2000)
        self._holes: deque[tuple[float, int]] = deque(maxlen=1000)
        self._last_t: float | None = None

    def hear(self, message: Imu, now_s: float) -> None:
        """Take a batch that has arrived."""
        if not message.t or not message.acc:
            return
        if now_s - self.heard_s > SILENT_S:
            self._counts.clear()  # the rate is that since it sends again
            self._last_t = None
        self.source, self.is_simulated = message.source, message.simulated
        self.has_rotation = message.gyr is not None
        self.has_gravity = message.gravity_included
        self.heard_s = now_s
        self._counts.append((now_s, len(message.t)))
        self._find_holes(message, now_s)
        self._follow_movement(message, now_s)

    def is_sending(self, now_s: float) -> bool:
        """Whether samples came just now."""
        return now_s - self.heard_s < SILENT_S

    def flow(self, now_s: float, measures: Mapping[str, float]) -> Flow:
        """How it sends; what its node ``measures`` goes before what is counted here."""
        lost = sum(count for _, count in self._recent_holes(now_s))
        there = sum(count for time_s, count in self._counts if now_s - time_s < REMEMBERED_S)
        loss = lost / (lost + there) if there else None
        return Flow(
            rate_hz=measures.get("rate_hz") or self.rate_hz(now_s),
            loss=measures.get("loss", loss),
            gaps=int(measures.get("gaps", len(self._recent_holes(now_s)))),
            drift_ppm=measures.get("drift_ppm"),
            delay_ms=measures.get("delay_ms"),
        )

    def rate_hz(self, now_s: float) -> float:
        """Samples a second that came in the last seconds; 0 when nothing comes."""
        if not self.is_sending(now_s):
            return 0.0
        counted = [(time_s, n) for time_s, n in self._counts if now_s - time_s <= RATE_OVER_S]
        if len(counted) < 2:
            return 0.0
        seconds = counted[-1][0] - counted[0][0]
        return sum(count for _, count in counted[1:]) / seconds if seconds > 0 else 0.0

    def _find_holes(self, message: Imu, now_s: float) -> None:
        """Note where samples are missing, as far as their times tell."""
        step_s = 1 / message.rate_hz if message.rate_hz > 0 else 0.0
        for t in message.t:
            if step_s and self._last_t is not None and t - self._last_t > _GAP_STEPS * step_s:
                count = round((t - self._last_t) / step_s) - 1
                self._holes.append((now_s, min(count, _MOST_LOST)))
            self._last_t = t

    def _recent_holes(self, now_s: float) -> list[tuple[float, int]]:
        return [one for one in self._holes if now_s - one[0] < REMEMBERED_S]

    def _follow_movement(self, message: Imu, now_s: float) -> None:
        self._latest.extend((now_s, row) for row in message.acc)
        while self._latest and now_s - self._latest[0][0] > MOVED_OVER_S:
            self._latest.popleft()
        axes = list(zip(*(row for _, row in self._latest), strict=True))
        self.movement_m_s2 = max(max(axis) - min(axis) for axis in axes)
        self.has_moved |= self.movement_m_s2 > MOVED_M_S2


# Hears the watch of a project: whose samples come, how fast, and what its node says of it.

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
                if planned.node == WATCH and name in nodes and nodes[name].is_there
            ),
            None,
        )

    @property
    def planned(self) -> PlannedNode | None:
        """How the node of the watch was started, when that was here."""
        return self._runner.local.planned.get(self.source)
