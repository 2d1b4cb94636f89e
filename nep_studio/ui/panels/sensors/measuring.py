"""What is between two times of a curve: its values there, least, greatest, mean, frequency."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nep_studio.ui.panels.sensors.ring import Floats

_SLACK = 0.3
"""A wave must leave the middle by this part of its deviation before it may come back."""


@dataclass(frozen=True)
class Measured:
    """One curve between two times; None where the samples do not tell."""

    first: float | None
    last: float | None
    least: float | None = None
    greatest: float | None = None
    mean: float | None = None
    frequency_hz: float | None = None

    @property
    def change(self) -> float | None:
        """How much more the last value is than the first."""
        return None if self.first is None or self.last is None else self.last - self.first


def measure(t: Floats, values: Floats, start_s: float, end_s: float) -> Measured:
    """Measure samples ``t`` (n,) rising and ``values`` (n,), NaN at gaps, between two times."""
    first_s, last_s = min(start_s, end_s), max(start_s, end_s)
    ends = (value_at(t, values, start_s), value_at(t, values, end_s))
    window = slice(int(np.searchsorted(t, first_s)), int(np.searchsorted(t, last_s, side="right")))
    inside = np.isfinite(values[window])
    if not inside.any():
        return Measured(*ends)
    kept = values[window][inside]
    return Measured(
        *ends,
        least=float(kept.min()),
        greatest=float(kept.max()),
        mean=float(kept.mean()),
        frequency_hz=frequency(t[window][inside], kept),
    )


def value_at(t: Floats, values: Floats, time_s: float) -> float | None:
    """The value at a time, on the line between two samples; None in gaps and outside."""
    if not len(t) or not t[0] <= time_s <= t[-1]:
        return None
    value = float(np.interp(time_s, t, values))
    return value if np.isfinite(value) else None


def frequency(t: Floats, values: Floats) -> float | None:
    """How often a wave comes a second, from where it rises through its middle; None when it
    does so fewer than three times.
    """
    middle, slack = values.mean(), _SLACK * values.std()
    if slack == 0:
        return None
    side = np.where(values > middle + slack, 1, np.where(values < middle - slack, -1, 0))
    clear = np.flatnonzero(side)
    rises = clear[1:][(side[clear[1:]] > 0) & (side[clear[:-1]] < 0)]
    if len(rises) < 3:
        return None
    times = [_crossing(t, values, middle, int(at)) for at in rises]
    return (len(times) - 1) / (times[-1] - times[0])


def _crossing(t: Floats, values: Floats, middle: float, at: int) -> float:
    """When the values rose through the middle, before sample ``at`` which is above it."""
    while at > 0 and values[at - 1] > middle:
        at -= 1
    if at == 0:
        return float(t[0])
    share = (middle - values[at - 1]) / (values[at] - values[at - 1])
    return float(t[at - 1] + share * (t[at] - t[at - 1]))
