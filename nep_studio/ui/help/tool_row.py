"""The row above the help: back and forth, search, contents, size, print."""

from __future__ import annotations

from PySide6.QtCore import QSize
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QHBoxLayout, QLineEdit, QToolButton, QVBoxLayout, QWidget

from nep_studio.ui.theme import Theme, icon
from nep_studio.ui.words import is_right_to_left, tr


class ToolRow(QWidget):
    """Buttons, and a field to search in."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.back = _button(tr("Back"))
        self.forward = _button(tr("Forward"))
        self.home = _button(tr("First page of the help"))
        self.contents = _button(tr("Contents"))
        self.contents.setCheckable(True)
        self.smaller = _button(tr("Smaller text"))
        self.larger = _button(tr("Larger text"))
        self.print = _button(tr("Print this page…"))
        self.search = QLineEdit()
        self.search.setPlaceholderText(tr("Search the help"))
        self.search.setAccessibleName(tr("Search the help"))
        self.search.setClearButtonEnabled(True)
        self._sign = QAction(self.search)
        self.search.addAction(self._sign, QLineEdit.ActionPosition.LeadingPosition)
        self._arrange()

    def dress(self, theme: Theme) -> None:
        """Take the theme and the size of the text."""
        back, forward = "arrow-left", "arrow-right"
        if is_right_to_left():
            back, forward = forward, back
        names = {
            self.back: back,
            self.forward: forward,
            self.home: "house",
            self.contents: "list-tree",
            self.smaller: "zoom-out",
            self.larger: "zoom-in",
            self.print: "printer",
        }
        side = self.fontMetrics().height()
        for button, name in names.items():
            button.setIcon(icon(name, theme))
            button.setIconSize(QSize(side, side))
        self._sign.setIcon(icon("search", theme))

    def _arrange(self) -> None:
        buttons = QHBoxLayout()
        buttons.setSpacing(0)
        for button in (self.back, self.forward, self.home, self.contents):
            buttons.addWidget(button)
        buttons.addStretch(1)
        for button in (self.smaller, self.larger, self.print):
            buttons.addWidget(button)
        gap = self.fontMetrics().height() // 4
        box = QVBoxLayout(self)
        box.setContentsMargins(gap, gap, gap, gap)
        box.setSpacing(gap)
        box.addLayout(buttons)
        box.addWidget(self.search)


def _button(words: str) -> QToolButton:
    button = QToolButton()
    button.setAutoRaise(True)
    button.setToolTip(words.removesuffix("…"))
    button.setAccessibleName(words.removesuffix("…"))
    return button
