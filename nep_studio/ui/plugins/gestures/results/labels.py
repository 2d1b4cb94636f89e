"""Labels and signs as the results use them."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import QLineF, QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QLabel

from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import icon_pixmap
from nep_studio.ui.theme.look import Look


class Words(QLabel):
    """Plain words that wrap; ``role`` is heading, hint, or none."""

    def __init__(self, text: str = "", role: str = "") -> None:
        super().__init__(text)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.setMinimumWidth(1)
        if role:
            self.setProperty("role", role)


class StatusIcon(QLabel):
    """An icon in a colour of the theme, as large as the text."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look, self._icon, self._colour = look, "", "text"
        look.theme_changed.connect(self._draw)

    def show_icon(self, name: str, colour: str) -> None:
        """Show this icon; with an empty name, none."""
        if (name, colour) != (self._icon, self._colour):
            self._icon, self._colour = name, colour
            self._draw()

    def _draw(self) -> None:
        self.setVisible(bool(self._icon))
        if self._icon:
            size = round(self.fontMetrics().height() * 1.2)
            colour = self._look.theme.colour(self._colour)
            self.setPixmap(icon_pixmap(self._icon, colour, size, self.devicePixelRatioF()))


# The two curves of a picture, and colours that can be read on another.


def curve_pen(theme: Theme, colour: str, width: float) -> QPen:
    """What a curve is drawn with; the second one is dashed too."""
    pen = QPen(theme.colour(colour), width)
    if colour == "plot_2":
        pen.setDashPattern([3.0, 2.0])
    return pen


def paint_legend(painter: QPainter, x: float, pens: Mapping[str, QPen], ink: QColor) -> None:
    """Above the curves, each word with a piece of its line."""
    metrics = painter.fontMetrics()
    line = metrics.height()
    for words, pen in pens.items():
        painter.setPen(pen)
        painter.drawLine(QLineF(x, line * 0.7, x + line * 1.6, line * 0.7))
        painter.setPen(ink)
        painter.drawText(QPointF(x + line * 1.9, line * 0.7 + metrics.ascent() * 0.4), words)
        x += line * 2.9 + metrics.horizontalAdvance(words)


READABLE = 4.5
"""The contrast that words need on what is behind them."""


def legible(ground: QColor, *colours: QColor) -> QColor:
    """The first of these colours that can be read on a ground; black or white where none can."""
    readable = (colour for colour in colours if contrast(ground, colour) >= READABLE)
    black, white = QColor("black"), QColor("white")
    return next(readable, max(black, white, key=lambda colour: contrast(ground, colour)))


def contrast(one: QColor, other: QColor) -> float:
    """The contrast of two colours, from 1 to 21, as WCAG 2 defines it."""
    bright, dark = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def _luminance(colour: QColor) -> float:
    parts = (colour.redF(), colour.greenF(), colour.blueF())
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
