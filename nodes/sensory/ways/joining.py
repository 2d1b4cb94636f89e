"""Puts the sensors of one device together, which it measures and tells separately."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence

from nodes.sensory.reading import Vector

Timed = tuple[float, Vector]
"""A time on the sender's clock, in its unit, and three values."""


def nearest(measured: Sequence[Timed], time: float, within: float) -> Vector | None:
    """The values at ``time``, between the two beside it, or of the nearest; None if far away.

    ``measured`` is in the order of its times.
    """
    at = bisect_left(measured, time, key=lambda one: one[0])
    before = measured[at - 1] if at > 0 else None
    after = measured[at] if at < len(measured) else None
    if before is not None and after is not None and after[0] - before[0] <= 2 * within:
        return _between(before, after, time)
    near = [one for one in (before, after) if one is not None and abs(one[0] - time) <= within]
    return min(near, key=lambda one: abs(one[0] - time))[1] if near else None


def _between(before: Timed, after: Timed, time: float) -> Vector:
    span = after[0] - before[0]
    share = (time - before[0]) / span if span > 0 else 0.0
    x, y, z = (one + share * (other - one) for one, other in zip(before[1], after[1], strict=True))
    return x, y, z
