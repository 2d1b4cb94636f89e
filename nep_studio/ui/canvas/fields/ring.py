"""The line around the field whose popup is open."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter, QPen

from .places import piece_of

if TYPE_CHECKING:
    from ..canvas import Canvas
    from ..view import PageView


class FieldRing:
    """Shows which field is being edited."""

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas

    def paint(self, painter: QPainter, view: PageView) -> None:
        """Draw the line around the field that is edited, in its shape."""
        place = self._canvas.fields.place
        found = piece_of(self._canvas, *place) if place is not None else None
        if found is None:
            return
        placed, piece = found
        painter.setPen(QPen(view.theme.colour("focus"), 3 * view.measures.unit))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        x, y = placed.x + piece.x, placed.y + piece.y
        painter.translate(x, y)
        painter.drawPath(view.block_painter.outlines.slot(piece.shape, piece.width, piece.height))
        painter.translate(-x, -y)
