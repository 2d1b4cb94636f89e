"""The settings of the program: each is in force at once, and Cancel undoes them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QPushButton,
    QSlider,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from nep_studio.settings import FolderName, Settings, ShowOptions
from nep_studio.ui.app import Studio
from nep_studio.ui.settings_pages import (
    FOLDERS,
    TEXT_STEP,
    FoldersPage,
    LookPage,
    NetworkPage,
    ShowPage,
)
from nep_studio.ui.support.privacy_page import PrivacyPage
from nep_studio.ui.words import tr
from nep_studio.updates import UpdateChoice

MorePage = Callable[[QWidget], tuple[str, QWidget]]
"""Makes one more page of the dialog: its title and its widget."""


@dataclass(frozen=True)
class _Kept:
    """What Cancel gives back."""

    language: str
    theme: str
    text_scale: float
    folders: dict[FolderName, Path | None]
    show: ShowOptions
    lets_original_join: bool
    updates: tuple[bool, str]


def _kept(settings: Settings) -> _Kept:
    updates = UpdateChoice(settings)
    return _Kept(
        settings.language,
        settings.theme,
        settings.text_scale,
        {name: settings.chosen_folder(name) for name in FOLDERS},
        settings.show_options,
        settings.lets_original_join,
        (updates.is_wanted, updates.address),
    )


class SettingsDialog(QDialog):
    """Shows what is chosen, and takes what is chosen anew."""

    def __init__(self, studio: Studio, parent: QWidget) -> None:
        super().__init__(parent)
        self._studio = studio
        self._before = _kept(studio.settings)
        self._more: list[MorePage] = []
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.reset_button = QPushButton()
        self.cancel_button = QPushButton()
        self.close_button = QPushButton()
        self.pages = QTabWidget()
        self._lay_out()
        self._fill()
        self.cancel_button.clicked.connect(self.reject)
        self.close_button.clicked.connect(self.accept)

    def add_page(self, make: MorePage) -> None:
        """Show one more page; it is made again when the language changes."""
        self._more.append(make)
        title, page = make(self)
        self.pages.addTab(page, title)

    def reject(self) -> None:
        """Take back what was chosen since the dialog was opened."""
        before, studio, settings = self._before, self._studio, self._studio.settings
        settings.show_options = before.show
        settings.lets_original_join = before.lets_original_join
        updates = UpdateChoice(settings)
        updates.is_wanted, updates.address = before.updates
        for name, folder in before.folders.items():
            settings.set_folder(name, folder)
        super().reject()
        if settings.theme != before.theme:
            studio.choose_theme(before.theme)
        if settings.text_scale != before.text_scale:
            studio.choose_text_scale(before.text_scale)
        if settings.language != before.language:
            studio.choose_language(before.language)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        buttons = QHBoxLayout()
        buttons.addWidget(self.reset_button)
        buttons.addStretch(1)
        buttons.addWidget(self.cancel_button)
        buttons.addWidget(self.close_button)
        self.close_button.setDefault(True)
        self.cancel_button.setAutoDefault(False)
        self.reset_button.setAutoDefault(False)
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line)
        box.addWidget(self.pages, 1)
        box.addLayout(buttons)
        self.setMinimumWidth(line * 34)

    def _fill(self) -> None:
        """Make all that has words in it."""
        here = self.pages.currentIndex()
        while self.pages.count():
            old = self.pages.widget(0)
            self.pages.removeTab(0)
            if old is not None:
                old.deleteLater()
        self.setWindowTitle(tr("Settings"))
        self.reset_button.setText(tr("Put the panels back"))
        self.cancel_button.setText(tr("Cancel"))
        self.close_button.setText(tr("Done"))
        settings = self._studio.settings
        look = LookPage(settings)
        self.language, self.theme = look.language, look.theme
        self.text_size: QSlider = look.text_size
        self.language.activated.connect(self._on_language_chosen)
        self.theme.activated.connect(self._on_theme_chosen)
        look.size_chosen.connect(self._on_size_chosen)
        self.folders, self.show_page = FoldersPage(settings), ShowPage(settings)
        self.privacy = PrivacyPage(settings)
        self.pages.addTab(look, tr("Look"))
        self.pages.addTab(self.folders, tr("Folders"))
        self.pages.addTab(self.show_page, tr("Show mode"))
        self.network_page = NetworkPage(settings)
        self.pages.addTab(self.network_page, tr("Network"))
        self.pages.addTab(self.privacy, tr("Privacy"))
        for make in self._more:
            title, page = make(self)
            self.pages.addTab(page, title)
        self.pages.setCurrentIndex(max(0, here))

    def _on_language_chosen(self) -> None:
        self._studio.choose_language(self.language.currentData())
        self._fill()
        self.language.setFocus()

    def _on_theme_chosen(self) -> None:
        self._studio.choose_theme(self.theme.currentData())

    def _on_size_chosen(self) -> None:
        self._studio.choose_text_scale(self.text_size.value() * TEXT_STEP / 100)
