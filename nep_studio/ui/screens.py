"""Which part of the screen a widget may use."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect
from PySide6.QtGui import QGuiApplication, QScreen
from PySide6.QtWidgets import QWidget


def room_around(widget: QWidget | None) -> QRect:
    """What may be used of the screen that a widget is on; without one, of the main screen."""
    return _screen_of(widget).availableGeometry()


def screen_around(widget: QWidget | None) -> QRect:
    """The whole screen that a widget is on; without one, the main screen."""
    return _screen_of(widget).geometry()


def fit_on_screen(dialog: QWidget, lines_wide: float, lines_high: float) -> None:
    """Give a dialog so many lines of text of room, and no more than most of the screen."""
    line, room = dialog.fontMetrics().height(), room_around(dialog.parentWidget()).size()
    dialog.resize(
        min(round(line * lines_wide), round(room.width() * 0.95)),
        min(round(line * lines_high), round(room.height() * 0.88)),
    )


def _screen_of(widget: QWidget | None) -> QScreen:
    """The screen of a widget.

    WORKAROUND for ``QWidget.screen()`` of PySide6 6.11: it makes the screen a child of the
    widget in Python's eyes. When the widget is collected as garbage, Qt's only screen is
    deleted with it, and the next widget that is made crashes the program.
    """
    middle = widget.mapToGlobal(widget.rect().center()) if widget is not None else QPoint()
    return QGuiApplication.screenAt(middle) or QGuiApplication.primaryScreen()
