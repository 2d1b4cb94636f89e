"""Find blocks by words, and where a thing is used and defined."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.edits.content import SetFlag
from nep_studio.blocks.operations.finding import Subject
from nep_studio.ui.workbench.find_bar import FindBar
from tests.blocks.block_building import B, build

KEY = Qt.Key
SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def bar(canvas, window) -> FindBar:
    bar = FindBar(canvas)
    window.layout().insertWidget(0, bar)
    return bar


def first_of(canvas, block_type: str) -> str:
    blocks = canvas.editor.project.blocks.values()
    return next(block.id for block in blocks if block.type == block_type)


def test_typing_finds_blocks_and_counts_them(canvas, bar, qtbot):
    bar.open("")

    qtbot.keyClicks(bar.line, "says")

    assert len(bar.hits) == 3
    assert bar.count.text() == "1 of 3"
    assert canvas.selection.ids == (bar.hits[0],)


@pytest.mark.parametrize(("key", "modifier"), [(KEY.Key_Return, None), (KEY.Key_F3, None)])
def test_enter_and_f3_go_to_the_next_and_round(canvas, bar, qtbot, key, modifier):
    bar.open("says")

    told = []
    for _ in range(3):
        qtbot.keyClick(bar.line, key)
        told.append(bar.count.text())

    assert told == ["2 of 3", "3 of 3", "1 of 3"]


@pytest.mark.parametrize("key", [KEY.Key_Return, KEY.Key_F3])
def test_with_shift_they_go_to_the_one_before(canvas, bar, qtbot, key):
    bar.open("says")

    qtbot.keyClick(bar.line, key, SHIFT)

    assert bar.count.text() == "3 of 3"


def test_the_buttons_do_the_same(canvas, bar):
    bar.open("says")

    QTest.mouseClick(bar.next, Qt.MouseButton.LeftButton)
    QTest.mouseClick(bar.next, Qt.MouseButton.LeftButton)
    QTest.mouseClick(bar.previous, Qt.MouseButton.LeftButton)

    assert bar.count.text() == "2 of 3"


def test_what_is_found_is_marked_on_the_canvas(canvas, bar):
    without = canvas.viewport().grab().toImage()
    bar.open("Impressive")

    with_mark = canvas.viewport().grab().toImage()

    rect = canvas.sight.view_rect_of(bar.hits[0])
    place = rect.topLeft().toPoint()
    hit = canvas.look.theme.colour("search_hit").name()
    near = {with_mark.pixelColor(place.x() + dx, place.y() + 20).name() for dx in range(-6, 7)}
    assert hit in near
    assert with_mark != without


def test_a_hit_on_another_page_is_gone_to(canvas, bar):
    build(
        canvas.editor.language,
        [B("robots.robot", {"name": "Pepper"})],
        page="robots",
        editor=canvas.editor,
    )

    bar.open("Pepper")

    assert canvas.page == "robots"
    assert canvas.selection.ids == (first_of(canvas, "robots.robot"),)


def test_a_hit_inside_a_folded_block_unfolds_it(canvas, bar):
    together = first_of(canvas, "control.together")
    inner = first_of(canvas, "robot.play")
    canvas.editor.apply(SetFlag(together, "collapsed", True))

    bar.open("animation")

    assert bar.hits == (inner,)
    assert not canvas.editor.project.blocks[together].collapsed
    assert canvas.sight.view_rect_of(inner) is not None


def test_nothing_found_is_said_in_words_and_by_the_line(canvas, bar):
    bar.open("zzzz")

    assert bar.count.text() == "Nothing found"
    assert bar.line.property("state") == "wrong"
    assert not bar.next.isEnabled()


def test_hits_follow_the_program(canvas, bar, qtbot):
    bar.open("says")
    canvas.selection.set([bar.hits[1]])

    canvas.commands.delete()

    qtbot.waitUntil(lambda: bar.count.text().endswith("of 2"))


def test_escape_closes_the_bar_and_takes_the_marks_away(canvas, bar, qtbot):
    bar.open("says")

    qtbot.keyClick(bar.line, KEY.Key_Escape)

    assert bar.isHidden()
    assert bar.hits == ()
    qtbot.waitUntil(canvas.hasFocus)


def test_the_uses_of_a_variable_are_listed(canvas, bar):
    bar.show_uses(Subject("variable", "v1"))

    assert bar.title.text() == "3 uses of times"
    assert bar.count.text() == "1 of 3"
    assert bar.line.isHidden()


def test_the_uses_of_what_a_block_names_are_listed(canvas, bar):
    assert bar.show_uses_of(first_of(canvas, "variable.change"))

    assert bar.title.text() == "3 uses of times"


def test_the_menu_of_the_canvas_asks_for_uses(canvas, bar):
    canvas.news.uses_requested.emit(Subject("variable", "v1"))

    assert bar.isVisible()


def test_the_definition_of_what_a_block_names_is_gone_to(canvas, bar):
    assert bar.go_to_definition(first_of(canvas, "variable.change"))

    assert canvas.selection.ids == (first_of(canvas, "variable.set"),)


def test_a_block_that_names_nothing_is_answered_kindly(canvas, bar, qtbot):
    with qtbot.waitSignal(canvas.news.refused):
        assert not bar.show_uses_of(first_of(canvas, "event.started"))


def test_find_again_opens_the_bar_when_it_is_closed(canvas, bar):
    bar.step(1)

    assert bar.isVisible()


def test_another_project_is_searched_after_it_was_opened(canvas, bar):
    bar.open("says")
    canvas.set_editor(build(canvas.editor.language, [B("robot.say", {"text": "Other"})]))
    bar.refresh()

    bar.open("other")

    assert bar.count.text() == "1 of 1"
