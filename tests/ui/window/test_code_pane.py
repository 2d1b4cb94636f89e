"""The Python beside the blocks: live, found by its blocks, and turned back into them."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QGuiApplication, QTextCursor
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.project import RenameProject
from nep_studio.blocks.generate.program import generate_program
from nep_studio.ui.shell.main_window import MainWindow


@pytest.fixture(autouse=True)
def shown(karate_in_python: MainWindow) -> None:
    """The Python is closed at first."""


def say_block(window: MainWindow, text: str = "Impressive!") -> str:
    blocks = window.files.document.project.blocks.values()
    return next(block.id for block in blocks if block.fields.get("text") == text)


def line_of(window: MainWindow, words: str) -> int:
    lines = window.workbench.code.text.toPlainText().split("\n")
    return next(number for number, line in enumerate(lines, start=1) if words in line)


def click_line(window: MainWindow, line: int, qtbot: QtBot) -> None:
    text = window.workbench.code.text
    block = text.document().findBlockByNumber(line - 1)
    place = text.cursorRect(QTextCursor(block)).center() + QPoint(20, 0)
    qtbot.mouseClick(text.viewport(), Qt.MouseButton.LeftButton, pos=place)


def marked_lines(window: MainWindow) -> list[int]:
    marks = window.workbench.code.text.extraSelections()
    return [mark.cursor.blockNumber() + 1 for mark in marks]


def test_the_code_is_that_of_the_blocks(karate: MainWindow) -> None:
    editor = karate.files.document.editor
    text = generate_program(editor.project, editor.language).text

    assert karate.workbench.code.text.toPlainText() + "\n" == text


def test_an_edit_changes_the_code_before_long(karate: MainWindow, qtbot: QtBot) -> None:
    editor = karate.files.document.editor

    editor.apply(SetField(say_block(karate), "text", "Wow 🤖"))

    qtbot.waitUntil(lambda: 'nao.say("Wow 🤖")' in karate.workbench.code.text.toPlainText())
    text = generate_program(editor.project, editor.language).text
    assert karate.workbench.code.text.toPlainText() + "\n" == text


def test_the_code_that_is_seen_is_the_program_until_that_is_changed(
    karate: MainWindow, qtbot: QtBot
) -> None:
    editor, live = karate.files.document.editor, karate.workbench.code.live
    assert live.program == generate_program(editor.project, editor.language)

    editor.apply(SetField(say_block(karate), "text", "Wow"))

    assert live.program is None
    qtbot.waitUntil(lambda: live.program is not None)
    assert 'nao.say("Wow")' in live.program.text


def test_a_click_on_a_line_selects_its_block(karate: MainWindow, qtbot: QtBot) -> None:
    click_line(karate, line_of(karate, "Impressive!"), qtbot)

    assert karate.workbench.canvas.selection.ids == (say_block(karate),)


def test_selecting_a_block_marks_its_lines(karate: MainWindow) -> None:
    karate.workbench.canvas.selection.set([say_block(karate)])

    assert marked_lines(karate) == [line_of(karate, "Impressive!")]


def test_a_page_of_robots_shows_what_starts_them(karate: MainWindow, qtbot: QtBot) -> None:
    karate.workbench.canvas.show_page("robots")

    qtbot.waitUntil(lambda: "launcher.start" in karate.workbench.code.text.toPlainText())
    assert not karate.workbench.code.edit_button.isVisible()


def test_copy_puts_the_code_on_the_clipboard(karate: MainWindow, qtbot: QtBot) -> None:
    code = karate.workbench.code
    qtbot.waitUntil(lambda: "behavior.run()" in code.text.toPlainText())

    qtbot.mouseClick(code.copy_button, Qt.MouseButton.LeftButton)

    assert QGuiApplication.clipboard().text().endswith("behavior.run()\n")


def replace(karate: MainWindow, old: str, new: str, qtbot: QtBot) -> None:
    """Type over a part of the text."""
    text = karate.workbench.code.text
    assert text.find(old) or (text.moveCursor(QTextCursor.MoveOperation.Start) or text.find(old))
    qtbot.keyClicks(text, new)


def test_edited_code_becomes_blocks_in_one_step(karate: MainWindow, qtbot: QtBot) -> None:
    block, code = say_block(karate), karate.workbench.code

    qtbot.mouseClick(code.edit_button, Qt.MouseButton.LeftButton)
    replace(karate, "Impressive!", "Superb", qtbot)
    qtbot.mouseClick(code.apply_button, Qt.MouseButton.LeftButton)

    project = karate.files.document.project
    assert not code.is_editing
    assert any(b.fields.get("text") == "Superb" for b in project.blocks.values())
    karate.files.document.editor.history.undo()
    assert project.blocks[block].fields["text"] == "Impressive!"


def test_wrong_code_changes_nothing_and_is_marked_at_its_line(
    karate: MainWindow, qtbot: QtBot
) -> None:
    code, before = karate.workbench.code, karate.files.document.editor.history.position

    qtbot.mouseClick(code.edit_button, Qt.MouseButton.LeftButton)
    replace(karate, 'nao.say("Impressive!")', "nao.say((", qtbot)
    qtbot.mouseClick(code.apply_button, Qt.MouseButton.LeftButton)

    assert code.is_editing
    assert code.note.isVisible()
    assert marked_lines(karate)
    assert karate.files.document.editor.history.position == before


def test_discard_shows_the_code_of_the_blocks_again(karate: MainWindow, qtbot: QtBot) -> None:
    code, before = karate.workbench.code, karate.workbench.code.text.toPlainText()

    qtbot.mouseClick(code.edit_button, Qt.MouseButton.LeftButton)
    qtbot.keyClicks(code.text, "nonsense")
    qtbot.mouseClick(code.discard_button, Qt.MouseButton.LeftButton)

    assert code.text.toPlainText() == before
    assert not karate.isWindowModified()


def test_a_block_that_cannot_become_code_is_told_and_shown(
    karate: MainWindow, qtbot: QtBot
) -> None:
    editor, code = karate.files.document.editor, karate.workbench.code
    block = editor.project.blocks[say_block(karate)]
    block.type = "unknown.block"  # as in a file of a newer version
    editor.project.touch(editor.project.stack_of(block.id).id, block.id)
    editor.apply(RenameProject("Anew"))

    qtbot.waitUntil(code.note.isVisible)


def test_hidden_code_is_not_computed(karate: MainWindow, qtbot: QtBot) -> None:
    code = karate.workbench.code
    karate.workbench.panels.show(karate.workbench.outline)
    made = []
    code.live.made.connect(made.append)

    karate.files.document.editor.apply(RenameProject("Quiet"))
    was_busy = code.live._next_frame.isActive()
    karate.workbench.panels.show(code)

    assert not was_busy
    assert len(made) == 1  # when it was shown again
    assert "Quiet" in code.text.toPlainText()
