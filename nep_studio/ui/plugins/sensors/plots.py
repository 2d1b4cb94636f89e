"""All plots of the panel, one below the other, over the same time."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
import pyqtgraph
from PySide6.QtCore import QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QFont, QFontMetricsF, QHideEvent, QPen, QResizeEvent, QShowEvent
from PySide6.QtWidgets import QScrollArea, QWidget

from nep_studio.ui.labels import follow_words
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.layouts import in_column

from .curves import Curve, CurveKey, Row, ValueRange, curves_of, rows_of
from .curves_view import (
    Columns,
    CurvesView,
    Frame,
    LiveColumns,
    LiveLayer,
    Picture,
    columns_of,
    marks_between,
    polygons,
)
from .feed import Mark, SensorFeed
from .measuring import TimeView, fitting_length
from .streams import Samples, StreamKey

FRAME_MS = 16
_QUIET_MS = 250
"""How often it looks whether something came, while there is nothing to see."""
_MOST_COLUMNS = 2000
_LEAST_WIDTH_LINES = 10
_LINES_OF_ROW = 5
"""How high a plot is at least, in lines of text."""


class Plots(QWidget):
    """Draws a feed 60 times a second while it is live and visible, else when something changes.

    ``view_changed`` tells that another time is shown, ``rows_changed`` that there are other
    curves, ``cursors_changed`` that a cursor moved.
    """

    view_changed = Signal()
    rows_changed = Signal()
    cursors_changed = Signal()

    def __init__(self, feed: SensorFeed, look: Look) -> None:
        super().__init__()
        self.feed, self.look = feed, look
        self.view = TimeView()
        self.is_fit = False
        """Whether it shows all that is kept."""
        self.hidden: set[CurveKey] = set()
        self.cursors: tuple[float, ...] = ()
        self.rows: list[PlotRow] = []
        self._zero_s = 0.0
        self._live: dict[StreamKey, LiveColumns] = {}
        self._frozen: dict[StreamKey, Samples] = {}
        self.canvas = new_canvas()
        self._scroll = QScrollArea(widgetResizable=True)
        self._scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._scroll.setWidget(self.canvas)
        in_column(self._scroll, of=self, margins=0)
        self.setMinimumWidth(self.fontMetrics().height() * _LEAST_WIDTH_LINES)
        self._timer = QTimer(self, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.draw)
        feed.streams_changed.connect(self._on_streams_changed)
        look.theme_changed.connect(self._dress)
        self._fit_rows()
        follow_words(self, self._say)

    # What is shown

    @property
    def curves(self) -> dict[CurveKey, Curve]:
        """All curves, hidden ones too."""
        return curves_of(row.row for row in self.rows)

    @property
    def now_s(self) -> float:
        """The time that a live view ends with."""
        return time.time()

    @property
    def shown_s(self) -> tuple[float, float]:
        """The time from which and up to which it shows."""
        now_s = self.now_s
        return self.view.start(now_s), self.view.end(now_s)

    def samples(self, key: StreamKey) -> Samples:
        """The samples that the plots are made of: of now, or of when it was paused."""
        return self._frozen[key] if key in self._frozen else self.feed.streams[key].samples()

    def pause(self) -> None:
        """Let the picture stand still; samples go on being collected, but are not shown."""
        if self.view.is_live:
            self._zero_s = self.now_s
            self._frozen = {key: one.samples().copied() for key, one in self.feed.streams.items()}
            self.set_view(self.view.paused(self._zero_s))

    def go_live(self) -> None:
        """Show what comes now."""
        self._frozen = {}
        self.set_view(self.view.live())

    def set_view(self, view: TimeView, *, is_fit: bool = False) -> None:
        """Show another time."""
        self.is_fit = is_fit
        self.view = view
        self._set_pace()
        self.draw()
        self.view_changed.emit()

    def zoom(self, factor: float, share: float = 0.5) -> None:
        """Show less time (``factor`` below 1) or more; ``share`` of the width stays."""
        self.set_view(self.view.zoomed(factor, share))

    def move_time(self, seconds: float) -> None:
        """Show what was earlier or later; a live view is paused first."""
        self.pause()
        oldest_s, newest_s = self.feed.oldest_s, self.feed.newest_s
        if self._frozen:
            kept = [one.t for one in self._frozen.values() if len(one.t)]
            oldest_s = min((float(t[0]) for t in kept), default=oldest_s)
            newest_s = self._zero_s
        self.set_view(self.view.moved(seconds, oldest_s, newest_s))

    def fit(self) -> None:
        """Show all that is kept, and all its values."""
        for row in self.rows:
            row.is_fitting = True
        oldest_s = min((float(one.t[0]) for one in self._shown_samples()), default=self.now_s)
        end_s = self.now_s if self.view.is_live else self._zero_s
        length_s = fitting_length(max(1.0, end_s - oldest_s))
        view = TimeView(length_s, None if self.view.is_live else end_s)
        self.set_view(view, is_fit=True)

    def set_hidden(self, key: CurveKey, is_hidden: bool) -> None:
        """Hide a curve, or show it again."""
        (self.hidden.add if is_hidden else self.hidden.discard)(key)
        self.draw()

    def set_cursors(self, *cursors: float) -> None:
        """Put the cursors A and B at these times, or take them away."""
        self.cursors = cursors
        self.draw()
        self.cursors_changed.emit()

    # Drawing

    def draw(self) -> None:
        """Draw all rows as they are now; nothing while it is not visible."""
        if not self.isVisible() or not self.rows:
            return
        if self.is_fit and self.view.is_live:
            self._grow()
        start_s, end_s = self.shown_s
        length_s = self.view.length_s
        offset_s = 0.0 if self.view.is_live else end_s - self._zero_s
        for row in self.rows:
            row.take_place()
        screen = self.rows[0].width * self.devicePixelRatioF()
        pixels = math.ceil(screen / _MOST_COLUMNS)
        width_s = length_s / max(1, round(screen / pixels))
        marks = marks_between(tuple(self.feed.marks), start_s, end_s)
        columns: dict[StreamKey, Columns] = {}
        for place, row in enumerate(self.rows):
            pairs = self._pairs(row, width_s, columns)
            row.show_time(length_s, offset_s)
            row.fit(pairs)
            frame = row.frame(start_s, length_s)
            live = pixels if self.view.is_live else 0
            row.draw(pairs, frame, marks, self.cursors, has_words=place == 0, pixels=live)
        self._set_pace()

    def _pairs(
        self, row: PlotRow, width_s: float, known: dict[StreamKey, Columns]
    ) -> list[tuple[Curve, Columns]]:
        """The curves of a row that are shown, with their columns."""
        pairs = []
        for curve in row.row.curves:
            key = curve.key.stream
            if curve.key in self.hidden or not (key in self._frozen or key in self.feed.streams):
                continue
            if key not in known:
                known[key] = self._columns(key, width_s).between(*self.shown_s)
            pairs.append((curve, known[key]))
        return pairs

    def _columns(self, key: StreamKey, width_s: float) -> Columns:
        if key in self._frozen:
            return columns_of(self._frozen[key].between(*self.shown_s, more=1), width_s)
        if not self.view.is_live:  # it came after the picture was paused
            return columns_of(Samples.none(len(self.feed.streams[key].channels)), width_s)
        live = self._live.get(key)
        if live is None or live.width_s != width_s or not live.is_of(self.feed.streams[key]):
            live = LiveColumns(self.feed.streams[key], width_s, 2 * _MOST_COLUMNS)
            self._live[key] = live
        live.refresh()
        return live.columns()

    def _shown_samples(self) -> list[Samples]:
        found = [self.samples(key.stream) for key in self.curves if key not in self.hidden]
        return [samples for samples in found if len(samples.t)]

    def _grow(self) -> None:
        length_s = fitting_length(self.now_s - self.feed.oldest_s)
        if length_s > self.view.length_s:
            self.view = self.view.with_length(length_s)

    def _fit_rows(self) -> None:
        """Make the plots anew when there are other ones than before."""
        wanted = rows_of(self.feed.streams)
        if [row.key for row in wanted] == [row.row.key for row in self.rows]:
            return
        for row in self.rows:
            row.view.deleteLater()
        self.canvas.clear()
        self.rows = [self._plot_row(row, at, len(wanted)) for at, row in enumerate(wanted)]
        self._live = {key: one for key, one in self._live.items() if key in self.feed.streams}
        self._dress()
        self.rows_changed.emit()

    def _plot_row(self, row: Row, place: int, count: int) -> PlotRow:
        box = pyqtgraph.ViewBox(enableMenu=False)
        plot = self.canvas.addPlot(row=place, col=0, viewBox=box)
        return PlotRow(row, plot, CurvesView(self.canvas.viewport()), is_last=place == count - 1)

    def _dress(self) -> None:
        theme = self.look.theme
        self.canvas.setBackground(theme.colour("field"))
        line = QFontMetricsF(self.font()).height()
        self.canvas.setMinimumHeight(round(len(self.rows) * _LINES_OF_ROW * line))
        for row in self.rows:
            row.set_look(theme, self.font())
        self.draw()

    def _set_pace(self) -> None:
        """Draw at 60 frames a second only what moves and is seen."""
        if not self.isVisible() or not self.view.is_live:
            self._timer.stop()
            return
        is_quiet = self.feed.newest_s < self.shown_s[0]
        pace_ms = _QUIET_MS if is_quiet else FRAME_MS
        if not self._timer.isActive() or self._timer.interval() != pace_ms:
            self._timer.start(pace_ms)

    @property
    def is_drawing(self) -> bool:
        """Whether it draws again and again."""
        return self._timer.isActive()

    # What happens

    def showEvent(self, event: QShowEvent) -> None:
        """Go on drawing."""
        super().showEvent(event)
        self._set_pace()
        self.draw()

    def hideEvent(self, event: QHideEvent) -> None:
        """Do nothing while nobody looks."""
        super().hideEvent(event)
        self._timer.stop()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Draw for the new size."""
        super().resizeEvent(event)
        QTimer.singleShot(0, self, self.draw)

    def changeEvent(self, event: QEvent) -> None:
        """Take another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._dress()

    def _on_streams_changed(self) -> None:
        self._fit_rows()
        self._set_pace()

    def _say(self) -> None:
        """Take the titles of the rows, which stay, in other words."""
        self._fit_rows()
        for row, named in zip(self.rows, rows_of(self.feed.streams), strict=True):
            row.row = named
        self._dress()


# One plot: its axes, which pyqtgraph draws, and its curves, which it does not.

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
        there = [(one, curve.key.channel) for curve, one in columns if len(one.number)]
        if there:
            low = np.fmin.reduce([np.fmin.reduce(one.low[at]) for one, at in there])
            high = np.fmax.reduce([np.fmax.reduce(one.high[at]) for one, at in there])
            self.set_values(self.values.fitted(float(low), float(high)))

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
                self.row.heading,
            )
        )

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
