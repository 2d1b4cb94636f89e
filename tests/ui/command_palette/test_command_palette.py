"""The command palette finds everything that the window can do, and does it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QAccessible
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from nep_studio.settings import Settings
from nep_studio.ui.shell.command_palette import CommandPalette, add_command_palette
from nep_studio.ui.shell.commands import Command
from nep_studio.ui.shell.main_window import MainWindow

Key = Qt.Key
CONTROL = Qt.KeyboardModifier.ControlModifier


def words(palette: CommandPalette) -> list[str]:
    return [row.command.words for row in palette.rows]


def type_in(palette: CommandPalette, text: str, qtbot: QtBot) -> None:
    palette.line.clear()
    qtbot.keyClicks(palette.line, text)


@pytest.mark.parametrize(
    ("key", "modifiers"),
    [(Key.Key_K, CONTROL), (Key.Key_P, CONTROL | Qt.KeyboardModifier.ShiftModifier)],
)
def test_keys_open_it_and_esc_goes_back_to_the_canvas(
    karate: MainWindow, palette: CommandPalette, qtbot: QtBot, key: Key, modifiers: object
) -> None:
    canvas = karate.workbench.canvas
    canvas.setFocus()

    qtbot.keyClick(canvas, key, modifiers)
    opened = palette.isVisible(), palette.line.hasFocus()
    qtbot.keyClick(palette.line, Key.Key_Escape)

    assert opened == (True, True)
    assert not palette.isVisible()
    assert canvas.hasFocus()


def test_it_has_every_action_panel_page_example_and_choice(
    karate: MainWindow, palette: CommandPalette
) -> None:
    palette.open()

    ids = {row.command.id for row in palette.rows}
    actions = {f"action:{name}" for name in karate.actions_by_name.by_name} - {"action:palette"}
    assert actions <= ids
    assert {f"panel:{panel.name}" for panel in karate.workbench.panels.all} <= ids
    assert {"page:behaviour", "page:robots", "example:karate_greeting"} <= ids
    assert {"choice:Theme:dark", "choice:Language:en"} <= ids


def test_enter_does_what_is_chosen(
    karate: MainWindow, palette: CommandPalette, qtbot: QtBot
) -> None:
    palette.open()
    type_in(palette, "dark", qtbot)

    qtbot.keyClick(palette.line, Key.Key_Return)

    assert karate.look.theme.name == "dark"
    assert not palette.isVisible()


def test_a_click_does_it_too(karate: MainWindow, palette: CommandPalette, qtbot: QtBot) -> None:
    palette.open()
    type_in(palette, "robots", qtbot)
    index = palette.model.index(words(palette).index("Robots"))
    centre = palette.list.visualRect(index).center()

    qtbot.mouseClick(palette.list.viewport(), Qt.MouseButton.LeftButton, pos=centre)

    assert karate.workbench.canvas.page == "robots"


def test_copying_from_the_palette_copies_the_blocks_that_were_selected(
    karate: MainWindow, palette: CommandPalette, qtbot: QtBot
) -> None:
    canvas, project = karate.workbench.canvas, karate.files.document.project
    canvas.setFocus()
    canvas.selection.set([project.pages["behaviour"][0].body[1]])
    palette.open()
    type_in(palette, "duplicate", qtbot)
    before = len(project.blocks)

    qtbot.keyClick(palette.line, Key.Key_Return)

    assert len(project.blocks) == before + 1


def test_what_cannot_be_used_says_why_and_does_nothing(
    karate: MainWindow, palette: CommandPalette, qtbot: QtBot
) -> None:
    karate.workbench.canvas.selection.clear()
    palette.open()
    type_in(palette, "cut", qtbot)

    qtbot.keyClick(palette.line, Key.Key_Return)

    assert words(palette)[0] == "Cut"
    assert palette.isVisible()
    assert palette.hint.text() == "Select a block first."
    assert palette.model.spoken(0).endswith("Select a block first.")


def test_without_a_project_it_says_to_open_one(window: MainWindow) -> None:
    palette = add_command_palette(window)
    palette.open()

    reasons = {row.command.id: row.command.why_not for row in palette.rows}
    assert reasons["action:save"] == "Open a project first."
    assert reasons["action:open"] == ""


def test_what_was_used_last_is_first_the_next_time(
    karate: MainWindow, palette: CommandPalette, qtbot: QtBot
) -> None:
    for typed in ("show all", "usual size"):
        palette.open()
        type_in(palette, typed, qtbot)
        qtbot.keyClick(palette.line, Key.Key_Return)

    palette.open()

    assert words(palette)[:2] == ["Usual size", "Show all"]
    assert Settings(karate.settings.folder).recent_commands[0] == "action:zoom_100"


def test_arrows_tab_and_pages_go_through_the_list(palette: CommandPalette, qtbot: QtBot) -> None:
    palette.open()
    rows = []

    for key in (Key.Key_Down, Key.Key_Tab, Key.Key_Up, Key.Key_PageDown, Key.Key_PageUp):
        qtbot.keyClick(palette.line, key)
        rows.append(palette.list.currentIndex().row())
    qtbot.keyClick(palette.line, Key.Key_Up)
    qtbot.keyClick(palette.line, Key.Key_Up)

    assert rows == [1, 2, 1, 12, 1]
    assert palette.list.currentIndex().row() == len(palette.rows) - 1
    assert palette.line.hasFocus()


def test_others_can_add_commands(palette: CommandPalette, qtbot: QtBot) -> None:
    done: list[str] = []
    help_page = Command("help:nao", "Connect a NAO", lambda: done.append("nao"), "Help")
    palette.add_source(lambda: [help_page])
    palette.open()

    type_in(palette, "connect nao", qtbot)
    qtbot.keyClick(palette.line, Key.Key_Return)

    assert done == ["nao"]


def test_nonsense_says_that_nothing_is_called_so(palette: CommandPalette, qtbot: QtBot) -> None:
    palette.open()

    type_in(palette, "qqqqq", qtbot)
    qtbot.keyClick(palette.line, Key.Key_Return)

    assert palette.hint.text() == "Nothing is called like that. Try fewer letters."
    assert palette.isVisible()


def test_a_click_elsewhere_closes_it(karate: MainWindow, palette: CommandPalette) -> None:
    palette.open()

    karate.workbench.canvas.setFocus(Qt.FocusReason.MouseFocusReason)

    assert not palette.isVisible()


def test_it_speaks_the_language_of_the_window(karate: MainWindow, qtbot: QtBot) -> None:
    karate.studio.choose_language("de")
    [palette] = karate.findChildren(CommandPalette)
    palette.open()

    type_in(palette, "dunkel", qtbot)
    qtbot.keyClick(palette.line, Key.Key_Return)

    assert karate.look.theme.name == "dark"


def test_a_screen_reader_finds_a_list_of_commands(palette: CommandPalette) -> None:
    palette.open()

    there = QAccessible.queryAccessibleInterface(palette.list)
    row = there.child(0)

    assert there.role() == QAccessible.Role.List
    assert row.text(QAccessible.Text.Name) == palette.model.spoken(0)


def test_it_stays_inside_a_small_window(karate: MainWindow, palette: CommandPalette) -> None:
    karate.resize(500, 400)
    palette.open()
    QApplication.processEvents()

    assert karate.rect().contains(palette.geometry())
