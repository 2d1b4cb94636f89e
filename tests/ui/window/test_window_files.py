"""Projects are opened, saved and closed, and nothing unsaved goes without a question."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from PySide6.QtWidgets import QDialog, QMenu
from pytestqt.qtbot import QtBot

from nep_studio import paths
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.shell.menus import fill_recent

KARATE = paths.examples() / "karate_greeting.nep"
Answer = Callable[[object, str], None]


def press(qtbot: QtBot, window: MainWindow, key: Qt.Key, shift: bool = False) -> None:
    modifiers = Qt.KeyboardModifier.ControlModifier
    if shift:
        modifiers |= Qt.KeyboardModifier.ShiftModifier
    qtbot.keyClick(window.workbench.canvas, key, modifiers)


def change(window: MainWindow, name: str = "Another name") -> None:
    window.files.document.editor.apply(RenameProject(name))


def questions(window: MainWindow) -> list[QDialog]:
    return [dialog for dialog in window.findChildren(QDialog) if dialog.isVisible()]


def test_new_from_the_start_page_shows_an_empty_canvas(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.mouseClick(window.start_page.new_button, Qt.MouseButton.LeftButton)

    assert window.workbench.canvas.isVisible()
    assert window.files.document.project.pages["behaviour"] == []
    assert not window.isWindowModified()


def test_an_example_opens_as_a_copy(karate: MainWindow) -> None:
    assert karate.files.document.path is None
    assert "Karate greeting" in karate.windowTitle()
    assert not karate.files.document.is_modified


def test_an_example_card_is_clicked(window: MainWindow, qtbot: QtBot) -> None:
    card = window.start_page.cards[KARATE]

    qtbot.mouseClick(card, Qt.MouseButton.LeftButton)

    assert window.files.document.project.name == "Karate greeting"


def test_ctrl_s_saves_where_the_person_says_and_then_without_asking(
    karate: MainWindow, chooser, tmp_path: Path, qtbot: QtBot
) -> None:
    chooser.path = tmp_path / "mine"

    press(qtbot, karate, Qt.Key.Key_S)
    change(karate)
    chooser.path = None
    press(qtbot, karate, Qt.Key.Key_S)

    saved = json.loads((tmp_path / "mine.nep").read_text(encoding="utf-8"))
    assert saved["name"] == "Another name"
    assert not karate.isWindowModified()
    assert karate.settings.recent_files == [tmp_path / "mine.nep"]


def test_the_title_says_whether_the_project_is_saved(karate: MainWindow, qtbot: QtBot) -> None:
    change(karate)
    was_modified = karate.isWindowModified()
    press(qtbot, karate, Qt.Key.Key_Z)

    assert was_modified
    assert not karate.isWindowModified()


def test_redo_back_to_what_was_saved_is_not_a_change(
    karate: MainWindow, chooser, tmp_path: Path, qtbot: QtBot
) -> None:
    change(karate)
    chooser.path = tmp_path / "mine.nep"
    press(qtbot, karate, Qt.Key.Key_S)

    press(qtbot, karate, Qt.Key.Key_Z)
    was_modified = karate.isWindowModified()
    press(qtbot, karate, Qt.Key.Key_Y)

    assert was_modified
    assert not karate.isWindowModified()


def test_closing_an_unsaved_project_asks_and_cancel_keeps_it(
    karate: MainWindow, answer: Answer
) -> None:
    change(karate)

    karate.close()
    answer(karate, "Cancel")

    assert karate.isVisible()
    assert karate.files.document.is_modified


def test_closing_without_saving_closes(karate: MainWindow, answer: Answer, qtbot: QtBot) -> None:
    change(karate)

    karate.close()
    answer(karate, "Don't save")

    qtbot.waitUntil(lambda: not karate.isVisible())


def test_save_in_the_question_saves_and_then_closes(
    karate: MainWindow, answer: Answer, chooser, tmp_path: Path, qtbot: QtBot
) -> None:
    chooser.path = tmp_path / "kept.nep"
    change(karate)

    karate.close()
    answer(karate, "Save")

    qtbot.waitUntil(lambda: not karate.isVisible())
    assert (tmp_path / "kept.nep").exists()


def test_a_save_that_fails_keeps_the_window_open(
    karate: MainWindow, answer: Answer, chooser, tmp_path: Path
) -> None:
    chooser.path = tmp_path / "no such folder" / "kept.nep"
    change(karate)

    karate.close()
    answer(karate, "Save")

    [card] = karate.message_area.cards
    assert "could not be saved" in card.message.sentence
    assert card.message.checklist
    assert karate.isVisible()
    assert karate.files.document.is_modified


def test_new_and_open_guard_unsaved_work_too(
    karate: MainWindow, answer: Answer, chooser, qtbot: QtBot
) -> None:
    chooser.path = KARATE
    change(karate)

    for key in (Qt.Key.Key_N, Qt.Key.Key_O):
        press(qtbot, karate, key)
        assert len(questions(karate)) == 1
        answer(karate, "Cancel")
        qtbot.waitUntil(lambda: not questions(karate))

    assert karate.files.document.project.name == "Another name"


def test_a_file_that_others_have_changed_is_not_overwritten_unasked(
    karate: MainWindow, answer: Answer, chooser, tmp_path: Path, qtbot: QtBot
) -> None:
    chooser.path = mine = tmp_path / "mine.nep"
    press(qtbot, karate, Qt.Key.Key_S)
    mine.write_text("somebody else's work", encoding="utf-8")
    os.utime(mine, (1, 1))
    change(karate)

    press(qtbot, karate, Qt.Key.Key_S)
    answer(karate, "Cancel")

    assert mine.read_text(encoding="utf-8") == "somebody else's work"
    assert karate.files.document.is_modified


def test_a_bad_file_is_told_with_a_checklist_and_the_open_project_stays(
    karate: MainWindow, tmp_path: Path
) -> None:
    bad = tmp_path / "bad.nep"
    bad.write_bytes(KARATE.read_bytes()[:500])

    karate.files.open(bad)

    [card] = karate.message_area.cards
    assert "bad.nep" in card.message.sentence
    assert card.message.checklist
    assert karate.files.document.project.name == "Karate greeting"


def test_a_missing_recent_project_is_grey_and_says_why(window: MainWindow, tmp_path: Path) -> None:
    there = tmp_path / "there.nep"
    there.write_bytes(KARATE.read_bytes())
    window.settings.add_recent(tmp_path / "gone.nep")
    window.settings.add_recent(there)
    menu = QMenu(window)

    fill_recent(menu, window)

    first, second = menu.actions()
    assert (first.text(), first.isEnabled()) == ("there", True)
    assert (second.text(), second.isEnabled()) == ("gone (not there any more)", False)


def test_a_file_dropped_onto_the_window_opens(window: MainWindow, tmp_path: Path) -> None:
    file = tmp_path / "dropped.nep"
    file.write_bytes(KARATE.read_bytes())
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(file))])
    buttons, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    drop = QDropEvent(QPointF(9, 9), Qt.DropAction.CopyAction, data, buttons, keys)

    window.dropEvent(drop)

    assert window.files.document.path == file


def test_a_huge_file_opens_while_the_window_answers(
    window: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    file = huge_file(tmp_path)
    window.files.open(file)

    window.files._opening.became_slow.emit()
    [card] = window.message_area.cards

    assert card.message.is_busy
    qtbot.waitUntil(lambda: window.files.document is not None, timeout=30_000)
    assert not window.message_area.cards


def test_opening_a_huge_file_can_be_stopped(
    window: MainWindow, tmp_path: Path, qtbot: QtBot
) -> None:
    window.files.open(huge_file(tmp_path))
    opening = window.files._opening
    opening.became_slow.emit()

    qtbot.mouseClick(window.message_area.cards[0].buttons[0], Qt.MouseButton.LeftButton)

    assert window.files._opening is None
    assert window.files.document is None
    assert not window.message_area.cards


def huge_file(folder: Path) -> Path:
    """The karate example with a number of empty texts at its end, larger than is read at once."""
    project = json.loads(KARATE.read_text(encoding="utf-8"))
    stacks = project["pages"]["behaviour"]
    for number in range(5000):
        block, stack = f"bx{number}", f"sx{number}"
        project["blocks"].append({"id": block, "type": "control.wait", "comment": "x" * 50})
        stacks.append({"id": stack, "x": 40, "y": 50 * number, "body": [block]})
    file = folder / "huge.nep"
    file.write_text(json.dumps(project), encoding="utf-8")
    return file
