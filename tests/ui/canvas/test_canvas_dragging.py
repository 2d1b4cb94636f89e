"""Dragging blocks with the mouse: what is carried, where it lands, and what Esc gives back."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDragMoveEvent, QDropEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLabel

from nep_studio.blocks.edits import SetField
from nep_studio.blocks.operations.copying import clip_of, to_text
from nep_studio.ui.canvas.gestures.drag_blocks import DragBlocks
from tests.blocks.block_building import B

CTRL, ALT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.AltModifier
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


def test_a_block_is_carried_with_all_below_it(desk):
    desk = desk(story())
    before, (hat, one, two, three) = desk.file, list(desk.body())

    desk.put(two, FREE)

    assert desk.body(0) == [hat, one]
    assert desk.body(1) == [two, three]
    assert undone(desk) == before


def test_a_dropped_block_lies_where_it_was_let_go(desk):
    desk = desk(story())
    two = desk.body()[2]

    desk.put(two, FREE)

    corner = desk.corner(two)
    assert (corner - FREE).manhattanLength() < 2


@pytest.mark.parametrize("held", [CTRL, ALT])
def test_with_ctrl_or_alt_one_block_comes_out_and_the_stack_closes(desk, held):
    desk = desk(story())
    before, (hat, one, two, three) = desk.file, list(desk.body())

    desk.put(one, FREE, held)

    assert desk.body(0) == [hat, two, three]
    assert desk.body(1) == [one]
    assert undone(desk) == before


def test_the_stack_closes_as_soon_as_a_block_is_carried(desk):
    desk = desk(story())
    _, one, two, _ = desk.body()
    place = desk.corner(one)

    desk.carry(one, FREE, CTRL)

    assert (desk.corner(two) - place).manhattanLength() < 1


def test_nothing_changes_in_the_program_until_the_drop(desk):
    desk = desk(story())
    before = desk.file

    desk.carry(desk.body()[1], FREE)

    assert desk.file == before
    assert desk.editor.history.undo_label != "move blocks"


def test_a_dropped_stack_snaps_to_the_block_above(desk):
    desk = desk(story(), loose("four", "five"))
    before, last, (four, five) = desk.file, desk.body()[-1], list(desk.body(1))
    rect = desk.canvas.view_rect_of(last)

    desk.put(four, rect.bottomLeft() + QPointF(9, 11))

    assert desk.body(0)[-2:] == [four, five]
    assert len(desk.editor.project.pages["behaviour"]) == 1
    assert undone(desk) == before


def test_a_stack_dropped_between_blocks_goes_between_them(desk):
    desk = desk(story(), loose("four"))
    hat, one, two, three = desk.body()
    [four] = desk.body(1)

    desk.put(four, desk.corner(two) + QPointF(8, 6))

    assert desk.body(0) == [hat, one, four, two, three]


def test_a_gap_shows_where_the_blocks_will_go(desk):
    desk = desk(story(), loose("four"))
    two, [four] = desk.body()[2], list(desk.body(1))
    place = desk.corner(two)

    desk.carry(four, place + QPointF(8, 6))

    assert desk.canvas.page_layout.layout.gap is not None
    assert desk.corner(two).y() > place.y() + 20


def test_the_gap_closes_when_the_blocks_are_carried_on(desk):
    desk = desk(story(), loose("four"))
    two, [four] = desk.body()[2], list(desk.body(1))
    place = desk.corner(two)
    desk.carry(four, place + QPointF(8, 6))

    desk.mouse.move(FREE)

    assert desk.canvas.page_layout.layout.gap is None
    assert desk.corner(two) == place


def test_a_stack_held_over_the_head_of_another_goes_on_top_of_it(desk):
    desk = desk(loose("four", "five"), loose("six"))
    before, (four, five), [six] = desk.file, list(desk.body(0)), list(desk.body(1))
    height = desk.canvas.view_rect_of(four).height() * 2
    place = desk.corner(six)

    desk.put(four, place - QPointF(-7, height - 5))

    assert desk.body(0) == [four, five, six]
    assert (desk.corner(six) - place).manhattanLength() < 1.5
    assert undone(desk) == before


def test_a_block_dropped_into_an_empty_mouth_is_inside_it(desk):
    desk = desk([B("event.started"), B("control.repeat")], loose("four"))
    repeat, [four] = desk.body()[1], list(desk.body(1))
    mouth = desk.canvas.page_layout.placed(repeat).box.mouths[0]

    desk.put(four, desk.corner(repeat) + QPointF(mouth.x + 6, mouth.y + 6))

    assert desk.editor.project.blocks[repeat].bodies["do"] == [four]


def test_a_reporter_dropped_on_a_slot_is_plugged_in(desk):
    desk = desk([B("event.started"), B("control.repeat")], [B("math.number", {"number": 3})])
    before, repeat, [number] = desk.file, desk.body()[1], list(desk.body(1))
    slot = desk.field(repeat, "times")

    desk.put(number, slot - QPointF(10, 14))

    assert desk.editor.project.blocks[repeat].inputs == {"times": number}
    assert undone(desk) == before


def test_a_reporter_pushes_out_the_one_that_is_in_the_slot(desk):
    held = B("control.repeat", inputs={"times": B("math.number", {"number": 3})})
    desk = desk([B("event.started"), held], [B("variable.get", {"variable": "v1"})])
    before, repeat, [new] = desk.file, desk.body()[1], list(desk.body(1))
    old = desk.editor.project.blocks[repeat].inputs["times"]

    desk.put(new, desk.corner(old) + QPointF(1, 2))

    assert desk.editor.project.blocks[repeat].inputs == {"times": new}
    assert desk.body(1) == [old]
    assert undone(desk) == before


def test_the_field_of_a_slot_comes_back_when_its_block_leaves(desk):
    held = B("control.repeat", {"times": 7}, {"times": B("math.number", {"number": 3})})
    desk = desk([B("event.started"), held])
    repeat = desk.body()[1]
    number = desk.editor.project.blocks[repeat].inputs["times"]

    desk.put(number, FREE)

    keys = [piece.key for piece in desk.canvas.page_layout.placed(repeat).box.pieces]
    assert "times" in keys
    assert desk.editor.project.blocks[repeat].fields["times"] == 7


def test_what_does_not_fit_is_told_beside_the_pointer_and_refused_at_the_drop(desk, qtbot):
    desk = desk([B("event.started"), B("control.repeat")], [B("text.text", {"text": "x"})])
    repeat, [text] = desk.body()[1], list(desk.body(1))
    slot = desk.field(repeat, "times")
    desk.carry(text, slot - QPointF(10, 14))

    assert "needs a number" in desk.canvas.bubble.text()
    assert desk.canvas.bubble.isVisible()
    with qtbot.waitSignal(desk.canvas.refused) as refused:
        desk.mouse.release()

    assert "needs a number" in refused.args[0]
    assert "times" not in desk.editor.project.blocks[repeat].inputs
    assert not desk.canvas.bubble.isVisible()


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
    assert desk.canvas.sprite is None
    desk.mouse.move(QPointF(900, 700))
    assert desk.canvas.grab().toImage() == picture


def test_the_right_button_during_a_drag_restores_everything(desk):
    desk = desk(story())
    before = desk.file
    desk.carry(desk.body()[2], FREE)

    desk.mouse.press(FREE, Qt.MouseButton.RightButton)

    assert desk.file == before
    assert desk.canvas.gesture is None
    assert desk.canvas.pointing.was_cancelled_by_right


def test_losing_the_focus_restores_everything(desk):
    desk = desk(story())
    before = desk.file
    desk.carry(desk.body()[2], FREE)

    desk.canvas.clearFocus()

    assert desk.canvas.gesture is None
    assert desk.file == before


def test_a_release_that_went_elsewhere_restores_everything(desk):
    desk = desk(story())
    before = desk.file
    desk.carry(desk.body()[2], FREE)

    desk.mouse.held = Qt.MouseButton.NoButton
    desk.mouse.move(FREE + QPointF(20, 0))

    assert desk.canvas.gesture is None
    assert desk.file == before


def test_a_change_of_the_program_ends_a_drag_first(desk):
    desk = desk(story())
    one, two = desk.body()[1:3]
    desk.carry(two, FREE)

    desk.editor.apply(SetField(one, "text", "changed"))

    assert desk.canvas.gesture is None
    assert desk.canvas.sprite is None
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

    assert not isinstance(desk.canvas.gesture, DragBlocks)


def test_dragging_one_of_several_selected_blocks_carries_them_all(desk):
    desk = desk(story(), loose("four", "five"))
    before = desk.file
    (hat, one, two, three), (four, five) = list(desk.body(0)), list(desk.body(1))
    desk.canvas.selection.set([two, four, five])
    way = desk.corner(four) - desk.corner(two)

    desk.put(two, desk.corner(two) + QPointF(400, 60))

    assert desk.body(0) == [hat, one, three]
    assert sorted(len(desk.body(n)) for n in (1, 2)) == [1, 2]
    assert (desk.corner(four) - desk.corner(two) - way).manhattanLength() < 1.5
    assert set(desk.canvas.selection.ids) == {two, four, five}
    assert undone(desk) == before


def test_the_dropped_block_is_selected(desk):
    desk = desk(story())
    two = desk.body()[2]

    desk.put(two, FREE)

    assert desk.canvas.selection.ids == (two,)


def test_blocks_dropped_on_the_delete_area_are_deleted(desk, qtbot):
    desk = desk(story())
    before, (hat, one, two, _) = desk.file, list(desk.body())
    corner = desk.canvas.viewport().mapToGlobal(QPoint(700, 500))
    desk.canvas.delete_area = lambda at: at.x() >= corner.x() and at.y() >= corner.y()
    with qtbot.waitSignal(desk.canvas.delete_area_entered):
        desk.carry(two, QPointF(760, 560))

    assert desk.canvas.bubble.text() == "Let go to delete 2 blocks"
    with qtbot.waitSignal(desk.canvas.blocks_deleted) as deleted:
        desk.mouse.release()

    assert desk.body() == [hat, one]
    assert len(deleted.args[0]) == 2
    assert undone(desk) == before


def test_a_c_block_held_with_its_mouth_at_a_block_goes_around_the_rest(desk):
    desk = desk(story(), [B("control.repeat")])
    before, (hat, one, two, three), [repeat] = desk.file, list(desk.body()), list(desk.body(1))
    mouth = desk.canvas.page_layout.placed(repeat).box.mouths[0]

    desk.put(repeat, desk.corner(two) - QPointF(mouth.x - 4, mouth.y - 4))

    assert desk.body(0) == [hat, one, repeat]
    assert desk.editor.project.blocks[repeat].bodies["do"] == [two, three]
    assert undone(desk) == before


def test_a_c_block_goes_around_a_whole_stack_that_stays_in_place(desk):
    desk = desk(loose("four", "five"), [B("control.repeat")])
    before, (four, five), [repeat] = desk.file, list(desk.body(0)), list(desk.body(1))
    mouth = desk.canvas.page_layout.placed(repeat).box.mouths[0]
    place = desk.corner(four)

    desk.put(repeat, place - QPointF(mouth.x - 4, mouth.y - 4))

    assert desk.editor.project.blocks[repeat].bodies["do"] == [four, five]
    assert (desk.corner(four) - place).manhattanLength() < 1.5
    assert undone(desk) == before


def test_a_c_block_dropped_on_selected_blocks_goes_around_exactly_these(desk):
    desk = desk(story(), [B("control.repeat")])
    before, (hat, one, two, three), [repeat] = desk.file, list(desk.body()), list(desk.body(1))
    desk.canvas.selection.set([one, two])

    desk.put(repeat, desk.corner(one) + QPointF(6, 4))

    assert desk.body(0) == [hat, repeat, three]
    assert desk.editor.project.blocks[repeat].bodies["do"] == [one, two]
    assert undone(desk) == before


def test_a_stack_dropped_onto_another_without_snapping_is_moved_clear_of_it(desk):
    desk = desk(story(), loose("four"))
    before, [four] = desk.file, list(desk.body(1))
    two = desk.canvas.view_rect_of(desk.body()[2])

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

    rect = desk.canvas.view_rect_of(two)
    assert desk.canvas.viewport().rect().toRectF().intersects(rect)


def test_the_page_scrolls_while_blocks_are_held_at_its_edge(desk, qtbot):
    desk = desk(story())
    two, right = desk.body()[2], desk.canvas.viewport().width()
    desk.carry(two, FREE)
    start = desk.canvas.camera.x
    desk.mouse.move(QPointF(right - 6, 300))

    qtbot.waitUntil(lambda: desk.canvas.camera.x > start + 60)
    desk.mouse.move(FREE)
    at_rest = desk.canvas.camera.x
    desk.mouse.release()

    assert desk.canvas.camera.x == at_rest
    assert (desk.corner(two) - FREE).manhattanLength() < 60


def test_a_copy_is_dragged_with_ctrl_and_alt(desk):
    desk = desk(story())
    before, two = desk.file, desk.body()[2]

    desk.put(two, FREE, CTRL | ALT)

    [copied] = desk.body(1)
    assert len(desk.body(0)) == 4
    assert desk.editor.project.blocks[copied].fields["text"] == "two"
    assert (desk.corner(copied) - FREE).manhattanLength() < 2
    assert undone(desk) == before


def test_the_variable_of_a_header_is_dragged_out_as_a_block(desk):
    desk = desk([B("event.started"), B("control.for_each", {"variable": "v1"})])
    before, loop = desk.file, desk.body()[1]
    start = desk.field(loop, "variable")

    desk.mouse.drop(start, start + QPointF(300, 250))

    [reporter] = desk.body(1)
    assert desk.editor.project.blocks[reporter].type == "variable.get"
    assert desk.editor.project.blocks[reporter].fields["variable"] == "v1"
    assert undone(desk) == before


def test_a_new_block_is_dragged_in_from_another_widget(desk, qtbot):
    desk = desk(story())
    before, last = desk.file, desk.canvas.view_rect_of(desk.body()[-1])
    palette = QLabel("palette")
    qtbot.addWidget(palette)
    palette.show()
    clip = clip_of(desk.editor.language, "robot.say", text="new")
    pressed = palette.mapToGlobal(QPoint(5, 5))
    desk.canvas.begin_external_drag(clip, pressed, palette)
    target = desk.canvas.viewport().mapToGlobal(last.bottomLeft().toPoint() + QPoint(40, 24))

    QTest.mousePress(palette, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    for step in range(1, 6):
        place = pressed + (target - pressed) * step / 5
        QTest.mouseMove(palette, palette.mapFromGlobal(place))
    QTest.mouseRelease(palette, Qt.MouseButton.LeftButton, pos=palette.mapFromGlobal(target))

    new = desk.editor.project.blocks[desk.body()[-1]]
    assert len(desk.body()) == 5
    assert new.fields["text"] == "new"
    assert undone(desk) == before


def test_a_new_block_that_is_let_go_outside_the_view_is_not_made(desk, qtbot):
    desk = desk(story())
    before, palette = desk.file, QLabel("palette")
    qtbot.addWidget(palette)
    clip = clip_of(desk.editor.language, "robot.say")
    desk.canvas.begin_external_drag(clip, palette.mapToGlobal(QPoint(5, 5)), palette)
    outside = desk.canvas.viewport().mapToGlobal(QPoint(-200, 300))

    QTest.mousePress(palette, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))
    QTest.mouseMove(palette, palette.mapFromGlobal(outside))
    is_carried = desk.canvas.sprite is not None
    QTest.mouseRelease(palette, Qt.MouseButton.LeftButton, pos=palette.mapFromGlobal(outside))

    assert is_carried
    assert desk.canvas.sprite is None
    assert desk.file == before


def test_a_click_on_the_palette_drags_nothing_in(desk, qtbot):
    desk = desk(story())
    before = desk.file
    palette = QLabel("palette")
    qtbot.addWidget(palette)
    clip = clip_of(desk.editor.language, "robot.say")
    desk.canvas.begin_external_drag(clip, palette.mapToGlobal(QPoint(5, 5)), palette)

    QTest.mouseClick(palette, Qt.MouseButton.LeftButton, pos=QPoint(8, 8))

    assert desk.canvas.gesture is None
    assert desk.file == before


def test_blocks_snap_in_a_mirrored_layout_too(desk):
    desk = desk(story(), loose("four"), is_mirrored=True)
    hat, one, two, three = desk.body()
    [four] = desk.body(1)
    right = desk.canvas.view_rect_of(two).topRight()
    width = desk.canvas.view_rect_of(four).width()

    desk.put(four, right + QPointF(-width - 8, 6))

    assert desk.body(0) == [hat, one, four, two, three]


def drag_in(desk, data: QMimeData, *, to: QPointF) -> None:
    """What the system sends when something is dragged in from another window, and dropped."""
    viewport, copy = desk.canvas.viewport(), Qt.DropAction.CopyAction
    held = (data, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier)
    start = QPoint(500, 20)
    QApplication.sendEvent(viewport, QDragEnterEvent(start, copy, *held))
    for step in range(1, 5):
        place = (QPointF(start) + (to - QPointF(start)) * step / 4).toPoint()
        QApplication.sendEvent(viewport, QDragMoveEvent(place, copy, *held))
    QApplication.sendEvent(viewport, QDropEvent(to, copy, *held))


def test_the_text_of_blocks_is_dropped_in_as_blocks(desk):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setText(to_text(clip_of(desk.editor.language, "robot.say", text="from afar")))

    drag_in(desk, data, to=FREE)

    [new] = desk.body(1)
    assert desk.editor.project.blocks[new].fields["text"] == "from afar"
    assert undone(desk) == before


def test_any_other_text_is_not_taken(desk):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setText("{ not blocks")

    drag_in(desk, data, to=FREE)

    assert desk.file == before
    assert desk.canvas.gesture is None


def test_a_project_file_that_is_dropped_is_told_of(desk, qtbot, tmp_path):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(tmp_path / "greeting.nep"))])

    with qtbot.waitSignal(desk.canvas.file_dropped) as dropped:
        drag_in(desk, data, to=FREE)

    assert dropped.args == [str(tmp_path / "greeting.nep")]
    assert desk.file == before


def test_a_block_of_another_page_is_refused(desk, qtbot):
    desk = desk(story())
    before, data = desk.file, QMimeData()
    data.setText(to_text(clip_of(desk.editor.language, "robots.robot")))

    with qtbot.waitSignal(desk.canvas.refused) as refused:
        drag_in(desk, data, to=FREE)

    assert "belongs on the page" in refused.args[0]
    assert desk.file == before


def test_carried_blocks_are_shown_outside_the_view_too(desk):
    desk = desk(story())
    desk.carry(desk.body()[2], FREE)

    desk.mouse.move(QPointF(-60, 200))
    outside = desk.canvas.floating.isVisible()
    desk.mouse.move(FREE)

    assert outside
    assert not desk.canvas.floating.isVisible()
