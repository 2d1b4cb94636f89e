"""Writing Python in the code pane, and the Python of a very large program."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QTextCursor
from pytestqt.qtbot import QtBot

from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.generate.program import generate_program
from nep_studio.ui.shell.main_window import MainWindow
from nep_studio.ui.workbench.code_text import CodeText
from tests.blocks.block_building import B, build

KEY, CONTROL = Qt.Key, Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def text(studio, qtbot: QtBot) -> CodeText:
    made = CodeText(studio.look)
    qtbot.addWidget(made)
    made.show_text("def greet():\n    say()\n    wave()\n")
    made.set_editable(True)
    return made


def select(text: CodeText, start: int, end: int) -> None:
    cursor = text.textCursor()
    cursor.setPosition(start)
    cursor.setPosition(end, QTextCursor.MoveMode.KeepAnchor)
    text.setTextCursor(cursor)


def test_enter_keeps_the_indentation_and_goes_deeper_after_a_colon(text, qtbot):
    select(text, 12, 12)

    qtbot.keyClick(text, KEY.Key_Return)
    qtbot.keyClicks(text, "if tired:")
    qtbot.keyClick(text, KEY.Key_Return)
    qtbot.keyClicks(text, "rest()  # all:")
    qtbot.keyClick(text, KEY.Key_Return)
    qtbot.keyClicks(text, "x")

    expected = ["def greet():", "    if tired:", "        rest()  # all:", "        x", "    say()"]
    assert text.toPlainText().split("\n")[:5] == expected


def test_tab_indents_the_selected_lines_and_shift_tab_takes_it_back(text, qtbot):
    before = text.toPlainText()
    select(text, 15, len(before))

    qtbot.keyClick(text, KEY.Key_Tab)
    deeper = text.toPlainText()
    qtbot.keyClick(text, KEY.Key_Backtab, Qt.KeyboardModifier.ShiftModifier)

    assert deeper == "def greet():\n        say()\n        wave()"
    assert text.toPlainText() == before


def test_tab_without_a_selection_goes_to_the_next_stop(text, qtbot):
    select(text, 14, 14)

    qtbot.keyClick(text, KEY.Key_Tab)

    assert text.toPlainText().split("\n")[1] == "       say()"


def test_control_slash_makes_comments_and_code_again(text, qtbot):
    before = text.toPlainText()
    select(text, 15, len(before))

    qtbot.keyClick(text, KEY.Key_Slash, CONTROL)
    commented = text.toPlainText()
    qtbot.keyClick(text, KEY.Key_Slash, CONTROL)

    assert commented == "def greet():\n    # say()\n    # wave()"
    assert text.toPlainText() == before


def test_one_undo_takes_all_lines_back(text, qtbot):
    before = text.toPlainText()
    select(text, 0, len(before))

    qtbot.keyClick(text, KEY.Key_Tab)
    qtbot.keyClick(text, KEY.Key_Z, CONTROL)

    assert text.toPlainText() == before


def test_a_text_that_is_only_read_takes_no_keys(text, qtbot):
    before = text.toPlainText()
    text.set_editable(False)

    qtbot.keyClick(text, KEY.Key_Return)
    qtbot.keyClick(text, KEY.Key_Slash, CONTROL)

    assert text.toPlainText() == before


@pytest.fixture
def large(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """A window with a program of thousands of blocks, and its Python beside it."""
    window.files.new()
    window.workbench.panels.show(window.workbench.code)
    editor = window.files.document.editor
    rule = [B("event.started"), *(B("robot.say", {"text": f"line {n}"}) for n in range(400))]
    with editor.transaction("paste"):
        build(editor.language, *([rule] * 12), editor=editor)
    return window


def test_long_code_is_made_in_slices_and_is_that_of_the_blocks(large: MainWindow, qtbot):
    live, editor = large.workbench.code.live, large.files.document.editor
    began = []
    live.began.connect(lambda: began.append(large.workbench.code.title.text()))
    live._generator = None

    live.start()

    assert began
    expected = generate_program(editor.project, editor.language).text
    qtbot.waitUntil(lambda: live.code is not None and live.code.text == expected)
    shown = large.workbench.code.text
    qtbot.waitUntil(lambda: shown.toPlainText() + "\n" == expected)


def test_an_edit_while_long_code_is_made_is_in_it(large: MainWindow, qtbot):
    live, editor = large.workbench.code.live, large.files.document.editor
    live._generator = None
    live.start()
    block = next(b for b in editor.project.blocks.values() if b.type == "robot.say")

    editor.apply(SetField(block.id, "text", "changed meanwhile"))

    shown = large.workbench.code.text
    qtbot.waitUntil(lambda: "changed meanwhile" in shown.toPlainText())
    expected = generate_program(editor.project, editor.language).text
    qtbot.waitUntil(lambda: shown.toPlainText() + "\n" == expected)


def test_changing_long_code_begins_with_all_of_it(large: MainWindow, qtbot):
    code, editor = large.workbench.code, large.files.document.editor
    code.live._generator = None
    code.live.start()

    qtbot.mouseClick(code.edit_button, Qt.MouseButton.LeftButton)

    expected = generate_program(editor.project, editor.language).text
    assert code.text.toPlainText() + "\n" == expected
    code.discard_button.click()
