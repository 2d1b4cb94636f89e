"""What of a stack must be painted again: its old and its new layout are compared."""

from __future__ import annotations

from collections.abc import Iterator

from .boxes import Box, Chain
from .index import Rect

Pair = tuple[Chain, Chain, float, float]


def changed_rects(old: Chain, new: Chain, rest: float) -> list[Rect]:
    """The rectangles of the page in which two layouts of a stack differ.

    Boxes that have not changed are the same objects, so that the search goes down only where
    something has changed. ``rest`` is how far blocks reach over their lower side.
    """
    if (old.x, old.y, old.is_mirrored) != (new.x, new.y, new.is_mirrored):
        return [_whole(chain, chain.x, chain.y, rest) for chain in (old, new)]
    rects: list[Rect] = []
    waiting: list[Pair] = [(old, new, new.x, new.y)]
    while waiting:
        one, other, x, y = waiting.pop()
        if one.ys != other.ys:
            rects.append(_from_first_difference(one, other, x, y, rest))
            continue
        for before, after, top in zip(one.boxes, other.boxes, other.ys, strict=False):
            if before is not after:
                left = x - after.width if other.is_mirrored else x
                waiting += _mouths(before, after, left, y + top, rects)
    return rects


def _mouths(before: Box, after: Box, x: float, y: float, rects: list[Rect]) -> Iterator[Pair]:
    """The mouths to compare; what else differs of a block is added to the rectangles."""
    is_same_form = (before.form, before.type) == (after.form, after.type)
    is_same_state = (before.is_disabled, before.is_collapsed) == (
        after.is_disabled,
        after.is_collapsed,
    )
    if not (is_same_form and is_same_state and before.block == after.block):
        reach = max(before.reach, after.reach)
        left = x + after.width - reach if after.is_mirrored else x
        rects.append(Rect(left, y, reach, max(before.height, after.height)))
        return
    if before.pieces != after.pieces or before.plugs != after.plugs:
        rects += _rows(after, x, y)
    for one, other in zip(before.mouths, after.mouths, strict=True):
        yield one, other, x + other.x, y + other.y


def _rows(box: Box, x: float, y: float) -> Iterator[Rect]:
    """The rows of a block, without its mouths."""
    for number, height in enumerate(box.segments):
        if number % 2 == 0:
            yield Rect(x, y, box.width, height)
        y += height


def _from_first_difference(old: Chain, new: Chain, x: float, y: float, rest: float) -> Rect:
    """From the first box that differs down to the end of the longer chain, and around it."""
    number = 0
    for before, after in zip(old.boxes, new.boxes, strict=False):
        if before is not after:
            break
        number += 1
    top = new.ys[min(number, len(new.ys) - 1)]
    whole = _whole(old, x, y, rest).united(_whole(new, x, y, rest))
    return Rect(whole.x, y + top, whole.width, whole.bottom - y - top)


def _whole(chain: Chain, x: float, y: float, rest: float) -> Rect:
    left = x - chain.width if chain.is_mirrored else x
    return Rect(left, y, chain.width, chain.height + rest)
