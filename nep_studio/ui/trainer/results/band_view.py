"""Draws the expected curve of a gesture with its band, and the last movement over it."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_studio.ui.panels.sensors.ring import Floats
from nep_studio.ui.theme import Look, Theme
from nep_studio.ui.trainer.results.band import WIDE, Band
from nep_studio.ui.words import tr

LINES_HIGH = 3.6
"""How high the strip of one axis is."""
_AXES = "xyz"


class BandView(QWidget):
    """Three strips, one for each axis, over the duration of the movement."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.band: Band | None = None
        self.kind = "body"
        self.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(tr("Expected curve"))
        look.theme_changed.connect(self.update)

    def show_band(self, band: Band | None, kind: str, words: str) -> None:
        """Show the signals of a kind; ``words`` say what is to be seen."""
        self.band, self.kind = band, kind
        self.setAccessibleDescription(words)
        self.update()

    def sizeHint(self) -> QSize:
        """Three strips and the legend."""
        line = self.fontMetrics().height()
        return QSize(line * 16, round(line * (LINES_HIGH * len(_AXES) + 1.5)))

    def minimumSizeHint(self) -> QSize:
        """Rather narrow, and as high."""
        return QSize(self.fontMetrics().height() * 9, self.sizeHint().height())

    def strip(self, number: int) -> QRectF:
        """Where the strip of an axis is."""
        line = self.fontMetrics().height()
        top = line * (1.5 + number * LINES_HIGH)
        return QRectF(line * 1.2, top, self.width() - line * 1.2 - 1, line * (LINES_HIGH - 0.4))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the strips."""
        theme = self._look.theme
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        columns = self.band.columns(self.kind) if self.band is not None else []
        for number, axis in enumerate(_AXES):
            strip = self.strip(number)
            painter.fillRect(strip, theme.colour("field"))
            if self.band is not None and number < len(columns):
                painter.setClipRect(strip)
                self._paint_strip(painter, theme, self.band, columns, number)
                painter.setClipping(False)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(theme.colour("line"), 1))
            painter.drawRect(strip)
            painter.setPen(theme.colour("muted"))
            room = QRectF(0, strip.top(), strip.left(), strip.height())
            painter.drawText(room, Qt.AlignmentFlag.AlignCenter, axis)
        self._paint_legend(painter, theme)
        painter.end()

    def _paint_strip(
        self, painter: QPainter, theme: Theme, band: Band, columns: list[int], number: int
    ) -> None:
        column, strip = columns[number], self.strip(number)
        low, high = _range(band, columns)

        def line_of(values: Floats) -> list[QPointF]:
            xs = np.linspace(strip.left(), strip.right(), len(values))
            ys = strip.bottom() - (values - low) / (high - low) * strip.height()
            return [QPointF(float(x), float(y)) for x, y in zip(xs, ys, strict=True)]

        mean, wide = band.mean[:, column], WIDE * band.spread[:, column]
        pale = QColor(theme.colour("plot_1"))
        pale.setAlphaF(0.25)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(pale)
        painter.drawPolygon(QPolygonF([*line_of(mean + wide), *reversed(line_of(mean - wide))]))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(self._pen(theme, "plot_1"))
        painter.drawPolyline(QPolygonF(line_of(mean)))
        if band.live is not None:
            painter.setPen(self._pen(theme, "plot_2", is_dashed=True))
            painter.drawPolyline(QPolygonF(line_of(band.live[:, column])))

    def _paint_legend(self, painter: QPainter, theme: Theme) -> None:
        line, metrics = self.fontMetrics().height(), self.fontMetrics()
        x, middle = self.strip(0).left(), line * 0.7
        for colour, words in (("plot_1", tr("expected")), ("plot_2", tr("yours"))):
            painter.setPen(self._pen(theme, colour, is_dashed=colour == "plot_2"))
            painter.drawLine(QPointF(x, middle), QPointF(x + line * 1.6, middle))
            painter.setPen(theme.colour("text"))
            painter.drawText(QPointF(x + line * 1.9, middle + metrics.ascent() * 0.4), words)
            x += line * 2.9 + metrics.horizontalAdvance(words)

    def _pen(self, theme: Theme, colour: str, *, is_dashed: bool = False) -> QPen:
        pen = QPen(theme.colour(colour), max(2.0, self.fontMetrics().height() / 9))
        if is_dashed:
            pen.setDashPattern([3.0, 2.0])
        return pen


def _range(band: Band, columns: list[int]) -> tuple[float, float]:
    """The values that the strips have room for, the same for all three."""
    mean, wide = band.mean[:, columns], WIDE * band.spread[:, columns]
    parts = [mean - wide, mean + wide] + ([] if band.live is None else [band.live[:, columns]])
    low, high = min(float(one.min()) for one in parts), max(float(one.max()) for one in parts)
    margin = max(high - low, 0.1) * 0.05
    return low - margin, high + margin
