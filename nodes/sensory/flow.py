"""How well samples flow in: their rate, what is lost, where there are gaps."""

from __future__ import annotations

from collections import deque
from itertools import pairwise
from statistics import median

_RATE_OVER = 200  # samples
_LOSS_OVER = 2_000  # samples
_FEW = 10
_MISSED = 1.6  # steps; a longer one misses samples
_GAP_S, _GAP_STEPS = 0.25, 4


class Flow:
    """Counts over the last samples; memory is bounded."""

    def __init__(self) -> None:
        self._times: deque[float] = deque(maxlen=_RATE_OVER)
        self._missed: deque[int] = deque(maxlen=_LOSS_OVER)
        self._step_s = 0.0
        self._since_step = 0
        self._numbers: deque[int] = deque(maxlen=_LOSS_OVER)  # lost messages before each
        self._last_number: int | None = None
        self.gaps = 0

    def add(self, t: float, *, is_stamped: bool = True) -> None:
        """A sample's time in s; times rise. Those of arrival tell nothing of losses."""
        if self._times and is_stamped:
            self._note_step(t - self._times[-1])
        self._times.append(t)
        self._since_step += 1
        if self._since_step >= _FEW:
            self._since_step = 0
            times = list(self._times)
            self._step_s = median([after - before for before, after in pairwise(times)])

    def add_message(self, number: int) -> None:
        """A message's place in the sender's count; one that starts anew loses nothing."""
        last, self._last_number = self._last_number, number
        if last is not None and 0 < number - last < _LOSS_OVER:
            self._numbers.append(number - last - 1)

    @property
    def rate_hz(self) -> float:
        """Samples a second, gaps left out; 0 while too few have come."""
        if len(self._times) < _FEW or self._times[-1] <= self._times[0]:
            return 0.0
        return (len(self._times) - 1) / (self._times[-1] - self._times[0])

    @property
    def loss(self) -> float:
        """The share of samples, or of messages, that is missing."""
        missed, lost = sum(self._missed), sum(self._numbers)
        by_cadence = missed / (missed + len(self._missed)) if self._missed else 0.0
        by_number = lost / (lost + len(self._numbers)) if self._numbers else 0.0
        return max(by_cadence, by_number)

    def _note_step(self, step_s: float) -> None:
        usual_s = self._step_s
        if not usual_s:
            return
        steps = step_s / usual_s
        self._missed.append(min(_LOSS_OVER, round(steps) - 1) if steps > _MISSED else 0)
        if step_s > max(_GAP_S, _GAP_STEPS * usual_s):
            self.gaps += 1
