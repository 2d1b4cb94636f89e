"""Move the page under the pointer."""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QNativeGestureEvent, QPainter, QPen, QWheelEvent

from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import boxes_touching

from .gesture import AutoScroll, Gesture, Pointer

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


class Pan(Gesture):
    """What was under the pointer at the press stays under it."""

    def __init__(self, canvas: CanvasHost, pointer: Pointer) -> None:
        self._start = canvas.sight.camera.x, canvas.sight.camera.y
        self._pressed = pointer.view
        canvas.area.viewport().setCursor(Qt.CursorShape.ClosedHandCursor)

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Bring the page along."""
        way = (self._pressed - pointer.view) / canvas.sight.camera.scale
        canvas.sight.move_camera(self._start[0] + way.x(), self._start[1] + way.y())

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Leave the page where it is."""
        self.move(canvas, pointer)
        canvas.area.viewport().unsetCursor()

    def cancel(self, canvas: CanvasHost) -> None:
        """Go back to where the view was."""
        canvas.sight.move_camera(*self._start)
        canvas.area.viewport().unsetCursor()


# Two fingers: the page moves and grows with them.

LEAST_SPREAD_PX = 20.0
"""Fingers nearer to each other than this do not zoom: a pixel would be too much."""


class PinchZoom(Gesture):
    """What was between the fingers at the press stays between them; one alone does nothing."""

    def __init__(self, canvas: CanvasHost, first: QPointF, second: QPointF) -> None:
        self._start = canvas.sight.camera.x, canvas.sight.camera.y, canvas.sight.camera.scale
        self._middle = (first + second) / 2
        self._spread = _spread(first, second)

    def pinch(self, canvas: CanvasHost, first: QPointF, second: QPointF) -> None:
        """Follow the two fingers."""
        middle, spread = (first + second) / 2, _spread(first, second)
        way = self._middle - middle
        canvas.sight.pan(way.x(), way.y())
        if abs(spread - self._spread) >= 1:
            canvas.sight.zoom(canvas.sight.camera.scale * spread / self._spread, middle)
        self._middle, self._spread = middle, spread

    def cancel(self, canvas: CanvasHost) -> None:
        """Go back to where the view was."""
        x, y, scale = self._start
        canvas.sight.zoom(scale)
        canvas.sight.move_camera(x, y)


def _spread(first: QPointF, second: QPointF) -> float:
    way = second - first
    return max(LEAST_SPREAD_PX, hypot(way.x(), way.y()))


# The wheel and the touch pad: scroll, sideways with Shift, zoom with Ctrl.

NOTCH = 120.0
"""What Qt reports for one notch of a wheel."""

NOTCH_PX = 72.0
NOTCH_ZOOM = 1.2


def wheel(canvas: CanvasHost, event: QWheelEvent) -> None:
    """Do what the wheel says; what is dragged comes along."""
    modifiers = event.modifiers()
    notches = QPointF(event.angleDelta()) / NOTCH
    if modifiers & Qt.KeyboardModifier.ControlModifier:
        canvas.sight.zoom(canvas.sight.camera.scale * NOTCH_ZOOM ** notches.y(), event.position())
    else:
        way = QPointF(event.pixelDelta()) if event.hasPixelDelta() else notches * NOTCH_PX
        if modifiers & Qt.KeyboardModifier.ShiftModifier and not way.x():
            way = QPointF(way.y(), 0.0)
        canvas.sight.pan(-way.x(), -way.y())
    event.accept()
    canvas.pointing.repeat()


def native_gesture(canvas: CanvasHost, event: QNativeGestureEvent) -> bool:
    """Zoom as two fingers on a touch pad say; gives whether it was such a gesture."""
    kind = event.gestureType()
    if kind == Qt.NativeGestureType.ZoomNativeGesture:
        canvas.sight.zoom(canvas.sight.camera.scale * (1.0 + event.value()), event.position())
    elif kind == Qt.NativeGestureType.SmartZoomNativeGesture:
        canvas.sight.fit()
    else:
        return False
    event.accept()
    canvas.pointing.repeat()
    return True


# Draw a rectangle on the empty canvas: the blocks that it touches are selected.


class RubberBand(Gesture):
    """With Shift or Ctrl held, the touched blocks are added to those selected before."""

    def __init__(self, canvas: CanvasHost, pointer: Pointer) -> None:
        self._corner = pointer.page
        self._end = pointer.page
        self._before = canvas.selection.ids, canvas.selection.cursor
        held = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.ControlModifier
        self._kept = canvas.selection.ids if pointer.modifiers & held else ()
        self._scroll = AutoScroll(canvas, canvas.pointing.repeat)
        canvas.layers.show_overlay(self)

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Take the rectangle to the pointer."""
        canvas.layers.update_page(self._rect())
        self._end = pointer.page
        canvas.layers.update_page(self._rect())
        touched = touched_blocks(canvas, self._rect())
        canvas.selection.set([*self._kept, *touched])
        self._scroll.follow(pointer.view)

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Keep what is selected."""
        self.move(canvas, pointer)
        self._finish(canvas)

    def cancel(self, canvas: CanvasHost) -> None:
        """Select again what was selected before."""
        canvas.selection.set(*self._before)
        self._finish(canvas)

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the rectangle."""
        colour = view.look.theme.colour("focus")
        painter.setPen(QPen(colour, 1.5 / view.sight.camera.scale))
        colour.setAlphaF(0.12)
        painter.setBrush(colour)
        painter.drawRect(QRectF(*self._rect()))

    def _finish(self, canvas: CanvasHost) -> None:
        self._scroll.end()
        canvas.layers.show_overlay(self, is_shown=False)
        canvas.layers.update_page(self._rect())

    def _rect(self) -> Rect:
        rect = QRectF(self._corner, QPointF(self._end)).normalized()
        return Rect(rect.x(), rect.y(), rect.width(), rect.height())


def touched_blocks(canvas: CanvasHost, rect: Rect) -> list[str]:
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
