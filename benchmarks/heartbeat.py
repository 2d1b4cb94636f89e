"""How long the window's thread is held up: a timer that should beat every 5 ms."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer

BEAT_MS = 5


@dataclass(frozen=True)
class Longest:
    """The longest times between two beats, in ms, each with the beat itself taken off.

    ``wall_ms`` is what the clock says. ``held_up_ms`` leaves out how long the thread was ready to
    run but the system ran another one: it counts work, locks, files and Python's own lock, and not
    what else the computer does. ``work_ms`` is the CPU time of the thread alone.
    """

    wall_ms: float = 0.0
    held_up_ms: float = 0.0
    work_ms: float = 0.0


class Heartbeat(QObject):
    """Beats in the thread that makes it; ``longest`` tells since ``begin``."""

    def __init__(self) -> None:
        super().__init__()
        self.longest = Longest()
        self.beats = 0
        self._last = self._now()
        self._timer = QTimer(self, interval=BEAT_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._on_beat)

    def begin(self) -> None:
        """Measure from now on."""
        self.longest, self.beats, self._last = Longest(), 0, self._now()
        self._timer.start()

    def end(self) -> Longest:
        """Measure no more; what there was."""
        self._on_beat()
        self._timer.stop()
        return self.longest

    def _on_beat(self) -> None:
        now = self._now()
        wall, waited, work = (1000 * (b - a) for a, b in zip(self._last, now, strict=True))
        self._last = now
        self.beats += 1
        self.longest = Longest(
            max(self.longest.wall_ms, wall - BEAT_MS),
            max(self.longest.held_up_ms, wall - waited - BEAT_MS),
            max(self.longest.work_ms, work),
        )

    @staticmethod
    def _now() -> tuple[float, float, float]:
        """The clock, how long the thread has waited for a processor, and its CPU time, in s."""
        return time.perf_counter(), _waited_s(), time.thread_time()


def _waited_s() -> float:
    """How long this thread has been ready to run without running; 0 where nobody counts it."""
    try:
        counts = Path("/proc/thread-self/schedstat").read_text(encoding="ascii").split()
    except OSError:
        return 0.0
    return int(counts[1]) / 1e9
