"""The outline shows the program as a tree, and goes where the canvas goes."""

from __future__ import annotations

import random

import pytest
from PySide6.QtCore import QAbstractItemModel, QModelIndex, Qt
from PySide6.QtTest import QAbstractItemModelTester

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.content import SetField
from nep_studio.blocks.edits.placing import DeleteBlocks, MoveBlocks
from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.places import InBody, InStack
from nep_studio.blocks.program import Project
from nep_studio.run.installation import studio_language
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.theme.colours import load_theme
from nep_studio.ui.widgets.forms import EmptyHint
from nep_studio.ui.workbench.outline import Outline, OutlineModel
from tests.blocks.block_building import B, build


def program():
    number = B("math.arithmetic", {"a": 1, "b": 2})
    does = [B("robot.say", {"text": "inside"})]
    repeat = B("control.repeat", {}, {"times": number}, {"do": does})
    return build(
        studio_language(),
        [B("event.started"), repeat, B("robot.say", {"text": "after"})],
        [B("event.gesture")],
    )


@pytest.fixture
def canvas(qtbot) -> Canvas:
    canvas = Canvas(program(), load_theme("light"))
    qtbot.addWidget(canvas)
    canvas.resize(600, 300)
    canvas.show()
    return canvas


@pytest.fixture
def outline(qtbot, canvas: Canvas) -> Outline:
    outline = Outline(canvas)
    qtbot.addWidget(outline)
    outline.show()
    return outline


def tree(model: QAbstractItemModel, parent: QModelIndex | None = None) -> list[object]:
    parent = parent or QModelIndex()
    rows = []
    for row in range(model.rowCount(parent)):
        index = model.index(row, 0, parent)
        rows.append((index.data(), tree(model, index)))
    return rows


def block_of(canvas: Canvas, text: str) -> str:
    blocks = canvas.editor.project.blocks.values()
    return next(b.id for b in blocks if b.fields.get("text") == text)


def test_the_outline_has_a_row_for_each_block_that_is_not_plugged_in(outline: Outline) -> None:
    rows = tree(outline.model())

    assert next(name for name, _ in rows) == "when the program starts"
    assert len(rows) == 2
    repeat, after = rows[0][1]
    assert repeat[0] == "repeat 1 + 2 times"
    assert [name for name, _ in repeat[1]] == ["NAO says inside with no gesture"]
    assert after == ("NAO says after with no gesture", [])


def test_the_rows_follow_edits_and_what_is_unfolded_stays_so(outline, canvas) -> None:
    model = outline.model()
    outline.expandAll()
    editor = canvas.editor

    editor.apply(SetField(block_of(canvas, "inside"), "text", "other"))
    gesture = editor.project.pages["behaviour"][1]
    editor.apply(MoveBlocks(block_of(canvas, "after"), 1, InStack(gesture.id, 1)))

    assert [name for name, _ in tree(model)[1][1]] == ["NAO says after with no gesture"]
    assert outline.isExpanded(model.index(0, 0, model.index(0, 0)))
    assert tree(model)[0][1][0][1][0][0] == "NAO says other with no gesture"


def test_choosing_a_row_shows_its_block_on_the_canvas(outline, canvas, qtbot) -> None:
    outline.expandAll()
    outline.setFocus()
    outline.setCurrentIndex(outline.model().index(0, 0))

    qtbot.keyClick(outline, Qt.Key.Key_Down)
    qtbot.keyClick(outline, Qt.Key.Key_Down)

    assert canvas.selection.ids == (block_of(canvas, "inside"),)


def test_selecting_a_plugged_block_chooses_the_row_of_the_block_around_it(outline, canvas) -> None:
    blocks = canvas.editor.project.blocks.values()
    number = next(b.id for b in blocks if b.type == "math.arithmetic")

    canvas.selection.set([number])

    assert outline.currentIndex().data() == "repeat 1 + 2 times"


def test_another_page_has_other_rows(outline: Outline, canvas: Canvas) -> None:
    canvas.show_page("robots")

    assert outline.model().rowCount() == 0


@pytest.mark.parametrize("seed", range(6))
def test_after_any_steps_the_rows_are_those_of_an_outline_made_anew(qtbot, seed) -> None:
    editor, chance = program(), random.Random(seed)
    model = awake(editor)
    tree(model)

    for _ in range(40):
        random_step(editor, chance)
        fresh = awake(editor)

        assert tree(model) == tree(fresh)
        fresh.set_awake(False)


def awake(editor: Editor) -> OutlineModel:
    """The rows as somebody who looks has them."""
    model = OutlineModel(editor, load_theme("light"))
    model.set_awake(True)
    return model


def random_step(editor: Editor, chance: random.Random) -> None:
    project = editor.project
    block = chance.choice(list(project.blocks))
    stack = chance.choice(list(project.stacks.values()))
    repeats = [b.id for b in project.blocks.values() if b.type == "control.repeat"]
    places = [InStack(stack.id, chance.randrange(3)), editor.new_stack("behaviour", 0, 0)]
    places += [InBody(repeat, "do", chance.randrange(2)) for repeat in repeats]
    try:
        match chance.randrange(4):
            case 0:
                editor.apply(MoveBlocks(block, 1, chance.choice(places)))
            case 1:
                editor.create("robot.say", chance.choice(places))
            case 2 if len(project.blocks) > 4:
                editor.apply(DeleteBlocks(block, 1))
            case _:
                editor.history.undo()
                if not project.blocks:
                    editor.history.redo()
    except EditRefused:
        pass


def test_qt_finds_no_fault_in_the_model_while_the_program_changes(qtbot) -> None:
    editor = program()
    model = awake(editor)
    tester = QAbstractItemModelTester(model, QAbstractItemModelTester.FailureReportingMode.Fatal)
    tree(model)
    stack = editor.project.pages["behaviour"][0]

    editor.apply(DeleteBlocks(stack.body[1], 1))
    editor.apply(DeleteBlocks(stack.body[0], 1))
    editor.history.undo()
    editor.history.undo()
    editor.history.redo()

    assert tree(model)[0][0] == "when the program starts"
    model.set_awake(False)
    assert model.rowCount() == 0
    assert tester.model() is model


def test_nothing_is_done_while_nobody_looks_and_all_is_there_again_afterwards(
    outline, canvas
) -> None:
    model, editor = outline.model(), canvas.editor
    outline.expandAll()
    outline.hide()

    editor.apply(DeleteBlocks(block_of(canvas, "after"), 1))
    assert model.rowCount() == 0
    outline.show()

    [repeat] = tree(model)[0][1]
    assert repeat[0] == "repeat 1 + 2 times"
    assert outline.isExpanded(model.index(0, 0, model.index(0, 0)))


def test_an_empty_page_says_what_belongs_here(qtbot):
    editor = Editor(Project(), studio_language())
    canvas = Canvas(editor, load_theme("light"))
    outline = Outline(canvas)
    for widget in (canvas, outline):
        qtbot.addWidget(widget)
        widget.show()
    [words] = outline.findChildren(EmptyHint)
    assert words.isVisible()

    build(editor.language, [B("event.started")], editor=editor)
    assert not words.isVisible()

    outline.refresh()
    assert not words.isVisible()
    [stack] = editor.project.pages["behaviour"]
    editor.apply(DeleteBlocks(stack.body[0], 1))
    assert words.isVisible()
