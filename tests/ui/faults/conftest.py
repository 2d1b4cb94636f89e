"""The karate example in a window that really runs it, and what the window tells when it breaks."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.run.plan import MASTER
from nep_studio.ui.messages import Message
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.window.conftest import answer, chooser, home, karate, studio, window

pytest.importorskip("resource", reason="signals and limits of processes are those of Unix")

__all__ = ["answer", "chooser", "home", "karate", "studio", "window"]

WAIT_MS = 40_000


class Scene:
    """A window with a project in it, all that it told, and all that was heard."""

    def __init__(self, window: MainWindow, qtbot: QtBot) -> None:
        self.window, self._qtbot = window, qtbot
        self.runner = window.running.runner
        self.local = self.runner.local
        self.told: list[Message] = []
        self.heard: list[object] = []
        self.states: list[str] = []
        window.messages.told.connect(lambda told: self.told.append(told.message))
        self.runner.arrived.connect(lambda batch: self.heard.extend(one for _, one in batch))
        self.runner.state_changed.connect(self.states.append)

    # What a person does

    def press(self, name: str) -> None:
        """Press a button of the toolbar."""
        button = self.window.toolbar.widgetForAction(self.window.actions_by_name[name])
        assert button.isEnabled(), name
        self._qtbot.mouseClick(button, Qt.MouseButton.LeftButton)

    def press_answer(self, title: str, words: str) -> None:
        """Press a button of a message."""
        buttons = [
            button
            for card in self.window.message_area.cards
            if card.message.title == title
            for button in card.findChildren(QPushButton)
            if button.text() == words
        ]
        assert len(buttons) == 1, (title, words, self.shown)
        self._qtbot.mouseClick(buttons[0], Qt.MouseButton.LeftButton)

    def run(self) -> None:
        """Run the program, until it goes."""
        self.press("run")
        self.state_is("running")

    # What happens to it

    def pid(self, name: str) -> int:
        return self.local.launcher.nodes[name].pid

    def kill(self, name: str) -> int:
        """Kill a node's process without warning; its number."""
        pid = self.pid(name)
        assert pid
        os.kill(pid, signal.SIGKILL)
        return pid

    def signal_master(self, number: int) -> None:
        """Send the master's process a signal."""
        pid = self.local._master_launcher.nodes[MASTER].pid
        assert pid  # 0 would be the tests themselves
        os.kill(pid, number)

    # What is seen of it

    def until(self, condition: Callable[[], object]) -> None:
        """Wait for it."""
        self._qtbot.waitUntil(lambda: bool(condition()), timeout=WAIT_MS)

    def state_is(self, state: str) -> None:
        self.until(lambda: self.runner.state == state)

    def is_back(self, name: str, pid: int) -> Callable[[], bool]:
        """Whether a node is there again, in another process."""
        board = self.runner.board.nodes
        return lambda: board[name].health in ("ready", "busy") and board[name].pid not in (0, pid)

    @property
    def said(self) -> list[str]:
        """What the robot began to say; each sentence once, however often it was asked for."""
        ids = self.results("started")
        requests = [one for one in self.heard if isinstance(one, m.ActionRequest)]
        said = {one.id: one.args["text"] for one in requests if one.action == "say"}
        return [text for id, text in said.items() if id in ids]

    def results(self, state: str) -> list[str]:
        """The ids of the requests of which a robot said that."""
        results = [one for one in self.heard if isinstance(one, m.ActionResult)]
        return [one.id for one in results if one.state == state]

    @property
    def shown(self) -> list[str]:
        """The titles of the messages that are shown now."""
        return [card.message.title for card in self.window.message_area.cards]

    @property
    def alarms(self) -> list[Message]:
        """What was told of something that went wrong."""
        return [one for one in self.told if one.kind in ("warning", "error")]


def scene_of(window: MainWindow, qtbot: QtBot) -> Scene:
    """The scene of a window, which has the panel What runs."""
    return Scene(window, qtbot)


@pytest.fixture
def scene(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> Scene:
    """The window as it is at the first start; nodes write their logs into the test's folder."""
    window.running.runner.local.logs = tmp_path / "logs"
    return scene_of(window, qtbot)


@pytest.fixture
def stage(scene: Scene, karate: MainWindow) -> Scene:
    """The scene with the karate example."""
    return scene
