"""How a drag ends: given back by Esc, deleted, or landing where it can be seen."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.edits.content import SetField
from nep_studio.ui.canvas.editing.drag_blocks import DragBlocks
from tests.blocks.block_building import B

FREE = QPointF(620, 480)


def say(text: str) -> B:
    return B("robot.say", {"text": text})


def story() -> list[B]:
    return [B("event.started"), say("one"), say("two"), say("three")]


def loose(*texts: str) -> list[B]:
    return [say(text) for text in texts]


def undone(desk) -> bytes:
    """The program after one step back, which must be a single one."""
    assert desk.editor.history.undo()
    return desk.file


def test_esc_during_a_drag_restores_everything(desk, qtbot):
    desk = desk(story(), loose("four"))
    before, label = desk.file, desk.editor.history.undo_label
    two = desk.body()[2]
    place, picture = desk.corner(two), desk.canvas.grab().toImage()
    desk.carry(two, FREE)

    QTest.keyClick(desk.canvas, Qt.Key.Key_Escape)
    desk.mouse.release()

    assert desk.file == before
    assert desk.editor.history.undo_label == label
    assert desk.corner(two) == place
    assert desk.canvas.layers.sprite is None
    desk.mouse.move(QPointF(900, 700))
    assert desk.canvas.grab().toImage() == picture


def test_the_right_button_during_a_drag_restores_everything(desk):
    desk = desk(story())
    before = desk.file
    desk.carry(desk.body()[2], FREE)

    desk.mouse.press(FREE, Qt.MouseButton.RightButton)

    assert desk.file == before
    assert desk.canvas.pointing.gesture is None
    assert desk.canvas.pointing.was_cancelled_by_right


def test_losing_the_focus_restores_everything(desk):
    desk = desk(story())
    before = desk.file
    desk.carry(desk.body()[2], FREE)

    desk.canvas.clearFocus()

    assert desk.canvas.pointing.gesture is None
    assert desk.file == before


def test_a_release_that_went_elsewhere_restores_everything(desk):
    desk = desk(story())
    before = desk.file
    desk.carry(desk.body()[2], FREE)

    desk.mouse.held = Qt.MouseButton.NoButton
    desk.mouse.move(FREE + QPointF(20, 0))

    assert desk.canvas.pointing.gesture is None
    assert desk.file == before


def test_a_change_of_the_program_ends_a_drag_first(desk):
    desk = desk(story())
    one, two = desk.body()[1:3]
    desk.carry(two, FREE)

    desk.editor.apply(SetField(one, "text", "changed"))

    assert desk.canvas.pointing.gesture is None
    assert desk.canvas.layers.sprite is None
    assert len(desk.body()) == 4


def test_going_back_to_where_it_was_makes_no_step(desk):
    desk = desk(story())
    label = desk.editor.history.undo_label
    two = desk.body()[2]
    place = desk.grip(two)
    desk.carry(two, FREE)

    desk.mouse.move(place)
    desk.mouse.release()

    assert desk.editor.history.undo_label == label


def test_a_shaky_click_is_no_drag(desk):
    desk = desk(story())
    two = desk.body()[2]
    grip = desk.grip(two)

    desk.mouse.drag(grip, grip + QPointF(4, 3))

    assert not isinstance(desk.canvas.pointing.gesture, DragBlocks)


def test_blocks_dropped_on_the_delete_area_are_deleted(desk, qtbot):
    desk = desk(story())
    before, (hat, one, two, _) = desk.file, list(desk.body())
    corner = desk.canvas.viewport().mapToGlobal(QPoint(700, 500))
    desk.canvas.marks.delete_area = lambda at: at.x() >= corner.x() and at.y() >= corner.y()
    with qtbot.waitSignal(desk.canvas.news.delete_area_entered):
        desk.carry(two, QPointF(760, 560))

    assert desk.canvas.marks.bubble.text() == "Let go to delete 2 blocks"
    with qtbot.waitSignal(desk.canvas.news.blocks_deleted) as deleted:
        desk.mouse.release()

    assert desk.body() == [hat, one]
    assert len(deleted.args[0]) == 2
    assert undone(desk) == before


def test_a_stack_dropped_onto_another_without_snapping_is_moved_clear_of_it(desk):
    desk = desk(story(), loose("four"))
    before, [four] = desk.file, list(desk.body(1))
    two = desk.canvas.sight.view_rect_of(desk.body()[2])

    desk.put(four, two.topLeft() + QPointF(60, 8))

    dropped, stack = desk.canvas.page_layout.placed(four).rect, desk.body(1)
    assert stack == [four]
    for block in desk.body(0):
        assert not dropped.touches(desk.canvas.page_layout.placed(block).rect)
    assert undone(desk) == before


def test_blocks_dropped_outside_the_view_can_still_be_seen(desk):
    desk = desk(story())
    two = desk.body()[2]

    desk.put(two, QPointF(-500, 3000))

    rect = desk.canvas.sight.view_rect_of(two)
    assert desk.canvas.viewport().rect().toRectF().intersects(rect)


def test_the_page_scrolls_while_blocks_are_held_at_its_edge(desk, qtbot):
    desk = desk(story())
    two, right = desk.body()[2], desk.canvas.viewport().width()
    desk.carry(two, FREE)
    start = desk.canvas.sight.camera.x
    desk.mouse.move(QPointF(right - 6, 300))

    qtbot.waitUntil(lambda: desk.canvas.sight.camera.x > start + 60)
    desk.mouse.move(FREE)
    at_rest = desk.canvas.sight.camera.x
    desk.mouse.release()

    assert desk.canvas.sight.camera.x == at_rest
    assert (desk.corner(two) - FREE).manhattanLength() < 60


def test_carried_blocks_are_shown_outside_the_view_too(desk):
    desk = desk(story())
    desk.carry(desk.body()[2], FREE)

    desk.mouse.move(QPointF(-60, 200))
    outside = desk.canvas.marks.floating.isVisible()
    desk.mouse.move(FREE)

    assert outside
    assert not desk.canvas.marks.floating.isVisible()
