"""Which values a plot shows: all that are there, without trembling with every sample."""

from __future__ import annotations

import math
from dataclasses import dataclass

_ROOM = 0.08
"""Above and below the curves, as a part of their height."""
_EMPTY = 0.45
"""When curves need less than this part of the height, the range becomes narrower."""
_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)


@dataclass(frozen=True)
class ValueRange:
    """The values from ``low`` to ``high``, which is greater."""

    low: float = -1.0
    high: float = 1.0

    @property
    def height(self) -> float:
        """How far it reaches."""
        return self.high - self.low

    def zoomed(self, factor: float, share: float) -> ValueRange:
        """Fewer values (``factor`` below 1) or more; the one at ``share`` from below stays."""
        held = self.low + share * self.height
        height = min(max(self.height * factor, 1e-9), 1e12)
        return ValueRange(held - share * height, held + (1 - share) * height)

    def moved(self, by: float) -> ValueRange:
        """Higher or lower values."""
        return ValueRange(self.low + by, self.high + by)

    def fitted(self, low: float, high: float) -> ValueRange:
        """A range for values from ``low`` to ``high``: this one while it serves them well."""
        if not (math.isfinite(low) and math.isfinite(high)):
            return self
        is_inside = self.low <= low and high <= self.high
        least = _least_height(low, high)
        if is_inside and max(high - low, least) >= _EMPTY * self.height:
            return self
        return _round_range(low, high, least)


def _least_height(low: float, high: float) -> float:
    """A curve that does not change is a line in the middle, not noise of its last digit."""
    return max(abs(low), abs(high), 1e-6) * 1e-3


def _round_range(low: float, high: float, least: float) -> ValueRange:
    middle, height = (low + high) / 2, max(high - low, least)
    step = _round_step(height / 8)
    first = math.floor((middle - height * (0.5 + _ROOM)) / step) * step
    last = math.ceil((middle + height * (0.5 + _ROOM)) / step) * step
    return ValueRange(first, last)


def _round_step(height: float) -> float:
    power: float = 10.0 ** math.floor(math.log10(height))
    return next(step * power for step in _STEPS if step * power >= height * 0.999)
