"""Draws the curves of one plot, with its grid, the marks of gestures and the two cursors."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPainter, QPaintEvent, QPen, QPixmap, QPolygonF
from PySide6.QtWidgets import QWidget

from nep_studio.ui.ring import Floats, Ring
from nep_studio.ui.theme.colours import Theme, load_theme, mixed
from nep_studio.ui.widgets.curves import polygon

from .curves import Curve, CurveKey, ValueRange
from .feed import Mark
from .streams import Samples, Stream

# Samples brought down to what a screen can show: the least and the greatest of each column.


@dataclass(frozen=True)
class Columns:
    """n columns that have samples in them.

    ``number`` (n,) counts columns of ``width_s`` from 1970, rising; ``low`` and ``high``
    (channels, n) are NaN in a gap.
    """

    width_s: float
    number: Floats
    low: Floats
    high: Floats

    @property
    def middle_s(self) -> Floats:
        """When the middles of the columns are."""
        middle: Floats = (self.number + 0.5) * self.width_s
        return middle

    def part(self, part: slice) -> Columns:
        """Some of the columns."""
        return Columns(self.width_s, self.number[part], self.low[:, part], self.high[:, part])

    def between(self, start_s: float, end_s: float) -> Columns:
        """The columns from a time to another, and one more on each side."""
        first = int(np.searchsorted(self.number, start_s / self.width_s)) - 2
        last = int(np.searchsorted(self.number, end_s / self.width_s)) + 1
        return self.part(slice(max(0, first), last))


def columns_of(samples: Samples, width_s: float) -> Columns:
    """Bring samples down to columns; costs some time for each sample."""
    if not len(samples.t):
        nothing = np.empty((len(samples.values), 0))
        return Columns(width_s, np.empty(0), nothing, nothing)
    number = np.floor(samples.t / width_s)
    starts = np.concatenate([[0], np.flatnonzero(np.diff(number)) + 1])
    low = np.fmin.reduceat(samples.values, starts, axis=1)
    high = np.fmax.reduceat(samples.values, starts, axis=1)
    return Columns(width_s, number[starts], low, high)


class LiveColumns:
    """The columns of a stream that goes on: only samples that are new are looked at."""

    def __init__(self, stream: Stream, width_s: float, most: int) -> None:
        self.width_s = width_s
        self._stream = stream
        self._channels = len(stream.channels)
        self._ring = Ring(1 + 2 * self._channels, most)
        self._seen = 0

    def is_of(self, stream: Stream) -> bool:
        """Whether it follows this stream."""
        return stream is self._stream

    def refresh(self) -> None:
        """Take what the stream has heard since the last time."""
        new = self._stream.total - self._seen
        self._seen = self._stream.total
        if new <= 0:
            return
        columns = columns_of(self._stream.samples(new), self.width_s)
        table = np.vstack([columns.number, columns.low, columns.high])
        if len(self._ring) and self._ring.newest(1)[0, 0] == table[0, 0]:
            # The newest column and more samples of it
            column, last = table[:, 0], self._ring.newest(1)[:, 0]
            low, high = slice(1, 1 + self._channels), slice(1 + self._channels, None)
            joined = column.copy()
            joined[low] = np.fmin(last[low], column[low])
            joined[high] = np.fmax(last[high], column[high])
            self._ring.replace_last(joined)
            table = table[:, 1:]
        self._ring.append(table)

    def columns(self) -> Columns:
        """All columns that are kept; a view that lives until the next refresh."""
        table = self._ring.newest()
        low, high = table[1 : 1 + self._channels], table[1 + self._channels :]
        return Columns(self.width_s, table[0], low, high)


# Columns of a curve as lines on the screen, made by numpy without a loop over points.

_FAR = 4.0
"""How many heights of the plot a line may go beyond it: further makes drawing slow."""


@dataclass(frozen=True)
class Frame:
    """What part of time and values is where: ``width`` by ``height`` logical pixels."""

    start_s: float
    length_s: float
    values: ValueRange
    width: float
    height: float

    def x(self, time_s: float) -> float:
        """Where a time is."""
        return (time_s - self.start_s) / self.length_s * self.width

    def time(self, x: float) -> float:
        """Which time is there."""
        return self.start_s + x / self.width * self.length_s

    def y(self, value: float) -> float:
        """Where a value is."""
        return (self.values.high - value) / self.values.height * self.height


def polygons(columns: Columns, channel: int, frame: Frame) -> list[QPolygonF]:
    """The lines of one channel: one from gap to gap."""
    return [polygon(points) for points in lines(columns, channel, frame)]


def lines(columns: Columns, channel: int, frame: Frame) -> list[Floats]:
    """The points (n, 2) of the lines of one channel: one line from gap to gap.

    A line goes through the least and the greatest of each column, up in one and down in the next:
    what is between two columns is then as short as it can be.
    """
    if not len(columns.number):
        return []
    x = (columns.middle_s - frame.start_s) * (frame.width / frame.length_s)
    is_falling = (columns.number % 2).astype(bool)
    low, high = columns.low[channel], columns.high[channel]
    scale = frame.height / frame.values.height
    points = np.empty((2 * len(x), 2))
    points[0::2, 0] = points[1::2, 0] = x
    points[0::2, 1] = np.where(is_falling, high, low)
    points[1::2, 1] = np.where(is_falling, low, high)
    points[:, 1] = (frame.values.high - points[:, 1]) * scale
    np.clip(points[:, 1], -_FAR * frame.height, (1 + _FAR) * frame.height, out=points[:, 1])
    is_gap = np.isnan(points[:, 1])
    if not is_gap.any():
        return [points]
    edges = np.flatnonzero(np.diff(is_gap)) + 1
    return [part for part in np.split(points, edges) if not np.isnan(part[0, 1])]


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
        self._grid = mixed(theme.colour("line"), self._ground, 0.5)
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
            # Lines one pixel wide, which are quicker to fill than to draw
            frame = picture.frame
            for time_s in picture.grid_s:
                painter.fillRect(QRectF(round(frame.x(time_s)), 0, 1, frame.height), self._grid)
            for value in picture.grid_values:
                painter.fillRect(QRectF(0, round(frame.y(value)), frame.width, 1), self._grid)
            if picture.layer is not None:
                painter.drawPixmap(QPointF(picture.layer[1], 0), picture.layer[0])
            for pen, polygons in picture.curves:
                painter.setPen(pen)
                for one in polygons:
                    painter.drawPolyline(one)
            self._draw_marks(painter, picture)
            for name, time_s in zip("AB", picture.cursors, strict=False):
                x = frame.x(time_s)
                pen = QPen(self._cursor, 2)
                pen.setStyle(Qt.PenStyle.SolidLine if name == "A" else Qt.PenStyle.DashLine)
                painter.setPen(pen)
                painter.drawLine(QPointF(x, 0), QPointF(x, frame.height))
                if picture.has_words:
                    self._draw_words(painter, x, 0, name, is_marked=True)
            if picture.title:
                self._draw_words(painter, 0, 0, picture.title, is_marked=False)
        painter.end()

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
    shown = (mark for mark in marks if start_s <= mark.time_s <= end_s)
    return sorted(shown, key=lambda one: one.time_s)


# Keeps the part of live curves that does not change any more as a picture that moves left.

_SPARE = 64
"""The picture has room for so many columns more than are seen: it is scrolled seldom."""

_AT_ONCE = 16
"""So many columns are added to the picture at once."""

_LATE_S = 0.4
"""Samples that come later than those of other streams are still drawn."""

Pairs = Sequence[tuple[Curve, Columns]]
Line = tuple[QPen, list[QPolygonF]]


@dataclass(frozen=True)
class _State:
    """What the picture was drawn for; when something of it changes, it is drawn anew."""

    keys: tuple[CurveKey, ...]
    column_s: float
    columns: int
    pixels: int
    ratio: float
    height: float
    values: ValueRange
    looks: int


_NOTHING = _State((), 1.0, 0, 1, 1.0, 0.0, ValueRange(), 0)


class LiveLayer:
    """The picture of one plot. Only columns that have come since the last frame are drawn.

    Every column is a whole number of the screen's pixels wide, and the picture moves by whole
    pixels: it looks as if all was drawn anew.
    """

    def __init__(self) -> None:
        self._state = _NOTHING
        self._pixmap = QPixmap()
        self._left = self._edge = 0  # the first column of the picture, the last that is drawn

        self._lengths: dict[CurveKey, float] = {}
        """How long each line is by now: where its dashes go on."""

    def refresh(
        self,
        pairs: Pairs,
        frame: Frame,
        pens: Mapping[CurveKey, QPen],
        *,
        pixels: int,
        ratio: float,
    ) -> tuple[QPixmap, float, list[Line]]:
        """The picture, where it begins, and the lines that follow it, which change still."""
        if not pairs:
            return QPixmap(), 0.0, []
        column_s = pairs[0][1].width_s
        count = round(frame.length_s / column_s)
        keys = tuple(curve.key for curve, _ in pairs)
        looks = hash(tuple((pens[key].color().rgba(), pens[key].widthF()) for key in keys))
        state = _State(keys, column_s, count, pixels, ratio, frame.height, frame.values, looks)
        # The column up to which nothing changes any more
        ends = [int(one.number[-1]) for _, one in pairs if len(one.number)]
        edge = max(ends, default=self._edge) - math.ceil(_LATE_S / column_s)
        if state != self._state or edge > self._left + 2 * (count + 2 * _SPARE):
            self._start(state, frame, edge)
        if edge >= self._edge + _AT_ONCE:
            self._draw(pairs, pens, edge)
        x = round((self._left * column_s - frame.start_s) / frame.length_s * frame.width * ratio)
        return self._pixmap, x / ratio, self._tails(pairs, pens, x / ratio)

    def _start(self, state: _State, frame: Frame, edge: int) -> None:
        self._state = state
        width = (state.columns + 2 * _SPARE) * state.pixels
        self._pixmap = QPixmap(width, round(frame.height * state.ratio))
        self._pixmap.setDevicePixelRatio(state.ratio)
        self._pixmap.fill(Qt.GlobalColor.transparent)
        first = int(frame.start_s / state.column_s) - 2
        self._left, self._edge = first, first
        self._lengths = dict.fromkeys(state.keys, 0.0)

    def _frame(self) -> Frame:
        """What is where in the picture."""
        state = self._state
        count = state.columns + 2 * _SPARE
        return Frame(
            self._left * state.column_s,
            count * state.column_s,
            state.values,
            count * state.pixels / state.ratio,
            state.height,
        )

    def _draw(self, pairs: Pairs, pens: Mapping[CurveKey, QPen], edge: int) -> None:
        """Draw the columns after the last one drawn, up to ``edge``."""
        self._make_room(edge)
        painter = QPainter(self._pixmap)
        frame = self._frame()
        for curve, columns in pairs:
            part = _part(columns, self._edge, edge)
            if not len(part.number) or part.number[-1] <= self._edge:
                continue
            for pen, polygons in self._lines(curve, part, frame, pens[curve.key], is_kept=True):
                painter.setPen(pen)
                for one in polygons:
                    painter.drawPolyline(one)
        painter.end()
        self._edge = edge

    def _make_room(self, edge: int) -> None:
        state = self._state
        over = edge + 2 - (self._left + state.columns + 2 * _SPARE)
        if over <= 0:
            return
        moved = over + _SPARE
        self._left += moved
        width, height = self._pixmap.width(), self._pixmap.height()
        self._pixmap.scroll(-moved * state.pixels, 0, self._pixmap.rect())
        painter = QPainter(self._pixmap)
        painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_Source)
        free = moved * state.pixels
        ratio = state.ratio
        empty = QRectF((width - free) / ratio, 0, free / ratio, height / ratio)
        painter.fillRect(empty, Qt.GlobalColor.transparent)
        painter.end()

    def _tails(self, pairs: Pairs, pens: Mapping[CurveKey, QPen], x: float) -> list[Line]:
        """The lines from the picture's last column to the newest."""
        frame, tails = self._frame(), []
        for curve, columns in pairs:
            part = _part(columns, self._edge, None)
            if not len(part.number) or part.number[-1] <= self._edge:
                continue
            made = self._lines(curve, part, frame, pens[curve.key], is_kept=False)
            for _, polygons in made:
                for one in polygons:
                    one.translate(x, 0)
            tails += made
        return tails

    def _lines(
        self, curve: Curve, columns: Columns, frame: Frame, pen: QPen, *, is_kept: bool
    ) -> list[Line]:
        """The lines through some columns, whose dashes go on from those before."""
        channel = curve.key.channel
        parts = lines(columns, channel, frame)
        if not parts:
            return []
        if columns.number[0] <= self._edge and not np.isnan(columns.low[channel, 0]):
            parts[0] = parts[0][1:]  # the line goes on from the end of the column drawn last
        used = QPen(pen)
        length = self._lengths[curve.key]
        if used.dashPattern():
            used.setDashOffset(length / used.widthF())
        if is_kept:
            steps = np.diff(np.concatenate(parts), axis=0)
            self._lengths[curve.key] = (length + float(np.hypot(*steps.T).sum())) % 1e6
        return [(used, [polygon(one) for one in parts])]


def _part(columns: Columns, first: int, last: int | None) -> Columns:
    """The columns from ``first`` to ``last``, both included; to the end without ``last``."""
    start = int(np.searchsorted(columns.number, first, side="right")) - 1
    end = None if last is None else int(np.searchsorted(columns.number, last, side="right"))
    return columns.part(slice(max(0, start), end))
