"""Samples brought down to what a screen can show: the least and the greatest of each column."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nep_studio.ui.panels.sensors.ring import Floats, Ring
from nep_studio.ui.panels.sensors.streams import Samples, Stream


@dataclass(frozen=True)
class Columns:
    """n columns that have samples in them.

    ``number`` (n,) counts columns of ``width_s`` from 1970, rising; ``low`` and ``high``
    (channels, n) are NaN in a gap.
    """

    width_s: float
    number: Floats
    low: Floats
    high: Floats

    @property
    def middle_s(self) -> Floats:
        """When the middles of the columns are."""
        middle: Floats = (self.number + 0.5) * self.width_s
        return middle

    def between(self, start_s: float, end_s: float) -> Columns:
        """The columns from a time to another, and one more on each side."""
        first = int(np.searchsorted(self.number, start_s / self.width_s)) - 2
        last = int(np.searchsorted(self.number, end_s / self.width_s)) + 1
        part = slice(max(0, first), last)
        return Columns(self.width_s, self.number[part], self.low[:, part], self.high[:, part])


def columns_of(samples: Samples, width_s: float) -> Columns:
    """Bring samples down to columns; costs some time for each sample."""
    if not len(samples.t):
        nothing = np.empty((len(samples.values), 0))
        return Columns(width_s, np.empty(0), nothing, nothing)
    number = np.floor(samples.t / width_s)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(number)) + 1])
    low = np.fmin.reduceat(samples.values, starts, axis=1)
    high = np.fmax.reduceat(samples.values, starts, axis=1)
    return Columns(width_s, number[starts], low, high)


class LiveColumns:
    """The columns of a stream that goes on: only samples that are new are looked at."""

    def __init__(self, stream: Stream, width_s: float, most: int) -> None:
        self.width_s = width_s
        self._stream = stream
        self._channels = len(stream.channels)
        self._ring = Ring(1 + 2 * self._channels, most)
        self._seen = 0

    def is_of(self, stream: Stream) -> bool:
        """Whether it follows this stream."""
        return stream is self._stream

    def refresh(self) -> None:
        """Take what the stream has heard since the last time."""
        new = self._stream.total - self._seen
        self._seen = self._stream.total
        if new <= 0:
            return
        columns = columns_of(self._stream.samples(new), self.width_s)
        table = np.vstack([columns.number, columns.low, columns.high])
        if len(self._ring) and self._ring.newest(1)[0, 0] == table[0, 0]:
            self._ring.replace_last(self._joined(table[:, 0]))
            table = table[:, 1:]
        self._ring.append(table)

    def columns(self) -> Columns:
        """All columns that are kept; a view that lives until the next refresh."""
        table = self._ring.newest()
        return Columns(
            self.width_s, table[0], table[1 : 1 + self._channels], table[1 + self._channels :]
        )

    def _joined(self, column: Floats) -> NDArray[np.float64]:
        """The newest column and more samples of it."""
        last = self._ring.newest(1)[:, 0]
        low, high = slice(1, 1 + self._channels), slice(1 + self._channels, None)
        joined = column.copy()
        joined[low] = np.fmin(last[low], column[low])
        joined[high] = np.fmax(last[high], column[high])
        return joined
