"""How often the robot view paints: while something moves, and only then."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QPainter, QPdfWriter
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import RobotState
from nep_studio.ui.robot_view.view import RobotView

StateMaker = Callable[..., RobotState]


def settle(view: RobotView, qtbot: QtBot) -> None:
    """Wait until the view has painted all that there is."""
    qtbot.waitUntil(lambda: not view._timer.isActive())
    painted = view.frames
    view.repaint()
    qtbot.waitUntil(lambda: view.frames > painted)


def test_a_robot_that_keeps_still_costs_nothing(
    view: RobotView, state: StateMaker, qtbot: QtBot
) -> None:
    view.show_robot("nao", state())
    settle(view, qtbot)
    before = view.frames

    for number in range(30):
        view.show_robot("nao", state(battery=1 - number / 100))
        qtbot.wait(2)  # as states come: one after the other, and each may be painted

    assert view.frames == before
    assert not view._timer.isActive()


def test_a_robot_that_moves_is_painted_until_it_is_there(
    view: RobotView, state: StateMaker, qtbot: QtBot
) -> None:
    view.show_robot("nao", state())
    settle(view, qtbot)
    before = view.frames

    view.show_robot("nao", state("StandZero"))
    qtbot.waitUntil(lambda: not view._timer.isActive())

    assert view.frames > before
    assert view.room.scene().robots[0].state.joints == state("StandZero").joints


def test_a_hidden_view_paints_and_ticks_no_more(
    view: RobotView, state: StateMaker, qtbot: QtBot
) -> None:
    view.show_robot("nao", state())
    settle(view, qtbot)
    view.hide()
    before = view.frames

    view.show_robot("nao", state("StandZero"))

    assert not view._timer.isActive()
    QApplication.processEvents()
    assert view.frames == before


def test_a_view_that_is_shown_again_shows_the_robot_as_it_is_now(
    view: RobotView, state: StateMaker, qtbot: QtBot
) -> None:
    view.show_robot("nao", state())
    view.hide()
    view.show_robot("nao", state("StandZero"))

    view.show()

    assert view.room.scene().robots[0].state.joints == state("StandZero").joints


def test_the_walked_path_goes_with_the_robot(
    view: RobotView, state: StateMaker, qtbot: QtBot
) -> None:
    for step in range(6):
        view.show_robot("nao", state(base=(0.05 * step, 0.0, 0.0)))
        view.room.step(float("inf"))

    robot = view.room.scene().robots[0]
    assert robot.path[0] == (0.0, 0.0)
    assert robot.path[-1] == pytest.approx((0.25, 0.0))
    view.clear_paths()
    assert view.room.scene().robots[0].path == ()


def test_a_new_robot_is_in_the_picture_with_those_that_are_there(
    view: RobotView, state: StateMaker
) -> None:
    view.show_robot("one", state())
    view.show_robot("two", state(base=(0.0, 1.0, 0.0)))

    places = [view.place_of(name, "chest_button") for name in ("one", "two")]

    assert all(place is not None and 0 < place.x() < 640 for place in places)


def test_the_room_is_told_in_words(view: RobotView, state: StateMaker) -> None:
    view.show_robot("nao", state(saying="Hello"))

    assert "nao" in view.accessibleDescription()
    assert "Hello" in view.accessibleDescription()


def test_a_picture_can_have_any_size(view: RobotView, state: StateMaker) -> None:
    view.show_robot("nao", state())

    image = view.grab_picture(QSize(1280, 960))

    assert image.size() == QSize(1280, 960)


def test_the_room_can_be_a_page_of_a_pdf(
    view: RobotView, state: StateMaker, tmp_path: Path
) -> None:
    view.show_robot("nao", state(saying="Hello"))
    path = tmp_path / "room.pdf"
    page = QPdfWriter(str(path))
    page.setResolution(150)
    painter = QPainter(page)

    view.paint_picture(painter, QSize(page.width(), page.height()))
    painter.end()

    assert path.stat().st_size > 10_000


def test_frames_leave_time_for_others_where_painting_is_slow(view: RobotView) -> None:
    for _ in range(30):
        view._pace(20.0)

    assert view._timer.interval() >= 40
