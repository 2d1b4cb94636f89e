"""Fingers: tap, drag, two fingers, and the long press."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QEvent, QPointF
from PySide6.QtGui import QPointingDevice, QTouchEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from tests.blocks.block_building import B


@pytest.fixture(scope="session")
def screen(qapp) -> QPointingDevice:
    return QTest.createTouchDevice()


class Fingers:
    """Fingers on the screen over a canvas; the system brings their events to the viewport."""

    def __init__(self, desk, screen: QPointingDevice) -> None:
        self._viewport, self._screen = desk.canvas.viewport(), screen
        self._on: list[int] = []

    def to(self, *points: QPointF) -> None:
        """Put fingers down at these points, or move those that are down there."""
        touch = QTest.touchEvent(self._viewport, self._screen, False)
        for number, point in enumerate(points):
            put = touch.move if number in self._on else touch.press
            put(number, point.toPoint(), self._viewport)
        self._on = list(range(len(points)))
        touch.commit()

    def up(self, *points: QPointF) -> None:
        """Lift all fingers."""
        touch = QTest.touchEvent(self._viewport, self._screen, False)
        for number, point in enumerate(points):
            touch.release(number, point.toPoint(), self._viewport)
        self._on = []
        touch.commit()

    def lost(self) -> None:
        """The system takes the touch for itself."""
        QApplication.sendEvent(self._viewport, QTouchEvent(QEvent.Type.TouchCancel, self._screen))


@pytest.fixture
def shown(desk):
    return desk([B("event.started"), B("robot.say", {"text": "one"}), B("control.wait")])


@pytest.fixture
def fingers(shown, screen) -> Fingers:
    return Fingers(shown, screen)


def test_a_tap_selects_a_block(shown, fingers):
    block = shown.body()[1]

    fingers.to(shown.grip(block))
    fingers.up(shown.grip(block))

    assert shown.canvas.selection.ids == (block,)


def test_a_finger_drags_blocks(shown, fingers):
    before, block = shown.file, shown.body()[2]
    start = shown.grip(block)

    fingers.to(start)
    for step in range(1, 5):
        fingers.to(start + QPointF(80, 70) * step)
    fingers.up(start + QPointF(320, 280))

    assert shown.body(1) == [block]
    shown.editor.history.undo()
    assert shown.file == before


def test_a_shaky_finger_is_no_drag(shown, fingers):
    block = shown.body()[2]
    start = shown.grip(block)

    fingers.to(start)
    fingers.to(start + QPointF(8, 5))
    fingers.up(start + QPointF(8, 5))

    assert len(shown.body()) == 3
    assert shown.canvas.selection.ids == (block,)


def test_a_finger_on_the_empty_canvas_moves_the_page(shown, fingers):
    start = QPointF(700, 500)
    page = shown.canvas.sight.to_page(start)

    fingers.to(start)
    fingers.to(start + QPointF(-60, -40))
    fingers.up(start + QPointF(-60, -40))

    assert (shown.canvas.sight.to_page(start + QPointF(-60, -40)) - page).manhattanLength() < 1


def test_two_fingers_zoom_and_move_the_page(shown, fingers):
    left, right = QPointF(300, 300), QPointF(500, 300)
    page = shown.canvas.sight.to_page(QPointF(400, 300))

    fingers.to(left)
    fingers.to(left, right)
    fingers.to(left + QPointF(-100, 50), right + QPointF(100, 50))
    fingers.up(left, right)

    assert shown.canvas.sight.camera.scale == pytest.approx(2.0)
    assert (shown.canvas.sight.to_page(QPointF(400, 350)) - page).manhattanLength() < 1


def test_a_second_finger_gives_carried_blocks_back(shown, fingers):
    before, block = shown.file, shown.body()[2]
    start = shown.grip(block)
    fingers.to(start)
    fingers.to(start + QPointF(200, 200))

    fingers.to(start + QPointF(200, 200), start)
    fingers.up(start + QPointF(200, 200), start)

    assert shown.file == before
    assert shown.canvas.layers.sprite is None


def test_a_touch_that_the_system_takes_away_gives_carried_blocks_back(shown, fingers):
    before, block = shown.file, shown.body()[2]
    start = shown.grip(block)
    fingers.to(start)
    fingers.to(start + QPointF(200, 200))

    fingers.lost()

    assert shown.file == before
    assert shown.canvas.pointing.gesture is None


def test_a_finger_that_rests_opens_the_menu(shown, fingers, qtbot):
    block = shown.body()[1]

    fingers.to(shown.grip(block))
    qtbot.waitUntil(lambda: shown.canvas.menu is not None and shown.canvas.menu.isVisible())

    assert shown.canvas.selection.ids == (block,)
    shown.canvas.menu.close()
    fingers.up(shown.grip(block))
    assert shown.canvas.pointing.gesture is None
