"""Tidy a page: stacks that lie on each other are pushed apart, the others stay where they are."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from itertools import groupby
from typing import Literal, NamedTuple

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.edits.project import MoveStack

# Boxes on a page, and where one has to go so that it lies on no other.

GAP = 24.0
"""How far apart stacks are put, in canvas units."""


class Box(NamedTuple):
    """A rectangle on a page, in canvas units."""

    x: float
    y: float
    width: float
    height: float

    def overlaps(self, other: Box, gap: float = 0.0) -> bool:
        """Whether two boxes are nearer to each other than ``gap``, or lie on each other."""
        return (
            self.x < other.x + other.width + gap
            and other.x < self.x + self.width + gap
            and self.y < other.y + other.height + gap
            and other.y < self.y + self.height + gap
        )


def pushed_apart(box: Box, others: Collection[Box], gap: float = GAP) -> Box:
    """The box moved right or down, whichever is less each time, until it is clear of the others.

    Once clear of a box it stays so, as it never goes back: at most one move for each.
    """
    while blocking := [other for other in others if box.overlaps(other, gap)]:
        other = blocking[0]
        right = other.x + other.width + gap
        down = other.y + other.height + gap
        is_right_nearer = right - box.x < down - box.y
        box = box._replace(x=right) if is_right_nearer else box._replace(y=down)
    return box


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
