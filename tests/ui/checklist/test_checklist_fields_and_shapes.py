"""The checklist, fields and shapes: one test for each row of the feature inventory."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QListWidget

from nep_studio.blocks.slots import FieldValue
from tests.blocks.block_building import B
from tests.ui.canvas.fields.kinds_language import kinds_language
from tests.ui.checklist.person import ALT, CTRL, Key, Person, say, say_block

FREE = QPoint(520, 560)


def value(person: Person, block: str, key: str) -> FieldValue | None:
    there = person.project.blocks[block]
    return person.editor.language.definitions[there.type].value(there, key)


def shown(person: Person, block: str) -> list[str]:
    """What is written on a block."""
    placed = person.canvas.page_layout.placed(block)
    assert placed is not None
    return [piece.text for piece in placed.box.pieces if piece.text]


def labels(rows: QListWidget) -> list[str]:
    return [rows.item(row).text() for row in range(rows.count())]


def fill_in(person: Person, block: str, key: str, text: str) -> None:
    """Click a field, type over what is there, and press Enter."""
    person.click(person.piece(block, key))
    editor = person.canvas.fields.widget
    line = next(
        getattr(editor, name)
        for name in ("search", "number", "code", "written", "path", "selectAll")
        if hasattr(editor, name)
    )
    line = editor if callable(line) else line
    line.selectAll()
    person.type(text, line)
    person.key(Key.Key_Return, widget=line)


def test_inline_inputs_wrap_by_themselves(person: Person) -> None:
    """Inline and external inputs: inline only + auto wrap."""
    words = [f"some words that are not short, number {n}" for n in range(1, 7)]
    joined = B(
        "text.join", {f"item.{n}": text for n, text in enumerate(words, 1)}, groups={"item": 6}
    )
    person.make([B("event.started"), say_block(joined)])
    speaker, join = person.body()[1], person.block("text.join").id

    placed = person.canvas.page_layout.placed(join)
    assert placed is not None
    rows = {round(piece.y) for piece in placed.box.pieces if piece.piece == "field"}
    inside, around = person.rect(join), person.rect(speaker)

    assert len(rows) > 1
    assert around.contains(inside)
    assert around.width() < person.canvas.viewport().width()


def test_default_values_come_back_when_the_block_leaves(person: Person) -> None:
    """Shadow (default) blocks that come back when the real one leaves."""
    person.make([say("my words")], [B("text.text", {"text": "plugged"})])
    speaker, text = person.body()[0], person.body(1)[0]
    before = person.file

    person.put(text, person.piece(speaker, "text") - QPoint(35, 14))
    assert person.project.blocks[speaker].inputs == {"text": text}
    assert "my words" not in shown(person, speaker)
    person.put(text, FREE)

    assert person.project.blocks[speaker].inputs == {}
    assert "my words" in shown(person, speaker)
    person.undo()
    assert person.undo() == before


def test_fields_text_number_choice_checkbox_words_and_variable(person: Person) -> None:
    """Fields: text, number, dropdown, checkbox, label, image, variable."""
    stack = [say("x"), B("control.repeat"), B("robot.do"), B("robot_moves.breathing")]
    person.make([*stack, B("variable.set", {"variable": "v4"})], variables=("score", "lives"))
    speaker, loop, pose, breath, assign = person.body()
    start = person.editor.history.steps

    fill_in(person, speaker, "text", "Grüß Gott 🤖")
    fill_in(person, loop, "times", "12,5")
    fill_in(person, pose, "posture", "sit")
    before = value(person, breath, "on")
    person.click(person.piece(breath, "on"))
    fill_in(person, assign, "variable", "lives")

    assert value(person, speaker, "text") == "Grüß Gott 🤖"
    assert value(person, loop, "times") == 12.5
    assert value(person, pose, "posture") == "posture_sit"
    assert value(person, breath, "on") is not before
    assert value(person, assign, "variable") == "v5"
    assert "takes the posture" in shown(person, pose)
    assert person.editor.history.steps == start + 5


def test_fields_lines_angle_colour_slider_and_dependent_choice(person: Person) -> None:
    """Fields: multiline, angle, colour, slider, column picker."""
    person.window.studio.language = kinds_language()
    person.window.studio.words_changed.emit()
    kinds = ("lines", "angle", "colour", "slider")
    joint = B("robot_moves.move_joint", {"part": "left_arm"})
    person.make([*(B(f"kinds.{kind}") for kind in kinds), joint])
    lines, angle, colour, slider, arm = person.body()
    start = person.editor.history.steps

    person.click(person.piece(lines, "text"))
    editor = person.canvas.fields.widget
    person.type("one", editor)
    person.key(Key.Key_Return, widget=editor)
    person.type("two", editor)
    person.key(Key.Key_Return, CTRL, editor)
    fill_in(person, angle, "angle", "-45")
    fill_in(person, colour, "colour", "#ff8800")
    fill_in(person, slider, "much", "70")
    person.click(person.piece(arm, "joint"))
    offered = labels(person.canvas.fields.widget.list)
    person.key(Key.Key_Escape, widget=person.canvas.fields.widget.first())

    assert value(person, lines, "text") == "one\ntwo"
    assert value(person, angle, "angle") == -45
    assert value(person, colour, "colour") == "#ff8800"
    assert value(person, slider, "much") == 70
    assert "elbow, bent" in offered and not any("knee" in label for label in offered)
    assert person.editor.history.steps == start + 4


def test_a_choice_is_searched_by_typing(person: Person) -> None:
    """Searchable dropdown; type-to-filter."""
    person.make([B("robot.do")])
    pose = person.body()[0]
    before = person.file

    person.click(person.piece(pose, "posture"))
    popup = person.canvas.fields.widget
    everything = labels(popup.list)
    person.type("sit", popup.first())
    found = labels(popup.list)
    person.key(Key.Key_Down, widget=popup.first())
    person.key(Key.Key_Return, widget=popup.first())

    assert len(found) < len(everything) and all("sit" in label for label in found)
    assert found[1] in shown(person, pose)
    assert person.undo() == before


def test_number_fields_accept_an_expression(person: Person) -> None:
    """Number fields accept an expression ("2*pi/3")."""
    person.make([B("event.started"), B("control.repeat")])
    loop = person.body()[1]

    fill_in(person, loop, "times", "2*pi/3")

    assert value(person, loop, "times") == "2*pi/3"
    assert "2*pi/3" in shown(person, loop)
    code = person.window.workbench.code.text
    person.qtbot.waitUntil(lambda: "pi / 3" in code.toPlainText())
    person.click(person.piece(loop, "times"))
    line = person.canvas.fields.widget
    assert "2.09" in line.result.text()
    line.selectAll()
    person.type("2*(", line)
    assert line.reason.text
    person.key(Key.Key_Escape, widget=line)
    assert value(person, loop, "times") == "2*pi/3"


def test_if_else_if_and_else_by_plus_and_minus_in_place(person: Person) -> None:
    """If / else-if / else extension: +/- in place."""
    person.make([B("control.if")])
    block, before = person.body()[0], person.file

    person.click(person.piece(block, "also", kind="add"))
    person.click(person.piece(block, "otherwise", kind="add"))
    assert person.project.blocks[block].groups == {"also": 1, "otherwise": 1}
    assert "else" in shown(person, block)
    person.click(person.piece(block, "also", kind="remove", number=1))

    assert person.project.blocks[block].groups.get("also", 0) == 0
    person.undo()
    person.undo()
    assert person.undo() == before


def test_items_are_added_removed_and_reordered_in_place(person: Person) -> None:
    """Variadic inputs (join, list): +/- in place, drag to reorder."""
    person.make([say_block(B("text.join", {"item.1": "a", "item.2": "b"}))])
    join, before = person.block("text.join").id, person.file

    person.click(person.piece(join, "item", kind="add"))
    fill_in(person, join, "item.3", "c")
    person.click(person.piece(join, "item.3"))
    person.key(Key.Key_Up, ALT, person.canvas.fields.widget)
    person.canvas.fields.close()
    assert [value(person, join, f"item.{n}") for n in (1, 2, 3)] == ["a", "c", "b"]
    person.click(person.piece(join, "item", kind="remove", number=1))

    assert [value(person, join, f"item.{n}") for n in (1, 2)] == ["c", "b"]
    for _ in range(4):
        after = person.undo()
    assert after == before


@pytest.mark.parametrize(
    ("block_type", "outline"),
    [
        ("math.number", "round"),
        ("logic.compare", "hexagon"),
        ("list.create", "bracket"),
        ("robot.say", "statement"),
        ("event.started", "hat"),
        ("control.stop_program", "cap"),
    ],
)
def test_shapes_say_what_fits(person: Person, block_type: str, outline: str) -> None:
    """Reporters round, booleans hexagonal, typed sockets (shape AND colour AND name)."""
    person.make([B("control.if")], [B("list.length")], [B(block_type)])
    check, length, block = (person.body(number)[0] for number in range(3))
    layout = person.canvas.page_layout

    def socket(owner: str):
        placed = layout.placed(owner)
        return next(piece for piece in placed.box.pieces if piece.piece == "socket")

    assert layout.placed(block).box.outline == outline
    assert (socket(check).shape, socket(length).shape) == ("hexagon", "bracket")
    assert socket(check).hint and socket(length).hint
