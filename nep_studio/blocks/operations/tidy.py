"""Tidy a page: stacks that lie on each other are pushed apart, the others stay where they are."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby
from typing import Literal

from ..editor import Editor
from ..edits import MoveStack
from .spacing import GAP, Box, pushed_apart

Sizes = Mapping[str, tuple[float, float]]
"""The width and height of each stack, in canvas units."""


def tidy(
    editor: Editor,
    page: str,
    sizes: Sizes,
    *,
    align: Literal["", "columns"] = "",
    is_mirrored: bool = False,
) -> tuple[str, ...]:
    """Push overlapping stacks apart, or put all in columns; gives the stacks that moved.

    No stack gets a place before one that was before it: the order of reading stays. On a mirrored
    page, where a stack's place is its right corner, everything goes from right to left.
    """
    side = -1 if is_mirrored else 1
    boxes = {
        stack.id: Box(side * stack.x, stack.y, *sizes.get(stack.id, (0.0, 0.0)))
        for stack in editor.project.pages[page]
    }
    placed = in_columns(boxes) if align == "columns" else apart(boxes)
    moved = tuple(stack for stack, box in placed.items() if box[:2] != boxes[stack][:2])
    with editor.transaction("tidy up"):
        for stack in moved:
            editor.apply(MoveStack(stack, side * placed[stack].x, placed[stack].y))
    return moved


def apart(boxes: Mapping[str, Box], gap: float = GAP) -> dict[str, Box]:
    """Boxes in reading order, each pushed clear of those before it; who is clear stays."""
    placed: dict[str, Box] = {}
    for stack in sorted(boxes, key=lambda stack: (boxes[stack].y, boxes[stack].x)):
        touching = [box for box in placed.values() if boxes[stack].overlaps(box)]
        free = not touching
        placed[stack] = boxes[stack] if free else pushed_apart(boxes[stack], placed.values(), gap)
    return placed


def in_columns(boxes: Mapping[str, Box], gap: float = GAP) -> dict[str, Box]:
    """Boxes in columns: those whose left edges are near each other are one column."""
    placed: dict[str, Box] = {}
    by_x = sorted(boxes, key=lambda stack: boxes[stack].x)
    right = min((box.x for box in boxes.values()), default=0.0)
    top = min((box.y for box in boxes.values()), default=0.0)
    for _, column in groupby(by_x, key=_column_numbers(boxes, by_x).__getitem__):
        x, y = right, top
        for stack in sorted(column, key=lambda stack: (boxes[stack].y, boxes[stack].x)):
            placed[stack] = boxes[stack]._replace(x=x, y=y)
            y += boxes[stack].height + gap
            right = max(right, x + boxes[stack].width + gap)
    return placed


def _column_numbers(boxes: Mapping[str, Box], by_x: list[str]) -> dict[str, int]:
    """A box begins a column when it begins right of the middle of the column's first box."""
    numbers: dict[str, int] = {}
    number, middle = -1, float("-inf")
    for stack in by_x:
        box = boxes[stack]
        if number < 0 or box.x > middle:
            number, middle = number + 1, box.x + max(box.width / 2, GAP)
        numbers[stack] = number
    return numbers
