"""Words that are as large as the room allows, for people who stand far away."""

from __future__ import annotations

from PySide6.QtCore import QRect, QSize, Qt
from PySide6.QtGui import QFont, QFontMetrics, QPainter, QPaintEvent, QPalette
from PySide6.QtWidgets import QSizePolicy, QWidget

_FLAGS = Qt.TextFlag.TextWordWrap.value | Qt.AlignmentFlag.AlignCenter.value


class StageWords(QWidget):
    """A text that fills its room, with the lines before it, smaller, above."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.lines: list[str] = []
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def show_lines(self, lines: list[str]) -> None:
        """Show these, the last one large."""
        self.lines = lines
        self.setAccessibleName(lines[-1] if lines else "")
        self.update()

    def sizeHint(self) -> QSize:
        """A few lines."""
        line = self.fontMetrics().height()
        return QSize(line * 20, line * 8)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the lines."""
        if not self.lines:
            return
        *before, now = self.lines
        with QPainter(self) as painter:
            room = self.rect()
            small = self._font(room.height() / 14)
            height = QFontMetrics(small).lineSpacing()
            painter.setFont(small)
            painter.setPen(self.palette().color(QPalette.ColorRole.PlaceholderText))
            metrics = QFontMetrics(small)
            for number, line in enumerate(before):
                row = QRect(room.left(), room.top() + number * height, room.width(), height)
                shown = metrics.elidedText(line, Qt.TextElideMode.ElideRight, row.width())
                painter.drawText(row, Qt.AlignmentFlag.AlignCenter, shown)
            large = room.adjusted(0, len(before) * height, 0, 0)
            painter.setFont(self._fitting(now, large))
            painter.setPen(self.palette().color(QPalette.ColorRole.WindowText))
            painter.drawText(large, _FLAGS, now)

    def _fitting(self, text: str, room: QRect) -> QFont:
        """The largest font in which the text fits."""
        least, most = 8, max(9, room.height() // 3)
        while least < most:
            middle = (least + most + 1) // 2
            metrics = QFontMetrics(self._font(middle))
            needed = metrics.boundingRect(room, _FLAGS, text)
            fits = needed.height() <= room.height() and needed.width() <= room.width()
            least, most = (middle, most) if fits else (least, middle - 1)
        return self._font(least)

    def _font(self, pixels: float) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(max(8, round(pixels)))
        font.setWeight(QFont.Weight.DemiBold)
        return font
