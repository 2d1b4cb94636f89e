"""The log panel: what happens, and what was told, on two tabs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QTabWidget

from nep_studio.blocks.language import Language
from nep_studio.ui.main_window_panels import Panel
from nep_studio.ui.messages import Messages
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme import Look
from nep_studio.ui.words import tr

from .told import ToldMessages
from .what_happens import WhatHappens

if TYPE_CHECKING:
    from nep_studio.ui.main_window import MainWindow


class LogPanel(QTabWidget):
    """Reads on while a program runs; it does no work while it is hidden."""

    def __init__(self, runner: Runner, messages: Messages, language: Language, look: Look) -> None:
        super().__init__()
        self.what_happens = WhatHappens(runner, messages, language, look)
        self.told = ToldMessages(messages, look)
        self.setDocumentMode(True)
        self.addTab(self.what_happens, tr("What happens"))
        self.addTab(self.told, tr("Messages"))

    def sizeHint(self) -> QSize:
        """Room for a few lines."""
        line = self.fontMetrics().height()
        return QSize(line * 30, line * 10)


def add_log_panel(window: MainWindow) -> Panel:
    """Put the log below the canvas."""
    studio = window.studio
    panel = LogPanel(window.running.runner, window.messages, studio.language, studio.look)
    return window.add_side_panel(panel, tr("Log"), "history", "bottom", is_shown=False)
