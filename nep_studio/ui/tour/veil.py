"""The veil of the tour: it darkens the window but for the place that is shown."""

from __future__ import annotations

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from nep_studio.ui.theme import Look

DARKNESS = {False: 105, True: 165}
"""How dark the veil is, of 255, over a light and over a dark theme."""


class Veil(QWidget):
    """Lies over the whole window; the mouse goes through it everywhere."""

    def __init__(self, look: Look, window: QWidget) -> None:
        super().__init__(window)
        self._look = look
        self.hole = QRect()
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.hide()

    def show_hole(self, hole: QRect) -> None:
        """Show a place of the window; an empty one darkens all of it."""
        if hole != self.hole:
            self.hole = hole
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the veil, and a line around the place."""
        theme, line = self._look.theme, self.fontMetrics().height()
        path = QPainterPath()
        path.addRect(self.rect())
        round_ = line * 0.45
        place = self.hole.toRectF().adjusted(-3, -3, 3, 3) & self.rect().toRectF()
        if not self.hole.isEmpty():
            path.addRoundedRect(place, round_, round_)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.fillPath(path, QColor(0, 0, 0, DARKNESS[theme.is_dark]))
            if not self.hole.isEmpty():
                width = max(2.0, line / 7)
                painter.setPen(QPen(theme.colour("glow"), width))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                inner = place.adjusted(width / 2, width / 2, -width / 2, -width / 2)
                painter.drawRoundedRect(inner, round_, round_)
