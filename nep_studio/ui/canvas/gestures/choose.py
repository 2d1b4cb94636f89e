"""Which gesture a press begins, by the button, the keys held, and what is under the pointer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt

from ..index import Rect
from ..note_editing import note_gesture
from ..overlay import badge_rect
from ..page import Hit
from .gesture import Gesture, Pointer
from .pan import Pan
from .press import Press

if TYPE_CHECKING:
    from ..canvas import Canvas


def choose(canvas: Canvas, pointer: Pointer, hit: Hit | None) -> Gesture | None:
    """The gesture that begins with a press; None when the button begins none."""
    is_left = pointer.button == Qt.MouseButton.LeftButton
    if pointer.button == Qt.MouseButton.MiddleButton or (is_left and canvas.pointing.is_space_down):
        return Pan(canvas, pointer)
    if not is_left:
        return None
    if hit is None and (gesture := note_gesture(canvas, pointer)) is not None:
        return gesture
    return Press(canvas, pointer, hit, problem=problem_at(canvas, pointer.page))


def problem_at(canvas: Canvas, at: QPointF) -> str:
    """The block whose problem badge is at a point of the page; empty when there is none."""
    if not canvas.problems.problems:
        return ""
    margin = 20 * canvas.measures.unit
    around = Rect(at.x() - margin, at.y() - margin, 2 * margin, 2 * margin)
    for placed in canvas.page_layout.boxes(around):
        block = placed.box.block
        if block in canvas.problems.problems and badge_rect(placed, canvas).contains(at):
            return block
    return ""
