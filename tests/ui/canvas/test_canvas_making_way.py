"""A stack that grows pushes the next one away, in the same step of undo."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.operations.moving import NEAREST, Box, make_way
from tests.blocks.block_building import B


def say(text: str) -> B:
    return B("robot.say", {"text": text})


@pytest.fixture
def three(desk):
    """Three stacks below each other, closely, and one to be dragged."""

    def made(*, is_mirrored: bool = False):
        shown = desk(
            [B("event.started"), say("one")],
            [B("event.started"), say("two")],
            [B("event.started"), say("three")],
            [say("new")],
            is_mirrored=is_mirrored,
        )
        side = -1 if is_mirrored else 1
        for number, (x, y) in enumerate([(40, 40), (40, 150), (40, 260), (600, 500)]):
            stack = shown.editor.project.pages["behaviour"][number]
            shown.editor.apply(MoveStack(stack.id, side * x, y))
        return shown

    return made


def places(desk) -> list[tuple[float, float]]:
    return [(stack.x, stack.y) for stack in desk.editor.project.pages["behaviour"]]


def covered(desk) -> list[tuple[str, str]]:
    rects = list(desk.canvas.page_layout.index.rects.items())
    return [(a, b) for a, one in rects for b, two in rects if a < b and one.touches(two)]


@pytest.mark.parametrize("is_mirrored", [False, True])
def test_a_dropped_block_pushes_the_next_stacks_down_and_one_undo_takes_all_back(
    three, is_mirrored
) -> None:
    desk = three(is_mirrored=is_mirrored)
    before, program = places(desk), desk.file
    side = QPointF(-20 if is_mirrored else 20, 0)
    last = desk.canvas.sight.view_rect_of(desk.body(0)[-1])
    foot = last.bottomRight() if is_mirrored else last.bottomLeft()
    rect = desk.canvas.sight.view_rect_of(desk.body(3)[0])
    start = (rect.topRight() if is_mirrored else rect.topLeft()) + side * 0.25 + QPointF(0, 14)

    desk.mouse.drag(start, foot + side * 0.25 + QPointF(0, 18))
    while_dragged = places(desk)
    desk.mouse.release()

    after = places(desk)
    assert len(desk.body(0)) == 3
    assert while_dragged == before
    assert after[0] == before[0]
    assert after[1][1] > before[1][1] and after[2][1] > before[2][1]
    assert [x for x, _ in after] == [x for x, _ in before[:3]]
    assert covered(desk) == []
    assert desk.editor.history.undo()
    assert desk.file == program


def test_only_what_would_be_covered_moves(three) -> None:
    desk = three()
    second, third = desk.editor.project.pages["behaviour"][1:3]
    desk.editor.apply(MoveStack(third.id, 40, 700))
    desk.editor.apply(MoveStack(second.id, 700, 110))
    before = places(desk)

    foot = desk.canvas.sight.view_rect_of(desk.body(0)[-1]).bottomLeft()
    desk.put(desk.body(3)[0], foot)

    assert places(desk) == before[:3]


def test_typing_pushes_the_stack_beside_away_and_is_one_step(three) -> None:
    desk = three()
    second = desk.editor.project.pages["behaviour"][1]
    right = desk.canvas.page_layout.index.rects[desk.editor.project.pages["behaviour"][0].id].right
    desk.editor.apply(MoveStack(second.id, right + 12, 60))
    desk.editor.history.seal()
    steps, before, program = desk.editor.history.steps, places(desk), desk.file

    desk.mouse.click(desk.field(desk.body(0)[1], "text"))
    QTest.keyClicks(QApplication.focusWidget(), "a much longer sentence")
    QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Return)

    assert places(desk)[1][0] > before[1][0]
    assert places(desk)[1][1] == before[1][1]
    assert covered(desk) == []
    assert desk.editor.history.steps == steps + 1
    assert desk.editor.history.undo()
    assert desk.file == program


def test_esc_while_typing_brings_the_pushed_stack_back(three) -> None:
    desk = three()
    second = desk.editor.project.pages["behaviour"][1]
    right = desk.canvas.page_layout.index.rects[desk.editor.project.pages["behaviour"][0].id].right
    desk.editor.apply(MoveStack(second.id, right + 12, 60))
    program = desk.file

    desk.mouse.click(desk.field(desk.body(0)[1], "text"))
    QTest.keyClicks(QApplication.focusWidget(), "a much longer sentence")
    QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_Escape)

    assert desk.file == program


def test_what_covers_another_already_stays(three) -> None:
    desk = three()
    second = desk.editor.project.pages["behaviour"][1]
    desk.editor.apply(MoveStack(second.id, 60, 70))
    before = places(desk)

    desk.put(desk.body(3)[0], desk.canvas.sight.view_rect_of(desk.body(2)[-1]).bottomLeft())

    assert places(desk)[:3] == before[:3]


BOXES = st.builds(
    Box, st.integers(0, 600), st.integers(0, 600), st.integers(20, 200), st.integers(20, 200)
)


@given(st.lists(BOXES, min_size=1, max_size=9), st.integers(0, 300), st.integers(0, 300))
def test_nothing_newly_covered_below_or_beside_a_grown_stack_stays_there(boxes, wider, higher):
    before = {str(number): box for number, box in enumerate(boxes)}
    first = before["0"]
    grown = first._replace(width=first.width + wider, height=first.height + higher)

    pushed = make_way(before, {"0": grown})

    now = before | {"0": grown} | pushed
    for stack, box in before.items():
        below = box.y >= first.y + first.height or box.x >= first.x + first.width
        if stack != "0" and below and not first.overlaps(box, NEAREST) and "0" not in pushed:
            assert not grown.overlaps(now[stack], NEAREST)
    assert all(now[stack].x >= before[stack].x for stack in before)
    assert all(now[stack].y >= before[stack].y for stack in before)
