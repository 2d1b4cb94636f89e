"""How certain the recogniser is of one gesture, and its recognition point, which can be dragged."""

from __future__ import annotations

from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_studio.ui.theme import Look, paint_icon
from nep_studio.ui.trainer.results.point_panel import PointSlider
from nep_studio.ui.trainer.results.tuning import Tuning
from nep_studio.ui.words import tr

LINES_HIGH = 2.5


class GestureBar(PointSlider):
    """A slider: its value is the recognition point, the bar behind it is the certainty now."""

    def __init__(
        self, tuning: Tuning, name: str, look: Look, parent: QWidget | None = None
    ) -> None:
        super().__init__(tuning, parent)
        self._look = look
        self.certainty = 0.0
        self.is_flashing = False
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setToolTip(tr("Drag the mark: the bar must reach it for the gesture to count"))
        self.show_gesture(name)
        look.theme_changed.connect(self.update)

    def show_certainty(self, certainty: float, *, is_flashing: bool = False) -> None:
        """Show how certain it is, and whether the gesture was made a moment ago."""
        if (certainty, is_flashing) != (self.certainty, self.is_flashing):
            self.certainty, self.is_flashing = certainty, is_flashing
            self.update()

    def sizeHint(self) -> QSize:
        """A line of words, and the bar below it."""
        line = self.fontMetrics().height()
        return QSize(line * 12, round(line * LINES_HIGH))

    # The mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the mark."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.setSliderDown(True)
            self._drag(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the mark."""
        if self.isSliderDown():
            self._drag(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let the mark go."""
        if event.button() == Qt.MouseButton.LeftButton and self.isSliderDown():
            self.setSliderDown(False)

    def _drag(self, event: QMouseEvent) -> None:
        groove = self.groove()
        share = (event.position().x() - groove.left()) / max(groove.width(), 1.0)
        self.setValue(round(min(max(share, 0.0), 1.0) * 100))

    # Painting

    def groove(self) -> QRectF:
        """Where the bar is; its whole width is certainty 1."""
        line = self.fontMetrics().height()
        return QRectF(line * 0.5, line * 1.35, self.width() - line, line * 0.6)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the words, the bar and the mark."""
        theme, groove = self._look.theme, self.groove()
        line = self.fontMetrics().height()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.is_flashing:
            painter.setPen(QPen(theme.colour("success"), max(2.0, line / 8)))
            painter.setBrush(theme.colour("success_panel"))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(2, 1, -2, -1), line / 4, line / 4)
        self._paint_words(painter)
        painter.setPen(QPen(theme.colour("field_line"), 1))
        painter.setBrush(theme.colour("field"))
        painter.drawRect(groove)
        filled = QRectF(groove)
        filled.setWidth(groove.width() * min(self.certainty, 1.0))
        is_over = self.certainty >= self.value() / 100
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(theme.colour("success" if is_over else "plot_1"))
        if filled.width() > 1:
            painter.drawRect(filled.adjusted(1, 1, 0, -1))
        self._paint_mark(painter, groove.left() + groove.width() * self.value() / 100)
        painter.end()

    def _paint_words(self, painter: QPainter) -> None:
        theme, line, metrics = self._look.theme, self.fontMetrics().height(), self.fontMetrics()
        gesture = self.tuning.desk.gestures.get(self.name)
        percent = f"{self.certainty * 100:.0f} %"
        room = QRectF(line * 0.5, line * 0.15, self.width() - line, line * 1.1)
        painter.setPen(theme.colour("text"))
        painter.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(room, right, percent)
        if self.is_flashing:
            paint_icon(
                painter,
                QRectF(room.left(), room.top(), line, line),
                "circle-check",
                QColor(theme.colour("success")),
            )
            room.setLeft(room.left() + line * 1.3)
        room.setRight(room.right() - metrics.horizontalAdvance("100 %") - line * 0.4)
        title = gesture.title if gesture is not None else self.name
        words = metrics.elidedText(title, Qt.TextElideMode.ElideRight, int(room.width()))
        painter.drawText(room, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter, words)

    def _paint_mark(self, painter: QPainter, x: float) -> None:
        theme, groove, line = self._look.theme, self.groove(), self.fontMetrics().height()
        colour = theme.colour("focus" if self.hasFocus() else "text")
        painter.setPen(QPen(colour, max(2.0, line / 8)))
        painter.drawLine(QLineF(x, groove.top() - line * 0.1, x, groove.bottom() + line * 0.12))
        painter.setBrush(colour)
        size, low = line * 0.28, groove.bottom() + line * 0.1
        corners = [QPointF(x, low), QPointF(x - size, low + size), QPointF(x + size, low + size)]
        painter.drawPolygon(QPolygonF(corners))
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(theme.colour("focus"), max(1.5, line / 10)))
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1, 1, -1, -1), line / 4, line / 4)
