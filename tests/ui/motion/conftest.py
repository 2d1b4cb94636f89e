"""A window with a project, and the window in which motions are made."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot
from shiboken6 import isValid

from nep_studio.ui.plugins.motion import MotionKit
from nep_studio.ui.plugins.motion.page import MotionPage
from nep_studio.ui.shell.main_window import MainWindow
from tests.ui.running.conftest import open_program
from tests.ui.window.conftest import answer, chooser, home, studio, window

__all__ = ["answer", "chooser", "home", "open_program", "studio", "window"]


@pytest.fixture
def kit(window: MainWindow) -> MotionKit:
    return window.actions_by_name.findChild(MotionKit)


@pytest.fixture
def motion(window: MainWindow, kit: MotionKit, qtbot: QtBot) -> Iterator[MotionPage]:
    """The window of an empty motion in a new project."""
    if window.files.document is None:
        window.files.new()
    made = kit.make()
    qtbot.waitExposed(made)
    yield made
    if isValid(made):
        made.player.pause()
        made.hide()


Drag = Callable[..., None]


@pytest.fixture
def drag(qtbot: QtBot) -> Drag:
    """Presses the mouse at a place of a widget, moves it in steps, and lets go."""

    def do(
        widget: QWidget,
        start: QPointF,
        end: QPointF,
        *,
        modifier: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier,
        steps: int = 8,
    ) -> None:
        button = Qt.MouseButton.LeftButton
        qtbot.mousePress(widget, button, modifier, start.toPoint())
        for step in range(1, steps + 1):
            place: QPoint = (start + (end - start) * step / steps).toPoint()
            qtbot.mouseMove(widget, place)
        qtbot.mouseRelease(widget, button, modifier, end.toPoint())

    return do
