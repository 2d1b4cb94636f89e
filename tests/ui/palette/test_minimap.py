"""The minimap: what it shows, and how one moves with it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.edits.project import MoveStack
from nep_studio.ui.workbench.minimap import Minimap

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def minimap(canvas) -> Minimap:
    minimap = Minimap(canvas)
    minimap.show()
    return minimap


def centre_of_view(canvas) -> QPointF:
    seen = canvas.sight.visible_page_rect()
    return QPointF(seen.x + seen.width / 2, seen.y + seen.height / 2)


def test_the_minimap_lies_in_the_lower_corner(canvas, minimap):
    corner = canvas.viewport().geometry().bottomRight()

    way = corner - minimap.geometry().bottomRight()

    assert 0 < way.x() < 24 and 0 < way.y() < 24


def test_it_stays_there_when_the_canvas_changes_its_size(canvas, minimap, window, qtbot):
    window.resize(800, 520)
    qtbot.waitUntil(lambda: canvas.width() < 820)

    corner = canvas.viewport().geometry().bottomRight()
    assert (corner - minimap.geometry().bottomRight()).y() < 24


def test_a_mirrored_canvas_has_it_on_the_other_side(canvas, minimap):
    canvas.set_look(canvas.look.theme, canvas.look.block_font, is_mirrored=True)

    minimap.refresh()

    assert minimap.x() < 40


def test_stacks_are_shown_in_the_colours_of_their_blocks(canvas, minimap):
    image = minimap.grab().toImage()

    colours = {
        image.pixelColor(x, y).name()
        for x in range(0, image.width(), 2)
        for y in range(0, image.height(), 2)
    }

    minimap.canvas.sight.move_camera(5000, 5000)  # so that the frame does not tint them
    image = minimap.grab().toImage()
    colours |= {
        image.pixelColor(x, y).name() for x in range(image.width()) for y in range(image.height())
    }
    assert canvas.look.theme.block("events").fill.name() in colours
    assert canvas.look.theme.block("robot").fill.name() in colours


def test_a_press_looks_there(canvas, minimap):
    canvas.sight.move_camera(3000, 3000)
    place = QPoint(minimap.width() // 2, minimap.height() // 2)

    QTest.mouseClick(minimap, LEFT, pos=place)

    way = centre_of_view(canvas) - minimap.to_page(QPointF(place))
    assert way.manhattanLength() < 4


def test_the_frame_is_dragged(canvas, minimap):
    minimap.grab()
    canvas.sight.zoom(2.0)
    canvas.sight.move_camera(40, 40)
    start = minimap.view_frame().center().toPoint()
    before = centre_of_view(canvas)

    QTest.mousePress(minimap, LEFT, pos=start)
    QTest.mouseMove(minimap, start + QPoint(8, 12))
    QTest.mouseRelease(minimap, LEFT, pos=start + QPoint(8, 12))

    way = centre_of_view(canvas) - before
    assert way.x() == pytest.approx(8 / minimap._scale, rel=0.15)
    assert way.y() == pytest.approx(12 / minimap._scale, rel=0.15)


def test_the_frame_follows_the_view(canvas, minimap):
    before = minimap.view_frame()

    canvas.sight.pan(0, 200)

    assert minimap.view_frame().y() > before.y()


def test_a_change_is_drawn_after_a_rest(canvas, minimap, qtbot):
    minimap.grab()
    before = minimap._whole
    stack = next(iter(canvas.editor.project.stacks))

    canvas.editor.apply(MoveStack(stack, 3000, 3000))
    minimap.grab()
    is_lazy = minimap._whole == before

    qtbot.waitUntil(lambda: minimap._whole != before)
    assert is_lazy


def test_a_hidden_minimap_does_nothing(canvas, minimap):
    minimap.grab()
    minimap.hide()
    key = minimap._picture.cacheKey()

    canvas.editor.history.undo()
    canvas.sight.pan(10, 10)

    assert not minimap._later.isActive()
    assert minimap._picture.cacheKey() == key


def test_an_empty_page_has_an_empty_minimap(canvas, minimap):
    canvas.show_page("nodes")

    assert not minimap.grab().isNull()
