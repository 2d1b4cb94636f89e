"""Outlines in numpy as polygons of Qt, all at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QByteArray, QDataStream
from PySide6.QtGui import QPolygonF

MANY_PX, SOME_PX = 34.0, 11.0
"""Parts that are larger than this have all corners, or half of them."""


def polygons(outlines: NDArray[np.float64]) -> list[QPolygonF]:
    """The outlines (n, k, 2) as n polygons.

    Qt reads them from its own binary form, which is ten times faster than making each point.
    """
    count, corners = outlines.shape[:2]
    rows = np.empty((count, 4 + 16 * corners), np.uint8)
    rows[:, :4] = np.frombuffer(np.array([corners], ">u4").tobytes(), np.uint8)
    rows[:, 4:] = np.ascontiguousarray(outlines, ">f8").reshape(count, 2 * corners).view(np.uint8)
    stream = QDataStream(QByteArray(rows.tobytes()))
    made = []
    for _ in range(count):
        polygon = QPolygonF()
        stream >> polygon
        made.append(polygon)
    return made


def fitting_polygons(outlines: NDArray[np.float64], sizes: NDArray[np.float64]) -> list[QPolygonF]:
    """The outlines (n, k, 2) as polygons, the smaller ones (sizes (n,), pixels) with less corners.

    Painting a polygon takes as long as it has corners, and most parts of a robot are small.
    """
    made: list[QPolygonF] = [QPolygonF()] * len(outlines)
    steps = np.digitize(-sizes, [-MANY_PX, -SOME_PX])
    for step in range(3):
        numbers = np.flatnonzero(steps == step)
        for number, polygon in zip(
            numbers.tolist(), polygons(outlines[numbers, :: 1 << step]), strict=True
        ):
            made[number] = polygon
    return made
