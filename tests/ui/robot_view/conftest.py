"""What the tests of the robot view share: a view on the screen, and states to show in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import RobotState
from nep_studio.ui.robot_view.figure import RobotFigure, load_figure
from nep_studio.ui.robot_view.view import RobotView, nao_folder
from nep_studio.ui.theme.look import Look

NAMES = {"head_front": "the front of the head", "chest_button": "the chest button"}

StateMaker = Callable[..., RobotState]


@pytest.fixture
def figure() -> RobotFigure:
    """NAO's look."""
    return load_figure(nao_folder())


@pytest.fixture
def state(figure: RobotFigure) -> StateMaker:
    """Makes states of a robot in one of its postures."""

    def make(posture: str = "Stand", **more: object) -> RobotState:
        angles = figure.body.posture_angles(posture).tolist()
        joints = dict(zip(figure.body.names, angles, strict=True))
        return RobotState(robot="nao", joints=joints, posture=posture, **more)

    return make


@pytest.fixture
def view(qtbot: QtBot, qapp: QApplication) -> Iterator[RobotView]:
    """An empty view of 640 x 480 pixels on the screen."""
    made = RobotView(Look(qapp, "light"), NAMES)
    qtbot.addWidget(made)
    made.resize(640, 480)
    made.show()
    qtbot.waitExposed(made)
    yield made
    made.hide()
