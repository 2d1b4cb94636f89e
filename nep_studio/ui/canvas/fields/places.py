"""Where the editor of a field goes: over the field, and a popup below it or above it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QRect, QRectF, QSize
from PySide6.QtGui import QFont

from ..boxes import Piece
from ..index import Rect
from ..page import Placed

if TYPE_CHECKING:
    from ..canvas import Canvas

SMALLEST_EDITOR_SCALE = 0.75
"""Zoomed out further, an editor is larger than its field: what is typed must be readable."""


def piece_of(canvas: Canvas, block: str, key: str) -> tuple[Placed, Piece] | None:
    """A block on the page and the piece that shows one of its fields, or None."""
    placed = canvas.page_layout.placed(block)
    if placed is None:
        return None
    fields = (p for p in placed.box.pieces if p.piece == "field" and p.key == key)
    piece = next(fields, None)
    return (placed, piece) if piece is not None else None


def page_rect_of(canvas: Canvas, block: str, key: str) -> Rect | None:
    """Where a field is on the page, or None when it cannot be seen there."""
    found = piece_of(canvas, block, key)
    if found is None:
        return None
    placed, piece = found
    return Rect(placed.x + piece.x, placed.y + piece.y, piece.width, piece.height)


def view_rect_of(canvas: Canvas, block: str, key: str) -> QRectF | None:
    """Where a field is in the viewport, or None."""
    rect = page_rect_of(canvas, block, key)
    return canvas.camera.view_rect(rect) if rect is not None else None


def editor_scale(canvas: Canvas) -> float:
    """How large an editor is drawn."""
    return max(canvas.camera.scale, SMALLEST_EDITOR_SCALE)


def editor_font(canvas: Canvas) -> QFont:
    """The font of the fields at the size in which an editor shows it."""
    font = QFont(canvas.block_font)
    font.setPointSizeF(font.pointSizeF() * editor_scale(canvas))
    return font


def beside(field: QRect, size: QSize, room: QRect, *, is_mirrored: bool, gap: int = 4) -> QPoint:
    """The corner of a popup of this size: below a field, above it where there is no room."""
    x = field.right() + 1 - size.width() if is_mirrored else field.left()
    y = field.bottom() + 1 + gap
    if y + size.height() > room.bottom():
        above = field.top() - gap - size.height()
        y = above if above >= room.top() else room.bottom() + 1 - size.height()
    x = min(x, room.right() + 1 - size.width())
    return QPoint(max(x, room.left()), max(y, room.top()))
