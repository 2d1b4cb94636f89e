"""The main window with an empty project, and a person who works in it."""

from __future__ import annotations

import pytest
from PySide6.QtGui import QPointingDevice
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.checklist.person import CTRL, Fingers, Key, Person
from tests.ui.window.conftest import home, studio
from tests.ui.window.putting_away import put_away

__all__ = ["home", "studio"]


@pytest.fixture
def window(studio: Studio, qtbot: QtBot) -> MainWindow:
    """The window, large enough to work in, with all blocks and the Python beside them."""
    studio.settings.palette_level = "all"
    studio.settings.set_shown("CodePane", True)
    made = MainWindow(studio)
    qtbot.addWidget(made, before_close_func=put_away)
    made.resize(1700, 950)
    with qtbot.waitActive(made):
        made.show()
        made.activateWindow()
    made.start(None)
    return made


@pytest.fixture
def person(window: MainWindow, qtbot: QtBot) -> Person:
    """Somebody who has begun a new project with Ctrl+N."""
    QTest.keyClick(window, Key.Key_N, CTRL)
    somebody = Person(window, qtbot)
    qtbot.waitUntil(lambda: somebody.canvas.isVisible())
    QApplication.processEvents()
    return somebody


@pytest.fixture(scope="session")
def screen(qapp: QApplication) -> QPointingDevice:
    return QTest.createTouchDevice()


@pytest.fixture
def fingers(person: Person, screen: QPointingDevice) -> Fingers:
    """The fingers of the person."""
    return Fingers(person, screen)
