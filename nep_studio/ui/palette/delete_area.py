"""Widgets onto which blocks are dropped to delete them."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPoint
from PySide6.QtWidgets import QWidget

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.gestures.drag_blocks import DragBlocks


class DeleteAreas:
    """Says for a canvas whether a place of the screen takes blocks away, and remembers where."""

    def __init__(self, before: Callable[[QPoint], bool]) -> None:
        self._before = before
        self.widgets: list[QWidget] = []
        self.entered: QWidget | None = None

    def __call__(self, place: QPoint) -> bool:
        """Whether a place is on one of the widgets."""
        self.entered = next((widget for widget in self.widgets if holds(widget, place)), None)
        return self.entered is not None or self._before(place)


def add_delete_area(canvas: Canvas, widget: QWidget) -> None:
    """Let blocks of a canvas that are dropped on a widget be deleted, beside where they were."""
    if not isinstance(canvas.delete_area, DeleteAreas):
        canvas.delete_area = DeleteAreas(canvas.delete_area)
    canvas.delete_area.widgets.append(widget)


def is_taking(canvas: Canvas, widget: QWidget) -> bool:
    """Whether blocks of the program are carried over a widget, so that letting go deletes them."""
    areas, gesture = canvas.delete_area, canvas.gesture
    is_here = isinstance(areas, DeleteAreas) and areas.entered is widget
    return is_here and isinstance(gesture, DragBlocks) and bool(gesture.cargo.hidden)


def holds(widget: QWidget, place: QPoint) -> bool:
    """Whether a place of the screen is on a widget that is shown."""
    return widget.isVisible() and widget.rect().contains(widget.mapFromGlobal(place))
