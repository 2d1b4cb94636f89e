"""A person at the robot view: looking around, touching, moving things, with mouse and keys."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QFocusEvent, QHelpEvent, QWheelEvent
from PySide6.QtWidgets import QApplication, QToolTip
from pytestqt.qtbot import QtBot

from nep_core.wire.messages import RobotState, Thing
from nep_studio.ui.robot_view.scene import Marked
from nep_studio.ui.robot_view.view import RobotView

StateMaker = Callable[..., RobotState]
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def shown(view: RobotView, state: StateMaker, qtbot: QtBot) -> RobotView:
    """A view with a standing NAO, at rest."""
    view.show_robot("nao", state())
    view.look_from("front")
    qtbot.waitUntil(lambda: not view._timer.isActive())
    return view


def at(view: RobotView, sensor: str) -> QPoint:
    place = view.place_of("nao", sensor)
    assert place is not None
    return place.toPoint()


def empty(view: RobotView) -> QPoint:
    return QPoint(12, view.height() - 12)


@pytest.mark.parametrize("sensor", ["head_front", "chest_button", "bumper_left", "hand_right"])
def test_a_press_on_a_sensor_touches_it_until_it_is_let_go(
    shown: RobotView, qtbot: QtBot, sensor: str
) -> None:
    shown.look_through(shown.camera.orbited(0.0, 0.35))
    heard: list[tuple[str, str, bool]] = []
    shown.touched.connect(lambda *told: heard.append(told))

    qtbot.mousePress(shown, LEFT, pos=at(shown, sensor))
    pressed = list(heard)
    qtbot.mouseRelease(shown, LEFT, pos=empty(shown))

    assert pressed == [("nao", sensor, True)]
    assert heard[1:] == [("nao", sensor, False)]


def test_a_robot_that_feels_nothing_is_not_touched(
    shown: RobotView, state: StateMaker, qtbot: QtBot
) -> None:
    shown.show_robot("nao", state(), can_touch=False)

    with qtbot.assertNotEmitted(shown.touched):
        qtbot.mouseClick(shown, LEFT, pos=at(shown, "chest_button"))


def test_dragging_the_floor_goes_around(shown: RobotView, qtbot: QtBot) -> None:
    before = shown.camera

    qtbot.mousePress(shown, LEFT, pos=empty(shown))
    qtbot.mouseMove(shown, empty(shown) + QPoint(100, 0))
    qtbot.mouseRelease(shown, LEFT)

    assert shown.camera.yaw < before.yaw - 0.5
    assert shown.camera.distance == before.distance


def test_the_wheel_comes_nearer(shown: RobotView, qapp: QApplication) -> None:
    before = shown.camera.distance
    middle = QPointF(320, 240)

    event = QWheelEvent(
        middle, shown.mapToGlobal(middle), QPoint(), QPoint(0, 120), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    qapp.sendEvent(shown, event)

    assert shown.camera.distance < before


def test_home_shows_all_again(shown: RobotView, qtbot: QtBot) -> None:
    whole = shown.camera
    for _ in range(5):
        qtbot.keyClick(shown, Qt.Key.Key_Plus)
    nearer = shown.camera.distance

    qtbot.keyClick(shown, Qt.Key.Key_Home)

    assert nearer < whole.distance
    assert shown.camera.distance == pytest.approx(whole.distance, rel=0.05)


@pytest.mark.parametrize(
    ("key", "yaw"), [(Qt.Key.Key_1, 0.0), (Qt.Key.Key_2, 1.57), (Qt.Key.Key_3, 3.14)]
)
def test_a_number_looks_from_a_side_of_the_robot(
    view: RobotView, state: StateMaker, qtbot: QtBot, key: Qt.Key, yaw: float
) -> None:
    view.show_robot("nao", state(base=(0.0, 0.0, 0.5)))

    qtbot.keyClick(view, key)

    assert view.camera.yaw == pytest.approx(yaw + 0.5, abs=0.02)


def test_tab_walks_through_what_can_be_touched_and_space_touches(
    shown: RobotView, qtbot: QtBot
) -> None:
    heard: list[tuple[str, str, bool]] = []
    shown.touched.connect(lambda *told: heard.append(told))
    shown.setFocus()

    qtbot.keyClick(shown, Qt.Key.Key_Tab)
    qtbot.keyClick(shown, Qt.Key.Key_Tab)
    qtbot.keyPress(shown, Qt.Key.Key_Space)
    qtbot.keyRelease(shown, Qt.Key.Key_Space)

    sensor = shown.room.scene().robots[0].figure.sensors[1]
    assert heard == [("nao", sensor, True), ("nao", sensor, False)]
    assert sensor in shown.accessibleDescription() or "front of the head" in (
        shown.accessibleDescription()
    )


def test_tab_leaves_after_the_last_sensor(shown: RobotView) -> None:
    count = len(shown.room.scene().robots[0].figure.sensors)

    walked = [shown.focusNextPrevChild(True) for _ in range(count)]
    shown.focusNextPrevChild(True)

    assert all(walked)
    assert shown.room.marked == Marked()


def test_the_pointer_over_a_sensor_marks_it_and_says_what_it_is(
    shown: RobotView, qtbot: QtBot, qapp: QApplication
) -> None:
    place = at(shown, "chest_button")

    qtbot.mouseMove(shown, place)
    qapp.sendEvent(shown, QHelpEvent(QHelpEvent.Type.ToolTip, place, shown.mapToGlobal(place)))

    assert shown.room.marked == Marked("nao", "chest_button")
    assert "chest button" in QToolTip.text()
    QToolTip.hideText()


def test_a_thing_is_dragged_over_the_floor(shown: RobotView, qtbot: QtBot) -> None:
    ball = Thing(id="b", kind="ball", place=(0.3, 0.3, 0.0), size=(0.12, 0.12, 0.12))
    shown.show_things([ball])
    shown.look_from("front")
    start = shown.lens.project([0.3, 0.3, 0.06])
    goal = shown.lens.project([0.3, -0.2, 0.06])
    chosen: list[str] = []
    shown.thing_chosen.connect(chosen.append)

    with qtbot.waitSignal(shown.thing_moved) as moved:
        qtbot.mousePress(shown, LEFT, pos=QPointF(*start).toPoint())
        qtbot.mouseMove(shown, QPointF(*goal).toPoint())
    qtbot.mouseRelease(shown, LEFT)

    name, x, y = moved.args
    assert (chosen, name) == (["b"], "b")
    assert (x, y) == pytest.approx((0.3, -0.2), abs=0.02)
    assert shown.room.things[0].place[:2] == pytest.approx((x, y))


def test_a_click_on_the_floor_chooses_nothing_and_a_drag_keeps_what_is_chosen(
    shown: RobotView, qtbot: QtBot
) -> None:
    chosen: list[str] = []
    shown.thing_chosen.connect(chosen.append)

    qtbot.mousePress(shown, LEFT, pos=empty(shown))
    qtbot.mouseMove(shown, empty(shown) + QPoint(50, 0))
    qtbot.mouseRelease(shown, LEFT)
    after_drag = list(chosen)
    qtbot.mouseClick(shown, LEFT, pos=empty(shown))

    assert after_drag == []
    assert chosen == [""]


def test_a_limb_is_dragged_while_the_robot_is_posed(shown: RobotView, qtbot: QtBot) -> None:
    shown.is_posing = True
    shown.look_through(shown.camera.orbited(0.0, 0.2))
    heard: list[tuple[object, ...]] = []
    shown.limb_pressed.connect(lambda *told: heard.append(("pressed", *told)))
    shown.limb_dragged.connect(lambda *told: heard.append(("dragged", *told)))
    shown.limb_released.connect(lambda *told: heard.append(("released", *told)))
    hand = at(shown, "hand_left")

    qtbot.mousePress(shown, LEFT, pos=hand)
    qtbot.mouseMove(shown, hand + QPoint(40, -30))
    qtbot.mouseRelease(shown, LEFT)

    assert [one[:3] for one in heard] == [
        (what, "nao", "L_wrist") for what in ("pressed", "dragged", "released")
    ]
    start, end = heard[0][3], heard[1][3]
    assert end[1] > start[1] and end[2] > start[2]


def test_a_key_that_is_down_when_the_focus_goes_lets_go(
    shown: RobotView, qtbot: QtBot, qapp: QApplication
) -> None:
    heard: list[bool] = []
    shown.touched.connect(lambda robot, sensor, is_pressed: heard.append(is_pressed))
    shown.focusNextPrevChild(True)
    qtbot.keyPress(shown, Qt.Key.Key_Space)

    qapp.sendEvent(shown, QFocusEvent(QFocusEvent.Type.FocusOut))

    assert heard == [True, False]
    assert shown.room.marked == Marked()
