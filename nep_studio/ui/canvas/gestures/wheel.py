"""The wheel and the touch pad: scroll, sideways with Shift, zoom with Ctrl."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QNativeGestureEvent, QWheelEvent

if TYPE_CHECKING:
    from ..canvas import Canvas

NOTCH = 120.0
"""What Qt reports for one notch of a wheel."""

NOTCH_PX = 72.0
NOTCH_ZOOM = 1.2


def wheel(canvas: Canvas, event: QWheelEvent) -> None:
    """Do what the wheel says; what is dragged comes along."""
    modifiers = event.modifiers()
    notches = QPointF(event.angleDelta()) / NOTCH
    if modifiers & Qt.KeyboardModifier.ControlModifier:
        canvas.zoom(canvas.camera.scale * NOTCH_ZOOM ** notches.y(), event.position())
    else:
        way = QPointF(event.pixelDelta()) if event.hasPixelDelta() else notches * NOTCH_PX
        if modifiers & Qt.KeyboardModifier.ShiftModifier and not way.x():
            way = QPointF(way.y(), 0.0)
        canvas.pan(-way.x(), -way.y())
    event.accept()
    canvas.pointing.repeat()


def native_gesture(canvas: Canvas, event: QNativeGestureEvent) -> bool:
    """Zoom as two fingers on a touch pad say; gives whether it was such a gesture."""
    kind = event.gestureType()
    if kind == Qt.NativeGestureType.ZoomNativeGesture:
        canvas.zoom(canvas.camera.scale * (1.0 + event.value()), event.position())
    elif kind == Qt.NativeGestureType.SmartZoomNativeGesture:
        canvas.fit()
    else:
        return False
    event.accept()
    canvas.pointing.repeat()
    return True
