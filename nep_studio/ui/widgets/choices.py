"""A list to choose from whose entries are told again, in place, in another language."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QComboBox, QWidget

from nep_studio.ui.labels import follow_words

Offered = Callable[[], Mapping[Any, str]]


class Choices(QComboBox):
    """Entries by what they stand for, which is their data; what is chosen stays chosen."""

    def __init__(self, offered: Offered, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._offered = offered
        """What there is, with its words in the language that is used now."""
        # longer words of another language have their room as well
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        follow_words(self, self.refill)

    def refill(self) -> None:
        """Offer what there is now, in the words that it has now."""
        offered, chosen = self._offered(), self.currentData()
        with QSignalBlocker(self):
            if list(offered) != [self.itemData(row) for row in range(self.count())]:
                self.clear()
                for one in offered:
                    self.addItem("", one)
                self.setCurrentIndex(max(self.findData(chosen), 0) if offered else -1)
            for row, words in enumerate(offered.values()):
                self.setItemText(row, words)

    def choose(self, one: object) -> None:
        """Let this be chosen, if it is offered."""
        self.setCurrentIndex(max(self.findData(one), 0))
