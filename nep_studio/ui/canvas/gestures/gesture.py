"""A gesture: what happens between a press and a release."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPointF, Qt

if TYPE_CHECKING:
    from ..canvas import Canvas

DRAG_PX, TOUCH_DRAG_PX = 5.0, 10.0
"""How far the mouse, or a finger, moves before a press becomes a drag."""


@dataclass(frozen=True, slots=True)
class Pointer:
    """Where the mouse or the finger is: in the viewport and on the page."""

    view: QPointF
    page: QPointF
    button: Qt.MouseButton = Qt.MouseButton.LeftButton
    modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier
    is_touch: bool = False

    def is_far(self, other: QPointF) -> bool:
        """Whether it has moved so far from a point of the view that a drag is meant."""
        way = self.view - other
        return max(abs(way.x()), abs(way.y())) >= (TOUCH_DRAG_PX if self.is_touch else DRAG_PX)


class Gesture(Protocol):
    """One gesture under way; the canvas tells it what happens until it ends."""

    def move(self, canvas: Canvas, pointer: Pointer) -> None:
        """The pointer moved."""

    def release(self, canvas: Canvas, pointer: Pointer) -> None:
        """The button was released: do what was meant."""

    def cancel(self, canvas: Canvas) -> None:
        """Esc was pressed, or the press was taken away: everything is as it was before."""
