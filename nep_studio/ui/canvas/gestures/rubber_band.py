"""Draw a rectangle on the empty canvas: the blocks that it touches are selected."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen

from ..index import Rect
from ..page import boxes_touching
from .auto_scroll import AutoScroll
from .gesture import Pointer

if TYPE_CHECKING:
    from ..canvas import Canvas
    from ..view import PageView


class RubberBand:
    """With Shift or Ctrl held, the touched blocks are added to those selected before."""

    def __init__(self, canvas: Canvas, pointer: Pointer) -> None:
        self._corner = pointer.page
        self._end = pointer.page
        self._before = canvas.selection.ids, canvas.selection.cursor
        held = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.ControlModifier
        self._kept = canvas.selection.ids if pointer.modifiers & held else ()
        self._scroll = AutoScroll(canvas, canvas.pointing.repeat)
        canvas.overlays.append(self)

    def move(self, canvas: Canvas, pointer: Pointer) -> None:
        """Take the rectangle to the pointer."""
        canvas.update_page(self._rect())
        self._end = pointer.page
        canvas.update_page(self._rect())
        touched = touched_blocks(canvas, self._rect())
        canvas.selection.set([*self._kept, *touched])
        self._scroll.follow(pointer.view)

    def release(self, canvas: Canvas, pointer: Pointer) -> None:
        """Keep what is selected."""
        self.move(canvas, pointer)
        self._finish(canvas)

    def cancel(self, canvas: Canvas) -> None:
        """Select again what was selected before."""
        canvas.selection.set(*self._before)
        self._finish(canvas)

    def paint(self, painter: QPainter, view: PageView) -> None:
        """Draw the rectangle."""
        colour = view.theme.colour("focus")
        painter.setPen(QPen(colour, 1.5 / view.camera.scale))
        colour.setAlphaF(0.12)
        painter.setBrush(colour)
        rect = self._rect()
        painter.drawRect(QRectF(rect.x, rect.y, rect.width, rect.height))

    def _finish(self, canvas: Canvas) -> None:
        self._scroll.end()
        canvas.overlays.remove(self)
        canvas.update_page(self._rect())

    def _rect(self) -> Rect:
        rect = QRectF(self._corner, QPointF(self._end)).normalized()
        return Rect(rect.x(), rect.y(), rect.width(), rect.height())


def touched_blocks(canvas: Canvas, rect: Rect) -> list[str]:
    """The blocks of chains whose first row a rectangle touches; not those inside such a block.

    Only the first row counts, so that blocks in the mouth of a C block can be had without it.
    """
    layout = canvas.page_layout
    touched: list[str] = []
    waiting = [
        (layout.chains[s], layout.chains[s].x, layout.chains[s].y) for s in layout.near(rect)
    ]
    waiting.reverse()
    while waiting:
        chain, x, y = waiting.pop()
        inner = []
        for box, left, top in boxes_touching(chain, x, y, rect):
            if Rect(left, top, box.width, box.segments[0]).touches(rect):
                touched.append(box.block)
            else:
                inner += [(mouth, left + mouth.x, top + mouth.y) for mouth in box.mouths]
        waiting += reversed(inner)
    return touched
