"""The menus of blocks, of notes and of the canvas."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QContextMenuEvent, QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from nep_studio.ui.canvas.editing.menu import MenuEntry
from tests.blocks.block_building import B

EMPTY = QPoint(700, 500)


def say(text: str) -> B:
    return B("robot.say", {"text": text})


@pytest.fixture
def shown(desk):
    repeat = B("control.repeat", bodies={"do": [say("inside")]})
    return desk([B("event.started"), say("one"), repeat, say("two")])


def right_click(desk, at: QPoint) -> QMenu:
    """What the system sends for a click with the right button."""
    viewport = desk.canvas.viewport()
    mouse = QContextMenuEvent.Reason.Mouse
    QApplication.sendEvent(viewport, QContextMenuEvent(mouse, at, viewport.mapToGlobal(at)))
    return desk.canvas.menu


def menu_of(desk, block: str) -> QMenu:
    return right_click(desk, desk.grip(block).toPoint())


def entry(menu: QMenu, name: str) -> QAction:
    return next(a for a in all_entries(menu) if a.objectName() == name)


def all_entries(menu: QMenu) -> list[QAction]:
    inner = [each for action in menu.actions() if action.menu() for each in action.menu().actions()]
    return [*menu.actions(), *inner]


def names(menu: QMenu) -> set[str]:
    return {action.objectName() for action in menu.actions()}


def test_the_right_button_opens_the_menu_of_a_block_and_selects_it(shown):
    one = shown.body()[1]

    menu = menu_of(shown, one)

    assert menu.isVisible()
    assert shown.canvas.selection.ids == (one,)
    assert {"duplicate", "copy", "cut", "delete", "extract", "wrap"} <= names(menu)


def test_the_menu_of_one_of_several_selected_blocks_is_about_all(shown):
    _, one, _, two = shown.body()
    shown.canvas.selection.set([one, two])

    menu = menu_of(shown, two)

    assert shown.canvas.selection.ids == (one, two)
    assert entry(menu, "delete").text().startswith("Delete 2 blocks")


def test_delete_takes_the_block_and_closes_the_stack(shown, qtbot):
    before, (hat, one, repeat, two) = shown.file, list(shown.body())

    with qtbot.waitSignal(shown.canvas.news.blocks_deleted):
        entry(menu_of(shown, one), "delete").trigger()

    assert shown.body() == [hat, repeat, two]
    shown.editor.history.undo()
    assert shown.file == before


def test_delete_below_takes_all_that_follows(shown, qtbot):
    before, (hat, one, _, _) = shown.file, list(shown.body())

    with qtbot.waitSignal(shown.canvas.news.blocks_deleted) as deleted:
        entry(menu_of(shown, one), "delete_below").trigger()

    assert shown.body() == [hat]
    assert len(deleted.args[0]) == 4
    shown.editor.history.undo()
    assert shown.file == before


def test_duplicate_makes_a_copy_beside(shown):
    entry(menu_of(shown, shown.body()[1]), "duplicate").trigger()

    [copied] = shown.body(1)
    assert shown.editor.project.blocks[copied].fields["text"] == "one"


def test_a_block_is_taken_out_alone_beside_its_stack(shown):
    before, (hat, one, repeat, two) = shown.file, list(shown.body())

    entry(menu_of(shown, one), "extract").trigger()

    assert shown.body(0) == [hat, repeat, two]
    assert shown.body(1) == [one]
    shown.editor.history.undo()
    assert shown.file == before


def test_a_c_block_is_put_around_the_selection(shown):
    before, one = shown.file, shown.body()[1]
    menu = menu_of(shown, one)

    entry(menu, "wrap.control.repeat").trigger()

    outer = shown.body()[1]
    assert shown.editor.project.blocks[outer].type == "control.repeat"
    assert shown.editor.project.blocks[outer].bodies["do"] == [one]
    shown.editor.history.undo()
    assert shown.file == before


def test_a_block_that_nothing_may_follow_is_offered_only_where_nothing_does(shown):
    _, one, _, two = shown.body()

    above, last = menu_of(shown, one), menu_of(shown, two)

    assert not entry(above, "wrap.control.forever").isEnabled()
    assert entry(last, "wrap.control.forever").isEnabled()


def test_a_block_around_others_is_removed_without_them(shown):
    hat, one, repeat, two = shown.body()
    [inside] = shown.editor.project.blocks[repeat].bodies["do"]

    entry(menu_of(shown, repeat), "unwrap").trigger()

    assert shown.body() == [hat, one, inside, two]


def test_a_block_is_switched_off_and_on(shown):
    one = shown.body()[1]

    entry(menu_of(shown, one), "disable").trigger()
    menu = menu_of(shown, one)

    assert shown.editor.project.blocks[one].disabled
    assert entry(menu, "disable").text().startswith("Switch on")


def test_a_block_is_folded(shown):
    repeat = shown.body()[2]

    entry(menu_of(shown, repeat), "collapse").trigger()

    assert shown.editor.project.blocks[repeat].collapsed


def test_the_uses_of_a_variable_are_asked_for(desk, qtbot):
    desk = desk([B("event.started"), B("variable.set", {"variable": "v1"})])

    with qtbot.waitSignal(desk.canvas.news.uses_requested) as asked:
        entry(menu_of(desk, desk.body()[1]), "uses").trigger()

    assert (asked.args[0].kind, asked.args[0].name) == ("variable", "v1")


def test_the_definition_of_a_variable_is_gone_to(desk):
    used = B("robot.say", inputs={"text": B("variable.get", {"variable": "v1"})})
    desk = desk([B("event.started"), B("variable.set", {"variable": "v1"}), used])
    _, setter, said = desk.body()
    getter = desk.editor.project.blocks[said].inputs["text"]

    entry(menu_of(desk, getter), "definition").trigger()

    assert desk.canvas.selection.ids == (setter,)


def test_help_is_asked_for(shown, qtbot):
    with qtbot.waitSignal(shown.canvas.news.help_requested) as asked:
        entry(menu_of(shown, shown.body()[1]), "help").trigger()

    assert asked.args[0]


def test_the_menu_of_the_canvas_undoes(shown):
    before, one = shown.file, shown.body()[1]
    entry(menu_of(shown, one), "delete").trigger()

    entry(right_click(shown, EMPTY), "undo").trigger()

    assert shown.file == before


def test_a_clipboard_on_which_nothing_ever_was_is_told_of_and_breaks_nothing(shown):
    QGuiApplication.clipboard().clear()  # what is on it is None then
    before, told = shown.file, []
    shown.canvas.news.refused.connect(told.append)

    entry(right_click(shown, EMPTY), "paste").trigger()
    shown.canvas.menu.close()
    QTest.keyClick(shown.canvas, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)

    assert shown.file == before
    assert ["nothing on the clipboard" in str(one) for one in told] == [True] * len(told)
    assert told


def test_blocks_are_pasted_where_the_menu_was_opened(shown):
    entry(menu_of(shown, shown.body()[1]), "copy").trigger()
    at = shown.canvas.sight.to_page(EMPTY)

    entry(right_click(shown, EMPTY), "paste").trigger()

    [pasted] = shown.body(1)
    placed = shown.canvas.page_layout.placed(pasted)
    assert abs(placed.x - at.x()) + abs(placed.y - at.y()) < 2


def test_everything_is_selected_from_the_menu(shown):
    entry(right_click(shown, EMPTY), "select_all").trigger()

    assert shown.canvas.selection.ids == tuple(shown.body())


def test_a_note_is_added_and_deleted_from_the_menu(shown):
    entry(right_click(shown, EMPTY), "add_note").trigger()
    notes = list(shown.editor.project.notes.values())

    menu = right_click(shown, EMPTY + QPoint(20, 20))
    entry(menu, "delete_note").trigger()

    assert len(notes) == 1
    assert not shown.editor.project.notes


def test_an_empty_canvas_offers_nothing_to_select(desk):
    menu = right_click(desk(), EMPTY)

    assert not entry(menu, "select_all").isEnabled()
    assert not entry(menu, "fit").isEnabled()


def test_others_can_add_entries(shown):
    done = []
    shown.canvas.menu_sections.append(
        lambda canvas, place: [MenuEntry("mine", "Mine", lambda: done.append(place.hit.block))]
    )
    one = shown.body()[1]

    entry(menu_of(shown, one), "mine").trigger()

    assert done == [one]


@pytest.mark.parametrize("key", [(Qt.Key.Key_Menu, 0), (Qt.Key.Key_F10, 1)])
def test_the_menu_key_opens_the_menu_of_the_cursor(shown, key):
    one = shown.body()[1]
    shown.canvas.selection.set([one])
    shift = Qt.KeyboardModifier.ShiftModifier if key[1] else Qt.KeyboardModifier.NoModifier

    QTest.keyClick(shown.canvas, key[0], shift)

    assert shown.canvas.menu.isVisible()
    assert "delete" in names(shown.canvas.menu)


def test_the_right_button_that_ends_a_drag_opens_no_menu(shown):
    shown.carry(shown.body()[1], shown.corner(shown.body()[1]) + EMPTY)
    shown.mouse.press(shown.mouse.at, Qt.MouseButton.RightButton)

    right_click(shown, EMPTY)

    assert shown.canvas.menu is None
