"""Selecting with the mouse: clicks, Shift and Ctrl, the rubber band, and what a click opens."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest

from nep_studio.blocks.checks.diagnostic import Diagnostic
from nep_studio.ui.canvas.painting.overlay import badge_rect
from tests.blocks.block_building import B

CTRL, SHIFT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.ShiftModifier
EMPTY = QPointF(700, 500)


def say(text: str) -> B:
    return B("robot.say", {"text": text})


def story() -> list[B]:
    inside = B("control.repeat", bodies={"do": [say("inside"), say("too")]})
    return [B("event.started"), say("one"), inside, say("two")]


def test_a_click_selects_a_block(desk):
    desk = desk(story())
    one = desk.body()[1]

    desk.mouse.click(desk.grip(one))

    assert desk.canvas.selection.ids == (one,)
    assert desk.canvas.selection.cursor == one


@pytest.mark.parametrize("held", [CTRL, SHIFT])
def test_a_click_with_shift_or_ctrl_adds_a_block_and_takes_it_out_again(desk, held):
    desk = desk(story())
    _, one, _, two = desk.body()
    desk.mouse.click(desk.grip(one))

    desk.mouse.click(desk.grip(two), modifiers=held)
    both = desk.canvas.selection.ids
    desk.mouse.click(desk.grip(one), modifiers=held)

    assert both == (one, two)
    assert desk.canvas.selection.ids == (two,)


def test_a_click_on_the_empty_canvas_selects_nothing(desk):
    desk = desk(story())
    desk.mouse.click(desk.grip(desk.body()[1]))

    desk.mouse.click(EMPTY)

    assert desk.canvas.selection.ids == ()


def test_a_click_on_one_of_several_selected_blocks_selects_it_alone(desk):
    desk = desk(story())
    _, one, _, two = desk.body()
    desk.canvas.selection.set([one, two])

    desk.mouse.click(desk.grip(two))

    assert desk.canvas.selection.ids == (two,)


def test_a_rubber_band_selects_the_blocks_that_it_touches(desk):
    desk = desk(story())
    _, one, repeat, two = desk.body()
    low = desk.canvas.sight.view_rect_of(two).center().y()

    desk.mouse.drop(QPointF(900, low), desk.grip(one) + QPointF(20, 4))

    assert set(desk.canvas.selection.ids) == {one, repeat, two}


def test_a_rubber_band_in_a_mouth_selects_the_blocks_inside_only(desk):
    desk = desk(story())
    repeat = desk.body()[2]
    first, second = desk.editor.project.blocks[repeat].bodies["do"]

    desk.mouse.drop(
        QPointF(900, desk.canvas.sight.view_rect_of(first).center().y()),
        desk.grip(second) + QPointF(20, 4),
    )

    assert desk.canvas.selection.ids == (first, second)


def test_a_rubber_band_with_shift_adds_to_the_selection(desk):
    desk = desk(story())
    _, one, _, two = desk.body()
    desk.canvas.selection.set([one])
    y = desk.canvas.sight.view_rect_of(two).center().y()

    desk.mouse.drop(QPointF(900, y), QPointF(60, y + 4), SHIFT)

    assert desk.canvas.selection.ids == (one, two)


def test_esc_during_a_rubber_band_gives_the_old_selection_back(desk):
    desk = desk(story())
    one = desk.body()[1]
    desk.canvas.selection.set([one])
    overlays = list(desk.canvas.layers.overlays)
    desk.mouse.drag(QPointF(900, 600), QPointF(50, 50))

    QTest.keyClick(desk.canvas, Qt.Key.Key_Escape)

    assert desk.canvas.selection.ids == (one,)
    assert desk.canvas.layers.overlays == overlays


def test_selecting_changes_nothing_in_the_program(desk):
    desk = desk(story())
    before = desk.file

    desk.mouse.drop(QPointF(900, 600), QPointF(50, 50))
    desk.mouse.click(desk.grip(desk.body()[1]), modifiers=SHIFT)

    assert desk.file == before


def test_a_click_on_a_field_opens_its_editor(desk):
    desk = desk(story())
    one = desk.body()[1]

    desk.mouse.click(desk.field(one, "text"))

    assert desk.canvas.fields.place == (one, "text")
    assert desk.canvas.selection.ids == (one,)


def test_a_drag_from_a_field_carries_the_block(desk):
    desk = desk(story())
    two = desk.body()[3]
    start = desk.field(two, "text")

    desk.mouse.drop(start, start + QPointF(300, 200))

    assert desk.body(1) == [two]
    assert desk.canvas.fields.place is None


def test_a_click_on_a_button_of_a_block_does_what_it_says(desk):
    desk = desk([B("event.started"), B("control.if")])
    fork = desk.body()[1]
    before = dict(desk.editor.project.blocks[fork].groups)
    placed = desk.canvas.page_layout.placed(fork)
    plus = next(p for p in placed.box.pieces if p.piece == "button" and p.kind == "add")
    at = desk.canvas.sight.camera.to_view(
        placed.x + plus.x + 6, placed.y + plus.y + plus.height / 2
    )

    desk.mouse.click(at)

    assert desk.editor.project.blocks[fork].groups != before


def test_a_click_on_a_badge_opens_the_problem(desk, qtbot):
    desk = desk(story())
    one = desk.body()[1]
    problem = Diagnostic("error", "some_kind", "behaviour", one, "This is wrong.")
    desk.canvas.problems.show([problem])
    badge = badge_rect(desk.canvas.page_layout.placed(one), desk.canvas)
    at = desk.canvas.sight.camera.to_view(badge.center().x() + 4, badge.center().y())

    with qtbot.waitSignal(desk.canvas.news.problem_opened) as opened:
        desk.mouse.click(at)

    assert opened.args == [one]


def test_a_double_click_opens_the_block(desk, qtbot):
    desk = desk(story())
    one = desk.body()[1]

    with qtbot.waitSignal(desk.canvas.news.block_opened) as opened:
        desk.mouse.double_click(desk.grip(one))

    assert opened.args == [one]


def test_the_cursor_shows_what_a_press_would_do(desk):
    desk = desk(story())
    one, viewport = desk.body()[1], desk.canvas.viewport()
    shapes = []

    for at in (desk.grip(one), desk.field(one, "text"), EMPTY):
        desk.mouse.move(at)
        shapes.append(viewport.cursor().shape())

    shape = Qt.CursorShape
    assert shapes == [shape.OpenHandCursor, shape.PointingHandCursor, shape.ArrowCursor]


def lines_across(desk, start: QPointF, end: QPointF) -> int:
    """How many lines in the colour of the selection a way through the view crosses."""
    picture, ink = desk.canvas.viewport().grab().toImage(), desk.canvas.look.theme.colour("focus")
    count, steps, was_line = 0, round((end - start).manhattanLength()), False
    for step in range(steps):
        at = (start + (end - start) * step / steps).toPoint()
        seen = picture.pixelColor(at)
        apart = abs(seen.red() - ink.red()) + abs(seen.blue() - ink.blue())
        is_line = apart + abs(seen.green() - ink.green()) < 40
        count, was_line = count + (is_line and not was_line), is_line
    return count


def test_a_selected_block_that_has_the_keyboard_too_has_one_outline(desk):
    desk = desk(story())
    one = desk.body()[1]

    desk.mouse.click(desk.grip(one))

    assert desk.canvas.hasFocus()
    rect = desk.canvas.sight.view_rect_of(one)
    middle = rect.center().y() + 12
    assert (
        lines_across(desk, QPointF(rect.left() - 20, middle), QPointF(rect.left() + 3, middle)) == 1
    )
    right = rect.right() - 6
    assert lines_across(desk, QPointF(right, rect.top() - 20), QPointF(right, rect.top() + 5)) == 1


def test_a_selected_stack_has_one_outline_around_all_of_it(desk):
    desk = desk(story())
    one = desk.body()[1]
    desk.mouse.click(desk.grip(one))

    QTest.keyClick(desk.canvas, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)

    first, last = (desk.canvas.sight.view_rect_of(block) for block in (one, desk.body()[-1]))
    x = first.left() + 4
    assert len(desk.canvas.selection.ids) == len(desk.body())
    assert lines_across(desk, QPointF(x, first.top() - 2), QPointF(x, last.bottom() + 20)) == 1
