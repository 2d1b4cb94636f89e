"""Dragging a part of a block, by its minus, to another place among its like."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, Qt

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.operations.wrapping import add_part
from nep_studio.blocks.places import InBody, InInput
from tests.blocks.block_building import B


def items(desk, block: str) -> list[object]:
    there = desk.editor.project.blocks[block]
    count = there.groups["item"]
    keys = [f"item.{number}" for number in range(1, count + 1)]
    return [there.inputs.get(key) or there.fields.get(key) for key in keys]


def part_button(desk, block: str, number: int) -> QPointF:
    placed = desk.canvas.page_layout.placed(block)
    piece = next(p for p in placed.box.pieces if p.kind == "remove" and p.number == number)
    x, y = placed.x + piece.x + piece.width / 2, placed.y + piece.y + piece.height / 2
    return desk.canvas.sight.camera.to_view(x, y)


def joined(desk, *, is_mirrored: bool = False):
    made = desk([B("text.join")], is_mirrored=is_mirrored)
    [block] = made.body()
    for number, text in enumerate(("one", "two", "three"), 1):
        if number > made.editor.project.blocks[block].groups["item"]:
            add_part(made.editor, block, "item")
        made.editor.apply(SetField(block, f"item.{number}", text))
    return made, block


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_an_item_dragged_before_the_first_becomes_the_first(desk, is_mirrored):
    desk, block = joined(desk, is_mirrored=is_mirrored)
    before = desk.file
    first = desk.field(block, "item.1")

    desk.mouse.drop(part_button(desk, block, 3), first + QPointF(14 if is_mirrored else -14, 0))

    assert items(desk, block) == ["three", "one", "two"]
    assert desk.editor.history.undo()
    assert desk.file == before


def test_a_plugged_block_moves_along(desk):
    desk, block = joined(desk)
    inner = desk.editor.create("math.number", InInput(block, "item.1"))

    desk.mouse.drop(part_button(desk, block, 1), part_button(desk, block, 3) + QPointF(6, 0))

    assert items(desk, block) == ["two", "three", inner]


def test_esc_leaves_the_items_as_they_were(desk, qtbot):
    desk, block = joined(desk)
    before = desk.file
    overlays = list(desk.canvas.layers.overlays)
    desk.mouse.drag(part_button(desk, block, 3), desk.field(block, "item.1"))

    qtbot.keyClick(desk.canvas, Qt.Key.Key_Escape)
    desk.mouse.release()

    assert desk.file == before
    assert desk.canvas.layers.overlays == overlays


def test_a_click_on_the_minus_still_takes_the_item_away(desk):
    desk, block = joined(desk)

    desk.mouse.click(part_button(desk, block, 2))

    assert items(desk, block) == ["one", "three"]


def test_an_else_if_is_dragged_with_what_is_in_it(desk):
    say = B("robot.say", {"text": "hello"})
    desk = desk([B("control.if")])
    [block] = desk.body()
    for _ in range(2):
        add_part(desk.editor, block, "also")
    inner = desk.editor.create(say.type, InBody(block, "also_do.2", 0))

    desk.mouse.drop(
        part_button(desk, block, 2), desk.field(block, "also_condition.1") - QPointF(0, 14)
    )

    assert desk.editor.project.blocks[block].bodies["also_do.1"] == [inner]


def test_a_part_that_is_alone_is_no_grip_but_carries_its_block(desk):
    desk = desk([B("control.if")])
    [block] = desk.body()
    add_part(desk.editor, block, "also")

    desk.mouse.drag(part_button(desk, block, 1), QPointF(620, 480))

    assert desk.canvas.layers.sprite is not None
