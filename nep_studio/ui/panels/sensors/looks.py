"""How curves look: each has a colour and a kind of line, so that colour never speaks alone."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QIcon, QPainter, QPen, QPixmap

from nep_studio.ui.theme import HIGH_CONTRAST, Theme

COLOURS = 6
_PATTERNS: tuple[tuple[float, ...], ...] = (
    (),
    (8, 4),
    (2, 3),
    (10, 3, 2, 3),
    (14, 6),
    (6, 2, 1, 2, 1, 2),
)
"""Lengths of dashes and of what is between them, in widths of the line."""
_DASHES_IN_ICON = 3.2
"""How long the icon of a line is, in lines of text: every pattern can be told from the others."""


@dataclass(frozen=True)
class CurveLook:
    """A colour of the theme's table and a pattern, by number; the seventh is like the first."""

    number: int

    def pen(self, theme: Theme, metrics: QFontMetricsF) -> QPen:
        """The pen that draws the curve."""
        colour = theme.colour(f"plot_{self.number % COLOURS + 1}")
        pen = QPen(colour, line_width(theme, metrics))
        pen.setCosmetic(True)
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        pattern = _PATTERNS[self.number % len(_PATTERNS)]
        if pattern:
            pen.setDashPattern(list(pattern))
        return pen

    def icon(self, theme: Theme, metrics: QFontMetricsF, ratio: float) -> QIcon:
        """A piece of the line."""
        size = icon_size(metrics)
        pixmap = QPixmap(size * ratio)
        pixmap.setDevicePixelRatio(ratio)
        pixmap.fill(Qt.GlobalColor.transparent)
        painter = QPainter(pixmap)
        pen = self.pen(theme, metrics)
        pen.setWidthF(pen.widthF() * 1.5)
        painter.setPen(pen)
        painter.drawLine(0, size.height() // 2, size.width(), size.height() // 2)
        painter.end()
        return QIcon(pixmap)


def line_width(theme: Theme, metrics: QFontMetricsF) -> float:
    """How wide curves are: wider with larger text and with high contrast."""
    width = max(1, round(metrics.height() / 17))
    return width + 1 if theme.name == HIGH_CONTRAST else width


def icon_size(metrics: QFontMetricsF) -> QSize:
    """How large the piece of a line in a list is."""
    height = round(metrics.height())
    return QSize(round(height * _DASHES_IN_ICON), height)


def mixed(one: QColor, other: QColor) -> QColor:
    """The colour in the middle between two."""
    return QColor(
        (one.red() + other.red()) // 2,
        (one.green() + other.green()) // 2,
        (one.blue() + other.blue()) // 2,
    )
