"""What keys and clicks on the timeline mean, apart from the widget."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt

from nep_studio.ui.motion.editing import SAME_S


def times_with(chosen: Sequence[float], time: float, *, is_more: bool) -> list[float]:
    """The chosen keys after a click on one; with ``is_more`` it joins or leaves the others."""
    others = [t for t in chosen if abs(t - time) >= SAME_S]
    was_chosen = len(others) < len(chosen)
    if is_more:
        return others if was_chosen else [*others, time]
    return list(chosen) if was_chosen else [time]


def shift_of(key: int, step_s: float) -> float | None:
    """How far an arrow key goes in time, or None when it is another key."""
    return {int(Qt.Key.Key_Left): -step_s, int(Qt.Key.Key_Right): step_s}.get(int(key))
