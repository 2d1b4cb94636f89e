"""The last half minute: how certain the recogniser was, and what it would have recognised."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy

from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import InLines
from nep_studio.ui.words import count_words, tr
from nodes.perceptual.recognition.features import Detection

from .certainties import KEPT_S, CertaintyHistory
from .findings import Tuning
from .threshold import PointSlider

LINES_HIGH = 6.0
_EVERY_S = 5.0


class TriggerTimeline(InLines):
    """Now is at the right. A flag with a name is a gesture that would count as made."""

    usual_lines, least_lines = (16, LINES_HIGH), (9, LINES_HIGH)

    def __init__(self, title: Callable[[str], str], look: Look) -> None:
        super().__init__()
        self._title, self._look = title, look
        self._history = CertaintyHistory()
        self._triggers: Sequence[Detection] = ()
        self.setLayoutDirection(Qt.LayoutDirection.LeftToRight)  # as the live curves are
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        labelled(self, name="The last 30 seconds")
        look.theme_changed.connect(self.update)
        follow_words(self, self._say)

    def show_history(self, history: CertaintyHistory, triggers: Sequence[Detection]) -> None:
        """Show these."""
        is_new = len(triggers) != len(self._triggers)
        self._history, self._triggers = history, triggers
        if is_new:
            self._say()
        self.update()

    def _say(self) -> None:
        count = len(self._triggers)
        words = count_words(
            count, "1 gesture would count as made", "{n} gestures would count as made"
        )
        self.setAccessibleDescription(words if count else "")

    def area(self) -> QRectF:
        """Where the curve is."""
        line = self.fontMetrics().height()
        return QRectF(1, line * 0.4, self.width() - 2, self.height() - line * 1.8)

    def x_of(self, time_s: float) -> float:
        """Where a moment is."""
        area = self.area()
        return area.right() - (self._history.now_s - time_s) / KEPT_S * area.width()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint everything."""
        theme, area = self._look.theme, self.area()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        painter.fillRect(area, theme.colour("field"))
        self._paint_scale(painter, theme)
        self._paint_curve(painter, theme)
        places = [self.x_of(one.t_end) for one in self._triggers]
        ends = [*places, area.right()][1:]
        for one, x, end in zip(self._triggers, places, ends, strict=True):
            self._paint_flag(painter, theme, x)
            self._paint_name(painter, theme, self._title(one.gesture), x, end)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(theme.colour("line"), 1))
        painter.drawRect(area)
        painter.end()

    def _paint_scale(self, painter: QPainter, theme: Theme) -> None:
        area, line = self.area(), self.fontMetrics().height()
        seconds = 0.0
        while seconds < KEPT_S:
            x = area.right() - seconds / KEPT_S * area.width()
            painter.setPen(QPen(theme.colour("line"), 1))
            painter.drawLine(QLineF(x, area.top(), x, area.bottom()))
            words = tr("now") if not seconds else tr("{seconds} s ago", seconds=f"{seconds:.0f}")
            wide = self.fontMetrics().horizontalAdvance(words)
            if not seconds or (seconds % (2 * _EVERY_S) == 0 and x - wide / 2 > 0):
                painter.setPen(theme.colour("muted"))
                left = min(x - wide / 2, self.width() - wide - 1)
                room = QRectF(left, area.bottom() + line * 0.1, wide + 1, line * 1.1)
                painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)
            seconds += _EVERY_S

    def _paint_curve(self, painter: QPainter, theme: Theme) -> None:
        area, line = self.area(), self.fontMetrics().height()
        high = area.height() - line * 1.4  # above it is room for flags
        curve = QPolygonF()
        for look in self._history.kept:
            certainty = min(float(look.certainties.max()), 1.0)
            curve.append(QPointF(self.x_of(look.end_s), area.bottom() - certainty * high))
        painter.setPen(QPen(theme.colour("plot_1"), max(1.5, line / 10)))
        painter.drawPolyline(curve)

    def _paint_flag(self, painter: QPainter, theme: Theme, x: float) -> None:
        area, line = self.area(), self.fontMetrics().height()
        painter.setPen(QPen(theme.colour("success"), max(2.0, line / 8)))
        painter.drawLine(QLineF(x, area.top(), x, area.bottom()))
        painter.setBrush(theme.colour("success"))
        flag = QPolygonF([QPointF(0, 0), QPointF(line * 0.6, line * 0.3), QPointF(0, line * 0.6)])
        painter.drawPolygon(flag.translated(x, area.top()))

    def _paint_name(
        self, painter: QPainter, theme: Theme, title: str, x: float, end: float
    ) -> None:
        """Beside the flag, up to the next one; before it where there is no room behind it."""
        area, line, metrics = self.area(), self.fontMetrics().height(), self.fontMetrics()
        painter.setPen(theme.colour("text"))
        base = area.top() + metrics.ascent()
        room = end - x - line * 0.9
        if end >= area.right() and room < metrics.horizontalAdvance(title):
            words = metrics.elidedText(title, Qt.TextElideMode.ElideRight, round(line * 5))
            base += line * 0.2
            left = x - metrics.horizontalAdvance(words) - line * 0.3
            painter.drawText(QPointF(max(left, area.left()), base + line * 0.8), words)
            return
        words = metrics.elidedText(title, Qt.TextElideMode.ElideRight, max(0, round(room)))
        if len(words) > 2:
            painter.drawText(QPointF(x + line * 0.8, base), words)


# How certain the recogniser is of one gesture, and its recognition point, which can be dragged.

BAR_LINES_HIGH = 2.5


class GestureBar(PointSlider):
    """A slider: its value is the recognition point, the bar behind it is the certainty now."""

    def __init__(self, tuning: Tuning, name: str, look: Look) -> None:
        super().__init__(tuning)
        self._look = look
        self.certainty = 0.0
        self.is_flashing = False
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        labelled(self, tip="Drag the mark: the bar must reach it for the gesture to count")
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
        return QSize(line * 12, round(line * BAR_LINES_HIGH))

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
        gesture = self.tuning.controller.gestures.get(self.name)
        percent = f"{self.certainty * 100:.0f} %"
        room = QRectF(line * 0.5, line * 0.15, self.width() - line, line * 1.1)
        painter.setPen(theme.colour("text"))
        painter.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(room, right, percent)
        if self.is_flashing:
            sign = QRectF(room.left(), room.top(), line, line)
            paint_icon(painter, sign, "circle-check", theme.colour("success"))
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
