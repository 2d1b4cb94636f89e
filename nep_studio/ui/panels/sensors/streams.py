"""What was measured by one sensor, or heard of one field: samples over the clock on the wall."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nep_studio.ui.panels.sensors.ring import Floats, Ring


@dataclass(frozen=True)
class StreamKey:
    """Which stream: what is heard under a topic of one sender; ``path`` of a field, else ""."""

    topic: str
    sender: str
    path: str = ""


@dataclass(frozen=True)
class Channel:
    """One number of a stream: its name, its unit, and the group whose axis it shares."""

    name: str
    unit: str
    group: str


@dataclass(frozen=True)
class Samples:
    """n samples: ``t`` (n,) s since 1970, rising; ``values`` (channels, n), NaN at a gap."""

    t: Floats
    values: Floats

    def between(self, start_s: float, end_s: float) -> Samples:
        """The samples from a time to another, both included."""
        first = int(np.searchsorted(self.t, start_s, side="left"))
        last = int(np.searchsorted(self.t, end_s, side="right"))
        return Samples(self.t[first:last], self.values[:, first:last])

    def around(self, start_s: float, end_s: float) -> Samples:
        """The same, and one sample more on each side, so that lines go on to the edges."""
        first = int(np.searchsorted(self.t, start_s, side="left"))
        last = int(np.searchsorted(self.t, end_s, side="right"))
        window = slice(max(0, first - 1), last + 1)
        return Samples(self.t[window], self.values[:, window])

    @staticmethod
    def none(channels: int = 0) -> Samples:
        """No samples."""
        return Samples(np.empty(0), np.empty((channels, 0)))

    def copied(self) -> Samples:
        """The same in memory of its own."""
        return Samples(self.t.copy(), self.values.copy())


class Stream:
    """A ring of samples; a gap is one sample of NaN in the middle of it."""

    def __init__(self, key: StreamKey, channels: tuple[Channel, ...], capacity: int) -> None:
        self.key, self.channels = key, channels
        self._ring = Ring(1 + len(channels), capacity)

    @property
    def total(self) -> int:
        """How many samples were ever added, gaps among them."""
        return self._ring.total

    @property
    def size_bytes(self) -> int:
        """The memory that its samples take."""
        return self._ring.size_bytes

    @property
    def last_s(self) -> float:
        """When the newest sample was measured; minus infinity when there is none."""
        return float(self._ring.newest(1)[0, 0]) if len(self._ring) else -np.inf

    @property
    def first_s(self) -> float:
        """When the oldest sample that is kept was measured; infinity when there is none."""
        return float(self._ring.newest()[0, 0]) if len(self._ring) else np.inf

    def samples(self, count: int | None = None) -> Samples:
        """The newest samples, or all; a view that lives until the next ones come."""
        table = self._ring.newest(count)
        return Samples(table[0], table[1:])

    def add(self, t: Floats, values: Floats, *, is_after_gap: bool = False) -> None:
        """Add samples: ``t`` (n,) rising, ``values`` (channels, n)."""
        if is_after_gap and len(self._ring):
            middle_s = (self.last_s + float(t[0])) / 2
            gap = np.full((1 + len(self.channels), 1), np.nan)
            gap[0] = middle_s
            self._ring.append(gap)
        self._ring.append(np.vstack([t[None], values]))
