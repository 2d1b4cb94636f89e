"""The palette without a mouse, in other looks, and what it remembers."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAccessible
from PySide6.QtTest import QTest

from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.workbench.palette.entries import tip
from nep_studio.ui.workbench.palette.palette import remember_types
from tests.ui.palette.palette_use import (
    LEFT,
    click,
    drop,
    listed,
    number_of,
    press_and_drag,
    type_of,
    types,
)


def leave(palette) -> None:
    """Bring the pointer from the palette to the canvas."""
    canvas = palette.canvas.viewport()
    QTest.mouseMove(palette.shelf.viewport(), QPoint(30, 30))
    QTest.mouseMove(canvas, canvas.rect().center())
    palette.canvas.setFocus()


def test_what_was_used_last_comes_first_and_is_remembered(palette, qtbot, settings):
    click(palette, "control.wait")
    leave(palette)

    qtbot.waitUntil(lambda: palette.shelf.entries[0].drawer.id == "recent")
    assert type_of(palette, 1) == "control.wait"
    assert settings.recent_blocks[0] == "control.wait"


def test_nothing_moves_under_the_pointer_when_blocks_are_used(palette, qtbot):
    remember_types(palette.settings, ["logic.truth", "control.wait"])
    palette.refresh()
    before = listed(palette)
    place = palette.shelf.rect_of(number_of(palette, "control.wait")).center()
    viewport = palette.shelf.viewport()

    for _ in range(2):
        QTest.mouseMove(viewport, place)
        QTest.mouseClick(viewport, LEFT, pos=place)
        qtbot.wait(30)

    assert palette.settings.recent_blocks[0] == "control.wait"
    assert listed(palette) == before
    assert types(palette).count("control.wait") == 2


def test_a_dragged_block_changes_the_list_only_after_the_pointer_has_gone(palette, qtbot):
    before = listed(palette)
    press_and_drag(palette, "control.wait", QPoint(450, 60))
    qtbot.wait(30)
    while_dragged = listed(palette)
    drop(palette, QPoint(450, 60))

    leave(palette)

    assert while_dragged == before
    qtbot.waitUntil(lambda: palette.shelf.entries[0].drawer.id == "recent")


def test_opening_the_drawer_shows_what_was_used_since(palette, qtbot):
    remember_types(palette.settings, ["logic.truth"])
    palette.refresh()
    click(palette, "control.wait")

    qtbot.mouseClick(palette.categories.buttons["recent"], LEFT)

    assert [type_of(palette, 1), type_of(palette, 2)] == ["control.wait", "logic.truth"]


def test_the_list_stays_where_it_is_when_something_is_used(palette, qtbot):
    def place() -> int:
        """Where the block is in its own drawer, which comes after the recent ones."""
        count = len(palette.shelf.entries)
        last = max(n for n in range(count) if type_of(palette, n) == "math.number")
        return palette.shelf.rect_of(last).top()

    click(palette, "math.number")
    before = place()
    leave(palette)

    qtbot.waitUntil(lambda: palette.shelf.entries[0].drawer.id == "recent")

    assert abs(place() - before) <= 1


@pytest.mark.parametrize("height", [560, 620, 640, 660, 680, 700])
def test_the_column_of_categories_is_as_wide_before_anything_was_used(
    window, palette, qtbot, height
):
    window.resize(1100, height)
    qtbot.waitUntil(lambda: palette.height() <= height)
    before = palette.categories.width()

    click(palette, "math.number")
    leave(palette)
    qtbot.waitUntil(lambda: palette.shelf.entries[0].drawer.id == "recent")

    assert palette.categories.width() == before


def test_the_list_stays_where_it_is_when_the_palette_becomes_narrower(palette, qtbot):
    shelf = palette.shelf
    shelf._go_to(number_of(palette, "math.number"))
    bar = shelf.verticalScrollBar()
    number, way = shelf._layout.spot_and_way(bar.value())
    height = shelf._layout.height

    palette.setFixedWidth(300)
    qtbot.waitUntil(lambda: shelf._layout.height != height)

    assert abs(shelf._layout.spots[number].y + way - bar.value()) <= 1


def test_arrows_choose_a_block_and_enter_inserts_it(palette, qtbot):
    palette.canvas.selection.clear()
    palette.shelf.setFocus()
    qtbot.keyClick(palette.shelf, Qt.Key.Key_Home)
    first = type_of(palette, palette.shelf.current_item())

    qtbot.keyClick(palette.shelf, Qt.Key.Key_Down)
    second = type_of(palette, palette.shelf.current_item())
    before = types(palette).count(second)
    qtbot.keyClick(palette.shelf, Qt.Key.Key_Return)

    assert first != second
    assert types(palette).count(second) == before + 1


def test_letters_typed_on_the_list_go_to_the_search(palette, qtbot):
    palette.shelf.setFocus()

    qtbot.keyClick(palette.shelf, Qt.Key.Key_W)

    assert palette.search.text() == "w"
    qtbot.waitUntil(palette.search.hasFocus)


def test_arrows_go_from_the_search_to_the_list_and_back(palette, qtbot):
    palette.search.setFocus()
    qtbot.keyClick(palette.search, Qt.Key.Key_Down)
    went = palette.shelf.hasFocus() and palette.shelf.current is not None

    qtbot.keyClick(palette.shelf, Qt.Key.Key_Up)

    assert went
    assert palette.search.hasFocus()


def test_a_screen_reader_finds_the_blocks_by_their_sentences(palette):
    found = QAccessible.queryAccessibleInterface(palette.shelf)

    names = [found.child(n).text(QAccessible.Text.Name) for n in range(found.childCount())]

    assert found.role() == QAccessible.Role.List
    assert "when the program starts" in names
    assert "Category Robot" in names


def test_the_tip_says_what_a_block_does_and_its_python(palette):
    stock = palette.shelf._stock

    words = tip(stock, stock.sample("control.wait"))

    assert "The program waits here" in words
    assert "sleep" in words or "wait" in words.split("<pre>")[1]


def test_the_palette_becomes_a_narrow_column_of_signs(palette, qtbot):
    with qtbot.waitSignal(palette.narrowed):
        qtbot.mouseClick(palette.fold, LEFT)

    assert palette.shelf.isHidden() and palette.search.isHidden()
    assert palette.maximumWidth() < 120


def test_a_category_of_the_narrow_palette_opens_it(palette, qtbot):
    palette.set_narrow(True)

    qtbot.mouseClick(palette.categories.buttons["math"], LEFT)

    assert not palette.is_narrow
    assert palette.shelf.shown_drawer().id == "math"


def test_the_palette_takes_another_theme_and_direction(palette):
    canvas = palette.canvas
    canvas.set_look(load_theme("dark"), canvas.look.block_font, is_mirrored=True)

    palette.refresh()

    rect = palette.shelf.rect_of(number_of(palette, "event.started"))
    assert rect.right() > palette.shelf.viewport().width() - 30
    image = palette.shelf.viewport().grab().toImage()
    assert image.pixelColor(2, 2) == load_theme("dark").colour("panel")


def test_blocks_are_as_narrow_as_the_palette(palette):
    palette.setFixedWidth(340)

    palette.shelf.refresh()

    width = palette.shelf.viewport().width()
    wide = [
        n for n in range(len(palette.shelf.entries)) if palette.shelf.rect_of(n).width() > width
    ]
    assert wide == []
