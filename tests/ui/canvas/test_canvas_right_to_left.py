"""A canvas for a language that is written from right to left."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.edits.content import AddNote
from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.program import Note
from tests.blocks.block_building import B


@pytest.fixture
def mirrored(desk):
    say = [B("robot.say", {"text": "a rather long sentence"}), B("control.wait")]
    return desk(say, [B("control.wait")], [B("robot.say")], is_mirrored=True)


def rects(shown) -> list:
    layout = shown.canvas.page_layout
    layout.chains.lay_out_all()
    return [layout.index.rects[stack] for stack in layout.chains]


@pytest.mark.parametrize("scale", [0.5, 1.0, 2.0])
def test_a_page_is_shown_from_its_right_corner(mirrored, scale) -> None:
    canvas = mirrored.canvas
    canvas.sight.zoom(scale)
    canvas.show_page("robots")

    canvas.show_page("behaviour")

    bounds, seen = canvas.page_layout.bounds(), canvas.sight.visible_page_rect()
    assert seen.right - bounds.right == pytest.approx(28 / scale, abs=1)
    assert bounds.y - seen.y == pytest.approx(28 / scale, abs=1)


@pytest.mark.parametrize("columns", [True, False])
def test_tidied_stacks_do_not_lie_on_each_other(mirrored, columns) -> None:
    for stack in list(mirrored.editor.project.stacks):
        mirrored.editor.apply(MoveStack(stack, 10, 10))

    mirrored.canvas.commands.tidy(columns=columns)

    found = rects(mirrored)
    assert not any(one.touches(other) for n, one in enumerate(found) for other in found[n + 1 :])


def test_columns_go_from_right_to_left(mirrored) -> None:
    first, second, _ = mirrored.editor.project.stacks
    mirrored.editor.apply(MoveStack(first, 0, 0))
    mirrored.editor.apply(MoveStack(second, -900, 300))

    mirrored.canvas.commands.tidy(columns=True)

    stacks = mirrored.editor.project.stacks
    assert stacks[second].y == stacks[first].y
    index = mirrored.canvas.page_layout.index
    assert index.rects[second].right < index.rects[first].x


def test_a_copy_lies_beside_its_block(mirrored) -> None:
    block = mirrored.body(0)[1]
    mirrored.canvas.selection.set([block])
    before = mirrored.canvas.sight.view_rect_of(block)

    QTest.keyClick(mirrored.canvas, Qt.Key.Key_D, Qt.KeyboardModifier.ControlModifier)

    [copy] = mirrored.canvas.selection.ids
    assert copy != block
    after = mirrored.canvas.sight.view_rect_of(copy)
    assert abs(after.right() - before.right()) < 60
    assert abs(after.top() - before.top()) < 60


def test_blocks_carried_by_keyboard_are_shown_at_the_place_that_is_told(mirrored) -> None:
    canvas, block = mirrored.canvas, mirrored.body(0)[1]
    canvas.selection.set([block])
    QTest.keyClick(canvas, Qt.Key.Key_Space)
    start = canvas.layers.sprite.x, canvas.layers.sprite.y

    QTest.keyClick(canvas, Qt.Key.Key_Left, Qt.KeyboardModifier.ControlModifier)

    assert (canvas.layers.sprite.x, canvas.layers.sprite.y) == (start[0] - 32, start[1])


def test_the_wide_side_of_a_carried_stack_stays_under_the_pointer(mirrored) -> None:
    block = mirrored.body(0)[0]
    rect = mirrored.canvas.sight.view_rect_of(block)
    grip = rect.topRight() + QPointF(-5, 14)

    mirrored.mouse.drop(grip, grip + QPointF(-120, 300))

    moved = mirrored.canvas.sight.view_rect_of(block)
    assert moved.right() == pytest.approx(rect.right() - 120, abs=1)


def test_the_right_side_stays_where_it_is_when_a_panel_takes_room(mirrored) -> None:
    canvas = mirrored.canvas
    canvas.sight.show_beginning()
    right = canvas.sight.visible_page_rect().right

    canvas.resize(canvas.width() - 140, canvas.height())

    assert canvas.sight.visible_page_rect().right == pytest.approx(right, abs=1)


def test_a_note_beside_the_blocks_does_not_push_them_out_of_view(mirrored) -> None:
    mirrored.editor.apply(AddNote(Note("n1", "behaviour", 1500, 0, 200, 100, "Read me")))

    mirrored.canvas.sight.show_beginning()

    blocks, seen = (
        mirrored.canvas.page_layout.index.bounds(),
        mirrored.canvas.sight.visible_page_rect(),
    )
    assert seen.x < blocks.right < seen.right
