"""The speech bubble over a robot's head."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPainterPath, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

LINES = 3
"""There is always room for so many, so that nothing jumps when the robot begins to speak."""


class SpeechBubble(QWidget):
    """What a robot says now; nothing is seen while it is silent."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.words = ""
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        look.theme_changed.connect(self.update)

    def say(self, words: str) -> None:
        """Show these words; none: be silent."""
        if words != self.words:
            self.words = words
            self.setToolTip(words)
            self.setAccessibleName(tr("Says “{text}”", text=words) if words else "")
            self.update()

    def sizeHint(self) -> QSize:
        """Room for a few lines, and the tail."""
        line = self.fontMetrics().height()
        return QSize(line * 10, round(line * (LINES + 1.4)))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the bubble as wide as its words, its tail down to the head."""
        if not self.words:
            return
        theme, line = self._look.theme, self.fontMetrics().height()
        tail, air = line * 0.6, line * 0.5
        room = QRectF(self.rect()).adjusted(1 + air, 1 + air / 2, -1 - air, -1 - tail - air / 2)
        flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
        words = self._fitting(room, flags)
        text = self.fontMetrics().boundingRect(room.toRect(), flags.value, words)
        bubble = QRectF(text).adjusted(-air, -air / 2, air, air / 2)
        bubble.moveBottom(self.height() - 1 - tail)
        bubble.moveLeft((self.width() - bubble.width()) / 2)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(theme.colour("field_line"), max(1.0, line / 14)))
        painter.setBrush(theme.colour("field"))
        painter.drawPath(_outline(bubble, tail, line / 2))
        painter.setPen(theme.colour("field_text"))
        painter.drawText(bubble, flags, words)

    def _fitting(self, room: QRectF, flags: Qt.AlignmentFlag | Qt.TextFlag) -> str:
        """The words as far as there is room for them."""
        words = self.words[:400]
        while words and self._height(words, room, flags) > room.height():
            words = words[: len(words) * 9 // 10].rstrip(" …") + "…"
            if len(words) < 4:
                break
        return words

    def _height(self, words: str, room: QRectF, flags: Qt.AlignmentFlag | Qt.TextFlag) -> int:
        endless = room.toRect()
        endless.setHeight(10_000)
        return self.fontMetrics().boundingRect(endless, flags.value, words).height()


def _outline(bubble: QRectF, tail: float, radius: float) -> QPainterPath:
    middle, foot = bubble.center().x(), bubble.bottom()
    body, point = QPainterPath(), QPainterPath()
    body.addRoundedRect(bubble, radius, radius)
    corners = [(middle - tail / 2, foot - 1), (middle + tail / 2, foot - 1), (middle, foot + tail)]
    point.addPolygon(QPolygonF([QPointF(x, y) for x, y in corners]))
    point.closeSubpath()
    return body.united(point)
