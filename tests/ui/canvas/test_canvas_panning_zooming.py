"""Moving the view: middle button, Space, the wheel, touch pads, and scrolling during a drag."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QNativeGestureEvent, QPointingDevice, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from tests.blocks.block_building import B

CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
PLAIN = Qt.KeyboardModifier.NoModifier
SOMEWHERE = QPointF(400, 300)
NONE = QPoint()


@pytest.fixture
def shown(desk):
    return desk([B("event.started"), B("robot.say"), B("control.wait")])


def wheel(desk, notches: float, held=PLAIN, at: QPointF = SOMEWHERE, pixels=NONE) -> None:
    viewport = desk.canvas.viewport()
    place = QPointF(viewport.mapToGlobal(at.toPoint()))
    turned = QPoint(0, round(notches * 120))
    event = QWheelEvent(
        at,
        place,
        pixels,
        turned,
        Qt.MouseButton.NoButton,
        held,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(viewport, event)


def pinch(desk, value: float, at: QPointF = SOMEWHERE) -> None:
    viewport = desk.canvas.viewport()
    place = QPointF(viewport.mapToGlobal(at.toPoint()))
    zooming = Qt.NativeGestureType.ZoomNativeGesture
    device = QPointingDevice.primaryPointingDevice()
    event = QNativeGestureEvent(zooming, device, 2, at, at, place, value, QPointF())
    QApplication.sendEvent(viewport, event)


def test_the_middle_button_moves_the_page_under_the_pointer(shown):
    page = shown.canvas.sight.to_page(SOMEWHERE)

    shown.mouse.press(SOMEWHERE, Qt.MouseButton.MiddleButton)
    shown.mouse.move(SOMEWHERE + QPointF(-80, 40))
    shown.mouse.release()

    moved = shown.canvas.sight.to_page(SOMEWHERE + QPointF(-80, 40))
    assert (moved - page).manhattanLength() < 1


def test_space_and_the_left_button_move_the_page(shown):
    block, before = shown.body()[1], shown.file
    start = shown.grip(block)
    page = shown.canvas.sight.to_page(start)

    QTest.keyPress(shown.canvas, Qt.Key.Key_Space)
    shown.mouse.drop(start, start + QPointF(120, 90))
    QTest.keyRelease(shown.canvas, Qt.Key.Key_Space)

    assert (shown.canvas.sight.to_page(start + QPointF(120, 90)) - page).manhattanLength() < 1
    assert shown.file == before
    assert not shown.canvas.pointing.is_space_down


def test_esc_while_the_page_is_moved_moves_it_back(shown):
    page = shown.canvas.sight.to_page(SOMEWHERE)
    shown.mouse.press(SOMEWHERE, Qt.MouseButton.MiddleButton)
    shown.mouse.move(SOMEWHERE + QPointF(-80, 40))

    QTest.keyClick(shown.canvas, Qt.Key.Key_Escape)

    assert (shown.canvas.sight.to_page(SOMEWHERE) - page).manhattanLength() < 1


def test_the_wheel_scrolls_down(shown):
    y = shown.canvas.sight.camera.y

    wheel(shown, -1)

    assert shown.canvas.sight.camera.y > y + 30


def test_the_wheel_scrolls_sideways_with_shift(shown):
    x, y = shown.canvas.sight.camera.x, shown.canvas.sight.camera.y

    wheel(shown, -1, SHIFT)

    assert shown.canvas.sight.camera.x > x + 30
    assert shown.canvas.sight.camera.y == y


def test_a_touch_pad_scrolls_by_pixels(shown):
    y = shown.canvas.sight.camera.y

    wheel(shown, -0.1, pixels=QPoint(0, -13))

    assert shown.canvas.sight.camera.y == y + 13


def test_the_wheel_with_ctrl_zooms_at_the_pointer(shown):
    page = shown.canvas.sight.to_page(SOMEWHERE)

    wheel(shown, 2, CTRL)

    assert shown.canvas.sight.camera.scale > 1.3
    assert (shown.canvas.sight.to_page(SOMEWHERE) - page).manhattanLength() < 1


def test_the_zoom_has_an_end(shown):
    for _ in range(40):
        wheel(shown, 3, CTRL)
    nearest = shown.canvas.sight.camera.scale
    for _ in range(80):
        wheel(shown, -3, CTRL)

    assert nearest == 4.0
    assert shown.canvas.sight.camera.scale == 0.1


def test_pinching_a_touch_pad_zooms(shown):
    page = shown.canvas.sight.to_page(SOMEWHERE)

    pinch(shown, 0.25)

    assert shown.canvas.sight.camera.scale == pytest.approx(1.25)
    assert (shown.canvas.sight.to_page(SOMEWHERE) - page).manhattanLength() < 1


def test_carried_blocks_stay_at_the_pointer_while_the_wheel_scrolls(shown):
    block = shown.body()[2]
    shown.carry(block, SOMEWHERE)

    wheel(shown, -2)
    shown.mouse.release()

    assert (shown.corner(block) - SOMEWHERE).manhattanLength() < 2


def test_carried_blocks_stay_at_the_pointer_while_the_wheel_zooms(shown):
    block = shown.body()[2]
    grip = shown.grip(block)
    shown.mouse.drag(grip, SOMEWHERE)

    wheel(shown, -2, CTRL)
    shown.mouse.release()

    rect = shown.canvas.sight.view_rect_of(block)
    assert rect.adjusted(-2, -2, 2, 2).contains(SOMEWHERE)


def test_leaving_the_view_forgets_the_cursor_shape(shown):
    shown.mouse.move(shown.grip(shown.body()[1]))

    QApplication.sendEvent(shown.canvas.viewport(), QEvent(QEvent.Type.Leave))

    assert shown.canvas.viewport().cursor().shape() == Qt.CursorShape.ArrowCursor
