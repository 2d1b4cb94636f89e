"""Text of several lines, typed in an editor that grows over the field."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent
from PySide6.QtWidgets import QPlainTextEdit

from .field_edit import Editing
from .line_editor import _KEPT_FOCUS
from .looks import line_style
from .places import beside, editor_font, editor_scale, view_rect_of
from .reason import ReasonBubble

if TYPE_CHECKING:
    from .editors import FieldEditors

_FEWEST_LINES, _MOST_LINES = 3, 12


class LinesEditor(QPlainTextEdit):
    """Enter begins a new line; Ctrl+Enter, Tab or a press elsewhere ends."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors.canvas.viewport())
        self.edit, self._editors = edit, editors
        self._look: tuple[float, bool] | None = None
        self.reason = ReasonBubble(editors.canvas.theme, editors.canvas.viewport())
        self.setAccessibleName(title)
        self.setPlainText(str(edit.value or ""))
        self.selectAll()
        self.setTabChangesFocus(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.textChanged.connect(self._on_changed)

    def follow(self) -> None:
        """Stay over the field, as high as the text is."""
        canvas = self._editors.canvas
        rect = view_rect_of(canvas, self.edit.block, self.edit.key)
        if rect is None:
            return
        look = (editor_scale(canvas), bool(self.reason.text))
        if look != self._look:  # a style sheet costs more than a key may
            self._look = look
            self.setFont(editor_font(canvas))
            self.setStyleSheet(line_style(canvas, "square", is_wrong=look[1]))
        line = self.fontMetrics().lineSpacing()
        unit = canvas.measures.unit * editor_scale(canvas)
        room = canvas.viewport().rect()
        width = round(min(max(rect.width(), 240 * unit), room.width()))
        rows = min(max(round(self.document().size().height()), _FEWEST_LINES), _MOST_LINES)
        height = round(rows * line + 16 * unit)
        left = rect.right() - width if canvas.measures.is_mirrored else rect.left()
        top = max(0.0, min(rect.top(), room.height() - height))
        left = max(0.0, min(left, room.width() - width))
        self.setGeometry(round(left), round(top), width, height)
        if self.reason.text:
            self.reason.resize(self.reason.sizeHint())
            mirrored = canvas.measures.is_mirrored
            corner = beside(self.geometry(), self.reason.size(), QRect(room), is_mirrored=mirrored)
            self.reason.move(corner)
            self.reason.raise_()

    def show_editor(self) -> None:
        """Begin to edit."""
        self.follow()
        self.show()
        self.setFocus(Qt.FocusReason.OtherFocusReason)

    def dispose(self) -> None:
        """Go away."""
        for widget in (self.reason, self):
            widget.hide()
            widget.deleteLater()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc restores, Ctrl+Enter keeps; the rest is typed."""
        is_enter = event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter)
        if event.key() == Qt.Key.Key_Escape:
            self._editors.cancel()
        elif is_enter and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self._editors.close()
        else:
            super().keyPressEvent(event)

    def focusNextPrevChild(self, forward: bool) -> bool:
        """Tab goes from field to field."""
        self._editors.go(forward=forward)
        return True

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """A press elsewhere keeps what was typed."""
        super().focusOutEvent(event)
        if event.reason() not in _KEPT_FOCUS:
            self._editors.close_if(self)

    def _on_changed(self) -> None:
        reason = self.edit.set(self.toPlainText())
        if reason != self.reason.text:
            self.reason.tell(reason)
            self.setAccessibleDescription(reason)
            if reason:
                self._editors.canvas.announced.emit(reason)
        self.follow()
