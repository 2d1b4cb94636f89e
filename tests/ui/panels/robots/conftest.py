"""The stage by itself, over a floor that a real project keeps."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QApplication, QMainWindow
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.run.installation import studio_language
from nep_studio.run.plan import PlannedNode
from nep_studio.settings import Settings
from nep_studio.ui.floor import Floor
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.plugins.robots.participants import Starts
from nep_studio.ui.running.runner import Heard, Runner
from nep_studio.ui.speech import Sound
from nep_studio.ui.theme.look import Look, load_fonts

NAO = PlannedNode("action/nao", "NAO", {"robot": "NAO", "driver": "virtual", "address": ""})
REAL = PlannedNode(
    "action/nao", "Anna", {"robot": "Anna", "driver": "naoqi", "address": "192.168.1.10"}
)
WATCH = PlannedNode("sensory/virtual_watch", "watch")


class Document:
    """An open project."""

    def __init__(self, editor: Editor) -> None:
        self.editor = editor


class Files(QObject):
    """What has a project open."""

    document_changed = Signal(object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.document: Document | None = Document(Editor(Project("Test"), studio_language()))

    def open(self, document: Document | None) -> None:
        self.document = document
        self.document_changed.emit(document)


@pytest.fixture
def planned() -> list[PlannedNode]:
    return [NAO, REAL, WATCH]


@pytest.fixture
def host(qtbot: QtBot) -> QMainWindow:
    made = QMainWindow()
    qtbot.addWidget(made)
    made.resize(420, 900)
    return made


@pytest.fixture
def runner(host: QMainWindow, planned: list[PlannedNode], tmp_path: Path) -> Iterator[Runner]:
    made = Runner(lambda: planned, host, logs=tmp_path)
    yield made
    made.close()


@pytest.fixture
def files(host: QMainWindow) -> Files:
    return Files(host)


@pytest.fixture
def floor(files: Files, runner: Runner) -> Floor:
    return Floor(files, runner, runner)  # type: ignore[arg-type]


@pytest.fixture
def look(qapp: QApplication) -> Iterator[Look]:
    load_fonts()
    made = Look(qapp, "light")
    yield made
    made.deleteLater()


@pytest.fixture
def panel(
    host: QMainWindow, runner: Runner, floor: Floor, look: Look, qtbot: QtBot, tmp_path: Path
) -> RobotsPanel:
    sound = Sound(runner, Settings(tmp_path / "home"), runner, lambda parent: None)
    made = RobotsPanel(runner, studio_language, look, floor, sound, Starts(runner, runner))
    host.setCentralWidget(made)
    host.show()
    qtbot.waitExposed(host)
    return made


def state(**parts: object) -> m.RobotState:
    usual = {"robot": "NAO", "joints": {}, "posture": "Stand"}
    return m.RobotState(**{**usual, **parts})  # type: ignore[arg-type]


def hear(panel: RobotsPanel, *states: m.RobotState) -> None:
    assert panel._tap is not None
    panel._tap.arrived.emit([Heard(one.time, one, "NAO") for one in states])
