"""Drag a repeated part of a block (an item, an else-if) to another place among its like."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPainter, QPen

from nep_studio.blocks.operations.wrapping import move_part
from nep_studio.blocks.program import split_slot
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import Hit, Placed
from nep_studio.ui.words import tr

from .gesture import Gesture, Pointer

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

Bar = Rect
"""A thin rectangle between two parts, before the first or after the last."""


class ReorderParts(Gesture):
    """A part in the hand, held by its minus; a bar shows where it would go.

    Nothing changes in the program until it is dropped.
    """

    def __init__(self, canvas: CanvasHost, hit: Hit) -> None:
        assert hit.piece is not None
        self._block, self._group, self._number = hit.block, hit.piece.key, hit.piece.number
        self._bars = _bars(canvas, hit.placed, hit.piece.key)
        self._shown: Bar | None = None
        canvas.layers.show_overlay(self)
        canvas.area.viewport().setCursor(Qt.CursorShape.ClosedHandCursor)

    @property
    def place(self) -> int:
        """The number that the part would get."""
        if self._shown is None:
            return self._number
        before = self._bars.index(self._shown)
        return before if before >= self._number else before + 1

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Show the bar that is nearest."""
        x, y = pointer.page.x(), pointer.page.y()
        nearest = min(self._bars, key=lambda bar: bar.distance(x, y), default=None)
        if nearest != self._shown:
            self._update(canvas)
            self._shown = nearest
            self._update(canvas)

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Put the part where the bar is."""
        self.move(canvas, pointer)
        to = self.place
        self.cancel(canvas)
        if to != self._number and canvas.attempt(
            lambda: move_part(canvas.editor, self._block, self._group, self._number, to)
        ):
            canvas.news.announced.emit(tr("Moved to place {n}", n=to))

    def cancel(self, canvas: CanvasHost) -> None:
        """Show the block as it was: nothing has changed."""
        canvas.layers.show_overlay(self, is_shown=False)
        self._update(canvas)
        canvas.area.viewport().unsetCursor()

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the bar."""
        bar = self._shown
        if bar is None:
            return
        pen = QPen(view.look.theme.colour("snap"), 4 * view.look.measures.unit)
        pen.setCapStyle(Qt.PenCapStyle.RoundCap)
        painter.setPen(pen)
        painter.drawLine(QPointF(bar.x, bar.y), QPointF(bar.right, bar.bottom))

    def _update(self, canvas: CanvasHost) -> None:
        if self._shown is not None:
            canvas.layers.update_page(self._shown.grown(4 * canvas.look.measures.unit))


def can_reorder(canvas: CanvasHost, hit: Hit) -> bool:
    """Whether a press holds a part, by its minus, that has others beside it."""
    piece = hit.piece
    if piece is None or (piece.piece, piece.kind) != ("button", "remove"):
        return False
    return canvas.editor.project.blocks[hit.block].groups.get(piece.key, 0) > 1


def _bars(canvas: CanvasHost, placed: Placed, group: str) -> list[Bar]:
    """Where the parts of a group can be put: before each of them, and after the last."""
    # What each part of a group covers of its block, on the page
    names, found = _names(canvas, placed, group), dict[int, Rect]()
    for key, rect in _rects(placed):
        name, number = split_slot(key)
        if name in names:
            found[number] = rect.united(found[number]) if number in found else rect
    parts = [found[number] for number in sorted(found)]
    if any(
        split_slot(mouth.key)[0] in _names(canvas, placed, group) for mouth in placed.box.mouths
    ):
        lines = [Rect(placed.x, part.y, placed.box.width, 0.0) for part in parts]
        return [*lines, Rect(placed.x, parts[-1].bottom, placed.box.width, 0.0)]
    half = canvas.look.measures.gap / 2
    is_mirrored = placed.box.is_mirrored
    starts = [part.right + half if is_mirrored else part.x - half for part in parts]
    end = parts[-1].x - half if is_mirrored else parts[-1].right + half
    lines = [Rect(x, part.y, 0.0, part.height) for x, part in zip(starts, parts, strict=True)]
    return [*lines, Rect(end, parts[-1].y, 0.0, parts[-1].height)]


def _rects(placed: Placed) -> list[tuple[str, Rect]]:
    """The slots of a block with their places on the page, its mouths too."""
    box, x, y = placed.box, placed.x, placed.y
    seen = (piece for piece in box.pieces if piece.piece in ("field", "socket"))
    rects = [(p.key, Rect(x + p.x, y + p.y, p.width, p.height)) for p in seen]
    rects += [(p.key, Rect(x + p.x, y + p.y, p.box.width, p.box.height)) for p in box.plugs]
    for number, mouth in enumerate(box.mouths):
        height = box.segments[2 * number + 1]
        rects.append((mouth.key, Rect(x, y + mouth.y, box.width, height)))
    return rects


def _names(canvas: CanvasHost, placed: Placed, group: str) -> tuple[str, ...]:
    return canvas.editor.language.definitions[placed.box.type].group_slots(group)
