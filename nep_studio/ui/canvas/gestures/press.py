"""A press that is not yet a click or a drag: how far it moves, and how long it lasts, decides."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, QTimer

from ..page import Hit
from .cargo import lift
from .drag_blocks import DragBlocks
from .drag_out_copy import copy_of, pulled_out
from .gesture import Gesture, Pointer
from .long_press import LONG_PRESS_MS, LongPress
from .pan import Pan
from .reorder_parts import ReorderParts, can_reorder
from .rubber_band import RubberBand

if TYPE_CHECKING:
    from ..canvas import Canvas

ADDS = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.ControlModifier
ALONE = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier


class Press:
    """A click selects, opens a field or presses a button; a drag carries, selects or scrolls."""

    def __init__(
        self, canvas: Canvas, pointer: Pointer, hit: Hit | None, *, problem: str = ""
    ) -> None:
        self.is_double = False
        self._start = pointer
        self._hit = hit
        self._problem = problem
        self._timer = QTimer(canvas, singleShot=True, interval=LONG_PRESS_MS)
        if pointer.is_touch:
            self._timer.timeout.connect(lambda: canvas.begin(LongPress(canvas, pointer)))
            self._timer.start()

    def move(self, canvas: Canvas, pointer: Pointer) -> None:
        """Become a drag when the pointer has moved far enough."""
        if pointer.is_far(self._start.view):
            self.cancel(canvas)
            drag = self._drag(canvas)
            canvas.begin(drag)
            drag.move(canvas, pointer)

    def release(self, canvas: Canvas, pointer: Pointer) -> None:
        """It was a click."""
        self.cancel(canvas)
        is_adding = bool(self._start.modifiers & ADDS)
        if self._problem:
            canvas.problem_opened.emit(self._problem)
        elif self._hit is None:
            if not is_adding:
                canvas.selection.clear()
        elif is_adding:
            canvas.selection.toggle(self._hit.block)
        else:
            self._click(canvas, self._hit)

    def cancel(self, canvas: Canvas) -> None:
        """Nothing has happened yet."""
        self._timer.stop()
        self._timer.deleteLater()

    def _click(self, canvas: Canvas, hit: Hit) -> None:
        canvas.selection.set([hit.block])
        piece = hit.piece
        if piece is not None and piece.piece == "button":
            canvas.fields.press_button(hit.block, piece.kind, piece.key, piece.number)
        elif piece is not None and canvas.fields.open(hit.block, piece.key):
            return
        elif self.is_double:
            canvas.block_opened.emit(hit.block)

    def _drag(self, canvas: Canvas) -> Gesture:
        start = self._start
        if self._hit is None:
            return Pan(canvas, start) if start.is_touch else RubberBand(canvas, start)
        if can_reorder(canvas, self._hit):
            return ReorderParts(canvas, self._hit)
        held = start.modifiers & ALONE
        pulled = copy_of(canvas, self._hit) if held == ALONE else pulled_out(canvas, self._hit)
        cargo = pulled or lift(canvas, self._hit.block, alone=bool(held))
        return DragBlocks(canvas, cargo, start.page)
