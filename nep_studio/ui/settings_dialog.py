"""The settings: language, theme and size of the text; each is in force at once."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from nep_studio.settings import LARGEST_TEXT, SMALLEST_TEXT, SYSTEM
from nep_studio.ui.app import Studio
from nep_studio.ui.theme import load_theme, themes
from nep_studio.ui.words import available_languages, tr

TEXT_STEP = 5
"""Percent between two sizes of the text."""


class SettingsDialog(QDialog):
    """Shows what is chosen, and takes what is chosen anew."""

    def __init__(self, studio: Studio, parent: QWidget) -> None:
        super().__init__(parent)
        self._studio = studio
        self.setWindowTitle(tr("Settings"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        chosen = studio.settings
        self.language = _choice(
            {SYSTEM: tr("Like the computer's"), **available_languages()}, chosen.language
        )
        named = {name: tr(load_theme(name).title) for name in themes()}
        self.theme = _choice({SYSTEM: tr("Like the computer's"), **named}, chosen.theme)
        self.text_size = QSlider(Qt.Orientation.Horizontal)
        self.text_percent = QLabel()
        self.reset_button = QPushButton(tr("Put the panels back"))
        self.close_button = QPushButton(tr("Close"))
        self._set_up_slider(chosen.text_scale)
        self._lay_out()
        self._connect()

    def _set_up_slider(self, scale: float) -> None:
        slider = self.text_size
        slider.setRange(
            round(100 * SMALLEST_TEXT / TEXT_STEP), round(100 * LARGEST_TEXT / TEXT_STEP)
        )
        slider.setPageStep(5)
        slider.setValue(round(100 * scale / TEXT_STEP))
        slider.setAccessibleName(tr("Size of the text"))
        self._show_percent(slider.value())

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        size = QHBoxLayout()
        size.addWidget(self.text_size, 1)
        size.addWidget(self.text_percent)
        self.text_percent.setMinimumWidth(self.fontMetrics().horizontalAdvance("0000 %"))
        form = QFormLayout()
        form.setVerticalSpacing(line)
        form.setHorizontalSpacing(line)
        form.addRow(tr("Language"), self.language)
        form.addRow(tr("Theme"), self.theme)
        form.addRow(tr("Size of the text"), size)
        buttons = QHBoxLayout()
        buttons.addWidget(self.reset_button)
        buttons.addStretch(1)
        buttons.addWidget(self.close_button)
        self.close_button.setDefault(True)
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line * 2)
        box.addLayout(form)
        box.addLayout(buttons)
        self.setMinimumWidth(line * 22)

    def _connect(self) -> None:
        self.language.activated.connect(self._on_language_chosen)
        self.theme.activated.connect(self._on_theme_chosen)
        self.text_size.valueChanged.connect(self._show_percent)
        self.text_size.sliderReleased.connect(self._on_size_chosen)
        self.text_size.actionTriggered.connect(self._on_size_stepped)
        self.close_button.clicked.connect(self.accept)

    def _show_percent(self, steps: int) -> None:
        self.text_percent.setText(f"{steps * TEXT_STEP} %")

    def _on_language_chosen(self) -> None:
        self.accept()  # it is in the old language
        self._studio.choose_language(self.language.currentData())

    def _on_theme_chosen(self) -> None:
        self._studio.choose_theme(self.theme.currentData())

    def _on_size_chosen(self) -> None:
        self._studio.choose_text_scale(self.text_size.value() * TEXT_STEP / 100)

    def _on_size_stepped(self) -> None:
        """A key or a click beside the knob; while it is dragged, the window waits."""
        if not self.text_size.isSliderDown():
            self.text_size.setValue(self.text_size.sliderPosition())
            self._on_size_chosen()


def _choice(words: dict[str, str], chosen: str) -> QComboBox:
    box = QComboBox()
    for value, word in words.items():
        box.addItem(word, value)
    box.setCurrentIndex(max(0, box.findData(chosen)))
    return box
