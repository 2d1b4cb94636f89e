"""Move the page under the pointer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt

from .gesture import Pointer

if TYPE_CHECKING:
    from ..canvas import Canvas


class Pan:
    """What was under the pointer at the press stays under it."""

    def __init__(self, canvas: Canvas, pointer: Pointer) -> None:
        self._start = canvas.camera.x, canvas.camera.y
        self._pressed = pointer.view
        canvas.viewport().setCursor(Qt.CursorShape.ClosedHandCursor)

    def move(self, canvas: Canvas, pointer: Pointer) -> None:
        """Bring the page along."""
        way = (self._pressed - pointer.view) / canvas.camera.scale
        canvas.move_camera(self._start[0] + way.x(), self._start[1] + way.y())

    def release(self, canvas: Canvas, pointer: Pointer) -> None:
        """Leave the page where it is."""
        self.move(canvas, pointer)
        canvas.viewport().unsetCursor()

    def cancel(self, canvas: Canvas) -> None:
        """Go back to where the view was."""
        canvas.move_camera(*self._start)
        canvas.viewport().unsetCursor()
