"""The canvas behind the blocks: plain, with dots that let the eye measure."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainter, QPen

from nep_studio.ui.theme import Theme

from .camera import Camera
from .index import Rect

STEP = 32.0
"""How far the dots are apart, in canvas units."""

SMALLEST_DOT_SCALE = 0.5


def paint_background(painter: QPainter, rect: Rect, camera: Camera, theme: Theme) -> None:
    """Paint what is behind the blocks in a part of the page."""
    pixel = 1.0 / camera.scale
    whole = QRectF(rect.x, rect.y, rect.width, rect.height).adjusted(-pixel, -pixel, pixel, pixel)
    painter.fillRect(whole, theme.colour("canvas"))
    if camera.scale < SMALLEST_DOT_SCALE:
        return
    columns = range(int(rect.x // STEP), int(rect.right // STEP) + 2)
    rows = range(int(rect.y // STEP), int(rect.bottom // STEP) + 2)
    painter.setPen(QPen(theme.colour("canvas_dot"), 2.0))
    painter.drawPoints([QPointF(x * STEP, y * STEP) for x in columns for y in rows])
