"""The big dot that answers a movement: grey while nothing comes, green once it has moved."""

from __future__ import annotations

from typing import Literal

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_studio.ui.theme import Look, paint_icon

Moving = Literal["waiting", "still", "moved", "failed"]
LINES_HIGH = 3.6
LIVELIEST_M_S2 = 15.0
"""A movement of so much fills the dot."""
SMALLEST = 0.62
ICONS = {"waiting": "hourglass", "still": "hand", "moved": "check", "failed": "x"}
COLOURS = {"waiting": "muted", "still": "info", "moved": "success", "failed": "error"}


class MoveDot(QWidget):
    """Grows with the movement; its shape and its sign differ, not its colour alone."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.state: Moving = "waiting"
        self._look = look
        self._liveliness = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)

    def show_movement(self, state: Moving, movement_m_s2: float) -> None:
        """Show how it is; the movement is how far the acceleration reached lately."""
        liveliness = min(1.0, max(0.0, movement_m_s2 / LIVELIEST_M_S2))
        if (state, liveliness) != (self.state, self._liveliness):
            self.state, self._liveliness = state, liveliness
            self.update()

    def sizeHint(self) -> QSize:
        """As high as a few lines."""
        side = round(self.fontMetrics().height() * LINES_HIGH)
        return QSize(side, side)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        theme, side = self._look.theme, min(self.width(), self.height())
        colour = theme.colour(COLOURS[self.state])
        is_live = self.state in ("still", "moved")
        share = SMALLEST + (1 - SMALLEST) * self._liveliness if is_live else SMALLEST + 0.2
        radius = side / 2 * share - 1
        middle = QPointF(self.width() / 2, self.height() / 2)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            pen = QPen(colour, max(1.5, side / 28))
            if not is_live:
                pen.setStyle(Qt.PenStyle.DashLine)
            painter.setPen(pen)
            painter.setBrush(colour if is_live else Qt.BrushStyle.NoBrush)
            painter.drawEllipse(middle, radius, radius)
            sign = side * 0.34
            place = QRectF(middle.x() - sign / 2, middle.y() - sign / 2, sign, sign)
            of_sign = theme.colour("field") if is_live else colour
            paint_icon(painter, place, ICONS[self.state], of_sign)
