"""Draws the curves of one plot, with its grid, the marks of gestures and the two cursors."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPainter, QPaintEvent, QPen, QPixmap, QPolygonF
from PySide6.QtWidgets import QWidget

from nep_studio.ui.panels.sensors.feed import Mark
from nep_studio.ui.panels.sensors.looks import mixed
from nep_studio.ui.panels.sensors.polygons import Frame
from nep_studio.ui.theme import Theme, load_theme

_MOST_LINES_OF_MARKS = 3


@dataclass(frozen=True)
class Picture:
    """What one plot shows: lines with their pens, marks, cursors, and where values have lines.

    ``layer`` is a picture behind the lines, and where it begins.
    """

    frame: Frame
    curves: Sequence[tuple[QPen, list[QPolygonF]]] = ()
    layer: tuple[QPixmap, float] | None = None
    marks: Sequence[Mark] = ()
    cursors: tuple[float, ...] = ()
    grid_s: Sequence[float] = ()
    grid_values: Sequence[float] = ()
    has_words: bool = True
    title: str = field(default="")


class CurvesView(QWidget):
    """Shows a picture before the middle of a plot of pyqtgraph.

    It is a widget of its own, which hides what is behind it: to draw curves 60 times a second
    then does not draw the axes again.
    """

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.picture: Picture | None = None
        self.set_look(load_theme("light"), self.font())
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.show()

    def set_look(self, theme: Theme, font: QFont) -> None:
        """Take the theme's colours and a font for words."""
        self._ground, self._label = theme.colour("field"), theme.colour("info_panel")
        self._grid = mixed(theme.colour("line"), self._ground)
        self._text, self._cursor = theme.colour("text"), theme.colour("focus")
        self._mark = QPen(theme.colour("accent"), 1)
        self._mark.setCosmetic(True)
        self._mark.setStyle(Qt.PenStyle.DashLine)
        self._metrics = QFontMetricsF(font)
        self.setFont(font)
        self.update()

    def show_picture(self, picture: Picture) -> None:
        """Show another picture."""
        self.picture = picture
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw what is behind the curves, the curves, and what is before them."""
        painter = QPainter(self)
        painter.setLayoutDirection(Qt.LayoutDirection.LayoutDirectionAuto)
        painter.fillRect(self.rect(), self._ground)
        picture = self.picture
        if picture is not None:
            self._draw_grid(painter, picture)
            if picture.layer is not None:
                painter.drawPixmap(QPointF(picture.layer[1], 0), picture.layer[0])
            for pen, polygons in picture.curves:
                painter.setPen(pen)
                for polygon in polygons:
                    painter.drawPolyline(polygon)
            self._draw_marks(painter, picture)
            self._draw_cursors(painter, picture)
            if picture.title:
                self._draw_words(painter, 0, 0, picture.title, is_marked=False)
        painter.end()

    def _draw_grid(self, painter: QPainter, picture: Picture) -> None:
        """Lines one pixel wide, which are quicker to fill than to draw."""
        frame = picture.frame
        for time_s in picture.grid_s:
            painter.fillRect(QRectF(round(frame.x(time_s)), 0, 1, frame.height), self._grid)
        for value in picture.grid_values:
            painter.fillRect(QRectF(0, round(frame.y(value)), frame.width, 1), self._grid)

    def _draw_marks(self, painter: QPainter, picture: Picture) -> None:
        frame = picture.frame
        ends = [-1.0] * _MOST_LINES_OF_MARKS
        for mark in picture.marks:
            x = frame.x(mark.time_s)
            painter.setPen(self._mark)
            painter.drawLine(QPointF(x, 0), QPointF(x, frame.height))
            line = next((at for at, end in enumerate(ends) if x >= end), None)
            if picture.has_words and line is not None:
                ends[line] = self._draw_words(painter, x, line + 1, mark.words, is_marked=True)

    def _draw_cursors(self, painter: QPainter, picture: Picture) -> None:
        frame = picture.frame
        for name, time_s in zip("AB", picture.cursors, strict=False):
            x = frame.x(time_s)
            pen = QPen(self._cursor, 2)
            pen.setStyle(Qt.PenStyle.SolidLine if name == "A" else Qt.PenStyle.DashLine)
            painter.setPen(pen)
            painter.drawLine(QPointF(x, 0), QPointF(x, frame.height))
            if picture.has_words:
                self._draw_words(painter, x, 0, name, is_marked=True)

    def _draw_words(
        self, painter: QPainter, x: float, line: int, words: str, *, is_marked: bool
    ) -> float:
        """Write words beside a place in one of the upper lines; where they end."""
        metrics = self._metrics
        room = metrics.height() * 0.3
        width = metrics.horizontalAdvance(words) + 2 * room
        if is_marked and x + width > self.width():
            x = max(0.0, x - width)
        rect = QRectF(x, line * metrics.height() * 1.15, width, metrics.height() * 1.1)
        painter.fillRect(rect, self._label if is_marked else self._ground)
        painter.setPen(self._text)
        painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, words)
        return rect.right() + room


def marks_between(marks: Iterable[Mark], start_s: float, end_s: float) -> list[Mark]:
    """The marks that are shown, the oldest first."""
    return sorted(
        (mark for mark in marks if start_s <= mark.time_s <= end_s), key=lambda one: one.time_s
    )
