"""The checklist, code and files: one test for each row of the feature inventory."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint
from PySide6.QtGui import QTextCursor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFileDialog, QPushButton

from nep_studio.blocks.files import load, to_bytes
from nep_studio.blocks.operations.finding import compare
from nep_studio.ui.plugins.exporting.picture import PictureDialog
from tests.blocks.block_building import B
from tests.ui.checklist.person import CTRL, LEFT, Key, Person, say, story

FREE = QPoint(520, 560)


def code_of(person: Person) -> str:
    return person.window.workbench.code.text.toPlainText()


def click_line(person: Person, words: str) -> int:
    """Click the line of the code with these words; gives its number."""
    text = person.window.workbench.code.text
    lines = code_of(person).split("\n")
    number = next(number for number, line in enumerate(lines) if words in line)
    cursor = QTextCursor(text.document().findBlockByNumber(number))
    place = text.cursorRect(cursor).center() + QPoint(20, 0)
    person.click(place, widget=text.viewport())
    return number


def test_json_save_keeps_ids_one_block_a_line(person: Person, tmp_path: Path, monkeypatch) -> None:
    """JSON save, stable ids: flat format."""
    inside = B("control.repeat", bodies={"do": [say("deep")]})
    person.make([B("event.started"), inside])
    path, before = tmp_path / "story.nep", person.file
    monkeypatch.setattr(
        person.window.files._chooser, "choose_to_save", lambda *about: about[-1](path)
    )

    person.key(Key.Key_S, CTRL)
    lines = path.read_text(encoding="utf-8").split("\n")
    saved = path.read_bytes()
    ids = set(person.project.blocks)
    person.put(person.body()[1], FREE)
    person.undo()
    person.key(Key.Key_S, CTRL)

    assert path.read_bytes() == saved
    assert sum('"type"' in line for line in lines) == len(ids)
    assert {block["id"] for block in json.loads(saved)["blocks"]} == ids
    again = load(path, person.editor.language)
    assert to_bytes(again) == saved and set(again.blocks) == ids
    assert b"control.repeat" in before and not person.window.isWindowModified()


def test_two_versions_differ_in_the_lines_that_were_changed(person: Person, tmp_path: Path) -> None:
    """Version control-friendly diff of two versions."""
    person.make(story(), story())
    before = person.file.decode().split("\n")
    old = person.window.studio.language
    two = person.body()[2]

    person.click(person.piece(two, "text"))
    person.canvas.fields.widget.selectAll()
    person.type("changed", person.canvas.fields.widget)
    person.key(Key.Key_Return, widget=person.canvas.fields.widget)
    after = person.file.decode().split("\n")
    changed = [line for line in after if line not in before]

    assert len(after) == len(before) and len(changed) == 1
    assert two in changed[0] and "changed" in changed[0]
    path = tmp_path / "before.nep"
    path.write_text("\n".join(before), encoding="utf-8")
    [difference] = compare(load(path, old), person.project, old)
    assert difference.what == "changed"


def test_live_python_beside_the_blocks_click_line_and_block(person: Person) -> None:
    """Live Python beside the blocks, click line <-> block."""
    person.make(story())
    one, two = person.body()[1:3]
    text = person.window.workbench.code.text
    person.qtbot.waitUntil(lambda: '.say("three")' in code_of(person))

    line = click_line(person, '.say("two")')
    assert person.canvas.selection.ids == (two,)
    person.select(one)
    marked = [mark.cursor.blockNumber() for mark in text.extraSelections()]
    assert marked == [line - 1]
    person.put(two, FREE)
    person.qtbot.waitUntil(lambda: '.say("two")' not in code_of(person).split("def ")[1])
    assert '.say("one")' in code_of(person)


def test_python_becomes_blocks(person: Person) -> None:
    """Python -> blocks."""
    person.make(story())
    pane, before = person.window.workbench.code, person.file
    person.qtbot.waitUntil(lambda: '.say("three")' in code_of(person))

    QTest.mouseClick(pane.edit_button, LEFT)
    pane.text.moveCursor(QTextCursor.MoveOperation.Start)
    assert pane.text.find('nao.say("two")')
    person.type("if 1 + 1 == 2:", pane.text)
    person.key(Key.Key_Return, widget=pane.text)
    person.type('        nao.say("so it is")', pane.text)
    QTest.mouseClick(pane.apply_button, LEFT)

    assert not pane.is_editing, code_of(person)
    kinds = [person.project.blocks[block].type for block in person.body()]
    assert kinds == ["event.started", "robot.say", "control.if", "robot.say"]
    assert person.texts() == ["one", "three"]
    assert person.undo() == before


@pytest.mark.parametrize("kind", ["png", "svg"])
def test_a_picture_is_exported_and_opens_again_as_the_program(
    person: Person, tmp_path: Path, monkeypatch, kind: str
) -> None:
    """Picture export (PNG/SVG, program embedded)."""
    person.make(story())
    before, path = person.file, tmp_path / f"story.{kind}"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))

    person.choose(person.menu(FREE), "picture")
    [dialog] = [d for d in person.window.findChildren(PictureDialog) if d.isVisible()]
    dialog.format.setCurrentIndex(dialog.format.findData(kind))
    save = next(b for b in dialog.findChildren(QPushButton) if b.text() == "Save…")
    QTest.mouseClick(save, LEFT)
    assert path.stat().st_size > 1000
    person.window.files.document.close()
    person.window.files.document = None
    person.window.files.open(path)
    person.qtbot.waitUntil(lambda: person.window.files.document is not None)

    assert person.file == before
