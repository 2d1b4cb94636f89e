"""Where a stack goes that was dropped very near to another one, without snapping to it."""

from __future__ import annotations

from collections.abc import Mapping

from .spacing import GAP, Box, pushed_apart


def bumped(box: Box, others: Mapping[str, Box], gap: float = GAP) -> tuple[float, float] | None:
    """Where the stack in ``box`` has to move so that it is clear, or None when it is clear.

    ``others`` are the boxes of the other stacks of the page by stack.
    """
    near = [other for other in others.values() if box.overlaps(other)]
    if not near:
        return None
    clear = pushed_apart(box, others.values(), gap)
    return clear.x, clear.y
