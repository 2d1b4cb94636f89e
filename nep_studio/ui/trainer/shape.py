"""How the parts of the page are arranged, by the room that there is for them."""

from __future__ import annotations

from dataclasses import dataclass

WIDE, TWO, NARROW = 64.0, 44.0, 30.0
"""Lines of text across: three columns fit, two fit, fewer than that is one."""
HIGH = 34.0
"""So high, the gestures have room below the graph."""


@dataclass(frozen=True)
class Shape:
    """Whether recording is a tab beside the others, and what stands beside what."""

    is_tabbed: bool
    is_beside: bool
    has_cards_beside: bool


def shape_for(wide: float, high: float) -> Shape:
    """The shape for a room of so many lines of text."""
    if high >= HIGH:
        is_narrow = wide < TWO
        return Shape(is_tabbed=is_narrow, is_beside=not is_narrow, has_cards_beside=False)
    if wide >= WIDE:
        return Shape(is_tabbed=False, is_beside=True, has_cards_beside=True)
    return Shape(is_tabbed=True, is_beside=False, has_cards_beside=wide >= NARROW)
