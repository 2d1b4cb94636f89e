"""A sensor's samples at an even rate, whatever the sensor's clock and connection do."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

RATE_HZ = 50.0
MAX_GAP_S = 0.5
"""A longer silence ends the movement: nothing is made up to fill it."""
_CLOCK_RESET_S = 1.0
_LATEST_S = 1e10  # later, two samples could have the same time; 1e10 s are 300 years
# m/s² and rad/s: twice what the sensors of watches and phones can measure
_LIMITS = np.array([320.0, 320.0, 320.0, 80.0, 80.0, 80.0])


@dataclass(frozen=True)
class Stretch:
    """m even samples: ``t`` (m,) s on the sensor's clock, ``values`` (m, 3 or 6) m/s² and rad/s.

    ``follows`` tells that it goes on where the stretch before it ended.
    """

    t: Floats
    values: Floats
    follows: bool


class EvenStream:
    """Turns samples as they come into samples at ``rate_hz``, by linear interpolation.

    Samples that are not numbers, come twice or come too late are left out; after a gap, or a
    clock that was set back, a new stretch begins.
    """

    def __init__(self, rate_hz: float = RATE_HZ) -> None:
        self.rate_hz = rate_hz
        self._seen_s = np.nan
        self._kept_s = np.nan
        self._kept = np.empty(0)
        self._origin_s = 0.0
        self._made = 0

    def push(self, t: ArrayLike, values: ArrayLike) -> Iterator[Stretch]:
        """Take n samples: ``t`` (n,) or one number, ``values`` (n, 3 or 6) or one row."""
        times_s = np.atleast_1d(np.asarray(t, float))
        rows = np.atleast_2d(np.asarray(values, float))
        usable = (np.abs(times_s) < _LATEST_S) & np.isfinite(rows).all(axis=1)
        times_s, rows = times_s[usable], _within_limits(rows[usable])
        if not len(times_s):
            return
        steps_s = times_s - np.concatenate([[self._seen_s], times_s[:-1]])
        self._seen_s = float(times_s[-1])
        breaks = np.flatnonzero(~((steps_s >= -_CLOCK_RESET_S) & (steps_s <= MAX_GAP_S)))
        begins = 0
        for ends in (*breaks.tolist(), len(times_s)):
            if ends > begins:
                part = slice(begins, ends)
                yield from self._resample(times_s[part], rows[part], begins in breaks)
            begins = ends

    def _resample(self, t: Floats, values: Floats, starts: bool) -> Iterator[Stretch]:
        if starts:
            self._origin_s, self._made = t[0], 0
        else:
            t, values = np.append(self._kept_s, t), np.vstack([self._kept, values])
        rises = np.ones(len(t), bool)
        rises[1:] = t[1:] > np.maximum.accumulate(t)[:-1]
        t, values = t[rises], values[rises]
        self._kept_s, self._kept = t[-1], values[-1]
        last = int(np.floor((t[-1] - self._origin_s) * self.rate_hz + 1e-9))
        even_s = self._origin_s + np.arange(self._made, last + 1) / self.rate_hz
        follows = self._made > 0
        self._made = max(self._made, last + 1)
        if len(even_s):
            yield Stretch(even_s, _interpolated(even_s, t, values), follows)


class Memory:
    """The last samples of a stream, in order, in one array that is seldom moved."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._rows = np.empty((0, 0))
        self._end = 0

    def __len__(self) -> int:
        return min(self._end, self._size)

    def clear(self) -> None:
        """Forget everything."""
        self._end = 0

    def add(self, row: Floats) -> None:
        """Remember one sample more, and forget the oldest when there are too many."""
        if self._rows.shape[1] != len(row):
            self._rows, self._end = np.empty((4 * self._size, len(row))), 0
        if self._end == len(self._rows):
            self._rows[: self._size] = self._rows[-self._size :]
            self._end = self._size
        self._rows[self._end] = row
        self._end += 1

    def samples(self) -> Floats:
        """The samples remembered, oldest first; (len, columns)."""
        return self._rows[self._end - len(self) : self._end]


def _interpolated(at: Floats, t: Floats, values: Floats) -> Floats:
    """Values (n, columns) at rising times ``t`` (n,) as values at other times between them."""
    if len(t) == 1:
        return np.repeat(values, len(at), axis=0)
    before = np.clip(np.searchsorted(t, at, side="right") - 1, 0, len(t) - 2)
    part = np.clip((at - t[before]) / (t[before + 1] - t[before]), 0.0, 1.0)[:, None]
    between: Floats = values[before] * (1 - part) + values[before + 1] * part
    return between


def _within_limits(values: Floats) -> Floats:
    limits = _LIMITS[: values.shape[1]]
    within: Floats = np.minimum(np.maximum(values, -limits), limits)
    return within
