"""One plot: its axes, which pyqtgraph draws, and its curves, which it does not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pyqtgraph
from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPen

from nep_studio.ui.theme.colours import Theme

from .curves import Curve, CurveKey, Row, ValueRange
from .curves_view import Columns, CurvesView, Frame, Picture, polygons
from .feed import Mark
from .live_layer import LiveLayer

_LETTERS_OF_AXIS = 7


class PlotRow:
    """The plot of a row; its owner tells it what to show, frame by frame."""

    def __init__(self, row: Row, plot: Any, view: CurvesView, *, is_last: bool) -> None:
        self.row, self.plot, self.view = row, plot, view
        self.values = ValueRange()
        self.is_fitting = True
        """Whether its values follow the curves; not after a person zoomed them."""
        self._is_last = is_last
        self._metrics = QFontMetricsF(QFont())
        self._length_s = self._offset_s = np.nan
        plot.hideButtons()
        plot.setMenuEnabled(False)
        self.box = plot.getViewBox()
        self.box.setMouseEnabled(x=False, y=False)
        self.box.disableAutoRange()
        self._left, self._bottom = plot.getAxis("left"), plot.getAxis("bottom")
        for axis in (self._left, self._bottom):
            axis.enableAutoSIPrefix(False)
        self._bottom.tickStrings = _seconds
        if not is_last:
            self._bottom.setStyle(showValues=False)
        self._pens: dict[CurveKey, QPen] = {}
        self._layer = LiveLayer()
        self._ticks: dict[str, tuple[object, list[float]]] = {}
        self.box.setYRange(self.values.low, self.values.high, padding=0)

    @property
    def width(self) -> float:
        """How many logical pixels the curves have."""
        return max(1.0, float(self.view.width()))

    def take_place(self) -> None:
        """Put the curves where the axes leave room for them."""
        place = self.plot.getViewWidget().mapFromScene(self.box.sceneBoundingRect()).boundingRect()
        if place != self.view.geometry():
            self.view.setGeometry(place)

    def set_look(self, theme: Theme, font: QFont) -> None:
        """Take the theme's colours and the font."""
        self._metrics = QFontMetricsF(font)
        for axis in (self._left, self._bottom):
            axis.setTickFont(font)
            axis.setPen(theme.colour("field_line"))
            axis.setTextPen(theme.colour("text"))
        self._left.setWidth(round(self._metrics.horizontalAdvance("0") * _LETTERS_OF_AXIS))
        line = round(self._metrics.height())
        self._bottom.setHeight(line * 3 // 2 if self._is_last else line // 4)
        self._pens = {curve.key: curve.look.pen(theme, self._metrics) for curve in self.row.curves}
        self.view.set_look(theme, font)

    def frame(self, start_s: float, length_s: float) -> Frame:
        """What is where."""
        size = self.box.size()
        return Frame(start_s, length_s, self.values, self.width, max(1.0, float(size.height())))

    def show_time(self, length_s: float, offset_s: float) -> None:
        """Let the time axis end ``offset_s`` before or after its zero."""
        if (length_s, offset_s) != (self._length_s, self._offset_s):
            self._length_s, self._offset_s = length_s, offset_s
            self.box.setXRange(offset_s - length_s, offset_s, padding=0)

    def fit(self, columns: Sequence[tuple[Curve, Columns]]) -> None:
        """Show all values of the curves, unless a person zoomed."""
        if not self.is_fitting:
            return
        ends = [
            (np.fmin.reduce(one.low[at]), np.fmax.reduce(one.high[at]))
            for curve, one in columns
            if len(one.number)
            for at in (curve.key.channel,)
        ]
        if ends:
            lows, highs = zip(*ends, strict=True)
            self.set_values(self.values.fitted(float(np.fmin.reduce(lows)), np.fmax.reduce(highs)))

    def set_values(self, values: ValueRange) -> None:
        """Show these values."""
        if values != self.values:
            self.values = values
            self.box.setYRange(values.low, values.high, padding=0)

    def draw(
        self,
        columns: Sequence[tuple[Curve, Columns]],
        frame: Frame,
        marks: Sequence[Mark],
        cursors: tuple[float, ...],
        *,
        has_words: bool,
        pixels: int = 0,
    ) -> None:
        """Show curves, marks and cursors; live, with columns so many pixels of the screen wide."""
        zero_s = frame.start_s + frame.length_s - self._offset_s
        layer = None
        if pixels:
            ratio = self.view.devicePixelRatioF()
            pixmap, x, curves = self._layer.refresh(
                columns, frame, self._pens, pixels=pixels, ratio=ratio
            )
            layer = pixmap, x
        else:
            curves = [
                (self._pens[curve.key], polygons(one, curve.key.channel, frame))
                for curve, one in columns
            ]
        self.view.show_picture(
            Picture(
                frame,
                curves,
                layer,
                marks,
                cursors,
                [zero_s + tick for tick in self._ticks_of(self._bottom)],
                self._ticks_of(self._left),
                has_words,
                self._title(),
            )
        )

    def _title(self) -> str:
        unit = f" ({self.row.unit})" if self.row.unit else ""
        return f"{self.row.title}{unit}"

    def _ticks_of(self, axis: Any) -> list[float]:
        """Where an axis has its numbers."""
        is_bottom = axis.orientation == "bottom"
        state = (*axis.range, self.view.width() if is_bottom else self.view.height())
        known = self._ticks.get(axis.orientation)
        if known is None or known[0] != state:
            levels = axis.tickValues(state[0], state[1], max(1, state[2]))
            known = state, [float(tick) for _, ticks in levels[:1] for tick in ticks]
            self._ticks[axis.orientation] = known
        return known[1]


def _seconds(values: Sequence[float], _scale: float, spacing: float) -> list[str]:
    """The words at the ticks of the time axis."""
    digits = max(0, -math.floor(math.log10(spacing))) if spacing < 1 else 0
    return [f"{value:.{digits}f} s".replace("-", "\N{MINUS SIGN}") for value in values]


def new_canvas() -> Any:
    """Make the widget in which pyqtgraph lays out the plots."""
    canvas = pyqtgraph.GraphicsLayoutWidget()
    canvas.ci.layout.setContentsMargins(0, 0, 0, 0)
    canvas.ci.layout.setSpacing(0)
    canvas.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    for part in (canvas, canvas.ci):  # time goes to the right in every language
        part.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
    return canvas


def new_plot(layout: Any, place: int) -> Any:
    """Make a plot in a layout of pyqtgraph."""
    return layout.addPlot(row=place, col=0, viewBox=pyqtgraph.ViewBox(enableMenu=False))
