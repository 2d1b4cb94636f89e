"""The main window with an empty project, and a person who works in it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from PySide6.QtGui import QPointingDevice
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog
from pytestqt.qtbot import QtBot

from nep_studio.ui.app import Studio
from nep_studio.ui.main_window import MainWindow
from tests.ui.checklist.person import CTRL, Fingers, Key, Person
from tests.ui.window.conftest import home, studio

__all__ = ["home", "studio"]


@pytest.fixture
def window(studio: Studio, qtbot: QtBot) -> Iterator[MainWindow]:
    """The window as it is at the first start, large enough to work in."""
    made = MainWindow(studio)
    qtbot.addWidget(made)
    made.resize(1700, 950)
    with qtbot.waitActive(made):
        made.show()
        made.activateWindow()
    made.start(None)
    yield made
    for dialog in made.findChildren(QDialog):
        dialog.blockSignals(True)
        dialog.close()
    made.workbench.canvas.fields.close()
    made.running.close()
    made.workbench.retire()
    if made.files.document is not None:
        made.files.document.close()
        made.files.document = None


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
