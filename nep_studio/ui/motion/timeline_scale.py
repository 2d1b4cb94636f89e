"""Where the moments of a motion are on its timeline, in pixels."""

from __future__ import annotations

from dataclasses import dataclass

STEPS_S = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0, 300.0, 600.0)


@dataclass(frozen=True)
class Scale:
    """Pixels for seconds: ``left`` is where 0 s is."""

    left: float
    per_s: float

    def x(self, time: float) -> float:
        """Where a moment is."""
        return self.left + time * self.per_s

    def time(self, x: float) -> float:
        """Which moment is at a place; never before the beginning."""
        return max(0.0, (x - self.left) / self.per_s)

    def marks(self, end_s: float, apart: float) -> list[float]:
        """The moments that get a mark with a number, at least ``apart`` pixels from each other."""
        step = next((s for s in STEPS_S if s * self.per_s >= apart), STEPS_S[-1])
        return [round(number * step, 3) for number in range(int(end_s / step) + 1)]


def snapped(time: float, step: float) -> float:
    """The nearest multiple of a step; with 0 the time itself."""
    return round(round(time / step) * step, 3) if step > 0 else time
