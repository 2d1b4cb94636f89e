"""Widgets onto which blocks are dropped to delete them."""

from __future__ import annotations

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QWidget

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.gestures.drag_blocks import DragBlocks


def add_delete_area(canvas: Canvas, widget: QWidget) -> None:
    """Let blocks of a canvas that are dropped on a widget be deleted, beside where they were."""
    before = canvas.delete_area
    canvas.delete_area = lambda place: before(place) or holds(widget, place)


def holds(widget: QWidget, place: QPoint) -> bool:
    """Whether a place of the screen is on a widget that is shown."""
    return widget.isVisible() and widget.rect().contains(widget.mapFromGlobal(place))


def is_deleting(canvas: Canvas) -> bool:
    """Whether what is carried is in the program, so that letting go deletes something."""
    gesture = canvas.gesture
    return isinstance(gesture, DragBlocks) and bool(gesture.cargo.hidden)
