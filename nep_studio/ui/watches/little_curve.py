"""A little live curve of how hard a watch is moved, over the last seconds."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize
from PySide6.QtGui import QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_core.messages import Imu
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

SHOWN_S = 6.0
GAP_S = 0.5
LEAST_REACH_M_S2 = 6.0
"""Of stillness the noise is not blown up to the full height."""
LINES_HIGH = 3.6


class LittleCurve(QWidget):
    """The length of the acceleration; what is newest is where reading ends."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._points: deque[tuple[float, float]] = deque(maxlen=4000)
        self.setAccessibleName(tr("How hard it is moved, over the last seconds"))
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def take(self, batch: Sequence[Imu]) -> None:
        """Draw these samples too."""
        for message in batch:
            for t, row in zip(message.t, message.acc, strict=False):
                if self._points and t <= self._points[-1][0]:
                    self._points.clear()  # another clock
                self._points.append((t, math.hypot(*row)))
        while self._points and self._points[-1][0] - self._points[0][0] > SHOWN_S:
            self._points.popleft()
        if self.isVisible():
            self.update()

    def clear(self) -> None:
        """Forget the samples."""
        self._points.clear()
        self.update()

    def sizeHint(self) -> QSize:
        """Wide and low."""
        line = self.fontMetrics().height()
        return QSize(line * 14, round(line * LINES_HIGH))

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the curve in a field."""
        theme = self._look.theme
        edge = max(1.0, self.fontMetrics().height() / 14)
        room = QRectF(self.rect()).adjusted(edge, edge, -edge, -edge)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(theme.colour("line"), edge))
            painter.setBrush(theme.colour("field"))
            painter.drawRoundedRect(room, edge * 5, edge * 5)
            painter.setClipRect(room)
            painter.setPen(QPen(theme.colour("plot_1"), edge * 1.8))
            for part in self._parts(room.adjusted(edge, edge * 3, -edge, -edge * 3)):
                painter.drawPolyline(part)

    def _parts(self, room: QRectF) -> list[QPolygonF]:
        """The curve in pixels, cut where nothing came for a while."""
        if not self._points:
            return []
        values = [value for _, value in self._points]
        middle = (max(values) + min(values)) / 2
        reach = max(LEAST_REACH_M_S2, (max(values) - min(values)) / 2)
        newest, parts, before = self._points[-1][0], [QPolygonF()], self._points[0][0]
        for t, value in self._points:
            if t - before > GAP_S:
                parts.append(QPolygonF())
            before = t
            x = room.right() - (newest - t) / SHOWN_S * room.width()
            y = room.center().y() - (value - middle) / reach * room.height() / 2
            parts[-1].append(QPointF(x, y))
        return parts
