"""A ring of samples that is written twice, so that any window of it is one slice."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Ring:
    """The newest ``capacity`` samples of ``channels`` numbers each; its memory never grows.

    Every sample is stored at a place and again ``capacity`` places later: what is asked for is
    never in two pieces, and is given as a view, without copying.
    """

    def __init__(self, channels: int, capacity: int) -> None:
        self.capacity = capacity
        self.total = 0
        """How many samples were ever added."""
        self._next = 0
        self._table: Floats = np.zeros((channels, 2 * capacity))

    def __len__(self) -> int:
        return min(self.total, self.capacity)

    @property
    def size_bytes(self) -> int:
        """The memory that it takes, now and later."""
        return self._table.nbytes

    def append(self, block: Floats) -> None:
        """Add n samples, as an array (channels, n), the oldest first."""
        count = block.shape[1]
        self.total += count
        kept = block[:, -self.capacity :]
        while kept.shape[1]:
            part = kept[:, : self.capacity - self._next]
            kept = kept[:, part.shape[1] :]
            self._write(part)

    def replace_last(self, sample: Floats) -> None:
        """Put another sample (channels,) in the place of the newest one."""
        last = self._next - 1  # -1 is the end of the second half, the other one of the first
        self._table[:, last + self.capacity] = sample
        self._table[:, last if last >= 0 else self.capacity - 1] = sample

    def newest(self, count: int | None = None) -> Floats:
        """The newest samples, or all, as a view (channels, n) that the next samples overwrite."""
        count = len(self) if count is None else max(0, min(count, len(self)))
        end = self._next + self.capacity
        return self._table[:, end - count : end]

    def _write(self, part: Floats) -> None:
        end = self._next + part.shape[1]
        self._table[:, self._next : end] = part
        self._table[:, self._next + self.capacity : end + self.capacity] = part
        self._next = end % self.capacity
