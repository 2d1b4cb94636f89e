"""Columns of a curve as lines on the screen, made by numpy without a loop over points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyqtgraph
from PySide6.QtGui import QPolygonF

from nep_studio.ui.panels.sensors.columns import Columns
from nep_studio.ui.panels.sensors.ranges import ValueRange
from nep_studio.ui.panels.sensors.ring import Floats

_FAR = 4.0
"""How many heights of the plot a line may go beyond it: further makes drawing slow."""
_DOT = np.array([[-1.0, 0.0], [1.0, 0.0]])


@dataclass(frozen=True)
class Frame:
    """What part of time and values is where: ``width`` by ``height`` logical pixels."""

    start_s: float
    length_s: float
    values: ValueRange
    width: float
    height: float

    def x(self, time_s: float) -> float:
        """Where a time is."""
        return (time_s - self.start_s) / self.length_s * self.width

    def time(self, x: float) -> float:
        """Which time is there."""
        return self.start_s + x / self.width * self.length_s

    def y(self, value: float) -> float:
        """Where a value is."""
        return (self.values.high - value) / self.values.height * self.height


def polygons(columns: Columns, channel: int, frame: Frame) -> list[QPolygonF]:
    """The lines of one channel: one from gap to gap."""
    return [polygon(points) for points in lines(columns, channel, frame)]


def lines(columns: Columns, channel: int, frame: Frame) -> list[Floats]:
    """The points (n, 2) of the lines of one channel: one line from gap to gap.

    A line goes through the least and the greatest of each column, up in one and down in the next:
    what is between two columns is then as short as it can be.
    """
    if not len(columns.number):
        return []
    x = (columns.middle_s - frame.start_s) * (frame.width / frame.length_s)
    is_falling = (columns.number % 2).astype(bool)
    low, high = columns.low[channel], columns.high[channel]
    scale = frame.height / frame.values.height
    points = np.empty((2 * len(x), 2))
    points[0::2, 0] = points[1::2, 0] = x
    points[0::2, 1] = np.where(is_falling, high, low)
    points[1::2, 1] = np.where(is_falling, low, high)
    points[:, 1] = (frame.values.high - points[:, 1]) * scale
    np.clip(points[:, 1], -_FAR * frame.height, (1 + _FAR) * frame.height, out=points[:, 1])
    return _between_gaps(points)


def polygon(points: Floats) -> QPolygonF:
    """Points (n, 2) as Qt takes them."""
    if len(points) == 1:
        points = points[[0, 0]]
    if len(points) == 2 and (points[0] == points[1]).all():
        points = points + _DOT  # one sample between two gaps: a short line, so that it is seen
    made: QPolygonF = pyqtgraph.functions.create_qpolygonf(len(points))
    pyqtgraph.functions.ndarray_from_qpolygonf(made)[:] = points
    return made


def _between_gaps(points: Floats) -> list[Floats]:
    is_gap = np.isnan(points[:, 1])
    if not is_gap.any():
        return [points]
    edges = np.flatnonzero(np.diff(is_gap)) + 1
    return [part for part in np.split(points, edges) if not np.isnan(part[0, 1])]
