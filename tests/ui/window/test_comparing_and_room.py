"""Comparing with the file, panels in a narrow window, and the folder of file fields."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.ui.robot_view.view import RobotView
from nep_studio.ui.shell.help_dialogs import ComparingDialog
from nep_studio.ui.shell.main_window import MainWindow

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def saved(karate: MainWindow, chooser, tmp_path: Path) -> MainWindow:
    chooser.path = tmp_path / "one" / "mine.nep"
    chooser.path.parent.mkdir()
    karate.files.save_as()
    return karate


def compared(window: MainWindow) -> ComparingDialog:
    window.actions_by_name["compare"].trigger()
    dialogs = window.findChildren(ComparingDialog)
    assert len(dialogs) == 1
    return dialogs[0]


def say_block(window: MainWindow) -> str:
    blocks = window.files.document.project.blocks.values()
    return next(block.id for block in blocks if block.fields.get("text") == "Impressive!")


def test_comparing_is_offered_when_there_is_a_file_and_a_change(saved):
    action = saved.actions_by_name["compare"]
    before = action.isEnabled()

    saved.files.document.editor.apply(SetField(say_block(saved), "text", "Wow"))

    assert not before
    assert action.isEnabled()
    saved.files.save()
    assert not action.isEnabled()


def test_a_click_on_a_difference_shows_its_block(saved, qtbot: QtBot):
    block = say_block(saved)
    saved.files.document.editor.apply(SetField(block, "text", "Wow"))

    dialog = compared(saved)
    place = dialog.list.visualItemRect(dialog.list.item(0)).center()
    qtbot.mouseClick(dialog.list.viewport(), LEFT, pos=place)

    assert dialog.list.count() == 1
    assert "Impressive!" in dialog.list.item(0).text()
    assert "Wow" in dialog.list.item(0).text()
    assert saved.workbench.canvas.selection.ids == (block,)


def test_a_block_that_is_gone_is_listed_and_a_click_does_no_harm(saved, qtbot: QtBot):
    block = say_block(saved)
    saved.files.document.editor.apply(DeleteBlocks(block))

    dialog = compared(saved)
    place = dialog.list.visualItemRect(dialog.list.item(0)).center()
    qtbot.mouseClick(dialog.list.viewport(), LEFT, pos=place)

    assert dialog.list.item(0).text().startswith("Taken away: ")


def test_when_no_block_differs_a_sentence_says_so(saved):
    saved.files.document.editor.apply(RenameProject("Another name"))

    dialog = compared(saved)

    assert not dialog.list.isVisible()
    assert "The blocks say the same" in dialog.words.text()


def started(studio, chooser, width: int, qtbot: QtBot) -> MainWindow:
    window = MainWindow(studio, chooser)
    qtbot.addWidget(window)
    window.resize(width, 700)
    window.show()
    window.start(None)
    window.files.new()
    qtbot.waitExposed(window)
    return window


def end(window: MainWindow) -> None:
    window.workbench.retire()
    window.files.document.close()
    window.files.document = None


def test_a_narrow_window_begins_with_room_for_the_page(studio, chooser, qtbot: QtBot):
    window = started(studio, chooser, 850, qtbot)

    assert window.workbench.helpers.palette.is_narrow
    assert not window.workbench.code.isVisible()
    assert window.workbench.canvas.width() > 500
    assert not studio.settings.is_chosen("CodePane")
    end(window)


def test_a_small_screen_has_room_for_the_window_with_words_of_twice_the_size(
    studio, chooser, qtbot: QtBot
):
    studio.look.set_scale(2.0)
    window = MainWindow(studio, chooser)
    qtbot.addWidget(window)
    window.show()
    window.start(None)

    assert window.minimumSizeHint().height() < 700
    studio.look.set_scale(1.0)


def test_a_wide_window_begins_with_blocks_and_stage(studio, chooser, qtbot: QtBot):
    window = started(studio, chooser, 1300, qtbot)

    assert not window.workbench.helpers.palette.is_narrow
    assert window.workbench.panels.areas["stage"].isVisible()
    assert not window.workbench.code.isVisible()
    end(window)


def test_what_a_person_chose_is_there_again_in_a_narrow_window(studio, chooser, qtbot: QtBot):
    first = started(studio, chooser, 850, qtbot)
    qtbot.mouseClick(first.workbench.helpers.palette.fold, LEFT)
    first.workbench.panels.show(first.workbench.code)
    end(first)

    second = started(studio, chooser, 850, qtbot)

    assert not second.workbench.helpers.palette.is_narrow
    assert second.workbench.code.isVisible()
    end(second)


def right_of_palette(window: MainWindow) -> int:
    """Where the page begins, from where the palette ends."""
    canvas, palette = window.workbench.canvas, window.workbench.helpers.palette
    end_of_palette = palette.mapTo(window, QPoint(palette.width(), 0)).x()
    return canvas.mapTo(window, QPoint()).x() - end_of_palette


def test_a_folded_palette_gives_its_room_to_the_page_also_after_a_restart(
    studio, chooser, qtbot: QtBot
):
    first = started(studio, chooser, 1280, qtbot)
    before = first.workbench.canvas.width()
    palette = first.workbench.helpers.palette
    freed = palette.width()
    qtbot.mouseClick(palette.fold, LEFT)
    qtbot.waitUntil(lambda: right_of_palette(first) < 10)
    freed -= palette.width()
    gained = first.workbench.canvas.width() - before
    first.workbench.panels.remember()
    end(first)

    second = started(studio, chooser, 1280, qtbot)

    assert abs(gained - freed) < 5 and freed > 150
    assert second.workbench.helpers.palette.is_narrow
    qtbot.waitUntil(lambda: right_of_palette(second) < 10)
    qtbot.mouseClick(second.workbench.helpers.palette.fold, LEFT)
    qtbot.waitUntil(lambda: second.workbench.helpers.palette.width() > 200)
    assert right_of_palette(second) < 10
    end(second)


def test_the_first_blocks_leave_more_than_half_of_a_small_screen_to_the_page(
    studio, chooser, qtbot: QtBot
):
    window = started(studio, chooser, 1280, qtbot)
    palette = window.workbench.helpers.palette
    few = palette.width()
    qtbot.mouseClick(palette.levels.buttons["all"], LEFT)
    many = palette.width()
    qtbot.mouseClick(palette.levels.buttons["first"], LEFT)

    assert few < 260 < many
    assert abs(palette.width() - few) < 10
    assert window.width() - few - 270 >= 0.55 * window.width()
    end(window)


def test_the_first_window_gives_the_page_the_most_and_the_robot_its_place(
    studio, chooser, qtbot: QtBot
):
    window = started(studio, chooser, 1280, qtbot)
    workbench = window.workbench
    qtbot.waitUntil(lambda: workbench.canvas.width() >= 0.55 * window.width())

    stage = workbench.panels.areas["stage"]
    small = stage.width()
    assert stage.x() + stage.mapTo(window, QPoint()).x() > workbench.canvas.width()
    assert small >= 0.18 * window.width()

    window.resize(1920, 1000)
    qtbot.waitUntil(lambda: stage.width() > 1.3 * small)
    assert workbench.canvas.width() >= 0.55 * window.width()
    end(window)


def test_the_person_is_under_the_robot_and_both_are_seen_whole(studio, chooser, qtbot: QtBot):
    window = started(studio, chooser, 1366, qtbot)
    panels = window.workbench.panels
    person = next(one for one in panels.all if one.title == "Person")
    panels.show(person.widget)
    stage, below = panels.areas["stage"], panels.areas["person"]
    qtbot.waitUntil(lambda: below.height() > 150)

    view = window.findChild(RobotView)
    assert stage.mapTo(window, QPoint()).y() < below.mapTo(window, QPoint()).y()
    assert stage.width() == below.width()
    assert view.isVisible() and view.height() > 120
    end(window)


def test_where_a_border_was_moved_is_kept(studio, chooser, qtbot: QtBot):
    first = started(studio, chooser, 1280, qtbot)
    row = first.workbench.panels.row
    handle = row.handle(3)
    qtbot.mousePress(handle, LEFT, pos=handle.rect().center())
    for step in (20, 60, 100):
        qtbot.mouseMove(handle, handle.rect().center() - QPoint(step, 0))
    qtbot.mouseRelease(handle, LEFT, pos=handle.rect().center())
    chosen = first.workbench.panels.areas["stage"].width()
    first.workbench.panels.remember()
    end(first)

    second = started(studio, chooser, 1280, qtbot)

    assert chosen > 300
    qtbot.waitUntil(lambda: second.workbench.panels.areas["stage"].width() == chosen)
    end(second)


def test_a_laptop_at_125_percent_shows_the_first_blocks(studio, chooser, qtbot: QtBot):
    window = started(studio, chooser, 1093, qtbot)

    assert not window.workbench.helpers.palette.is_narrow
    assert window.workbench.canvas.width() >= 0.5 * window.width()
    end(window)
