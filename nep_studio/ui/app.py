"""The application: its look, its words, its block language, and its window."""

from __future__ import annotations

import gc
import logging
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from PySide6.QtWidgets import QApplication

from nep_studio import __version__, safe_mode, settings
from nep_studio.safe_mode import StartNote
from nep_studio.settings import Settings
from nep_studio.ui import words
from nep_studio.ui.application import Application
from nep_studio.ui.theme import Look, application_icon, load_fonts

if TYPE_CHECKING:
    from nep_studio.blocks.language import Language
    from nep_studio.ui.main_window import MainWindow

log = logging.getLogger(__name__)

SAFE_AFTER_MS = 5000
"""A start has gone well when the whole window was there for so long."""


class Studio(QObject):
    """What all parts of the window share. ``words_changed`` comes after a change of language."""

    words_changed = Signal()

    def __init__(self, app: QApplication, chosen: Settings | None = None) -> None:
        super().__init__(app)
        self.app = app
        usual = safe_mode.passing_settings if safe_mode.is_on() else Settings
        self.settings = chosen or usual()
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


def make_application() -> Application:
    """The application with its name and icon."""
    app = Application(sys.argv[:1])
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
    from nep_studio.ui.stop_signals import StopSignals

    app = make_application()
    with LastResort(settings.log_file()) as last_resort, StopSignals() as stop_signals:
        note = StartNote(settings.user_folder())
        app.commitDataRequest.connect(note.succeeded)  # the session ends: that is no crash
        safe_mode.keep_crashes(settings.user_folder())
        if note.last_failed and not safe_mode.is_on() and not _may_start():
            note.succeeded()  # the person has closed it
            return 0
        window = MainWindow(Studio(app), is_gradual=True)
        last_resort.watch(window)
        stop_signals.came.connect(lambda: _end_at_once(window))
        once = Qt.ConnectionType.SingleShotConnection
        window.later.completed.connect(_collect_from_now_on, once)
        window.later.completed.connect(lambda: _begin_later(window, note), once)
        window.show()
        window.start(Path(arguments[0]) if arguments else None)
        app.file_asked_for.connect(lambda file: window.files.open(Path(file)))
        code = app.exec()
        note.succeeded()
        window.deleteLater()
    return code


def _end_at_once(window: MainWindow) -> None:
    """End without a question; work that is not saved is offered at the next start."""
    if (document := window.files.document) is not None:
        document.close(keep=document.is_modified)
    window.close_now()


def _may_start() -> bool:
    """Ask what is to be done after a start that failed; False to end."""
    from nep_studio.ui.support.after_a_crash import ask

    return ask()


def _begin_later(window: MainWindow, note: StartNote) -> None:
    """What can wait until all of the window is there."""
    from nep_studio.ui.support.adding import tell_how_it_runs

    QTimer.singleShot(SAFE_AFTER_MS, window, note.succeeded)
    tell_how_it_runs(window)


def _collect_from_now_on() -> None:
    """Collect garbage, but never look through what stays: that would hold the window up."""
    gc.freeze()
    gc.enable()
