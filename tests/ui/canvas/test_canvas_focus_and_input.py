"""Who has the keyboard, and what reaches the canvas from it: Space, letters, input methods."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QInputMethodEvent, QKeyEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QLineEdit, QVBoxLayout, QWidget

from nep_studio.blocks.edits.content import AddNote
from nep_studio.blocks.program import Note
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.editing.notes import edit_note
from nep_studio.ui.theme.colours import load_theme
from tests.blocks.block_building import B, build

SPACE = Qt.Key.Key_Space


@dataclass
class Window:
    """A canvas below a box to type in."""

    around: QWidget
    canvas: Canvas
    box: QLineEdit
    block: str


def program():
    editor = build(studio_language(), [B("robot.say", {"text": "x"}), B("control.wait")])
    editor.apply(AddNote(Note("n1", "behaviour", 10, 150, 200, 100, "a note")))
    return editor


@pytest.fixture
def window(qtbot) -> Window:
    around, box, editor = QWidget(), QLineEdit(), program()
    canvas = Canvas(editor, load_theme("light"))
    column = QVBoxLayout(around)
    column.addWidget(box)
    column.addWidget(canvas)
    around.resize(700, 500)
    qtbot.addWidget(around)
    with qtbot.waitActive(around):
        around.show()
    canvas.setFocus()
    return Window(around, canvas, box, next(iter(editor.project.blocks)))


def open_field(window: Window) -> None:
    window.canvas.fields.open(window.block, "text")


def open_comment(window: Window) -> None:
    window.canvas.fields.comments.open(window.block)


def open_note(window: Window) -> None:
    edit_note(window.canvas, "n1")


@pytest.mark.parametrize("open_editor", [open_field, open_comment, open_note])
def test_a_press_into_another_box_gives_it_the_keyboard(window, open_editor) -> None:
    open_editor(window)
    assert QApplication.focusWidget() not in (window.canvas, window.box)

    QTest.mouseClick(window.box, Qt.MouseButton.LeftButton)
    QTest.keyClicks(QApplication.focusWidget(), "found")

    assert window.box.text() == "found"


def test_enter_in_a_field_gives_the_keyboard_back_to_the_canvas(window) -> None:
    open_field(window)

    QTest.keyClick(window.canvas.fields.widget, Qt.Key.Key_Return)

    assert window.canvas.hasFocus()


def test_escape_in_a_note_gives_the_keyboard_back_to_the_canvas(window) -> None:
    open_note(window)

    QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Escape)

    assert window.canvas.hasFocus()


def test_a_note_that_is_written_writes_nothing_into_the_next_project(window) -> None:
    open_note(window)
    before, other = window.canvas.editor, program()
    QTest.keyClicks(QApplication.focusWidget(), "old")

    window.canvas.set_editor(other)

    assert window.canvas.notes.writing is None
    assert "old" in before.project.notes["n1"].text
    assert other.project.notes["n1"].text == "a note"


# Space


def test_space_with_a_press_pans_and_picks_nothing_up(window) -> None:
    canvas, told = window.canvas, []
    canvas.news.announced.connect(told.append)
    canvas.selection.set([window.block])
    corner = canvas.sight.camera.x

    QTest.keyPress(canvas, SPACE)
    QTest.mousePress(canvas.viewport(), Qt.MouseButton.LeftButton, pos=QPointF(300, 300).toPoint())
    QTest.mouseMove(canvas.viewport(), QPointF(250, 300).toPoint())
    QTest.mouseRelease(
        canvas.viewport(), Qt.MouseButton.LeftButton, pos=QPointF(250, 300).toPoint()
    )
    QTest.keyRelease(canvas, SPACE)

    assert told == []
    assert canvas.pointing.gesture is None
    assert canvas.sight.camera.x == pytest.approx(corner + 50)


def test_space_picks_up_and_puts_down_however_long_it_is_held(window) -> None:
    canvas, told = window.canvas, []
    canvas.news.announced.connect(told.append)
    canvas.selection.set([window.block])
    press, none = QEvent.Type.KeyPress, Qt.KeyboardModifier.NoModifier

    QTest.keyPress(canvas, SPACE)
    for _ in range(5):
        QApplication.sendEvent(canvas, QKeyEvent(press, SPACE, none, " ", True))
    QTest.keyRelease(canvas, SPACE)
    carried = canvas.pointing.gesture
    QTest.keyClick(canvas, SPACE)

    assert carried is not None
    assert canvas.pointing.gesture is None
    assert len(told) == 2


# Input methods


def compose(widget: QWidget, preedit: str, committed: str = "") -> None:
    """Send what an input method sends: letters that are not chosen yet, then the chosen ones."""
    event = QInputMethodEvent(preedit, [])
    event.setCommitString(committed)
    QApplication.sendEvent(widget, event)


def test_letters_that_are_being_composed_reach_a_field_when_they_are_chosen(window) -> None:
    open_field(window)
    field, blocks = window.canvas.fields.widget, window.canvas.editor.project.blocks

    compose(field, "か")
    composing = blocks[window.block].fields["text"]
    compose(field, "", "書")
    QTest.keyClick(field, Qt.Key.Key_Return)

    assert composing != "か"
    assert blocks[window.block].fields["text"] == "書"


def test_the_canvas_takes_no_composed_letters_as_the_name_of_a_block(window) -> None:
    typed: list[str] = []
    window.canvas.keyboard.type_letter = typed.append

    compose(window.canvas, "か")
    compose(window.canvas, "", "")

    assert typed == []
    assert not window.canvas.testAttribute(Qt.WidgetAttribute.WA_InputMethodEnabled)


@pytest.mark.parametrize("corner", [QPointF(690, 440), QPointF(5, 440), QPointF(690, 5)])
def test_a_popup_stays_inside_the_screen(window, qtbot, corner) -> None:
    canvas = window.canvas
    screen = QApplication.primaryScreen().availableGeometry()
    canvas.window().move(screen.bottomRight() - canvas.window().rect().bottomRight())
    block = canvas.editor.create("robot.do", canvas.editor.new_stack("behaviour", 0, 400))
    field = canvas.page_layout.placed(block)
    canvas.sight.move_camera(field.x - corner.x() + 200, field.y - corner.y() + 40)

    assert canvas.fields.open(block, "posture")

    assert screen.contains(canvas.fields.widget.frameGeometry())
    canvas.fields.close()
