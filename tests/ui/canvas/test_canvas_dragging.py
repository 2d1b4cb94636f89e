"""Dragging blocks with the mouse: what is carried, where it snaps, what it pushes aside."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, Qt

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


def test_a_block_snaps_from_as_far_as_in_other_editors_and_no_farther(desk):
    desk = desk([B("event.started"), B("robot.say", {"text": "one"})], [B("control.wait")])
    [loose] = desk.body(1)
    end = desk.canvas.sight.view_rect_of(desk.body()[-1]).bottomLeft()

    desk.put(loose, end + QPointF(0, 52))
    is_far_free = len(desk.body()) == 2
    desk.put(loose, end + QPointF(0, 44))

    assert is_far_free
    assert desk.body()[-1] == loose


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
    rect = desk.canvas.sight.view_rect_of(last)

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
    height = desk.canvas.sight.view_rect_of(four).height() * 2
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

    assert "needs a number" in desk.canvas.marks.bubble.text()
    assert desk.canvas.marks.bubble.isVisible()
    with qtbot.waitSignal(desk.canvas.news.refused) as refused:
        desk.mouse.release()

    assert "needs a number" in str(refused.args[0])
    assert "times" not in desk.editor.project.blocks[repeat].inputs
    assert not desk.canvas.marks.bubble.isVisible()


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


def test_blocks_snap_in_a_mirrored_layout_too(desk):
    desk = desk(story(), loose("four"), is_mirrored=True)
    hat, one, two, three = desk.body()
    [four] = desk.body(1)
    right = desk.canvas.sight.view_rect_of(two).topRight()
    width = desk.canvas.sight.view_rect_of(four).width()

    desk.put(four, right + QPointF(-width - 8, 6))

    assert desk.body(0) == [hat, one, four, two, three]


@pytest.mark.parametrize("zoom", [0.5, 2.0])
def test_blocks_snap_at_any_zoom(desk, zoom):
    desk = desk(story(), loose("four"))
    desk.canvas.sight.zoom(zoom, QPointF(0, 0))
    hat, one, two, three = desk.body()
    [four] = desk.body(1)

    desk.put(four, desk.corner(two) + QPointF(8, 6) * zoom)

    assert desk.body(0) == [hat, one, four, two, three]
