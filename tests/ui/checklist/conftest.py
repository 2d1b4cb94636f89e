"""The main window with an empty project, and a person who works in it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QPointingDevice
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialog
from pytestqt.qtbot import QtBot

from nep_studio.settings import FOLDER_VARIABLE, Settings
from nep_studio.ui.app import Studio
from nep_studio.ui.main_window import MainWindow
from nep_studio.ui.words import use_language
from tests.ui.checklist.person import CTRL, Fingers, Key, Person


@pytest.fixture
def studio(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, qapp: QApplication) -> Iterator[Studio]:
    """The program with settings of its own."""
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "home"))
    settings = Settings(tmp_path / "home")
    settings.language, settings.theme = "en", "light"
    made = Studio(qapp, settings)
    yield made
    use_language("en")
    made.look.deleteLater()
    made.deleteLater()
    qapp.setLayoutDirection(Qt.LayoutDirection.LeftToRight)


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
