"""How a sender's clock runs against ours, from when its samples arrive."""

from __future__ import annotations

from collections import deque
from statistics import median

_SPAN_S = 5.0  # of which the quickest arrival is kept: the others waited on their way
_MOST_SPANS = 60  # five minutes
_ENOUGH_SPANS = 5
_RECENT = 50  # arrivals that the usual delay is taken from


class ClockFit:
    """Fits a line through the quickest arrivals of each few seconds.

    A message is never too early, so the least delayed ones tell the offset of the two clocks; the
    median of the slopes between them (Theil-Sen) is the drift, whatever a few spans say.
    """

    def __init__(self) -> None:
        self._quickest: deque[tuple[float, float]] = deque(maxlen=_MOST_SPANS)
        self._span_end_s: float | None = None
        self._delays: deque[float] = deque(maxlen=_RECENT)
        self._slope = 0.0

    def add(self, sent_s: float, arrived_s: float) -> None:
        """A sample's time on the sender's clock, and when it arrived on ours."""
        offset_s = arrived_s - sent_s
        if self._span_end_s is None or arrived_s >= self._span_end_s:
            self._span_end_s = arrived_s + _SPAN_S
            self._slope = self._fit()
            self._quickest.append((arrived_s, offset_s))
        elif offset_s < self._quickest[-1][1]:
            self._quickest[-1] = (arrived_s, offset_s)
        self._delays.append(max(0.0, offset_s - self._expected(arrived_s)))

    @property
    def drift_ppm(self) -> float | None:
        """How much slower than ours the sender's clock runs, None before that is known."""
        return self._slope * 1e6 if len(self._quickest) > _ENOUGH_SPANS else None

    @property
    def delay_s(self) -> float:
        """How much later than the quickest a message usually arrives."""
        return median(self._delays) if self._delays else 0.0

    def lead_s(self, sent_s: float, arrived_s: float) -> float:
        """How much earlier than even the quickest before it this sample would have arrived."""
        if not self._quickest:
            return 0.0
        return self._expected(arrived_s) - (arrived_s - sent_s)

    def _expected(self, arrived_s: float) -> float:
        """The least offset at a moment, by the line through the quickest arrivals."""
        return min(
            offset_s + self._slope * (arrived_s - then_s) for then_s, offset_s in self._quickest
        )

    def _fit(self) -> float:
        points = list(self._quickest)
        if len(points) < _ENOUGH_SPANS:
            return 0.0
        slopes = [
            (later[1] - one[1]) / (later[0] - one[0])
            for number, one in enumerate(points)
            for later in points[number + 1 :]
            if later[0] > one[0]
        ]
        return median(slopes) if slopes else 0.0
