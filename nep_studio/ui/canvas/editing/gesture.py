"""A gesture: what happens between a press and a release."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt, QTimer

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


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


class Gesture:
    """One gesture under way; the canvas tells it what happens until it ends.

    A gesture leaves out what means nothing to it.
    """

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """The pointer moved."""

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """The button was released: do what was meant."""

    def cancel(self, canvas: CanvasHost) -> None:
        """Esc was pressed, or the press was taken away: everything is as it was before."""


# Scrolls while something is dragged near the edge of the view: the nearer, the faster.

EDGE_PX = 36.0
"""How near to the edge scrolling begins."""

FASTEST_PX = 22.0
"""How far the view moves at each tick when the pointer is at the edge or beyond."""

TICK_MS = 16


class AutoScroll:
    """Scrolls once the pointer has been well inside the view: blocks come from the side too."""

    def __init__(self, canvas: CanvasHost, scrolled: Callable[[], None]) -> None:
        self._canvas = canvas
        self._scrolled = scrolled
        self._was_inside = False
        self._step = QPointF()
        self._timer = QTimer(canvas.area, interval=TICK_MS)
        self._timer.timeout.connect(self._on_tick)

    def follow(self, at: QPointF, *, is_resting: bool = False) -> None:
        """Take the pointer's place in the view."""
        view = self._canvas.area.viewport().rect()
        dx, dy = _depth(at.x(), view.width()), _depth(at.y(), view.height())
        self._was_inside = self._was_inside or (dx == dy == 0)
        if is_resting or not self._was_inside or (dx == dy == 0):
            self._timer.stop()
            return
        self._step = QPointF(dx, dy) * FASTEST_PX
        if not self._timer.isActive():
            self._timer.start()

    def end(self) -> None:
        """Scroll no more."""
        self._timer.stop()
        self._timer.deleteLater()

    def _on_tick(self) -> None:
        self._canvas.sight.pan(self._step.x(), self._step.y())
        self._scrolled()


def _depth(at: float, length: float) -> float:
    """How deep a point is in the edge zone: -1 at the beginning, 1 at the end, 0 between."""
    zone = min(EDGE_PX, length / 4)
    if at < zone:
        return max(-1.0, (at - zone) / zone)
    return min(1.0, (at - (length - zone)) / zone) if at > length - zone else 0.0
