"""A desk of the trainer over a project of its own, without the whole window around it."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace

import pytest
from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.run.installation import studio_language
from nep_studio.ui.messages import Messages
from nep_studio.ui.plugins.gestures.gesture_controller import GestureController
from nep_studio.ui.theme.look import Look


class OpenProject(QObject):
    """The file that is open, as the window's Files tell it."""

    document_changed = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.document = None
        self.new()

    def new(self) -> None:
        """Open another project."""
        self.document = SimpleNamespace(editor=Editor(Project("Mine"), studio_language()))
        self.document_changed.emit(self.document)


@pytest.fixture
def look(qapp: QApplication) -> Iterator[Look]:
    made = Look(qapp, "light")
    yield made
    made.deleteLater()


@pytest.fixture
def desk(look: Look, qtbot: QtBot) -> Iterator[GestureController]:
    owner = QWidget()
    qtbot.addWidget(owner)
    made = GestureController(OpenProject(), None, Messages(owner), look, owner)
    yield made
    made.deleteLater()
