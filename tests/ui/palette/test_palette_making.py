"""Variables and own blocks made from the palette."""

from __future__ import annotations

from PySide6.QtCore import Qt

from nep_studio.blocks.procedures import title
from nep_studio.ui.workbench.palette.palette import Palette

LEFT = Qt.MouseButton.LeftButton


def press_button(palette: Palette, action: str) -> None:
    palette.use(next(entry for entry in palette.shelf.entries if entry.action == action))


def test_new_variable_asks_for_a_name_and_makes_it(palette, qtbot):
    press_button(palette, "variable")
    question = palette.making.asking.question

    qtbot.keyClicks(question.name, "score")
    qtbot.keyClick(question, Qt.Key.Key_Return)

    assert [v.name for v in palette.canvas.editor.project.variables] == ["times", "score"]


def test_a_name_that_is_taken_is_refused_with_a_reason(palette, qtbot):
    press_button(palette, "variable")
    asking = palette.making.asking

    qtbot.keyClicks(asking.question.name, "times")
    qtbot.keyClick(asking.question, Qt.Key.Key_Return)

    assert asking.isVisible()
    assert asking.reason.text
    asking.close()


def test_make_a_block_puts_its_header_on_the_page_and_the_block_into_the_palette(palette, qtbot):
    press_button(palette, "block")
    dialog = palette.making.dialog
    qtbot.keyClicks(dialog.rows[0].name, "greet")
    row = dialog.add_value()
    qtbot.keyClicks(row.name, "name")
    row.kind.setCurrentIndex(row.kind.findData("text"))
    shown = not dialog.picture.is_empty

    dialog.accept()

    project = palette.canvas.editor.project
    [procedure] = project.procedures.values()
    header = palette.canvas.selection.ids[0]
    assert shown
    assert title(procedure) == "greet (name)"
    assert project.blocks[header].type == f"my.define.{procedure.id}"
    qtbot.waitUntil(lambda: any("greet" in e.text for e in palette.shelf.entries))
    palette.canvas.editor.history.undo()
    assert not project.procedures


def test_a_block_without_words_is_refused_with_a_reason(palette):
    press_button(palette, "block")
    dialog = palette.making.dialog

    dialog.accept()

    assert dialog.isVisible()
    assert dialog.reason.text
    dialog.reject()


def test_a_part_can_be_taken_away_again(palette, qtbot):
    press_button(palette, "block")
    dialog = palette.making.dialog
    qtbot.keyClicks(dialog.rows[0].name, "greet")
    row = dialog.add_value()

    dialog.take_away(row)

    assert dialog.parts == ["greet"]
    assert not dialog.picture.is_empty
    dialog.reject()
