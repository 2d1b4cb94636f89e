"""The tabs of the pages: show, add, rename, move and delete, each undone in one step."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QMenu, QTabBar
from pytestqt.qtbot import QtBot

from nep_studio.ui.shell.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def bar(karate: MainWindow):
    return karate.workbench.pages_bar


def titles(bar) -> list[str]:
    """Of the pages, whether they have a tab or not."""
    return [bar.tabs.tabText(index) for index in range(bar.tabs.count())]


def seen(bar) -> list[str]:
    return [title for index, title in enumerate(titles(bar)) if bar.tabs.isTabVisible(index)]


def choose(bar, words: str, qtbot: QtBot) -> None:
    """Open the menu of the plus with the mouse, and choose from it."""
    qtbot.mouseClick(bar.add_button, LEFT)
    menu = QApplication.activePopupWidget()
    assert isinstance(menu, QMenu)
    action = next(one for one in menu.actions() if one.text() == words)
    qtbot.mouseClick(menu, LEFT, pos=menu.actionGeometry(action).center())


def close_button(bar, title: str):
    return bar.tabs.tabButton(titles(bar).index(title), QTabBar.ButtonPosition.RightSide)


def test_a_project_begins_with_its_behaviour_alone(bar) -> None:
    assert titles(bar) == ["Behaviour", "Robots", "Nodes"]
    assert seen(bar) == ["Behaviour"]


def test_a_page_for_setting_up_comes_when_somebody_wants_it_and_goes_again(
    karate: MainWindow, bar, qtbot: QtBot
) -> None:
    choose(bar, "Nodes", qtbot)
    assert seen(bar) == ["Behaviour", "Nodes"]
    assert karate.workbench.canvas.page == "nodes"

    qtbot.mouseClick(close_button(bar, "Nodes"), LEFT)

    assert seen(bar) == ["Behaviour"]
    assert karate.workbench.canvas.page == "behaviour"


@pytest.mark.parametrize("room", ["Gestures", "Sensors", "Network", "Motion"])
def test_a_room_has_the_whole_page_beside_the_robot(
    karate: MainWindow, bar, qtbot: QtBot, room: str
) -> None:
    workbench = karate.workbench
    choose(bar, room, qtbot)

    shown = workbench.rooms.shown
    assert shown is not None and shown.isVisible() and seen(bar) == ["Behaviour", room]
    assert not workbench.canvas.isVisible() and not workbench.helpers.palette.isVisible()
    is_beside = room != "Motion"  # which shows a robot itself
    assert workbench.panels.areas["stage"].isVisible() == is_beside
    assert shown.width() >= 0.7 * workbench.width()
    focus = QApplication.focusWidget()
    assert focus is not None and shown.isAncestorOf(focus)

    qtbot.mouseClick(bar.tabs, LEFT, pos=bar.tabs.tabRect(0).center())
    assert workbench.canvas.isVisible() and workbench.helpers.palette.isVisible()
    qtbot.mouseClick(bar.tabs, LEFT, pos=bar.tabs.tabRect(3).center())
    assert shown.isVisible()
    qtbot.mouseClick(close_button(bar, room), LEFT)
    assert workbench.canvas.isVisible() and seen(bar) == ["Behaviour"]


def test_a_message_leaves_the_room_that_is_open(karate: MainWindow, bar, qtbot: QtBot) -> None:
    canvas = karate.workbench.canvas
    qtbot.mouseClick(
        canvas.viewport(), LEFT, pos=canvas.sight.view_rect_of("b4").center().toPoint()
    )
    choose(bar, "Gestures", qtbot)
    room = karate.workbench.rooms.shown

    karate.messages.confirm("“watch” is ready")
    karate.workbench.show_change("b4", "Done: something")

    qtbot.waitUntil(lambda: len(karate.message_area.cards) == 2)
    assert karate.workbench.rooms.shown is room and not canvas.isVisible()


def test_delete_in_a_room_leaves_the_blocks_alone(karate: MainWindow, bar, qtbot: QtBot) -> None:
    canvas = karate.workbench.canvas
    block = karate.files.document.project.pages["behaviour"][0].body[1]
    canvas.selection.set([block])
    choose(bar, "Network", qtbot)

    qtbot.keyClick(karate.workbench.rooms.shown, Qt.Key.Key_Delete)

    assert block in karate.files.document.project.blocks
    assert not karate.actions_by_name["delete"].isEnabled()
    canvas.show_block(block)
    assert canvas.isVisible()


def test_a_click_shows_a_page(karate: MainWindow, bar, qtbot: QtBot) -> None:
    choose(bar, "Robots", qtbot)
    qtbot.mouseClick(bar.tabs, LEFT, pos=bar.tabs.tabRect(0).center())
    assert karate.workbench.canvas.page == "behaviour"
    qtbot.mouseClick(bar.tabs, LEFT, pos=bar.tabs.tabRect(1).center())

    assert karate.workbench.canvas.page == "robots"


def test_plus_adds_a_page_for_behaviour_and_shows_it(karate: MainWindow, bar, qtbot: QtBot) -> None:
    choose(bar, "New page for behaviour", qtbot)

    assert titles(bar) == ["Behaviour", "Behaviour 2", "Robots", "Nodes"]
    assert karate.workbench.canvas.page == list(karate.files.document.project.pages)[1]


def test_plus_adds_a_page_on_which_a_behaviour_tree_is_begun(
    karate: MainWindow, bar, qtbot: QtBot
) -> None:
    choose(bar, "New page for a behaviour tree", qtbot)
    choose(bar, "New page for a behaviour tree", qtbot)

    project = karate.files.document.project
    page = list(project.pages)[2]
    assert titles(bar)[:3] == ["Behaviour", "Behaviour tree", "Behaviour tree 2"]
    assert karate.workbench.canvas.page == page
    stack = project.pages[page][0]
    assert [project.blocks[block].type for block in stack.body] == ["tree.tree", "tree.sequence"]
    categories = karate.workbench.helpers.palette.categories
    qtbot.waitUntil(lambda: categories.buttons["tree"].isChecked())  # what goes in is at hand

    karate.actions_by_name["undo"].trigger()

    assert titles(bar)[:3] == ["Behaviour", "Behaviour tree", "Robots"]


def test_undo_takes_an_added_page_away_and_shows_the_first(
    karate: MainWindow, bar, qtbot: QtBot
) -> None:
    choose(bar, "New page for behaviour", qtbot)

    karate.actions_by_name["undo"].trigger()

    assert titles(bar) == ["Behaviour", "Robots", "Nodes"]
    assert karate.workbench.canvas.page == "behaviour"


def test_a_double_click_renames_a_page(bar, qtbot: QtBot) -> None:
    qtbot.mouseDClick(bar.tabs, LEFT, pos=bar.tabs.tabRect(0).center())
    qtbot.keyClicks(bar.tabs.title_edit, "Greeting")
    qtbot.keyClick(bar.tabs.title_edit, Qt.Key.Key_Return)

    assert titles(bar) == ["Greeting", "Robots", "Nodes"]


def test_esc_leaves_the_title_as_it_was(karate: MainWindow, bar, qtbot: QtBot) -> None:
    qtbot.mouseDClick(bar.tabs, LEFT, pos=bar.tabs.tabRect(0).center())
    qtbot.keyClicks(bar.tabs.title_edit, "Greeting")
    qtbot.keyClick(bar.tabs.title_edit, Qt.Key.Key_Escape)

    assert titles(bar) == ["Behaviour", "Robots", "Nodes"]
    assert not karate.files.document.is_modified


def test_a_page_is_moved_and_stays_shown(karate: MainWindow, bar, qtbot: QtBot) -> None:
    right = next(a for a in bar.menu(0).actions() if a.text() == "Move right")

    right.trigger()

    assert titles(bar) == ["Robots", "Behaviour", "Nodes"]
    assert bar.tabs.currentIndex() == 1
    assert karate.workbench.canvas.page == "behaviour"


def test_a_tab_is_dragged_to_another_place(karate: MainWindow, bar, qtbot: QtBot) -> None:
    choose(bar, "Robots", qtbot)
    start, end = bar.tabs.tabRect(0).center(), bar.tabs.tabRect(1).center()

    qtbot.mousePress(bar.tabs, LEFT, pos=start)
    for step in range(1, 11):
        qtbot.mouseMove(bar.tabs, start + (end - start) * step / 10)
    qtbot.mouseRelease(bar.tabs, LEFT, pos=end)

    assert list(karate.files.document.project.pages) == ["robots", "behaviour", "nodes"]


def test_deleting_a_page_takes_its_blocks_and_undo_brings_them_back(
    karate: MainWindow, bar, qtbot: QtBot
) -> None:
    project, editor = karate.files.document.project, karate.files.document.editor
    choose(bar, "New page for behaviour", qtbot)
    page = list(project.pages)[1]
    editor.create("control.wait", editor.new_stack(page, 40, 40))

    delete = next(a for a in bar.menu(1).actions() if a.text() == "Delete the page")
    delete.trigger()
    were = titles(bar)
    karate.actions_by_name["undo"].trigger()

    assert were == ["Behaviour", "Robots", "Nodes"]
    assert len(project.pages[page]) == 1


def test_the_three_pages_of_every_project_cannot_be_deleted(bar) -> None:
    delete = next(a for a in bar.menu(0).actions() if a.text() == "Delete the page")

    assert not delete.isEnabled()
