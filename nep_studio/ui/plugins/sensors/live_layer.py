"""Keeps the part of live curves that does not change any more as a picture that moves left."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter, QPen, QPixmap, QPolygonF

from nep_studio.ui.widgets.curves import polygon

from .curves import Curve, CurveKey, ValueRange
from .curves_view import Columns, Frame, lines

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
    end = len(columns.number)
    if last is not None:
        end = int(np.searchsorted(columns.number, last, side="right"))
    part = slice(max(0, start), end)
    return Columns(
        columns.width_s, columns.number[part], columns.low[:, part], columns.high[:, part]
    )
