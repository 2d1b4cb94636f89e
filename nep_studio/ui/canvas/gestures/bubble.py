"""A small bubble beside the pointer: why something does not fit here, what letting go does."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPalette
from PySide6.QtWidgets import QLabel, QWidget

from nep_studio.ui.theme import Theme

OFFSET_PX = 18
WIDEST_LETTERS = 44


class Bubble(QLabel):
    """One sentence, shown over the view; it never takes the mouse."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._view = parent
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setForegroundRole(QPalette.ColorRole.WindowText)
        self._fill = QColor()
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.hide()

    def dress(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        palette = self.palette()
        self._fill = theme.colour("tooltip")
        palette.setColor(QPalette.ColorRole.WindowText, theme.colour("tooltip_text"))
        self.setPalette(palette)
        margin = self.fontMetrics().height() // 3
        self.setContentsMargins(2 * margin, margin, 2 * margin, margin)

    def say(self, text: str, at: QPoint) -> None:
        """Show a sentence beside a point of the view, inside the view; an empty one hides it."""
        if not text:
            self.hide()
            return
        if text != self.text():
            self.setText(text)
            self._take_size()
        room = self._view.rect()
        place = at + QPoint(OFFSET_PX, OFFSET_PX)
        if place.x() + self.width() > room.right():
            place.setX(at.x() - OFFSET_PX - self.width())
        if place.y() + self.height() > room.bottom():
            place.setY(at.y() - OFFSET_PX - self.height())
        self.move(max(0, place.x()), max(0, place.y()))
        self.show()
        self.raise_()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the sentence on a rounded ground."""
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self._fill)
            radius = self.fontMetrics().height() / 3
            painter.drawRoundedRect(self.rect(), radius, radius)
        super().paintEvent(event)

    def _take_size(self) -> None:
        margins = self.contentsMargins()
        sides = margins.left() + margins.right() + 2
        widest = self.fontMetrics().averageCharWidth() * WIDEST_LETTERS
        width = min(widest, self.fontMetrics().horizontalAdvance(self.text()) + sides)
        self.resize(width, max(1, self.heightForWidth(width)))
