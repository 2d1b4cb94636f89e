"""The acceleration of x, y and z as three lines, each with its letter at its end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QFontMetricsF, QPainter, QPen

from nep_studio.ui.ring import Floats
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.widgets.curves import polygon
from nep_studio.ui.words import tr

from .live import Samples

LETTERS = ("x", "y", "z")
COLOURS = ("plot_1", "plot_2", "plot_6")
"""Blue, orange and grey: everybody can tell them apart, by lightness too."""
LEAST_SPAN_M_S2 = 12.0
_MARGIN = 0.08
_SMOOTH_S = 0.04


@dataclass(frozen=True)
class Window:
    """Which part of time and values is drawn where."""

    rect: QRectF
    start_s: float
    end_s: float
    low: float
    high: float

    def x(self, time_s: float) -> float:
        """Where a time is."""
        part = (time_s - self.start_s) / max(self.end_s - self.start_s, 1e-9)
        return self.rect.left() + part * self.rect.width()

    def time(self, x: float) -> float:
        """Which time is there."""
        part = (x - self.rect.left()) / max(self.rect.width(), 1.0)
        return self.start_s + part * (self.end_s - self.start_s)

    def y(self, value: float) -> float:
        """Where a value is."""
        part = (self.high - value) / max(self.high - self.low, 1e-9)
        return self.rect.top() + part * self.rect.height()


def value_range(samples: Samples) -> tuple[float, float]:
    """The least and the greatest value, with room around them."""
    if not len(samples):
        return -LEAST_SPAN_M_S2 / 2, LEAST_SPAN_M_S2 / 2
    low, high = float(samples.acc.min()), float(samples.acc.max())
    lacking = max(0.0, LEAST_SPAN_M_S2 - (high - low)) / 2
    room = _MARGIN * max(high - low, LEAST_SPAN_M_S2)
    return low - lacking - room, high + lacking + room


def paint_lines(
    painter: QPainter, window: Window, samples: Samples, theme: Theme, width: float
) -> None:
    """Draw the three lines; the painter is clipped to the window meanwhile."""
    if not len(samples):
        return
    painter.save()
    painter.setClipRect(window.rect)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    points = np.empty((len(samples), 2))
    points[:, 0] = _mapped(samples.t, window.x(0.0), window.x(1.0))
    for axis, colour in enumerate(COLOURS):
        points[:, 1] = _mapped(samples.acc[:, axis], window.y(0.0), window.y(1.0))
        pen = QPen(theme.colour(colour), width * 1.4)
        pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        painter.setPen(pen)
        painter.drawPolyline(polygon(_fewer(points, window.rect.width())))
    painter.restore()


def paint_letters(
    painter: QPainter, window: Window, samples: Samples, theme: Theme, font: QFont
) -> None:
    """Write x, y and z beside the ends of their lines; none covers another."""
    if not len(samples):
        return
    line = QFontMetricsF(font).height()
    newest = samples.acc[-max(1, round(_SMOOTH_S * samples.rate_hz)) :].mean(axis=0)
    places = _spread([window.y(float(value)) for value in newest], line * 0.95, window)
    painter.setFont(font)
    for letter, colour, y in zip(LETTERS, COLOURS, places, strict=True):
        painter.setPen(theme.colour(colour))
        room = QRectF(0, 0, line, line)
        room.moveTo(window.rect.right() + line * 0.3, y - line / 2)
        sides = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignAbsolute
        painter.drawText(room, int(sides | Qt.AlignmentFlag.AlignVCenter), letter)


def paint_ground(painter: QPainter, window: Window, theme: Theme) -> None:
    """Draw the line of no acceleration, if it is in the window."""
    y = window.y(0.0)
    if window.rect.top() < y < window.rect.bottom():
        painter.setPen(QPen(theme.colour("line"), 1, Qt.PenStyle.DotLine))
        painter.drawLine(QPointF(window.rect.left(), y), QPointF(window.rect.right(), y))


def _mapped(values: Floats, zero: float, one: float) -> Floats:
    return zero + values * (one - zero)


def _fewer(points: Floats, width: float) -> Floats:
    """The points that can be told apart: the least and greatest of each half pixel or so."""
    columns = max(1, round(width))
    if len(points) <= 3 * columns:
        return points
    groups = np.array_split(points, columns)
    ends = [sorted({int(one[:, 1].argmin()), int(one[:, 1].argmax())}) for one in groups]
    return np.concatenate([one[kept] for one, kept in zip(groups, ends, strict=True)])


def _spread(places: list[float], least: float, window: Window) -> list[float]:
    """The same places, moved apart so that no two are nearer than ``least``."""
    order = sorted(range(len(places)), key=lambda at: places[at])
    top, bottom = window.rect.top() + least / 2, window.rect.bottom() - least / 2
    moved = [min(max(places[at], top), bottom) for at in order]
    for at in range(1, len(moved)):
        moved[at] = max(moved[at], moved[at - 1] + least)
    over = max(0.0, moved[-1] - bottom)
    moved[-1] -= over
    for at in range(len(moved) - 2, -1, -1):
        moved[at] = min(moved[at], moved[at + 1] - least)
    found = dict(zip(order, moved, strict=True))
    return [found[at] for at in range(len(places))]


# What is drawn over the curves: takes, the recording, a countdown, and words where none are.

HANDLE_LINES = 0.55
_FAULT_ALPHA, _TAKE_ALPHA, _RECORDED_ALPHA = 46, 40, 16


@dataclass(frozen=True)
class Mark:
    """A stretch with words on it; one with a fault is hatched."""

    start_s: float
    end_s: float
    words: str
    is_fault: bool = False


def fault_words(fault: str) -> str:
    """Why a movement does not count, in a few words."""
    return {
        "short": tr("too short"),
        "still": tr("too still"),
        "long": tr("too long"),
        "gap": tr("samples are missing"),
    }.get(fault, fault)


def paint_recorded(painter: QPainter, window: Window, start_s: float, theme: Theme) -> None:
    """Tint all that is part of the recording, with a line where it began."""
    left = max(window.rect.left(), window.x(start_s))
    if left >= window.rect.right():
        return
    rect = QRectF(QPointF(left, window.rect.top()), window.rect.bottomRight())
    painter.fillRect(rect, _tint(theme.colour("stop"), _RECORDED_ALPHA))
    if window.x(start_s) >= window.rect.left():
        painter.setPen(QPen(theme.colour("stop"), 2))
        painter.drawLine(rect.topLeft(), rect.bottomLeft())


def _place(window: Window, mark: Mark) -> QRectF:
    """Where a stretch is, as far as it is in the window."""
    left, right = window.x(mark.start_s), window.x(mark.end_s)
    whole = QRectF(left, window.rect.top(), right - left, window.rect.height())
    return whole.intersected(window.rect)


def _colour(mark: Mark, theme: Theme) -> QColor:
    return theme.colour("warning" if mark.is_fault else "success")


def paint_mark(painter: QPainter, window: Window, mark: Mark, theme: Theme) -> None:
    """Tint a stretch, with a bar at the top."""
    rect, colour = _place(window, mark), _colour(mark, theme)
    if rect.isEmpty():
        return
    if mark.is_fault:
        painter.fillRect(rect, QBrush(_tint(colour, 2 * _FAULT_ALPHA), Qt.BrushStyle.BDiagPattern))
    painter.fillRect(rect, _tint(colour, _FAULT_ALPHA if mark.is_fault else _TAKE_ALPHA))
    painter.fillRect(QRectF(rect.left(), rect.top(), rect.width(), 3), colour)


def paint_label(painter: QPainter, window: Window, mark: Mark, theme: Theme, font: QFont) -> None:
    """Write the words of a stretch at its top, over the curves."""
    rect, colour, words = _place(window, mark), _colour(mark, theme), mark.words
    if rect.isEmpty():
        return
    metrics = QFontMetricsF(font)
    width = metrics.horizontalAdvance(words) + metrics.height() * 0.6
    x = min(max(rect.center().x() - width / 2, window.rect.left()), window.rect.right() - width)
    room = QRectF(x, rect.top() + 5, width, metrics.height() * 1.1)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(colour, 1))
    painter.setBrush(theme.colour("field"))
    painter.drawRoundedRect(room, room.height() / 2, room.height() / 2)
    painter.setFont(font)
    painter.setPen(theme.colour("field_text"))
    painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)


def paint_handle(
    painter: QPainter, window: Window, time_s: float, theme: Theme, line: float, *, is_held: bool
) -> None:
    """Draw an end of a take, which can be dragged."""
    x = window.x(time_s)
    colour = theme.colour("focus" if is_held else "success")
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(colour, 3 if is_held else 2))
    painter.drawLine(QPointF(x, window.rect.top()), QPointF(x, window.rect.bottom()))
    grip = QRectF(0, 0, line * HANDLE_LINES, line * 1.3)
    grip.moveCenter(QPointF(x, window.rect.center().y()))
    painter.setBrush(theme.colour("field"))
    painter.drawRoundedRect(grip, 3, 3)


def paint_big(
    painter: QPainter, rect: QRectF, words: str, theme: Theme, font: QFont, share: float
) -> None:
    """Write a few words as large as this share of the height, readable over curves."""
    big = QFont(font)
    metrics = QFontMetricsF(big)
    width = max(metrics.horizontalAdvance(words), 1.0)
    scale = min(rect.height() * share / metrics.height(), rect.width() * share / width)
    big.setPixelSize(max(8, round(metrics.height() * scale * 0.8)))
    big.setWeight(QFont.Weight.DemiBold)
    metrics = QFontMetricsF(big)
    room = QRectF(0, 0, metrics.horizontalAdvance(words) + metrics.height(), metrics.height() * 1.1)
    room.moveCenter(rect.center())
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(_tint(theme.colour("field"), 225))
    painter.drawRoundedRect(room, room.height() / 3, room.height() / 3)
    painter.setFont(big)
    painter.setPen(theme.colour("field_text"))
    painter.drawText(room, Qt.AlignmentFlag.AlignCenter, words)


def paint_words(painter: QPainter, rect: QRectF, words: str, theme: Theme, font: QFont) -> None:
    """Say in the middle what is missing, readable over curves."""
    metrics = QFontMetricsF(font)
    flags = int(Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap)
    room = rect.adjusted(metrics.height(), 4, -metrics.height(), -4)
    written = metrics.boundingRect(room, flags, words)
    around = metrics.height() * 0.4
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(_tint(theme.colour("field"), 230))
    painter.drawRoundedRect(written.adjusted(-around, -around, around, around), around, around)
    painter.setFont(font)
    painter.setPen(theme.colour("muted"))
    painter.drawText(room, flags, words)


def _tint(colour: QColor, alpha: int) -> QColor:
    tinted = QColor(colour)
    tinted.setAlpha(alpha)
    return tinted
