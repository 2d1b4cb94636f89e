"""A line of words that ends in … where there is no room for all of them."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

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
