"""Paints the timeline of a motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QPainter, QPen, QPolygonF

from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.words import tr
from robots.body.limbs import Limb

from .editing import SAME_S, key_times

if TYPE_CHECKING:
    from .timeline import Timeline


LIMBS = (Limb.HEAD, Limb.LEFT_ARM, Limb.RIGHT_ARM, Limb.LEGS)
"""The rows."""


@dataclass(frozen=True)
class Fault:
    """Where on the timeline something is wrong, and what, in words."""

    kind: Literal["fast", "fall"]
    from_s: float
    to_s: float
    words: str


def limb_words() -> dict[Limb, str]:
    """What the limbs are called, in the order of the rows."""
    words = (tr("Head"), tr("Left arm"), tr("Right arm"), tr("Legs"))
    return dict(zip(LIMBS, words, strict=True))


class TimelinePainter:
    """One picture of the timeline as it is now."""

    def __init__(self, timeline: Timeline, painter: QPainter) -> None:
        self.timeline, self.painter = timeline, painter
        self.controller, self.theme = timeline.controller, timeline.look.theme
        self.line, self.scale = timeline.line, timeline.scale

    def paint(self) -> None:
        """Paint everything."""
        self.painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.painter.fillRect(self.timeline.rect(), self.theme.colour("field"))
        self._rows()
        row, text = self.timeline.row(0), self.theme.colour("muted")
        self.painter.fillRect(row, self.theme.colour("panel_alt"))
        for time in self.scale.marks(self.timeline.shown_s, self.line * 3):
            x = self.scale.x(time)
            self.painter.setPen(QPen(text, 1.0))
            self.painter.drawLine(QLineF(x, row.bottom() - self.line * 0.3, x, row.bottom()))
            words = f"{time:g}" if time else tr("0 s")
            place = QRectF(x - self.line * 2, row.top(), self.line * 4, self.line * 1.15)
            self.painter.drawText(place, Qt.AlignmentFlag.AlignCenter, words)
        for fault in self.timeline.faults:
            self._fault(fault)
        self._limb_keys()
        row = self.timeline.row(1)
        for time in key_times(self.controller.motion):
            self._diamond(time, row, self.line * 0.42, self._is_chosen(time))
        names = ["", tr("Poses"), *limb_words().values()]
        width = self.timeline.names_width
        for number, name in enumerate(names):
            row = self.timeline.row(number)
            row.setWidth(width)
            self.painter.fillRect(row.adjusted(0, 0, 0, -1), self.theme.colour("panel_alt"))
            self.painter.setPen(self.theme.colour("text"))
            row.setLeft(self.line * 0.4)
            flags = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
            self.painter.drawText(row, flags, name)
        self._cursor()
        if self.timeline.hasFocus():
            self._focus()

    def _rows(self) -> None:
        pen = QPen(self.theme.colour("line"), max(1.0, self.line / 16))
        self.painter.setPen(pen)
        for number in range(len(LIMBS) + 2):
            row = self.timeline.row(number)
            if number == 1:
                self.painter.fillRect(row, self.theme.colour("panel"))
            self.painter.drawLine(QLineF(row.bottomLeft(), row.bottomRight()))
        end = self.scale.x(self.controller.motion.duration_s)
        beyond = QRectF(end, self.timeline.row(1).top(), self.timeline.width() - end, 1e4)
        shade = self.theme.colour("panel_alt")
        shade.setAlphaF(0.5)
        self.painter.fillRect(beyond, shade)

    def _fault(self, fault: Fault) -> None:
        """Hatched, with a sign: colour does not speak alone."""
        is_fall = fault.kind == "fall"
        colour = self.theme.colour("error" if is_fall else "warning")
        top = self.timeline.row(1).top()
        bottom = self.timeline.row(len(LIMBS) + 1).bottom()
        left, right = self.scale.x(fault.from_s), self.scale.x(fault.to_s)
        style = Qt.BrushStyle.BDiagPattern if is_fall else Qt.BrushStyle.FDiagPattern
        pale = QColor(colour)
        pale.setAlphaF(0.55)
        self.painter.fillRect(QRectF(left, top, right - left, bottom - top), QBrush(pale, style))
        size = self.line * 0.8
        place = QRectF((left + right - size) / 2, top - size * 1.05, size, size)
        paint_icon(self.painter, place, "triangle-alert", colour)

    def _limb_keys(self) -> None:
        body = self.controller.body
        for number, limb in enumerate(LIMBS, start=2):
            row = self.timeline.row(number)
            names = [n for n in self.controller.motion.joints if n in body.index]
            moving = [n for n in names if body.joints[body.index[n]].limb is limb]
            times = sorted(
                {t for name in moving for t in self.controller.motion.joints[name].times}
            )
            if not times:
                continue
            colour = self.theme.colour("accent")
            pale = QColor(colour)
            pale.setAlphaF(0.35)
            self.painter.setPen(QPen(pale, self.line * 0.12))
            middle = row.center().y()
            start, end = self.scale.x(0.0), self.scale.x(times[-1])
            self.painter.drawLine(QLineF(start, middle, end, middle))
            for time in times:
                self._diamond(time, row, self.line * 0.22, self._is_chosen(time))

    def _diamond(self, time: float, row: QRectF, size: float, is_chosen: bool) -> None:
        x, y = self.scale.x(time), row.center().y()
        around = [(0, -size), (size, 0), (0, size), (-size, 0)]
        fill = self.theme.colour("accent" if is_chosen else "field")
        self.painter.setBrush(fill)
        self.painter.setPen(QPen(self.theme.colour("accent"), max(1.5, self.line / 9)))
        self.painter.drawPolygon(QPolygonF([QPointF(x + a, y + b) for a, b in around]))
        if is_chosen and size > self.line * 0.3:  # a dot too: not by its filling alone
            self.painter.setBrush(self.theme.colour("accent_text"))
            self.painter.setPen(Qt.PenStyle.NoPen)
            self.painter.drawEllipse(QPointF(x, y), size * 0.25, size * 0.25)

    def _is_chosen(self, time: float) -> bool:
        return any(abs(one - time) < SAME_S for one in self.controller.chosen)

    def _cursor(self) -> None:
        x = self.scale.x(self.controller.cursor_s)
        colour = self.theme.colour("snap")
        ruler = self.timeline.row(0)
        self.painter.setPen(QPen(colour, max(1.5, self.line / 9)))
        bottom = self.timeline.row(len(LIMBS) + 1).bottom()
        self.painter.drawLine(QLineF(x, ruler.bottom() - self.line * 0.3, x, bottom))
        half, low = self.line * 0.36, ruler.bottom()
        self.painter.setBrush(colour)
        self.painter.setPen(Qt.PenStyle.NoPen)
        points = [(x - half, low - self.line * 0.6), (x + half, low - self.line * 0.6), (x, low)]
        self.painter.drawPolygon(QPolygonF([QPointF(x, y) for x, y in points]))

    def _focus(self) -> None:
        wide = max(2.0, self.line / 8)
        self.painter.setBrush(Qt.BrushStyle.NoBrush)
        self.painter.setPen(QPen(self.theme.colour("focus"), wide))
        inner = QRectF(self.timeline.rect()).adjusted(wide / 2, wide / 2, -wide / 2, -wide / 2)
        self.painter.drawRect(inner)


# Where the moments of a motion are on its timeline, in pixels.

STEPS_S = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0, 300.0, 600.0)


@dataclass(frozen=True)
class Scale:
    """Pixels for seconds: ``left`` is where 0 s is."""

    left: float
    per_s: float

    def x(self, time: float) -> float:
        """Where a moment is."""
        return self.left + time * self.per_s

    def time(self, x: float) -> float:
        """Which moment is at a place; never before the beginning."""
        return max(0.0, (x - self.left) / self.per_s)

    def marks(self, end_s: float, apart: float) -> list[float]:
        """The moments that get a mark with a number, at least ``apart`` pixels from each other."""
        step = next((s for s in STEPS_S if s * self.per_s >= apart), STEPS_S[-1])
        return [round(number * step, 3) for number in range(int(end_s / step) + 1)]


def snapped(time: float, step: float) -> float:
    """The nearest multiple of a step; with 0 the time itself."""
    return round(round(time / step) * step, 3) if step > 0 else time
