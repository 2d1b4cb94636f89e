"""Two fingers: the page moves and grows with them."""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF

from .gesture import Pointer

if TYPE_CHECKING:
    from ..canvas import Canvas

LEAST_SPREAD_PX = 20.0
"""Fingers nearer to each other than this do not zoom: a pixel would be too much."""


class PinchZoom:
    """What was between the fingers at the press stays between them."""

    def __init__(self, canvas: Canvas, first: QPointF, second: QPointF) -> None:
        self._start = canvas.camera.x, canvas.camera.y, canvas.camera.scale
        self._middle = (first + second) / 2
        self._spread = _spread(first, second)

    def pinch(self, canvas: Canvas, first: QPointF, second: QPointF) -> None:
        """Follow the two fingers."""
        middle, spread = (first + second) / 2, _spread(first, second)
        way = self._middle - middle
        canvas.pan(way.x(), way.y())
        if abs(spread - self._spread) >= 1:
            canvas.zoom(canvas.camera.scale * spread / self._spread, middle)
        self._middle, self._spread = middle, spread

    def move(self, canvas: Canvas, pointer: Pointer) -> None:
        """One finger alone does nothing here."""

    def release(self, canvas: Canvas, pointer: Pointer) -> None:
        """Leave the page as it is."""

    def cancel(self, canvas: Canvas) -> None:
        """Go back to where the view was."""
        x, y, scale = self._start
        canvas.zoom(scale)
        canvas.move_camera(x, y)


def _spread(first: QPointF, second: QPointF) -> float:
    way = second - first
    return max(LEAST_SPREAD_PX, hypot(way.x(), way.y()))
