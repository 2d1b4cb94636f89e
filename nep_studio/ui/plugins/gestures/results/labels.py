"""Labels and signs as the results use them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QFrame, QLabel, QSizePolicy, QWidget

from nep_studio.ui.theme.icons import icon_pixmap
from nep_studio.ui.theme.look import Look


class Words(QLabel):
    """Plain words that wrap; ``role`` is heading, hint, or none."""

    def __init__(self, text: str = "", role: str = "", parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.setMinimumWidth(1)
        if role:
            self.setProperty("role", role)


class StatusIcon(QLabel):
    """An icon in a colour of the theme, as large as the text."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look, self._icon, self._colour = look, "", "text"
        look.theme_changed.connect(self._draw)

    def show_icon(self, name: str, colour: str) -> None:
        """Show this icon; with an empty name, none."""
        if (name, colour) != (self._icon, self._colour):
            self._icon, self._colour = name, colour
            self._draw()

    def _draw(self, _theme: object = None) -> None:
        self.setVisible(bool(self._icon))
        if self._icon:
            size = round(self.fontMetrics().height() * 1.2)
            colour = self._look.theme.colour(self._colour)
            self.setPixmap(icon_pixmap(self._icon, colour, size, self.devicePixelRatioF()))


def card(parent: QWidget | None = None) -> QFrame:
    """A frame around what belongs together."""
    frame = QFrame(parent)
    frame.setProperty("kind", "card")
    frame.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
    return frame


# Colours between two of the table, and those that can be read on another.

READABLE = 4.5
"""The contrast that words need on what is behind them."""


def mixed(one: QColor, other: QColor, part: float) -> QColor:
    """A colour on the way from one to another; ``part`` is how far, from 0 to 1."""
    return QColor(
        round(one.red() + part * (other.red() - one.red())),
        round(one.green() + part * (other.green() - one.green())),
        round(one.blue() + part * (other.blue() - one.blue())),
    )


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
