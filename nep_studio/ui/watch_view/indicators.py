"""A little live curve of how hard a watch is moved, over the last seconds."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from nep_core.wire.messages import Imu
from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.words import count_words, tr

from .receiving import Flow

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


# The big dot that answers a movement: grey while nothing comes, green once it has moved.

Moving = Literal["waiting", "still", "moved", "failed"]
LIVELIEST_M_S2 = 15.0
"""A movement of so much fills the dot."""
SMALLEST = 0.62
ICONS = {"waiting": "hourglass", "still": "hand", "moved": "check", "failed": "x"}
COLOURS = {"waiting": "muted", "still": "info", "moved": "success", "failed": "error"}


class MoveDot(QWidget):
    """Grows with the movement; its shape and its sign differ, not its colour alone."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.state: Moving = "waiting"
        self._look = look
        self._liveliness = 0.0
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)

    def show_movement(self, state: Moving, movement_m_s2: float) -> None:
        """Show how it is; the movement is how far the acceleration reached lately."""
        liveliness = min(1.0, max(0.0, movement_m_s2 / LIVELIEST_M_S2))
        if (state, liveliness) != (self.state, self._liveliness):
            self.state, self._liveliness = state, liveliness
            self.update()

    def sizeHint(self) -> QSize:
        """As high as a few lines."""
        side = round(self.fontMetrics().height() * LINES_HIGH)
        return QSize(side, side)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw it."""
        theme, side = self._look.theme, min(self.width(), self.height())
        colour = theme.colour(COLOURS[self.state])
        is_live = self.state in ("still", "moved")
        share = SMALLEST + (1 - SMALLEST) * self._liveliness if is_live else SMALLEST + 0.2
        radius = side / 2 * share - 1
        middle = QPointF(self.width() / 2, self.height() / 2)
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            pen = QPen(colour, max(1.5, side / 28))
            if not is_live:
                pen.setStyle(Qt.PenStyle.DashLine)
            painter.setPen(pen)
            painter.setBrush(colour if is_live else Qt.BrushStyle.NoBrush)
            painter.drawEllipse(middle, radius, radius)
            sign = side * 0.34
            place = QRectF(middle.x() - sign / 2, middle.y() - sign / 2, sign, sign)
            of_sign = theme.colour("field") if is_live else colour
            paint_icon(painter, place, ICONS[self.state], of_sign)


# How a watch sends, in words and numbers: rate, loss, gaps, delay and the drift of its clock.

Grade = Literal["good", "fair", "poor"]

GOOD_HZ, FAIR_HZ = 25.0, 14.0
"""Gestures are told apart from 16 samples a second on; 25 and more are better."""
GOOD_LOSS, FAIR_LOSS = 0.02, 0.10
GOOD_DELAY_MS, FAIR_DELAY_MS = 150.0, 500.0
GOOD_GAPS, FAIR_GAPS = 0, 5
GOOD_DRIFT_PPM, FAIR_DRIFT_PPM = 500.0, 5000.0


@dataclass(frozen=True)
class Figure:
    """One number of a watch: what it is, the number with its unit, how good it is, and why."""

    name: str
    number: str
    grade: Grade
    words: str


def figures(flow: Flow) -> list[Figure]:
    """What is known of how a watch sends, the most important first."""
    return [*_rate(flow), *_loss(flow), *_gaps(flow), *_delay(flow), *_drift(flow)]


def figure_lines(flow: Flow) -> str:
    """The same, a line each, as for a tool tip."""
    return "\n".join(f"{one.name}: {one.number} ({one.words})" for one in figures(flow))


def rate_words(rate_hz: float) -> str:
    """Such as “62 samples a second”."""
    return count_words(round(rate_hz), "1 sample a second", "{n} samples a second")


def _grade(value: float, good: float, fair: float) -> Grade:
    """How good a value is of which less is better."""
    if value <= good:
        return "good"
    return "fair" if value <= fair else "poor"


def _rate(flow: Flow) -> Iterator[Figure]:
    grade = _grade(-flow.rate_hz, -GOOD_HZ, -FAIR_HZ)
    words = {
        "good": tr("fast enough"),
        "fair": tr("enough; 50 are better"),
        "poor": tr("too few: choose 50 in the app"),
    }
    number = tr("{number} a second", number=round(flow.rate_hz))
    yield Figure(tr("Samples"), number, grade, words[grade])


def _loss(flow: Flow) -> Iterator[Figure]:
    if flow.loss is None:
        return
    grade = _grade(flow.loss, GOOD_LOSS, FAIR_LOSS)
    words = {
        "good": tr("next to nothing is missing"),
        "fair": tr("it still works"),
        "poor": tr("go nearer to the Wi-Fi"),
    }
    percent = flow.loss * 100
    number = tr("{percent} %", percent=f"{percent:.1f}" if 0 < percent < 9.95 else f"{percent:.0f}")
    yield Figure(tr("Lost"), number, grade, words[grade])


def _gaps(flow: Flow) -> Iterator[Figure]:
    grade = _grade(flow.gaps, GOOD_GAPS, FAIR_GAPS)
    words = {
        "good": tr("it never paused in the last minute"),
        "fair": tr("short pauses in the last minute"),
        "poor": tr("many pauses: keep its screen on"),
    }
    yield Figure(tr("Gaps"), str(flow.gaps), grade, words[grade])


def _delay(flow: Flow) -> Iterator[Figure]:
    if flow.delay_ms is None:
        return
    grade = _grade(flow.delay_ms, GOOD_DELAY_MS, FAIR_DELAY_MS)
    words = {
        "good": tr("as good as at once"),
        "fair": tr("a little late"),
        "poor": tr("late: let the app send more often"),
    }
    number = tr("{number} ms", number=round(flow.delay_ms))
    yield Figure(tr("Delay"), number, grade, words[grade])


def _drift(flow: Flow) -> Iterator[Figure]:
    if flow.drift_ppm is None:
        return
    grade = _grade(abs(flow.drift_ppm), GOOD_DRIFT_PPM, FAIR_DRIFT_PPM)
    words = {
        "good": tr("its clock runs like ours"),
        "fair": tr("its clock runs a little differently; that is allowed for"),
        "poor": tr("its clock runs very differently; that is allowed for"),
    }
    per_hour_s = flow.drift_ppm * 3600 / 1e6
    number = tr("{seconds} s an hour", seconds=f"{per_hour_s:+.2f}")
    yield Figure(tr("Clock"), number, grade, words[grade])
