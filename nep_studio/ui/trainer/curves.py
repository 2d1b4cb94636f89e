"""The acceleration of x, y and z as three lines, each with its letter at its end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from nep_studio.ui.panels.sensors.looks import line_width
from nep_studio.ui.panels.sensors.polygons import polygon
from nep_studio.ui.panels.sensors.ring import Floats
from nep_studio.ui.theme import Theme
from nep_studio.ui.trainer.live import Samples

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
    painter: QPainter, window: Window, samples: Samples, theme: Theme, metrics: QFontMetricsF
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
        pen = QPen(theme.colour(colour), line_width(theme, metrics) * 1.4)
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
    metrics = QFontMetricsF(font)
    newest = samples.acc[-max(1, round(_SMOOTH_S * samples.rate_hz)) :].mean(axis=0)
    places = _spread([window.y(float(value)) for value in newest], metrics.height() * 0.95, window)
    painter.setFont(font)
    for letter, colour, y in zip(LETTERS, COLOURS, places, strict=True):
        painter.setPen(theme.colour(colour))
        corner = QPointF(window.rect.right() + metrics.height() * 0.3, y - metrics.height() / 2)
        room = QRectF(corner.x(), corner.y(), metrics.height(), metrics.height())
        sides = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignAbsolute
        painter.drawText(room, int(sides | Qt.AlignmentFlag.AlignVCenter), letter)


def paint_ground(painter: QPainter, window: Window, theme: Theme) -> None:
    """Draw the line of no acceleration, if it is in the window."""
    y = window.y(0.0)
    if window.rect.top() < y < window.rect.bottom():
        colour = QColor(theme.colour("line"))
        painter.setPen(QPen(colour, 1, Qt.PenStyle.DotLine))
        painter.drawLine(QPointF(window.rect.left(), y), QPointF(window.rect.right(), y))


def _mapped(values: Floats, zero: float, one: float) -> Floats:
    return zero + values * (one - zero)


def _fewer(points: Floats, width: float) -> Floats:
    """The points that can be told apart: the least and greatest of each half pixel or so."""
    columns = max(1, round(width))
    if len(points) <= 3 * columns:
        return points
    groups = np.array_split(points, columns)
    kept = [
        group[sorted({int(group[:, 1].argmin()), int(group[:, 1].argmax())})] for group in groups
    ]
    return np.concatenate(kept)


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
