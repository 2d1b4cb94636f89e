"""What is known of a watch that sends, from its own samples and from what its node measures."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

from nep_core.messages import Imu

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
