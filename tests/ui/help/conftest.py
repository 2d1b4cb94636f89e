"""What the tests of the help share: a window with the help in it, and a panel by itself."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.plugins.help.help_controller import HelpController
from nep_studio.ui.plugins.help.panel import HelpPages
from nep_studio.ui.plugins.help.repository import Book
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import FIRST_SIZE, MainWindow
from tests.ui.window.conftest import home, studio
from tests.ui.window.putting_away import put_away

__all__ = ["home", "studio"]

LANGUAGE = studio_language()


@pytest.fixture
def book() -> Book:
    return Book(LANGUAGE, lambda: [("Run", "F5")])


@pytest.fixture
def window(studio: Studio, qtbot: QtBot) -> MainWindow:
    """The window as it is at the first start."""
    made = MainWindow(studio)
    made.resize(FIRST_SIZE)
    qtbot.addWidget(made, before_close_func=put_away)
    made.show()
    made.start(None)
    qtbot.waitExposed(made)
    return made


@pytest.fixture
def desk(window: MainWindow) -> HelpController:
    """The help of the window."""
    made = window.findChild(HelpController)
    yield made
    if made._window is not None:
        made._window.close()


@pytest.fixture
def karate(window: MainWindow, desk: HelpController, qtbot: QtBot) -> MainWindow:
    """The window with the karate example, and with help."""
    window.files.open_example(paths.examples() / "karate_greeting.nep")
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    window.activateWindow()
    window.workbench.canvas.setFocus()
    qtbot.waitUntil(window.workbench.canvas.hasFocus)
    return window


@pytest.fixture
def first_of(karate: MainWindow) -> Callable[[str], str]:
    """The first block of a type."""

    def find(block_type: str) -> str:
        blocks = karate.workbench.canvas.editor.project.blocks.values()
        return next(block.id for block in blocks if block.type == block_type)

    return find


@pytest.fixture
def canvas(studio, qtbot) -> Canvas:
    made = Canvas(Editor(Project(), LANGUAGE), studio.look.theme)
    qtbot.addWidget(made)
    made.resize(700, 600)
    made.show()
    return made


@pytest.fixture
def panel(canvas, studio, qtbot) -> HelpPages:
    made = HelpPages(canvas, studio.look, lambda: LANGUAGE, lambda: [("Run", "F5")])
    qtbot.addWidget(made)
    made.resize(380, 800)
    made.show()
    qtbot.waitExposed(made)
    made.activateWindow()
    return made


def centre(widget: QWidget):
    return widget.mapToGlobal(widget.rect().center())
