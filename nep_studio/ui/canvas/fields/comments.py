"""The sticky note beside a block, in which its comment is written."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint, QPointF, QSize, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QFrame, QPlainTextEdit, QWidget

from nep_studio.blocks.edits.content import SetComment, SetCommentSize
from nep_studio.blocks.text import sentence
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

from .field_edit import editor_font, editor_scale

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


WIDTH, HEIGHT = 220.0, 110.0
SMALLEST_WIDTH, SMALLEST_HEIGHT = 110.0, 60.0
_GAP = 26.0
"""Between a block and its comment, and the sizes above, in canvas units."""


class NoteText(QPlainTextEdit):
    """The text of a note; Esc ends the writing."""

    def __init__(self, parent: QWidget, ended: Callable[[], None]) -> None:
        super().__init__(parent)
        self._ended = ended
        self.setTabChangesFocus(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        labelled(self, placeholder="Write a note")

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc ends the writing, and so does Ctrl+Enter."""
        is_enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        is_ctrl = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        if event.key() == Qt.Key.Key_Escape or (is_enter and is_ctrl):
            self._ended()
        else:
            super().keyPressEvent(event)


class Corner(QWidget):
    """What a note is made larger or smaller by."""

    def __init__(
        self, parent: QWidget, moved: Callable[[QPoint], None], ended: Callable[[], None]
    ) -> None:
        super().__init__(parent)
        self._moved, self._ended = moved, ended
        self._from: QPointF | None = None
        self.setCursor(Qt.CursorShape.SizeFDiagCursor)
        labelled(self, name="Change the size of the note")

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take hold of the corner."""
        self._from = event.globalPosition()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Pull the corner."""
        if self._from is not None:
            self._moved((event.globalPosition() - self._from).toPoint())
            self._from = event.globalPosition()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        self._from = None
        self._ended()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw two slanted lines."""
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(QPen(self.palette().windowText().color(), 1.5))
            side = self.width()
            for inset in (0.2, 0.55):
                low, high = side * inset, side * 0.9
                start, end = QPointF(low, high), QPointF(high, low)
                if is_mirrored:
                    start, end = QPointF(side - low, high), QPointF(side - high, low)
                painter.drawLine(start, end)


class CommentBubble(QFrame):
    """The comment of one block; what is written is in the block at once."""

    def __init__(self, canvas: CanvasHost, block: str, ended: Callable[[], None]) -> None:
        super().__init__(canvas.area.viewport())
        self._canvas, self.block = canvas, block
        theme = canvas.look.theme
        self.setObjectName("note")
        ink = theme.colour("note_text").name()
        self.setStyleSheet(
            f"#note {{ background: {theme.colour('note').name()}; border: 1px solid {ink};"
            " border-radius: 6px; }"
            f"#note QPlainTextEdit {{ background: transparent; border: none; color: {ink}; }}"
        )
        self.text = NoteText(self, ended)
        self.text.setPlainText(canvas.editor.project.blocks[block].comment)
        self.text.textChanged.connect(self._on_written)
        self.corner = Corner(self, self._on_pulled, self._on_sized)
        in_column(self.text, of=self, margins=4)
        there = canvas.editor.project.blocks[block]
        self._size = (there.comment_width or WIDTH, there.comment_height or HEIGHT)
        canvas.editor.history.seal()
        follow_words(self, self._say)

    def _say(self) -> None:
        canvas, direction = self._canvas, Qt.LayoutDirection
        is_mirrored = canvas.look.measures.is_mirrored
        self.setLayoutDirection(direction.RightToLeft if is_mirrored else direction.LeftToRight)
        said = sentence(canvas.editor.project, canvas.editor.language, self.block)
        self.text.setAccessibleName(tr("Comment of the block “{block}”", block=said))

    def follow(self) -> None:
        """Stay beside the block."""
        placed = self._canvas.page_layout.placed(self.block)
        if placed is None:
            return
        canvas, scale = self._canvas, editor_scale(self._canvas)
        size = QSize(round(self._size[0] * scale), round(self._size[1] * scale))
        gap = _GAP * canvas.sight.camera.scale
        rect = canvas.sight.camera.view_rect(placed.rect)
        is_mirrored = canvas.look.measures.is_mirrored
        x = rect.left() - gap - size.width() if is_mirrored else rect.right() + gap
        self.text.setFont(editor_font(canvas))
        self.setGeometry(round(x), round(rect.top()), size.width(), size.height())
        side = round(14 * canvas.look.measures.unit)
        corner = 2 if is_mirrored else size.width() - side - 2
        self.corner.setGeometry(corner, size.height() - side - 2, side, side)
        self.corner.raise_()

    def _on_written(self) -> None:
        editor, text = self._canvas.editor, self.text.toPlainText()
        if self.block in editor.project.blocks:
            self._canvas.attempt(lambda: editor.apply(SetComment(self.block, text)))

    def _on_pulled(self, by: QPoint) -> None:
        scale = editor_scale(self._canvas)
        sign = -1 if self._canvas.look.measures.is_mirrored else 1
        self._size = (
            max(SMALLEST_WIDTH, self._size[0] + sign * by.x() / scale),
            max(SMALLEST_HEIGHT, self._size[1] + by.y() / scale),
        )
        self.follow()
        self._canvas.area.viewport().update()

    def _on_sized(self) -> None:
        editor, (width, height) = self._canvas.editor, self._size
        block = editor.project.blocks[self.block]
        if (block.comment_width, block.comment_height) != (width, height):
            self._canvas.attempt(lambda: editor.apply(SetCommentSize(self.block, width, height)))


# The comments of blocks: one bubble at most is open, beside its block.


class Comments(QObject):
    """Opens and closes the bubble, and draws the line from it to its block."""

    def __init__(self, canvas: CanvasHost) -> None:
        super().__init__(canvas.area)
        self._canvas = canvas
        self.bubble: CommentBubble | None = None
        canvas.news.page_changed.connect(self.close)

    def open(self, block: str) -> None:
        """Show the comment of a block, to read and to write."""
        self.close()
        if self._canvas.page_layout.placed(block) is None:
            return
        self.bubble = CommentBubble(self._canvas, block, self.close)
        self._canvas.layers.show_overlay(self)
        for signal in (self._canvas.news.view_changed, self._canvas.news.layout_changed):
            signal.connect(self._follow)
        self.bubble.follow()
        self.bubble.show()
        self.bubble.text.setFocus(Qt.FocusReason.OtherFocusReason)
        self._canvas.area.viewport().update()

    def close(self) -> None:
        """Keep what was written, and take the bubble away."""
        closing, self.bubble = self.bubble, None
        if closing is not None:
            closing.hide()
            closing.deleteLater()
            self._canvas.layers.show_overlay(self, is_shown=False)
            for signal in (self._canvas.news.view_changed, self._canvas.news.layout_changed):
                signal.disconnect(self._follow)
            self._canvas.editor.history.seal()
            self._canvas.area.viewport().update()
            self._canvas.area.setFocus(Qt.FocusReason.OtherFocusReason)

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the line from the bubble to its block."""
        if self.bubble is None:
            return
        placed = view.page_layout.placed(self.bubble.block)
        if placed is None:
            return
        is_mirrored = view.look.measures.is_mirrored
        geometry = self.bubble.geometry()
        row = min(placed.box.height, view.look.measures.row_height) / 2
        start = QPointF(placed.x + (0 if is_mirrored else placed.box.width), placed.y + row)
        side = geometry.right() if is_mirrored else geometry.left()
        end = view.sight.to_page(QPointF(side, geometry.top() + view.look.measures.line))
        pixel = 1 / view.sight.camera.scale
        painter.setPen(QPen(view.look.theme.colour("note_text"), 2 * pixel, Qt.PenStyle.DotLine))
        painter.drawLine(start, end)
        painter.setBrush(view.look.theme.colour("note_text"))
        painter.drawEllipse(start, 3 * pixel, 3 * pixel)

    def _follow(self) -> None:
        if self.bubble is None:
            return
        if self._canvas.page_layout.placed(self.bubble.block) is None:
            self.close()
        else:
            self.bubble.follow()
