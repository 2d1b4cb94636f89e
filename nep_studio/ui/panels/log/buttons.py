"""The buttons of a list that can be copied, saved and emptied."""

from __future__ import annotations

from PySide6.QtWidgets import QHBoxLayout, QToolButton, QWidget

from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr


class LogButtons(QWidget):
    """Copy, save, clear."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.copy, self.save, self.clear = QToolButton(), QToolButton(), QToolButton()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        words = {self.copy: tr("Copy"), self.save: tr("Save as text…"), self.clear: tr("Clear")}
        for button, tip in words.items():
            button.setToolTip(tip)
            button.setAccessibleName(tip)
            row.addWidget(button)
        look.theme_changed.connect(self._dress)
        self._dress()

    def _dress(self) -> None:
        signs = {self.copy: "copy", self.save: "save", self.clear: "trash-2"}
        for button, name in signs.items():
            button.setIcon(icon(name, self._look.theme))
