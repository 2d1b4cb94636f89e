"""Icons as large as the text beside them, which Qt leaves at one size."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QAbstractButton, QTabBar, QTabWidget, QWidget

ICON_LINES = 1.0
"""How high an icon is, in lines of text."""

WIDENING = 1.3
"""How much wider than high the room of an icon beside a word is: Qt leaves too little there."""


def fit_icons(root: QWidget) -> None:
    """Give the icons of all buttons and tabs inside a widget the size of their text."""
    for kind in (QAbstractButton, QTabBar, QTabWidget):
        for widget in root.findChildren(kind):
            side = round(widget.fontMetrics().height() * ICON_LINES)
            has_words = not isinstance(widget, QAbstractButton) or bool(widget.text())
            widget.setIconSize(icon_room(side) if has_words else QSize(side, side))


def icon_room(side: int) -> QSize:
    """The room of an icon that stands beside a word."""
    return QSize(round(side * WIDENING), side)
