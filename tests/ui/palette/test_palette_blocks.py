"""The palette: what it lists, how blocks are found in it, and how they come out of it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.edits.project import RenameVariable
from nep_studio.ui.canvas.layout.index import Rect
from tests.ui.palette.palette_use import (
    LEFT,
    click,
    drop,
    grip,
    listed,
    number_of,
    press_and_drag,
    type_of,
    types,
)


def test_the_palette_lists_every_block_of_the_page(palette):
    definitions = palette.canvas.editor.language.definitions.values()

    wanted = {definition.id for definition in definitions if definition.page == "behaviour"}

    assert set(listed(palette)) == wanted


def test_the_palette_follows_the_page(palette):
    palette.canvas.show_page("nodes")

    assert listed(palette) == ["nodes.launch"]


def test_the_palette_has_no_widget_for_a_block(palette):
    assert len(palette.shelf.viewport().findChildren(object)) == 0


def test_a_press_on_a_category_scrolls_to_its_blocks(palette, qtbot):
    qtbot.mouseClick(palette.categories.buttons["math"], LEFT)

    top = palette.shelf._entry_at(palette.shelf.rect_of(number_of(palette, "math.number")).center())
    assert palette.shelf.shown_drawer().id == "math"
    assert type_of(palette, top) == "math.number"


def test_the_last_category_too_comes_to_the_top(palette, qtbot):
    qtbot.mouseClick(palette.categories.buttons["snippets"], LEFT)

    assert palette.shelf.shown_drawer().id == "snippets"
    assert palette.categories.buttons["snippets"].isChecked()


def test_scrolling_marks_the_category_in_view(palette):
    palette.shelf.show_drawer("text")

    assert palette.categories.buttons["text"].isChecked()


def test_a_variable_that_is_made_gets_a_block_of_its_own(palette, qtbot):
    palette.canvas.editor.add_variable("score")

    qtbot.waitUntil(lambda: "score" in [entry.text for entry in palette.shelf.entries])


def test_a_renamed_variable_is_renamed_in_the_palette(palette, qtbot):
    palette.canvas.editor.apply(RenameVariable("v1", "score"))

    qtbot.waitUntil(lambda: "score" in [entry.text for entry in palette.shelf.entries])
    assert "times" not in [entry.text for entry in palette.shelf.entries]


def test_typing_in_the_search_box_filters_the_blocks(palette, qtbot):
    qtbot.keyClicks(palette.search, "repeat")

    assert listed(palette)[0] == "control.repeat"
    assert len(listed(palette)) < 12


@pytest.mark.parametrize(
    ("typed", "found"),
    [("speak", "robot.say"), ("pause", "control.wait"), ("repaet", "control.repeat")],
)
def test_the_search_knows_other_words_and_forgives_a_wrong_letter(palette, qtbot, typed, found):
    qtbot.keyClicks(palette.search, typed)

    assert found in listed(palette)[:6]


def test_a_search_that_finds_nothing_says_so(palette, qtbot):
    qtbot.keyClicks(palette.search, "xyzzyq")

    assert "xyzzyq" in palette.shelf.entries[0].text


def test_enter_in_the_search_box_inserts_the_first_block(palette, qtbot):
    palette.canvas.selection.clear()
    qtbot.keyClicks(palette.search, "wait 2")

    qtbot.keyClick(palette.search, Qt.Key.Key_Return)

    assert "control.wait" in types(palette)


def test_escape_clears_the_search(palette, qtbot):
    qtbot.keyClicks(palette.search, "repeat")

    qtbot.keyClick(palette.search, Qt.Key.Key_Escape)

    assert len(listed(palette)) > 140


def test_a_click_inserts_after_the_selected_block(palette):
    project = palette.canvas.editor.project
    say = next(block.id for block in project.blocks.values() if block.type == "robot.say")
    palette.canvas.selection.set([say])

    click(palette, "control.wait")

    chain = project.stack_of(say).body
    assert project.blocks[chain[chain.index(say) + 1]].type == "control.wait"
    assert palette.canvas.selection.ids == (chain[chain.index(say) + 1],)


def test_a_click_on_a_value_fills_the_empty_slot_of_the_selected_block(palette):
    project = palette.canvas.editor.project
    change = next(block for block in project.blocks.values() if block.type == "variable.change")
    palette.canvas.selection.set([change.id])

    click(palette, "math.number")

    assert project.blocks[change.inputs["amount"]].type == "math.number"


def test_a_click_without_a_selection_inserts_where_one_looks(palette):
    palette.canvas.selection.clear()

    click(palette, "event.started")

    made = palette.canvas.selection.ids[0]
    rect = palette.canvas.sight.view_rect_of(made)
    assert palette.canvas.viewport().rect().contains(rect.center().toPoint())


def test_an_inserted_block_is_one_step_of_undo(palette):
    before = len(types(palette))
    click(palette, "control.wait")

    palette.canvas.editor.history.undo()

    assert len(types(palette)) == before


def test_a_block_dragged_out_is_carried_and_lands_on_the_canvas(palette):
    before = len(types(palette))

    press_and_drag(palette, "control.wait", QPoint(450, 60))
    is_carried = palette.canvas.layers.sprite is not None and len(types(palette)) == before
    drop(palette, QPoint(450, 60))

    assert is_carried
    assert types(palette)[-1] == "control.wait"
    assert len(types(palette)) == before + 1


@pytest.mark.parametrize("block_type", ["robot.say", "control.repeat", "math.arithmetic"])
@pytest.mark.parametrize("width", [400, 230])
@pytest.mark.parametrize("zoom", [1.0, 1.4])
def test_a_block_dragged_out_stays_under_the_pointer_where_it_was_grabbed(
    palette, qtbot, block_type, width, zoom
):
    palette.setFixedWidth(width)
    palette.canvas.sight.zoom(zoom)
    qtbot.waitUntil(lambda: palette.shelf.width() <= width, timeout=3000)
    qtbot.waitUntil(lambda: palette.shelf._is_settled, timeout=3000)
    shelf, canvas, place = palette.shelf, palette.canvas, QPoint(450, 300)
    viewport = shelf.viewport()
    shelf._go_to(number_of(palette, block_type))
    spot = shelf._layout.spots[number_of(palette, block_type)]
    corner = shelf.rect_of(number_of(palette, block_type)).topLeft()
    end = viewport.mapFromGlobal(canvas.viewport().mapToGlobal(place))
    for piece in [one for one in spot.chain.boxes[0].pieces if one.piece != "words"]:
        middle = QPointF(piece.x + piece.width / 2, piece.y + piece.height / 2) * spot.scale

        QTest.mousePress(viewport, LEFT, pos=corner + middle.toPoint())
        QTest.mouseMove(viewport, corner + middle.toPoint() + QPoint(30, 0))
        QTest.mouseMove(viewport, end)
        [chain] = canvas.pointing.gesture.cargo.chains
        way = canvas.sight.to_page(place) - canvas.pointing.gesture._grabbed
        held = next(one for one in chain.boxes[0].pieces if one.key == piece.key)
        x, y = chain.x + way.x() + held.x, chain.y + way.y() + held.y
        seen = canvas.sight.camera.view_rect(Rect(x, y, held.width, held.height))
        QTest.keyClick(canvas, Qt.Key.Key_Escape)
        QTest.mouseRelease(viewport, LEFT, pos=end)

        assert (seen.center() - QPointF(place)).manhattanLength() < 4, piece.key


def test_a_short_drag_is_a_click(palette):
    viewport = palette.shelf.viewport()
    place = grip(palette.shelf, number_of(palette, "control.wait"))
    before = len(types(palette))

    QTest.mousePress(viewport, LEFT, pos=place)
    QTest.mouseMove(viewport, place + QPoint(3, 2))
    QTest.mouseRelease(viewport, LEFT, pos=place + QPoint(3, 2))

    assert len(types(palette)) == before + 1
    assert palette.canvas.layers.sprite is None


def test_a_block_dragged_back_to_the_palette_is_let_go(palette):
    before = len(types(palette))
    viewport = palette.shelf.viewport()
    press_and_drag(palette, "control.wait", QPoint(450, 60))

    QTest.mouseMove(viewport, QPoint(60, 200))
    QTest.mouseRelease(viewport, LEFT, pos=QPoint(60, 200))

    assert len(types(palette)) == before
    assert not palette.shelf._is_delete


def test_blocks_dropped_on_the_palette_are_deleted_and_it_says_so(palette, qtbot):
    canvas = palette.canvas
    say = next(b.id for b in canvas.editor.project.blocks.values() if b.type == "robot.say")
    place = canvas.sight.view_rect_of(say).topLeft().toPoint() + QPoint(10, 24)
    over = canvas.viewport().mapFromGlobal(palette.mapToGlobal(QPoint(200, 300)))

    QTest.mousePress(canvas.viewport(), LEFT, pos=place)
    QTest.mouseMove(canvas.viewport(), place + QPoint(20, 20))
    QTest.mouseMove(canvas.viewport(), over)
    was_shown = palette.shelf._is_delete
    with qtbot.waitSignal(canvas.news.blocks_deleted):
        QTest.mouseRelease(canvas.viewport(), LEFT, pos=over)

    assert was_shown and not palette.shelf._is_delete
    assert say not in canvas.editor.project.blocks
