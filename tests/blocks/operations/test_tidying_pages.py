"""Tidying and bumping: no overlaps, no new order, as little movement as can be."""

from __future__ import annotations

from itertools import combinations

from block_building import build
from hypothesis import given
from hypothesis import strategies as st
from operating import one_step, say

from nep_studio.blocks.operations.moving import (
    GAP,
    Box,
    apart,
    bumped,
    in_columns,
    pushed_apart,
    tidy,
)

BOXES = st.lists(
    st.builds(Box, *[st.integers(-300, 300)] * 2, *[st.integers(1, 300)] * 2), max_size=25
).map(lambda boxes: {f"s{n}": box for n, box in enumerate(boxes)})


@given(BOXES)
def test_no_two_stacks_overlap_after_tidying(boxes):
    for placed in (apart(boxes), in_columns(boxes)):
        assert placed.keys() == boxes.keys()
        for one, other in combinations(placed.values(), 2):
            assert not one.overlaps(other)


@given(BOXES)
def test_tidying_twice_changes_nothing_more(boxes):
    once = apart(boxes)

    assert apart(once) == once


def test_only_stacks_that_overlap_move_and_by_the_shorter_way():
    boxes = {
        "a": Box(0, 0, 200, 600),
        "b": Box(190, 10, 200, 600),
        "c": Box(900, 0, 50, 50),
        "d": Box(10, 590, 100, 100),
    }

    placed = apart(boxes)

    assert placed["a"] == boxes["a"] and placed["c"] == boxes["c"]
    assert placed["b"] == boxes["b"]._replace(x=200 + GAP)
    assert placed["d"] == boxes["d"]._replace(y=600 + GAP)


def test_columns_keep_the_order_from_top_to_bottom():
    boxes = {
        "low": Box(5, 500, 100, 50),
        "high": Box(0, 20, 100, 50),
        "right": Box(400, 90, 10, 10),
    }

    placed = in_columns(boxes)

    assert placed["high"][:2] == (0, 20)
    assert placed["low"][:2] == (0, 20 + 50 + GAP)
    assert placed["right"][:2] == (100 + GAP, 20)


def test_tidying_a_page_is_one_step_and_keeps_the_order_of_the_page(language):
    editor = build(language, [say("a")], [say("b")], [say("c")])
    stacks = editor.project.pages["behaviour"]
    sizes = {stack.id: (400.0, 250.0) for stack in stacks}

    with one_step(editor):
        moved = tidy(editor, "behaviour", sizes)

    assert moved == (stacks[1].id, stacks[2].id)
    assert [stack.y for stack in stacks] == [40, 290 + GAP, 540 + 2 * GAP]
    assert tidy(editor, "behaviour", sizes) == ()


def test_a_stack_near_another_is_bumped_clear_and_a_clear_one_stays():
    others = {"a": Box(0, 0, 100, 100)}

    assert bumped(Box(95, 50, 40, 40), others) == (100 + GAP, 50)
    assert bumped(Box(105, 50, 40, 40), others) is None


@given(BOXES, st.builds(Box, *[st.integers(-300, 300)] * 2, *[st.integers(1, 300)] * 2))
def test_a_pushed_box_is_clear_and_never_left_or_above(boxes, box):
    pushed = pushed_apart(box, boxes.values())

    assert not any(pushed.overlaps(other, GAP) for other in boxes.values())
    assert pushed.x >= box.x and pushed.y >= box.y
