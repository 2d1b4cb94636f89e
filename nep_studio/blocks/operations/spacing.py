"""Boxes on a page, and where one has to go so that it lies on no other."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

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
