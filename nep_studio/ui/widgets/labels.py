"""A line of words that ends in … where there is no room for all of them."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtGui import QGuiApplication, QResizeEvent, QScreen
from PySide6.QtWidgets import QLabel, QMenu, QSizePolicy, QWidget

FEWEST_LETTERS = 10
"""With fewer than these the rest cannot be guessed, and nothing is shown."""


class ElidedLabel(QLabel):
    """Shows as much of its words as it can; its tool tip and screen readers have all of them."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.words = ""
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    def set_words(self, words: str) -> None:
        """Show these words."""
        self.words = words
        self.setAccessibleName(words)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show more or less of the words."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        room, mode = self.contentsRect().width(), Qt.TextElideMode.ElideRight
        shown = self.fontMetrics().elidedText(self.words, mode, room)
        if len(shown) < min(len(self.words), FEWEST_LETTERS):
            shown = ""
        self.setText(shown)
        self.setToolTip("" if shown == self.words else self.words)


# Which part of the screen a widget may use.


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


# Titles inside menus: those that Qt has of its own are not painted in our style.


def add_title(menu: QMenu, words: str) -> None:
    """Begin a part of a menu with words that cannot be chosen."""
    if not menu.isEmpty():
        menu.addSeparator()
    menu.addAction(words.replace("&", "&&")).setEnabled(False)
