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
    for button in root.findChildren(QAbstractButton):
        side = _side(button)
        button.setIconSize(icon_room(side) if button.text() else QSize(side, side))
    for bar in root.findChildren(QTabBar):
        bar.setIconSize(icon_room(_side(bar)))
    for tabs in root.findChildren(QTabWidget):
        tabs.setIconSize(icon_room(_side(tabs)))


def _side(widget: QWidget) -> int:
    return round(widget.fontMetrics().height() * ICON_LINES)


def icon_room(side: int) -> QSize:
    """The room of an icon that stands beside a word."""
    return QSize(round(side * WIDENING), side)
