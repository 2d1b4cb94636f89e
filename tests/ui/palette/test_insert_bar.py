"""Insert blocks by typing what they say."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.places import InInput
from nep_studio.ui.workbench.insert_bar import InsertBar

KEY = Qt.Key


@pytest.fixture
def bar(canvas, settings) -> InsertBar:
    return InsertBar(canvas, settings)


def first_of(canvas, block_type: str) -> str:
    blocks = canvas.editor.project.blocks.values()
    return next(block.id for block in blocks if block.type == block_type)


def new_blocks(canvas, before: set[str]) -> list[str]:
    blocks = canvas.editor.project.blocks
    return [blocks[block].type for block in blocks if block not in before]


def test_a_slash_on_the_canvas_opens_the_bar(canvas, bar, qtbot):
    qtbot.keyClick(canvas, "/")

    assert bar.isVisible()
    assert bar.line.text() == ""
    qtbot.waitUntil(bar.line.hasFocus)


def test_a_letter_on_the_canvas_opens_the_bar_with_it(canvas, bar, qtbot):
    qtbot.keyClick(canvas, KEY.Key_W)

    assert bar.isVisible()
    assert bar.line.text() == "w"


def test_a_double_click_on_the_empty_page_opens_the_bar_there(canvas, bar):
    place = QPoint(600, 480)

    QTest.mouseDClick(canvas.viewport(), Qt.MouseButton.LeftButton, pos=place)

    assert bar.isVisible()
    assert bar._at == canvas.sight.to_page(place)


def test_a_double_click_on_a_block_does_not(canvas, bar):
    place = canvas.sight.view_rect_of(first_of(canvas, "robot.do")).topLeft().toPoint() + QPoint(
        6, 10
    )

    QTest.mouseDClick(canvas.viewport(), Qt.MouseButton.LeftButton, pos=place)

    assert not bar.isVisible()


def test_say_hello_twice_makes_a_repeat_with_what_is_said(canvas, bar, qtbot):
    cursor = first_of(canvas, "robot.do")
    canvas.selection.set([cursor])
    before = set(canvas.editor.project.blocks)
    bar.open()

    qtbot.keyClicks(bar.line, "say hello twice")
    qtbot.keyClick(bar.line, KEY.Key_Return)

    project = canvas.editor.project
    chain = project.stack_of(cursor).body
    repeat = project.blocks[chain[chain.index(cursor) + 1]]
    [said] = [project.blocks[block] for block in repeat.bodies["do"]]
    assert sorted(new_blocks(canvas, before)) == ["control.repeat", "robot.say"]
    assert (repeat.fields["times"], said.fields["text"]) == (2, "hello")
    assert not bar.isVisible()
    qtbot.waitUntil(canvas.hasFocus)


def test_what_was_inserted_is_one_step_of_undo(canvas, bar, qtbot):
    before = set(canvas.editor.project.blocks)
    steps = canvas.editor.history.steps
    bar.open(text="set score to 5")
    qtbot.keyClick(bar.line, KEY.Key_Return)
    made = [variable.name for variable in canvas.editor.project.variables]

    canvas.editor.history.undo()

    assert "score" in made
    assert canvas.editor.history.steps == steps
    assert set(canvas.editor.project.blocks) == before
    assert [variable.name for variable in canvas.editor.project.variables] == ["times"]


def test_arrows_choose_another_suggestion(canvas, bar, qtbot):
    before = set(canvas.editor.project.blocks)
    bar.open(text="say hello twice")
    second = bar.list.rows[1].clip.project.blocks.values()

    qtbot.keyClick(bar.line, KEY.Key_Down)
    qtbot.keyClick(bar.line, KEY.Key_Return)

    assert sorted(new_blocks(canvas, before)) == sorted(block.type for block in second)


def test_control_enter_inserts_and_keeps_the_bar_open(canvas, bar, qtbot):
    cursor = first_of(canvas, "robot.do")
    canvas.selection.set([cursor])
    bar.open(text="wait 2")
    qtbot.keyClick(bar.line, KEY.Key_Return, Qt.KeyboardModifier.ControlModifier)
    stayed = bar.isVisible() and bar.line.text() == ""

    qtbot.keyClicks(bar.line, "wait 3")
    qtbot.keyClick(bar.line, KEY.Key_Return)

    project = canvas.editor.project
    chain = project.stack_of(cursor).body
    at = chain.index(cursor)
    assert stayed
    assert [project.blocks[b].fields["seconds"] for b in chain[at + 1 : at + 3]] == [2, 3]


def test_tab_writes_the_suggestion_out(canvas, bar, qtbot):
    bar.open(text="wai")

    qtbot.keyClick(bar.line, KEY.Key_Tab)

    assert bar.line.text().startswith("wait")
    assert bar.line.text() != "wai"


def test_escape_closes_the_bar_and_changes_nothing(canvas, bar, qtbot):
    before = set(canvas.editor.project.blocks)
    bar.open(text="wait 2")

    qtbot.keyClick(bar.line, KEY.Key_Escape)

    assert not bar.isVisible()
    assert set(canvas.editor.project.blocks) == before
    qtbot.waitUntil(canvas.hasFocus)


def test_the_bar_closes_when_the_keyboard_goes_elsewhere(canvas, bar, qtbot):
    bar.open()

    canvas.setFocus()

    qtbot.waitUntil(lambda: not bar.isVisible())


def test_a_block_is_inserted_loose_at_a_point_of_the_page(canvas, bar, qtbot):
    canvas.selection.set([first_of(canvas, "robot.do")])
    bar.open(QPointF(900, 300), "wait 2")

    qtbot.keyClick(bar.line, KEY.Key_Return)

    stack = canvas.editor.project.stack_of(canvas.selection.ids[0])
    assert (stack.x, stack.y) == (900, 300)


def test_a_slot_is_filled_and_only_what_fits_is_suggested(canvas, bar, qtbot):
    change = first_of(canvas, "variable.change")
    bar.open(text="2 + 3", place=InInput(change, "amount"))
    shapes = {
        canvas.editor.language.definitions[row.clip.project.blocks[row.clip.roots[0][0]].type].shape
        for row in bar.list.rows
    }

    qtbot.keyClick(bar.line, KEY.Key_Return)

    project = canvas.editor.project
    assert shapes == {"reporter"}
    assert project.blocks[project.blocks[change].inputs["amount"]].type.startswith("math.")


def test_a_click_on_a_suggestion_inserts_it(canvas, bar):
    before = set(canvas.editor.project.blocks)
    bar.open(text="wait 2")
    row = bar.list.rows[0]

    place = QPoint(30, round(row.y + row.height / 2))
    QTest.mouseClick(bar.list, Qt.MouseButton.LeftButton, pos=place)

    assert new_blocks(canvas, before) == ["control.wait"]


def test_suggestions_are_painted_as_blocks(canvas, bar, qtbot):
    bar.open(text="repeat 10")
    qtbot.waitUntil(lambda: bar.list.width() > 200)

    image = bar.list.grab().toImage()

    fill = canvas.look.theme.block("control").fill
    row = bar.list.rows[0]
    colours = {image.pixelColor(x, round(row.y + 12)).name() for x in range(8, 120)}
    assert fill.name() in colours


def test_words_that_no_block_says_are_answered_kindly(canvas, bar):
    bar.open(text="qwxyz vbnk")

    assert bar.list.rows == []
    assert "other words" in bar.hint.text()


def test_only_blocks_of_the_page_are_suggested(canvas, bar):
    canvas.show_page("nodes")

    bar.open(text="launch")

    types = {row.clip.project.blocks[row.clip.roots[0][0]].type for row in bar.list.rows}
    assert types == {"nodes.launch"}


def test_the_bar_is_inside_the_view(canvas, bar):
    bar.open(QPointF(5000, 5000), "say")

    assert canvas.rect().contains(bar.geometry())
