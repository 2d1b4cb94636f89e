"""Which time the plots show: live, up to now, or a part of what was."""

from __future__ import annotations

from dataclasses import dataclass, replace

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
    for length in _FITTING_S:
        if seconds <= length:
            return length
    length = _FITTING_S[-1]
    while length < min(seconds, LONGEST_S):
        length *= 1.5
    return min(length, LONGEST_S)
