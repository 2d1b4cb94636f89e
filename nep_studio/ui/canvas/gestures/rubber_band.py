"""Draw a rectangle on the empty canvas: the blocks that it touches are selected."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen

from nep_studio.blocks.operations.selection import is_inside

from ..index import Rect
from ..page import Placed
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
    touched: dict[str, None] = {}
    for placed in _heads(canvas, rect):
        if not is_inside(canvas.editor.project, placed.box.block, touched):
            touched[placed.box.block] = None
    return list(touched)


def _heads(canvas: Canvas, rect: Rect) -> Iterator[Placed]:
    parents = canvas.editor.project.parents
    for placed in canvas.page_layout.boxes(rect):
        box = placed.box
        is_plugged = box.outline not in ("statement", "hat", "cap")
        if is_plugged and parents[box.block].slot:
            continue
        if Rect(placed.x, placed.y, box.width, box.segments[0]).touches(rect):
            yield placed
