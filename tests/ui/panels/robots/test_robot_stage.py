"""Things around the robots: placed, dragged, moved with keys, named, taken away; kept and told."""

from __future__ import annotations

import math

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QMainWindow
from pytestqt.qtbot import QtBot

from nep_core.wire import messages as m
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.project.surroundings import kept_things, new_thing
from nep_studio.run.installation import studio_language
from nep_studio.ui.floor import Floor
from nep_studio.ui.plugins.robots.panel import RobotsPanel
from nep_studio.ui.plugins.robots.stage import RobotStage
from nep_studio.ui.running.runner import Runner
from tests.ui.panels.robots.conftest import NAO, Document, Files, hear, state

pytestmark = pytest.mark.long

NODE_START_MS = 30_000


@pytest.fixture
def stage(panel: RobotsPanel) -> RobotStage:
    hear(panel, state(robot="NAO"))
    panel.stage.view.look_from("front")
    return panel.stage


def kept(files: Files) -> list[m.Thing]:
    assert files.document is not None
    return kept_things(files.document.editor.project)


def undo(files: Files) -> None:
    assert files.document is not None
    files.document.editor.history.undo()


def test_an_empty_floor_invites_to_place_a_person(
    stage: RobotStage, files: Files, qtbot: QtBot
) -> None:
    assert stage.invitation.isVisible()

    qtbot.mouseClick(stage.invitation, Qt.MouseButton.LeftButton)

    [person] = kept(files)
    assert (person.kind, person.name) == ("person", "Anna")
    assert not stage.invitation.isVisible()
    assert stage.thing_bar.isVisible()
    assert stage.view.room.things == (person,)


@pytest.mark.parametrize("kind", ["person", "ball", "wall", "mark"])
def test_a_thing_of_each_kind_is_placed_and_can_be_taken_back(
    stage: RobotStage, files: Files, qtbot: QtBot, kind: str
) -> None:
    stage.tools.place_asked.emit(kind)
    assert [thing.kind for thing in kept(files)] == [kind]

    undo(files)

    assert kept(files) == []
    qtbot.waitUntil(lambda: stage.view.room.things == ())
    assert not stage.thing_bar.isVisible()


def test_a_ball_is_dragged_over_the_floor_in_one_step(
    stage: RobotStage, files: Files, floor: Floor, qtbot: QtBot
) -> None:
    stage.place("ball")
    view = stage.view
    view.look_from("top")
    view.zoom(0.5)
    [ball] = kept(files)
    import numpy as np

    middle = np.array([ball.place[0], ball.place[1], 0.06])
    x, y = view.lens.project(middle)
    start = QPointF(float(x), float(y)).toPoint()

    qtbot.mousePress(view, Qt.MouseButton.LeftButton, pos=start)
    for step in range(1, 6):
        qtbot.mouseMove(view, start + QPoint(8 * step, 0))
    assert floor.find(ball.id) != ball
    assert kept(files) == [ball]
    qtbot.mouseRelease(view, Qt.MouseButton.LeftButton, pos=start + QPoint(40, 0))
    qtbot.waitUntil(lambda: kept(files) != [ball])

    undo(files)
    assert kept(files) == [ball]


def test_keys_move_turn_and_remove_what_is_chosen(
    stage: RobotStage, files: Files, qtbot: QtBot
) -> None:
    stage.place("person")
    view = stage.view
    view.look_from("back")
    [before] = kept(files)

    qtbot.keyClick(view, Qt.Key.Key_Up)
    [away] = kept(files)
    qtbot.keyClick(view, Qt.Key.Key_Comma)
    [turned] = kept(files)
    qtbot.keyClick(view, Qt.Key.Key_Delete)

    assert away.place[0] == pytest.approx(before.place[0] + 0.1)
    way = math.remainder(turned.heading - before.heading, math.tau)
    assert way == pytest.approx(math.radians(15), abs=1e-3)
    assert kept(files) == []


def test_without_a_chosen_thing_keys_look_around(stage: RobotStage, qtbot: QtBot) -> None:
    stage.place("person")
    yaw = stage.view.camera.yaw

    qtbot.keyClick(stage.view, Qt.Key.Key_Escape)
    qtbot.keyClick(stage.view, Qt.Key.Key_Left)

    assert not stage.thing_bar.isVisible()
    assert stage.view.camera.yaw != yaw


def test_a_person_gets_a_name_and_a_landmark_a_number(
    stage: RobotStage, files: Files, qtbot: QtBot
) -> None:
    for kind, name in (("person", "Zoe & Co"), ("mark", "108")):
        stage.place(kind)
        stage.thing_bar.name.clear()
        qtbot.keyClicks(stage.thing_bar.name, name)
        qtbot.keyClick(stage.thing_bar.name, Qt.Key.Key_Return)

    assert [thing.name for thing in kept(files)] == ["Zoe & Co", "108"]
    menu = stage.tools._things_menu
    assert [action.text() for action in menu.actions()] == ["Person Zoe && Co", "Landmark 108"]


def test_things_of_another_project_are_shown_when_it_is_opened(
    stage: RobotStage, files: Files, floor: Floor
) -> None:
    stage.place("person")
    floor.show(new_thing("ball", (0.0, 0.0, 0.0), []))

    files.open(Document(Editor(Project("Other"), studio_language())))

    assert floor.things == []
    assert stage.view.room.things == ()
    files.open(None)
    assert not stage.tools._placing.isEnabled()


def test_robots_are_told_what_stands_there_when_they_come_and_when_it_changes(
    stage: RobotStage, floor: Floor, runner: Runner, qtbot: QtBot
) -> None:
    """On a real network: also who joins later hears it."""
    stage.place("person")
    runner.start_node(NAO)
    qtbot.waitUntil(lambda: runner.is_connected, timeout=NODE_START_MS)
    heard: list[m.Surroundings] = []
    tap = runner.tap(m.SURROUNDINGS, kind=m.Surroundings, parent=runner)
    tap.arrived.connect(lambda batch: heard.extend(one.message for one in batch))
    qtbot.waitUntil(lambda: bool(heard), timeout=NODE_START_MS)
    assert [thing.kind for thing in heard[-1].things] == ["person"]

    stage.place("ball")
    qtbot.waitUntil(lambda: len(heard[-1].things) == 2)
    stage.remove()
    stage.choose("person1")
    stage.remove()

    qtbot.waitUntil(lambda: heard[-1].things == [])


def test_a_robot_that_leaves_the_picture_by_itself_is_seen_again(
    stage: RobotStage, panel: RobotsPanel
) -> None:
    stage.view.fit()
    stage._sight.look()
    before = stage.view.camera

    hear(panel, state(robot="NAO", base=(6.0, 3.0, 0.0)))
    stage.view.follows = True
    stage.view.room.step(1e12)
    stage._sight.look()

    assert stage._sight._is_all_seen()
    assert stage.view.camera != before


def test_who_looks_closer_goes_on_doing_so(stage: RobotStage) -> None:
    stage.view.fit()
    stage._sight.look()
    stage.view.zoom(4.0)
    camera = stage.view.camera

    stage._sight.look()

    assert stage.view.camera == camera


def test_sound_is_switched_in_the_tools(stage: RobotStage, qtbot: QtBot) -> None:
    qtbot.mouseClick(stage.tools.sound, Qt.MouseButton.LeftButton)

    assert not stage._sound.is_on
    assert stage.tools.sound.toolTip() == "Robots are not heard"


def test_the_scene_is_painted_with_the_robot_and_the_person(
    stage: RobotStage, host: QMainWindow
) -> None:
    stage.place("ball")
    stage.view.fit()

    image = stage.view.grab().toImage()

    colours = {
        QColor(image.pixel(x, y)).name()
        for x in range(0, image.width(), 3)
        for y in range(0, image.height(), 3)
    }
    assert len(colours) > 50
