"""A main window of its own for each test: its settings and journals are in the test's folder."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QDialog, QPushButton, QWidget
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.language import Language
from nep_studio.run.installation import studio_language
from nep_studio.settings import FOLDER_VARIABLE, Settings
from nep_studio.ui.services import Studio
from nep_studio.ui.shell.main_window import FIRST_SIZE, MainWindow
from nep_studio.ui.words import use_language
from tests.ui.window.putting_away import put_away


class Chooser:
    """Chooses what the test says, without asking."""

    def __init__(self) -> None:
        self.path: Path | None = None
        self.suggested: Path | None = None

    def choose_to_open(self, parent: QWidget, folder: Path, on_chosen: Callable) -> None:
        if self.path is not None:
            on_chosen(self.path)

    def choose_to_save(self, parent: QWidget, suggested: Path, on_chosen: Callable) -> None:
        self.suggested = suggested
        if self.path is not None:
            on_chosen(self.path)


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's folder."""
    folder = tmp_path / "home"
    monkeypatch.setenv(FOLDER_VARIABLE, str(folder))
    return folder


@cache
def english() -> Language:
    """The blocks in English: they do not change, so their files are read once."""
    return studio_language()


@pytest.fixture
def studio(home: Path, qapp: QApplication) -> Iterator[Studio]:
    settings = Settings(home)
    settings.language, settings.theme = "en", "light"
    made = Studio(qapp, settings)
    made.language = english()
    yield made
    use_language("en")
    made.look.deleteLater()
    made.deleteLater()
    qapp.setLayoutDirection(Qt.LayoutDirection.LeftToRight)


@pytest.fixture
def chooser() -> Chooser:
    return Chooser()


@pytest.fixture
def window(studio: Studio, chooser: Chooser, qtbot: QtBot) -> MainWindow:
    """The window as it is at the first start, on a screen that has room for it."""
    made = MainWindow(studio, chooser)
    made.resize(FIRST_SIZE)
    qtbot.addWidget(made, before_close_func=put_away)
    made.show()
    made.start(None)
    qtbot.waitExposed(made)
    return made


@pytest.fixture
def karate(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """The window with a copy of the karate example."""
    window.files.open_example(paths.examples() / "karate_greeting.nep")
    qtbot.waitUntil(lambda: window.workbench.canvas.isVisible())
    return window


@pytest.fixture
def karate_in_python(karate: MainWindow, qtbot: QtBot) -> MainWindow:
    """The window with a copy of the karate example, and its Python beside it."""
    karate.workbench.panels.show(karate.workbench.code)
    qtbot.waitUntil(lambda: "Impressive" in karate.workbench.code.text.toPlainText())
    return karate


@pytest.fixture
def answer(qtbot: QtBot) -> Callable[[QWidget, str], None]:
    """Clicks a button of the dialog that is open."""

    def click(window: QWidget, words: str) -> None:
        def find() -> QPushButton | None:
            dialogs = [d for d in window.findChildren(QDialog) if d.isVisible()]
            buttons = [b for d in dialogs for b in d.findChildren(QPushButton)]
            return next((b for b in buttons if b.text() == words), None)

        qtbot.waitUntil(lambda: find() is not None)
        qtbot.mouseClick(find(), Qt.MouseButton.LeftButton)

    return click
