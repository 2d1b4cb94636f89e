"""The notes of a page: drawn below the blocks, moved, resized, written in, deleted."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Project
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.editing.notes import NoteEditor
from nep_studio.ui.canvas.painting.notes import NEW_HEIGHT, NEW_WIDTH
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.theme.look import text_font

PLAIN = Qt.KeyboardModifier.NoModifier
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def canvas(qtbot) -> Canvas:
    canvas = Canvas(Editor(Project("Test"), studio_language()), load_theme("light"))
    canvas.set_look(canvas.look.theme, text_font(11), is_mirrored=False)
    qtbot.addWidget(canvas)
    canvas.resize(600, 400)
    canvas.show()
    qtbot.waitExposed(canvas)
    return canvas


def view_point(canvas: Canvas, x: float, y: float) -> QPoint:
    return canvas.sight.camera.to_view(x, y).toPoint()


def drag(canvas: Canvas, start: QPoint, by: QPoint) -> None:
    view = canvas.viewport()
    QTest.mousePress(view, LEFT, PLAIN, start)
    for step in (0.4, 1.0):
        at = start + QPoint(round(by.x() * step), round(by.y() * step))
        QTest.mouseMove(view, at)
    QTest.mouseRelease(view, LEFT, PLAIN, start + by)


def test_a_new_note_is_selected_and_found_where_it_is(canvas) -> None:
    note = canvas.notes.add(50, 60, "hello")

    assert canvas.notes.selected == note
    assert canvas.notes.hit(QPointF(60, 70)).id == note
    assert canvas.notes.hit(QPointF(20, 70)) is None


def test_a_note_is_painted_below_the_blocks(canvas) -> None:
    canvas.notes.add(0, 0)
    canvas.editor.create("control.wait", canvas.editor.new_stack("behaviour", 20, 20))
    canvas.notes.select("")

    picture = canvas.viewport().grab().toImage()

    note = canvas.look.theme.colour("note")
    wait = canvas.look.theme.block("control").fill
    assert picture.pixelColor(view_point(canvas, 150, 100)) == note
    assert picture.pixelColor(view_point(canvas, 27, 38)) == wait


def test_a_note_is_moved_with_the_mouse_in_one_step(canvas) -> None:
    note = canvas.notes.add(50, 60)
    steps = canvas.editor.history.steps

    drag(canvas, view_point(canvas, 100, 100), QPoint(80, 40))

    there = canvas.editor.project.notes[note]
    assert (there.x, there.y) == (130, 100)
    assert canvas.editor.history.steps == steps + 1
    canvas.editor.history.undo()
    assert canvas.editor.project.notes[note].x == 50


def test_escape_leaves_a_dragged_note_where_it_was(canvas) -> None:
    note = canvas.notes.add(50, 60)
    start, view = view_point(canvas, 100, 100), canvas.viewport()

    QTest.mousePress(view, LEFT, PLAIN, start)
    QTest.mouseMove(view, start + QPoint(50, 50))
    QTest.keyClick(canvas, Qt.Key.Key_Escape)
    QTest.mouseRelease(view, LEFT, PLAIN, start + QPoint(50, 50))

    assert canvas.editor.project.notes[note].x == 50
    assert canvas.notes.carried is None


def test_a_note_is_resized_by_its_corner(canvas) -> None:
    note = canvas.notes.add(50, 60)
    corner = view_point(canvas, 50 + NEW_WIDTH - 5, 60 + NEW_HEIGHT - 5)

    drag(canvas, corner, QPoint(30, 20))

    there = canvas.editor.project.notes[note]
    assert (there.width, there.height) == (NEW_WIDTH + 30, NEW_HEIGHT + 20)
    assert (there.x, there.y) == (50, 60)


def test_a_double_click_opens_a_note_to_write_in_one_step(canvas) -> None:
    note = canvas.notes.add(50, 60)
    steps = canvas.editor.history.steps

    place = view_point(canvas, 100, 100)
    QTest.mouseDClick(canvas.viewport(), LEFT, PLAIN, place)
    QTest.mouseRelease(canvas.viewport(), LEFT, PLAIN, place)
    writing = canvas.viewport().findChild(NoteEditor)
    QTest.keyClicks(writing, "charge it")
    QTest.keyClick(writing, Qt.Key.Key_Escape)

    assert canvas.editor.project.notes[note].text == "charge it"
    assert canvas.editor.history.steps == steps + 1
    assert canvas.notes.edited == ""


def test_the_delete_key_deletes_the_selected_note(canvas) -> None:
    note = canvas.notes.add(50, 60)
    canvas.setFocus()

    QTest.keyClick(canvas, Qt.Key.Key_Delete)

    assert note not in canvas.editor.project.notes
    assert canvas.notes.selected == ""
    canvas.editor.history.undo()
    assert note in canvas.editor.project.notes


def test_arrows_move_the_selected_note(canvas) -> None:
    note = canvas.notes.add(50, 60)

    QTest.keyClick(canvas, Qt.Key.Key_Right)

    assert canvas.editor.project.notes[note].x == 60


def test_selecting_a_block_leaves_the_note(canvas) -> None:
    block = canvas.editor.create("control.wait", canvas.editor.new_stack("behaviour", 20, 20))
    canvas.notes.add(50, 60)

    canvas.selection.set([block])

    assert canvas.notes.selected == ""


def test_notes_are_on_their_own_page_only(canvas) -> None:
    canvas.notes.add(50, 60)

    canvas.show_page("robots")

    assert canvas.notes.hit(QPointF(60, 70)) is None


def test_the_page_reaches_as_far_as_its_notes(canvas) -> None:
    canvas.notes.add(3000, 60)

    bounds = canvas.page_layout.bounds()

    assert bounds.right == 3000 + NEW_WIDTH
