"""Where a long drawing is cut into pages: between its pieces, never through one that fits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

Span = tuple[float, float]
"""From where to where something lies, from above."""


def cut(levels: Sequence[Iterable[Span]], height: float) -> list[Span]:
    """Cut a drawing into pieces of at most ``height``, from above, without what is empty between.

    ``levels`` are where its things lie, then where their parts do, and so on. A piece ends where
    no thing is; else where no part is; and where even the finest parts leave no place, anywhere.
    """
    sorted_levels = [sorted(level) for level in levels]
    whole = sorted_levels[0] if sorted_levels else []
    if not whole or height <= 0:
        return []
    start, end = whole[0][0], max(bottom for _, bottom in whole)
    pieces = []
    while start < end:
        stop = end if start + height >= end else _stop(sorted_levels, start, height)
        pieces.append((start, stop))
        start = min((max(top, stop) for top, bottom in whole if bottom > stop), default=end)
    return pieces


def _stop(levels: Sequence[Sequence[Span]], start: float, height: float) -> float:
    """The lowest place on the page that is inside nothing of the coarsest level that has one."""
    limit = start + height
    for spans in levels:
        edges = sorted({edge for span in spans for edge in span if start < edge <= limit})
        free = [edge for edge in edges if not any(top < edge < bottom for top, bottom in spans)]
        if free:
            return free[-1]
    return limit
