"""What keys do in the window, asked of a real one in each language."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import qInstallMessageHandler

from nep_studio.settings import Settings
from nep_studio.ui.actions import on_the_canvas, shortcuts_of
from nep_studio.ui.plugins.help.repository import Rows
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.app import make_application
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.theme.look import load_fonts


class Shortcuts:
    """Makes a window that nobody sees, in a home of its own, and asks its actions."""

    def __init__(self, home: Path) -> None:
        self._home = home
        qInstallMessageHandler(lambda *message: None)  # a screen that is not there says much
        self._app = make_application()
        load_fonts()

    def __call__(self, language: str) -> Rows:
        """What each key does, in a language."""
        settings = Settings(self._home / language)
        settings.language = language
        studio = Studio(self._app, settings)
        window = MainWindow(studio)
        assert window.lazy.is_done  # it comes last: then all actions are there
        rows = [*shortcuts_of(window.actions_by_name.by_name.values()), *on_the_canvas()]
        window.workbench.retire()
        window.deleteLater()
        studio.deleteLater()
        return rows
