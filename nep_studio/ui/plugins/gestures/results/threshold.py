"""Sets how certain the recogniser must be of one gesture, and shows both sides of it at once."""

from __future__ import annotations

import math

from PySide6.QtCore import QLineF, QPointF, QRectF, QSignalBlocker, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QPushButton, QSizePolicy, QSlider, QWidget

from faults import text_of
from nep_studio.blocks.own_gestures import TRIGGER
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.theme.colours import HIGH_CONTRAST, Theme
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import plain_label
from nep_studio.ui.widgets.layouts import InLines, in_column, in_row
from nep_studio.ui.words import count_words, tr

from .findings import HIGHEST, LOWEST, Findings, Point, Tuning, between
from .labels import curve_pen, paint_legend

# What a recognition point of a gesture means, in one sentence with both of its sides.

_NEVER = 0.05
"""Fewer false triggers an hour are told as none."""


def both_sides(findings: Findings, name: str, certainty: float) -> str:
    """How much is caught and how much is false at a certainty; empty when it was not measured."""
    point = findings.found_at(name, certainty)
    if point is None:
        return ""
    takes = findings.takes.get(name, 0)
    caught = tr("Caught {caught} of {all}", caught=round(point.caught * takes), all=takes)
    parts = [caught, _false_words(findings, point.false_per_hour)]
    if others := round(point.false_in_others):
        parts.append(count_words(others, "once at another gesture", "{n} times at other gestures"))
    return " — ".join(parts)


def _false_words(findings: Findings, rate: float) -> str:
    if not findings.everyday_s:
        return tr("false triggers not known yet")
    if rate < _NEVER:
        minutes = round(findings.everyday_s / 60)
        return count_words(
            max(minutes, 1),
            "no false one in a minute of everyday movement",
            "no false one in {n} minutes of everyday movement",
        )
    told = f"{rate:.0f}" if rate >= 3 else f"{rate:.1f}"
    return tr("false about {rate} times an hour", rate=told)


# Draws what each recognition point of a gesture catches, and what it lets through.

LINES_HIGH = 7.0
_LEAST_RATE = 1.0
"""The scale of false triggers an hour goes up to this at least: one false one looks small."""


class PointCurve(InLines):
    """Two curves over the certainty, and the place where the recognition point is.

    ``dragged`` gives the certainty that the mouse is at, ``let_go`` that it was let go.
    """

    usual_lines, least_lines = (16, LINES_HIGH), (9, LINES_HIGH)

    dragged = Signal(float)
    let_go = Signal()

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.points: tuple[Point, ...] = ()
        self.certainty = 0.75
        self.setLayoutDirection(Qt.LayoutDirection.LeftToRight)  # as all scales of numbers are
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.SizeHorCursor)
        look.theme_changed.connect(self.update)

    def show_points(self, points: tuple[Point, ...], certainty: float) -> None:
        """Show the curves of a gesture and its recognition point."""
        self.points, self.certainty = points, certainty
        self.update()

    # The mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Set the recognition point."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.dragged.emit(self.certainty_at(event.position().x()))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move it."""
        if event.buttons() & Qt.MouseButton.LeftButton:
            self.dragged.emit(self.certainty_at(event.position().x()))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let it go."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.let_go.emit()

    # Where things are

    def area(self) -> QRectF:
        """Where the curves are; as wide as the groove of a slider below."""
        line = self.fontMetrics().height()
        width = max(self.width() - line, 1.0)
        return QRectF(line * 0.5, line * 1.4, width, self.height() - line * 2.8)

    def certainty_at(self, x: float) -> float:
        """The certainty at a place."""
        area = self.area()
        share = min(max((x - area.left()) / area.width(), 0.0), 1.0)
        return LOWEST + share * (HIGHEST - LOWEST)

    def x_of(self, certainty: float) -> float:
        """Where a certainty is."""
        area = self.area()
        return area.left() + (certainty - LOWEST) / (HIGHEST - LOWEST) * area.width()

    @property
    def most_per_hour(self) -> float:
        """What the top of the scale of false triggers is."""
        return max(_LEAST_RATE, *(point.false_per_hour for point in self.points), 0.0)

    # Painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the curves and the place."""
        theme, area = self._look.theme, self.area()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        painter.fillRect(area, theme.colour("field"))
        painter.setPen(QPen(theme.colour("line"), 1))
        painter.drawRect(area)
        if self.points:
            most = self.most_per_hour
            caught = [self._place(point.certainty, point.caught) for point in self.points]
            false = [self._place(p.certainty, _height(p.false_per_hour, most)) for p in self.points]
            pale = theme.colour("plot_1")
            pale.setAlphaF(0.15)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(pale)
            ends = [QPointF(one.x(), area.bottom()) for one in (caught[-1], caught[0])]
            painter.drawPolygon(QPolygonF([*caught, *ends]))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            wide = max(2.0, self.fontMetrics().height() / 8)
            wide *= 1.5 if theme.name == HIGH_CONTRAST else 1
            pens = [curve_pen(theme, colour, wide) for colour in ("plot_1", "plot_2")]
            for pen, curve in zip(reversed(pens), (false, caught), strict=True):
                painter.setPen(pen)
                painter.drawPolyline(QPolygonF(curve))
            legend = dict(zip((tr("caught"), tr("false alarms")), pens, strict=True))
            paint_legend(painter, area.left(), legend, theme.colour("text"))
        self._paint_place(painter, theme)
        painter.end()

    def _paint_place(self, painter: QPainter, theme: Theme) -> None:
        area, line, x = self.area(), self.fontMetrics().height(), self.x_of(self.certainty)
        painter.setPen(QPen(theme.colour("snap"), max(2.0, line / 8)))
        painter.drawLine(QLineF(x, area.top(), x, area.bottom() + line * 0.3))
        found = between(self.points, self.certainty)
        if found is not None:
            most = self.most_per_hour
            painter.setBrush(theme.colour("field"))
            heights = {"plot_1": found.caught, "plot_2": _height(found.false_per_hour, most)}
            for colour, height in heights.items():
                painter.setPen(QPen(theme.colour(colour), max(2.0, line / 8)))
                painter.drawEllipse(self._place(self.certainty, height), line / 4, line / 4)
        painter.setPen(theme.colour("text"))
        words = f"{self.certainty * 100:.0f} %"
        wide = self.fontMetrics().horizontalAdvance(words)
        left = min(max(x - wide / 2, 0.0), self.width() - wide)
        room = QRectF(left, area.bottom() + line * 0.25, wide + 1, line * 1.1)
        painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)

    def _place(self, certainty: float, share: float) -> QPointF:
        area = self.area()
        return QPointF(self.x_of(certainty), area.bottom() - min(share, 1.0) * area.height())


def _height(per_hour: float, most: float) -> float:
    """Where a rate is between none and the most: few false triggers matter, many are many."""
    return math.sqrt(per_hour / most)


KEEP_MS = 700
"""Steps of keys that follow each other within this time are one step of undo."""


class PointPanel(QWidget):
    """A gesture is chosen, its curves are shown, a slider below them sets its point."""

    def __init__(self, tuning: Tuning, look: Look) -> None:
        super().__init__()
        self.tuning = tuning
        self.gesture = labelled(Choices(self._gestures), name="Gesture")
        self.gesture.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.curve = PointCurve(look)
        self.slider = PointSlider(tuning)
        self.sentence = plain_label()
        self.reset = labelled(
            QPushButton(),
            text="Usual",
            tip=text_of("Set the recognition point to {percent} %", percent=75),
        )
        self.reset.setProperty("kind", "quiet")
        row = in_row((self.gesture, 1), self.reset)
        in_column(row, self.curve, self.slider, self.sentence, of=self, margins=0)
        self.gesture.currentIndexChanged.connect(self.refresh)
        self.curve.dragged.connect(lambda certainty: tuning.preview(self.name, certainty))
        self.curve.let_go.connect(lambda: tuning.keep(self.name))
        self.reset.clicked.connect(lambda: tuning.reset(self.name))
        tuning.point_changed.connect(self._on_point_changed)
        tuning.method_changed.connect(self.refresh)
        follow_words(self, self.refresh)

    @property
    def name(self) -> str:
        """The gesture that is chosen."""
        return str(self.gesture.currentData() or "")

    def fill(self) -> None:
        """Offer the gestures that were learned."""
        self.gesture.refill()
        self.refresh()

    def _gestures(self) -> dict[str, str]:
        findings, gestures = self.tuning.findings, self.tuning.controller.gestures
        known = findings.takes if findings is not None else {}
        return {name: one.title for name, one in gestures.items() if name in known}

    def choose(self, name: str) -> None:
        """Show a gesture."""
        if (at := self.gesture.findData(name)) >= 0:
            self.gesture.setCurrentIndex(at)

    def refresh(self) -> None:
        """Show the recognition point as it is now."""
        findings, certainty = self.tuning.findings, self.tuning.point(self.name)
        points = findings.curves.get(self.name, ()) if findings is not None else ()
        self.curve.show_points(points, certainty)
        self.slider.show_gesture(self.name)
        words = both_sides(findings, self.name, certainty) if findings is not None else ""
        missing = tr("Record each gesture at least twice: then it is known what a point means.")
        self.sentence.setText(words or missing)
        self.slider.setAccessibleDescription(words)
        self.reset.setEnabled(bool(self.name) and round(certainty - TRIGGER, 3) != 0)

    def _on_point_changed(self, name: str) -> None:
        if name == self.name:
            self.refresh()


class PointSlider(QSlider):
    """The recognition point of a gesture in hundredths; a drag is one step of undo."""

    def __init__(self, tuning: Tuning) -> None:
        super().__init__(Qt.Orientation.Horizontal)
        self.tuning, self.name = tuning, ""
        self.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.setRange(round(LOWEST * 100), round(HIGHEST * 100))
        self.setPageStep(5)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._keep_soon = QTimer(self, singleShot=True, interval=KEEP_MS)
        self._keep_soon.timeout.connect(self.keep)
        self.valueChanged.connect(self._on_value_changed)
        self.sliderReleased.connect(self.keep)

    def show_gesture(self, name: str) -> None:
        """Be the slider of this gesture."""
        if name != self.name:
            self.keep()
            self.name = name
            gesture = self.tuning.controller.gestures.get(name)
            title = gesture.title if gesture is not None else ""
            labelled(self, name=text_of("Recognition point of “{gesture}”", gesture=title))
        with QSignalBlocker(self):
            self.setValue(round(self.tuning.point(name) * 100))
        self.setEnabled(bool(name))
        self.update()

    def keep(self) -> None:
        """Let the project have what is shown, if it was moved."""
        self._keep_soon.stop()
        if self.name in self.tuning.moved:
            self.tuning.keep(self.name)

    def _on_value_changed(self, value: int) -> None:
        self.tuning.preview(self.name, value / 100)
        if not self.isSliderDown():
            self._keep_soon.start()

    def minimumSizeHint(self) -> QSize:
        """As narrow as the curves above may be."""
        return QSize(self.fontMetrics().height() * 6, super().minimumSizeHint().height())
