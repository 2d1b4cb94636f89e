"""The comments of blocks: one bubble at most is open, beside its block."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPointF, Qt
from PySide6.QtGui import QPainter, QPen

from .comment_bubble import CommentBubble

if TYPE_CHECKING:
    from ..canvas import Canvas
    from ..view import PageView


class Comments(QObject):
    """Opens and closes the bubble, and draws the line from it to its block."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self._canvas = canvas
        self.bubble: CommentBubble | None = None
        canvas.overlays.append(self)
        canvas.view_changed.connect(self._follow)
        canvas.layout_changed.connect(self._follow)
        canvas.page_changed.connect(self.close)

    def open(self, block: str) -> None:
        """Show the comment of a block, to read and to write."""
        self.close()
        if self._canvas.page_layout.placed(block) is None:
            return
        self.bubble = CommentBubble(self._canvas, block, self.close)
        self.bubble.show_bubble()
        self._canvas.viewport().update()

    def close(self) -> None:
        """Keep what was written, and take the bubble away."""
        closing, self.bubble = self.bubble, None
        if closing is not None:
            closing.dispose()
            self._canvas.editor.history.seal()
            self._canvas.viewport().update()
            self._canvas.setFocus(Qt.FocusReason.OtherFocusReason)

    def paint(self, painter: QPainter, view: PageView) -> None:
        """Draw the line from the bubble to its block."""
        if self.bubble is None:
            return
        placed = view.page_layout.placed(self.bubble.block)
        if placed is None:
            return
        is_mirrored = view.measures.is_mirrored
        geometry = self.bubble.geometry()
        row = min(placed.box.height, view.measures.row_height) / 2
        start = QPointF(placed.x + (0 if is_mirrored else placed.box.width), placed.y + row)
        side = geometry.right() if is_mirrored else geometry.left()
        end = view.to_page(QPointF(side, geometry.top() + view.measures.line))
        pixel = 1 / view.camera.scale
        painter.setPen(QPen(view.theme.colour("note_text"), 2 * pixel, Qt.PenStyle.DotLine))
        painter.drawLine(start, end)
        painter.setBrush(view.theme.colour("note_text"))
        painter.drawEllipse(start, 3 * pixel, 3 * pixel)

    def _follow(self) -> None:
        if self.bubble is None:
            return
        if self._canvas.page_layout.placed(self.bubble.block) is None:
            self.close()
        else:
            self.bubble.follow()
