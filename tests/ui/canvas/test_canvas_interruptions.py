"""Whatever comes between a press and its release, the program and the view stay in order."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.run.installation import studio_language
from nep_studio.ui.theme.colours import load_theme
from tests.blocks.block_building import B, build

CONTROL = Qt.KeyboardModifier.ControlModifier


def said(desk, text: str) -> str:
    blocks = desk.editor.project.blocks.values()
    return next(block.id for block in blocks if block.fields.get("text") == text)


@pytest.fixture
def two_stacks(desk):
    """A canvas with two stacks of two blocks."""
    first = [B("robot.say", {"text": "one"}), B("robot.say", {"text": "two"})]
    second = [B("robot.say", {"text": "three"}), B("robot.say", {"text": "four"})]
    return desk(first, second)


def undo_by_shortcut(desk) -> None:
    QTest.keyClick(desk.canvas, Qt.Key.Key_Z, CONTROL)


def delete_by_key(desk) -> None:
    QTest.keyClick(desk.canvas, Qt.Key.Key_Delete)


def show_other_page(desk) -> None:
    desk.canvas.show_page("robots")
    desk.canvas.show_page("behaviour")


def change_theme(desk) -> None:
    desk.canvas.set_look(load_theme("dark"), desk.canvas.look.block_font, is_mirrored=True)


def hide_canvas(desk) -> None:
    desk.canvas.hide()
    desk.canvas.show()


def open_dialog(desk) -> None:
    dialog = QDialog(desk.canvas)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.open()
    dialog.close()


def press_escape(desk) -> None:
    QTest.keyClick(desk.canvas, Qt.Key.Key_Escape)


HARMLESS = [
    undo_by_shortcut,
    delete_by_key,
    show_other_page,
    change_theme,
    hide_canvas,
    open_dialog,
    press_escape,
]


@pytest.mark.parametrize("interrupt", HARMLESS)
def test_a_drag_that_is_interrupted_leaves_the_program_as_it_was(two_stacks, interrupt) -> None:
    canvas, before = two_stacks.canvas, two_stacks.file
    two_stacks.carry(said(two_stacks, "two"), QPointF(500, 500))

    interrupt(two_stacks)
    press_escape(two_stacks)
    two_stacks.mouse.release()

    assert two_stacks.file == before
    assert canvas.pointing.gesture is None
    assert canvas.layers.sprite is None
    assert not canvas.page_layout.layout.hidden


@pytest.mark.parametrize("interrupt", [show_other_page, change_theme, hide_canvas, open_dialog])
def test_an_interrupted_drag_has_ended(two_stacks, interrupt) -> None:
    two_stacks.carry(said(two_stacks, "two"), QPointF(500, 500))

    interrupt(two_stacks)

    assert two_stacks.canvas.pointing.gesture is None
    assert two_stacks.canvas.layers.sprite is None


def test_a_drag_ends_when_another_view_deletes_what_is_carried(two_stacks) -> None:
    block = said(two_stacks, "two")
    two_stacks.carry(block, QPointF(500, 500))

    two_stacks.editor.apply(DeleteBlocks(block, 1))
    two_stacks.mouse.move(QPointF(300, 300))
    two_stacks.mouse.release()

    assert block not in two_stacks.editor.project.blocks
    assert len(two_stacks.editor.project.stacks) == 2


def test_a_rubber_band_that_another_project_ends_selects_nothing_in_it(two_stacks) -> None:
    canvas = two_stacks.canvas
    canvas.selection.set([said(two_stacks, "four")])
    two_stacks.mouse.drag(QPointF(900, 700), QPointF(950, 750))

    canvas.set_editor(build(studio_language(), [B("robot.say")]))

    assert canvas.pointing.gesture is None
    assert canvas.selection.ids == ()


def test_a_rubber_band_that_another_page_ends_selects_nothing_on_it(two_stacks) -> None:
    canvas = two_stacks.canvas
    canvas.selection.set([said(two_stacks, "four")])
    two_stacks.mouse.drag(QPointF(900, 700), QPointF(950, 750))

    canvas.show_page("robots")

    assert canvas.pointing.gesture is None
    assert canvas.selection.ids == ()


def test_blocks_carried_by_keyboard_are_put_back_when_the_project_changes(two_stacks) -> None:
    canvas, before = two_stacks.canvas, two_stacks.file
    canvas.selection.set([said(two_stacks, "two")])
    QTest.keyClick(canvas, Qt.Key.Key_Space)
    QTest.keyClick(canvas, Qt.Key.Key_Up)

    canvas.set_editor(build(studio_language(), [B("robot.say")]))

    assert two_stacks.file == before
    assert canvas.layers.sprite is None
    assert canvas.pointing.gesture is None


@pytest.mark.parametrize("key", [Qt.Key.Key_Space, Qt.Key.Key_Down, Qt.Key.Key_Return])
def test_keys_do_nothing_while_the_mouse_carries(two_stacks, key) -> None:
    before = two_stacks.file
    two_stacks.carry(said(two_stacks, "two"), QPointF(500, 500))

    QTest.keyClick(two_stacks.canvas, key)
    press_escape(two_stacks)
    two_stacks.mouse.release()

    assert two_stacks.file == before


def open_field(desk) -> str:
    block = said(desk, "three")
    assert desk.canvas.fields.open(block, "text")
    QTest.keyClicks(desk.canvas.fields.widget, "new")
    return block


def zoom_in_and_out(desk) -> None:
    for scale in (4.0, 0.1, 1.0):
        desk.canvas.sight.zoom(scale)


def scroll_far(desk) -> None:
    desk.canvas.sight.pan(5000, 5000)
    desk.canvas.sight.pan(-5000, -5000)


STAYS: list[Callable[[object], None]] = [zoom_in_and_out, scroll_far]
ENDS: list[Callable[[object], None]] = [show_other_page, hide_canvas, change_theme]


@pytest.mark.parametrize("occurrence", STAYS)
def test_a_field_stays_open_over_its_block(two_stacks, occurrence) -> None:
    block = open_field(two_stacks)

    occurrence(two_stacks)

    editor = two_stacks.canvas.fields.widget
    assert two_stacks.canvas.fields.place == (block, "text")
    assert abs(editor.geometry().center().y() - two_stacks.field(block, "text").y()) < 4


@pytest.mark.parametrize("occurrence", ENDS)
def test_a_field_keeps_what_was_typed_when_its_canvas_goes_away(two_stacks, occurrence) -> None:
    block = open_field(two_stacks)

    occurrence(two_stacks)

    assert two_stacks.canvas.fields.widget is None
    assert two_stacks.editor.project.blocks[block].fields["text"] == "new"


def test_a_field_closes_when_its_block_is_deleted(two_stacks) -> None:
    block = open_field(two_stacks)

    two_stacks.editor.apply(DeleteBlocks(block, 1))

    assert two_stacks.canvas.fields.widget is None


def test_a_field_of_a_project_that_is_closed_writes_nothing_into_the_next_one(two_stacks) -> None:
    block = open_field(two_stacks)
    other = build(studio_language(), [B("robot.say", {"text": "a"})], [B("robot.say")])
    texts = [b.fields.get("text") for b in other.project.blocks.values()]

    two_stacks.canvas.set_editor(other)

    assert two_stacks.canvas.fields.widget is None
    assert two_stacks.editor.project.blocks[block].fields["text"] == "new"
    assert [b.fields.get("text") for b in other.project.blocks.values()] == texts


def test_undo_elsewhere_while_a_field_is_open_leaves_the_program_in_order(two_stacks) -> None:
    block = open_field(two_stacks)

    two_stacks.editor.history.undo()
    QTest.keyClick(two_stacks.canvas.fields.widget, Qt.Key.Key_Escape)

    assert two_stacks.editor.project.blocks[block].fields["text"] == "three"


def test_a_change_elsewhere_shows_in_an_open_field_at_the_next_key(two_stacks) -> None:
    block = open_field(two_stacks)

    two_stacks.editor.apply(SetField(said(two_stacks, "one"), "text", "other"))
    QTest.keyClicks(two_stacks.canvas.fields.widget, "er")

    assert two_stacks.editor.project.blocks[block].fields["text"] == "newer"
