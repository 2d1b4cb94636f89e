"""Tells when samples were measured: from a sensor's own clock to the clock on the wall."""

from __future__ import annotations

from collections import deque

import numpy as np

from nep_studio.ui.panels.sensors.ring import Floats

JUMP_S = 0.5
"""Clocks that disagree more than this about one step: one of them was set anew."""
_UNNOTICED_S = 0.03
"""Messages come at uneven times; a smaller disagreement is no reason to shift samples."""
_LOOKED_BACK_S = 1.5
_ENOUGH_S = 0.5
_REAL_TIME = 0.1
"""A clock within a tenth of the wall's runs like it; a recording may be played at any speed."""


class ClockMap:
    """Maps times of one sensor to s since 1970; what it gives always rises."""

    def __init__(self) -> None:
        self._last_t = 0.0
        self._last_s = -np.inf
        self._pace = 1.0
        self._arrivals: deque[tuple[float, float]] = deque(maxlen=64)

    def to_wall(self, t: Floats, arrived_s: float) -> tuple[Floats, bool]:
        """Times of samples ``t`` (n,), n > 0, that arrived together; whether a clock jumped."""
        if not self._arrivals or self._has_jumped(t, arrived_s):
            return self._start_anew(t, arrived_s), True
        self._arrivals.append((float(t[-1]), arrived_s))
        self._set_pace(arrived_s)
        steps = t - self._last_t
        ahead_s = self._last_s + float(steps[-1]) * self._pace - arrived_s
        times = self._last_s + steps * (self._pace * self._correction(ahead_s))
        self._last_t, self._last_s = float(t[-1]), float(times[-1])
        return times, False

    def _has_jumped(self, t: Floats, arrived_s: float) -> bool:
        if t[0] <= self._last_t:
            return True
        by_wall_s = arrived_s - self._arrivals[-1][1]
        return bool(abs((t[-1] - self._last_t) * self._pace - by_wall_s) > JUMP_S)

    def _start_anew(self, t: Floats, arrived_s: float) -> Floats:
        first_s = max(arrived_s - float(t[-1] - t[0]), self._last_s + 0.001)
        times: Floats = first_s + (t - t[0])
        self._arrivals.clear()
        self._arrivals.append((float(t[-1]), arrived_s))
        self._pace = 1.0
        self._last_t, self._last_s = float(t[-1]), float(times[-1])
        return times

    def _set_pace(self, now_s: float) -> None:
        """How many s pass on the wall in one of the sensor's."""
        while self._arrivals[0][1] < now_s - _LOOKED_BACK_S and len(self._arrivals) > 2:
            self._arrivals.popleft()
        t, arrived_s = self._arrivals[0]
        if now_s - arrived_s < _ENOUGH_S or self._arrivals[-1][0] <= t:
            return
        pace = (now_s - arrived_s) / (self._arrivals[-1][0] - t)
        self._pace = 1.0 if abs(pace - 1) < _REAL_TIME else pace

    def _correction(self, ahead_s: float) -> float:
        """How much faster or slower the time of samples passes, until both clocks agree."""
        if abs(ahead_s) < _UNNOTICED_S:
            return 1.0
        return float(np.clip(1 - ahead_s / _ENOUGH_S, 0.5, 2.0))
