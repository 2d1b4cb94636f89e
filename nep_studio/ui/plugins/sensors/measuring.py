"""What is between two times of a curve: its values there, least, greatest, mean, frequency."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from nep_studio.ui.ring import Floats

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


# Which time the plots show: live, up to now, or a part of what was.

SHORTEST_S, LONGEST_S = 0.02, 4000.0
LENGTHS_S = (5.0, 10.0, 30.0)
"""The windows that a person can choose."""

ZOOM_STEP = 1.25
_EDGE = 0.1
"""How much of the width shows samples at least, however far a person goes."""

_FITTING_S = (5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 90.0)


@dataclass(frozen=True)
class TimeView:
    """``length_s`` of time; live while ``end_s`` is None, else up to that time."""

    length_s: float = 10.0
    end_s: float | None = None

    @property
    def is_live(self) -> bool:
        """Whether it goes on with the time."""
        return self.end_s is None

    def end(self, now_s: float) -> float:
        """The newest time that is shown."""
        return now_s if self.end_s is None else self.end_s

    def start(self, now_s: float) -> float:
        """The oldest time that is shown."""
        return self.end(now_s) - self.length_s

    def with_length(self, length_s: float) -> TimeView:
        """As much time as this, with the same end."""
        return replace(self, length_s=min(max(length_s, SHORTEST_S), LONGEST_S))

    def paused(self, now_s: float) -> TimeView:
        """What is shown now, and it stays."""
        return replace(self, end_s=self.end(now_s))

    def live(self) -> TimeView:
        """Up to now."""
        return replace(self, end_s=None)

    def zoomed(self, factor: float, share: float) -> TimeView:
        """Less time (``factor`` below 1) or more; what is at ``share`` of the width stays there.

        A live view stays live: its end is now.
        """
        new = self.with_length(self.length_s * factor)
        if self.end_s is None:
            return new
        return replace(new, end_s=self.end_s - (1 - share) * (self.length_s - new.length_s))

    def moved(self, seconds: float, oldest_s: float, newest_s: float) -> TimeView:
        """Later or earlier, but so that something of oldest to newest is in it."""
        if self.end_s is None:
            return self
        edge_s = _EDGE * self.length_s
        earliest, latest = oldest_s + edge_s, newest_s + self.length_s - edge_s
        return replace(self, end_s=max(min(self.end_s + seconds, latest), earliest))


def fitting_length(seconds: float) -> float:
    """The length that shows so many seconds; it grows in steps, not with every sample."""
    length = next((one for one in _FITTING_S if seconds <= one), _FITTING_S[-1])
    while length < min(seconds, LONGEST_S):
        length *= 1.5
    return min(length, LONGEST_S)
