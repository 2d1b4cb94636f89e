"""The application: its look, its words, its block language, and its window."""

from __future__ import annotations

import gc
import logging
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtWidgets import QApplication

from nep_studio import __version__, settings
from nep_studio.settings import Settings
from nep_studio.ui import words
from nep_studio.ui.theme import Look, application_icon, load_fonts

if TYPE_CHECKING:
    from nep_studio.blocks.language import Language

log = logging.getLogger(__name__)


class Studio(QObject):
    """What all parts of the window share. ``words_changed`` comes after a change of language."""

    words_changed = Signal()

    def __init__(self, app: QApplication, chosen: Settings | None = None) -> None:
        super().__init__(app)
        self.app = app
        self.settings = chosen or Settings()
        load_fonts()
        self._use_words()
        self.look = Look(app, self.settings.theme, self.settings.text_scale)
        self._language: Language | None = None

    @property
    def language(self) -> Language:
        """The blocks that there are; their files are read when somebody first asks."""
        if self._language is None:
            self.read_language()
        assert self._language is not None
        return self._language

    @language.setter
    def language(self, language: Language) -> None:
        self._language = language

    def read_language(self) -> None:
        """Read the files of the blocks now."""
        from nep_studio.studio_language import studio_language  # the first page needs none

        self._language = studio_language(words.language_code())

    def choose_theme(self, name: str) -> None:
        """Use a theme from now on."""
        self.settings.theme = name
        self.look.choose(name)

    def choose_text_scale(self, scale: float) -> None:
        """Make the text larger or smaller from now on."""
        self.settings.text_scale = scale
        self.look.set_scale(self.settings.text_scale)

    def choose_language(self, code: str) -> None:
        """Speak a language from now on; "system" is the computer's."""
        self.settings.language = code
        self._use_words()
        self.look.refresh()
        self._language = None
        self.words_changed.emit()

    def _use_words(self) -> None:
        code = self.settings.language
        if code == settings.SYSTEM:
            code = settings.system_language(words.available_languages())
        words.use_language(code)
        is_mirrored = words.is_right_to_left()
        direction = (
            Qt.LayoutDirection.RightToLeft if is_mirrored else Qt.LayoutDirection.LeftToRight
        )
        self.app.setLayoutDirection(direction)


def make_application() -> QApplication:
    """The application with its name and icon."""
    app = QApplication(sys.argv[:1])
    app.setApplicationName("nep-studio")
    app.setApplicationDisplayName("NEP Studio")
    app.setApplicationVersion(__version__)
    app.setDesktopFileName("nep-studio")
    app.setWindowIcon(application_icon())
    return app


def main(arguments: list[str]) -> int:
    """Open the window, with a project if one is named; the exit code."""
    gc.disable()  # until the window is there: what is made before stays as long as it does
    from nep_studio.ui.last_resort import LastResort
    from nep_studio.ui.main_window import MainWindow

    app = make_application()
    with LastResort(settings.log_file()) as last_resort:
        window = MainWindow(Studio(app), is_gradual=True)
        last_resort.watch(window)
        once = Qt.ConnectionType.SingleShotConnection
        window.later.completed.connect(_collect_from_now_on, once)
        window.show()
        window.start(Path(arguments[0]) if arguments else None)
        code = app.exec()
        window.deleteLater()
    return code


def _collect_from_now_on() -> None:
    """Collect garbage, but never look through what stays: that would hold the window up."""
    gc.freeze()
    gc.enable()
