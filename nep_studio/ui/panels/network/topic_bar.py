"""The head of a topic's pane: its name, a filter, and what can be done with its messages."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QLineEdit, QMenu, QToolButton, QVBoxLayout, QWidget

from nep_studio.ui.elided_label import ElidedLabel
from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr


class TopicBar(QWidget):
    """Has no behaviour of its own; the pane connects its buttons."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.title = ElidedLabel()
        self.title.setProperty("role", "heading")
        self.pause_button = _button(tr("Pause"), tr("Stop the list, to read it"))
        self.pause_button.setCheckable(True)
        self.copy_button = _button(tr("Copy"), tr("Copy the chosen message, or all of them"))
        self.save_button = _button(tr("Save as…"), tr("Save the messages as a table or JSON lines"))
        self.plot_button = _button(tr("Plot"), tr("Show a number of these messages as a curve"))
        self.plot_menu = QMenu(self.plot_button)
        self.plot_button.setMenu(self.plot_menu)
        self.plot_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.close_button = QToolButton()
        self.close_button.setToolTip(tr("Close"))
        self.close_button.setAccessibleName(tr("Close these messages"))
        self.filter = QLineEdit()
        self.filter.setPlaceholderText(tr("Show only messages with…"))
        self.filter.setAccessibleName(tr("Show only messages with…"))
        self.filter.setClearButtonEnabled(True)
        self._lay_out()
        look.theme_changed.connect(self._on_theme_changed)
        self._on_theme_changed()

    def _lay_out(self) -> None:
        first, second = QHBoxLayout(), QHBoxLayout()
        first.addWidget(self.title, 1)
        first.addWidget(self.close_button)
        for button in (self.pause_button, self.copy_button, self.save_button, self.plot_button):
            second.addWidget(button)
        second.addWidget(self.filter, 1)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addLayout(first)
        box.addLayout(second)

    def show_topic(self, topic: str) -> None:
        """Say whose messages these are."""
        self.title.set_words(topic)

    def _on_theme_changed(self) -> None:
        theme = self._look.theme
        icons = {
            self.pause_button: "pause",
            self.copy_button: "copy",
            self.save_button: "download",
            self.plot_button: "chart-line",
            self.close_button: "x",
        }
        for button, name in icons.items():
            button.setIcon(icon(name, theme))


def _button(words: str, tip: str) -> QToolButton:
    button = QToolButton()
    button.setText(words)
    button.setToolTip(tip)
    button.setAccessibleName(words)
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
    return button
