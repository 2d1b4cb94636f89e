"""One line of text or a number, typed right in the field."""

from __future__ import annotations

from decimal import Decimal
from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QFocusEvent, QKeyEvent
from PySide6.QtWidgets import QLabel, QLineEdit, QPlainTextEdit

from nep_studio.blocks.arithmetic import (
    ArithmeticRefused,
    calculate,
    is_number_text,
    number_of,
    number_text,
)
from nep_studio.ui.words import tr

from .field_edit import (
    Editing,
    ReasonBubble,
    beside,
    editor_font,
    editor_scale,
    line_style,
    note_style,
    view_rect_of,
)

if TYPE_CHECKING:
    from .editors import FieldEditors


# What arithmetic comes to, and one step up or down from a number.


def result_text(text: str) -> str:
    """What arithmetic comes to, as "= 2.094"; empty for a plain number, or for no arithmetic."""
    if is_number_text(text) or not text.strip():
        return ""
    try:
        value = calculate(text).value
    except ArithmeticRefused:
        return ""
    return f"= {value:.4g}" if isinstance(value, float) else f"= {value}"


def stepped(value: object, steps: int) -> int | float:
    """A number so many ones higher or lower, without the dust of binary fractions."""
    try:
        number = number_of(value)
    except (ArithmeticRefused, TypeError):
        number = 0
    moved = Decimal(repr(number)) + steps
    return int(moved) if moved == moved.to_integral_value() else float(moved)


_KEPT_FOCUS = (
    Qt.FocusReason.PopupFocusReason,
    Qt.FocusReason.ActiveWindowFocusReason,
    Qt.FocusReason.MenuBarFocusReason,
)


class LineEditor(QLineEdit):
    """A line over a field; sets the field at each key."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors.canvas.area.viewport())
        self.edit, self._editors = edit, editors
        self._look: tuple[float, bool] | None = None
        self._kind = edit.slot.kind
        self.reason = ReasonBubble(editors.canvas.look.theme, editors.canvas.area.viewport())
        self.result = QLabel(editors.canvas.area.viewport())
        self.result.setStyleSheet(note_style(editors.canvas))
        self.result.hide()
        self.setAccessibleName(title)
        self.setText(self._kind.write(edit.value))
        self.selectAll()
        self.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.textEdited.connect(self._on_edited)
        self._tell_result()

    def follow(self) -> None:
        """Stay over the field."""
        rect = view_rect_of(self._editors.canvas, self.edit.block, self.edit.key)
        if rect is None:
            return
        canvas = self._editors.canvas
        look = scale, is_wrong = editor_scale(canvas), bool(self.reason.text)
        if look != self._look:  # a style sheet costs more than a key may
            self._look = look
            self.setFont(editor_font(canvas))
            shape, block = self._kind.shape, self.edit.block
            self.setStyleSheet(line_style(canvas, block, shape, is_wrong=is_wrong))
        unit = canvas.look.measures.unit * scale
        text = self.fontMetrics().horizontalAdvance(self.text()) + 17 * unit
        room = canvas.area.viewport().rect()
        width = round(min(max(rect.width(), text, 40 * unit), room.width()))
        height = round(canvas.look.measures.field_height * scale)
        left = rect.right() - width if canvas.look.measures.is_mirrored else rect.left()
        left = max(0.0, min(left, room.width() - width))
        top = max(0.0, min(rect.center().y() - height / 2, room.height() - height))
        self.setGeometry(round(left), round(top), width, height)
        self._place_notes()

    def show_editor(self) -> None:
        """Begin to edit."""
        self.follow()
        self.show()
        self.setFocus(Qt.FocusReason.OtherFocusReason)

    def dispose(self) -> None:
        """Go away."""
        for widget in (self.reason, self.result, self):
            widget.hide()
            widget.deleteLater()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter keeps, Esc restores, Up and Down count; the rest is typed."""
        key = event.key()
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._editors.close()
        elif key == Qt.Key.Key_Escape:
            self._editors.cancel()
        elif key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self._step(event, 1 if key == Qt.Key.Key_Up else -1)
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
            self._editors.leave(self, event.reason())

    def _step(self, event: QKeyEvent, sign: int) -> None:
        modifiers = event.modifiers()
        if modifiers & Qt.KeyboardModifier.AltModifier:
            self._editors.move_item(sign < 0)
            return
        if not (self._kind.is_number or isinstance(self.edit.value, int | float)):
            return
        step = 10 if modifiers & Qt.KeyboardModifier.ShiftModifier else 1
        self.setText(number_text(stepped(self.edit.value, sign * step)))
        self._on_edited(self.text())

    def _on_edited(self, text: str) -> None:
        reason = self.edit.set(self._kind.read(text))
        if (words := tr(reason or "")) != self.reason.text:
            self.reason.tell(reason)
            self.setAccessibleDescription(words)
            if words:
                self._editors.canvas.news.announced.emit(words)
        if self._kind.is_number:
            self._tell_result()
        self.follow()

    def _tell_result(self) -> None:
        shown = result_text(self.text()) if self._kind.is_number else ""
        self.result.setText(shown)
        self.result.setVisible(bool(shown))
        if shown:
            self.result.setAccessibleName(tr("The value is {value}", value=shown.lstrip("= ")))

    def _place_notes(self) -> None:
        canvas, field = self._editors.canvas, self.geometry()
        is_mirrored = canvas.look.measures.is_mirrored
        if not self.result.isHidden():
            self.result.adjustSize()
            size = self.result.size()
            left = field.left() - size.width() - 4 if is_mirrored else field.right() + 5
            top = field.center().y() - size.height() // 2
            self.result.move(left, top)
            self.result.raise_()
        if self.reason.text:
            room = QRect(canvas.area.viewport().rect())
            corner = beside(field, self.reason.sizeHint(), room, is_mirrored=is_mirrored)
            self.reason.resize(self.reason.sizeHint())
            self.reason.move(corner)
            self.reason.raise_()


# Text of several lines, typed in an editor that grows over the field.

_FEWEST_LINES, _MOST_LINES = 3, 12


class LinesEditor(QPlainTextEdit):
    """Enter begins a new line; Ctrl+Enter, Tab or a press elsewhere ends."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors.canvas.area.viewport())
        self.edit, self._editors = edit, editors
        self._look: tuple[float, bool] | None = None
        self.reason = ReasonBubble(editors.canvas.look.theme, editors.canvas.area.viewport())
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
            self.setStyleSheet(line_style(canvas, self.edit.block, "square", is_wrong=look[1]))
        line = self.fontMetrics().lineSpacing()
        unit = canvas.look.measures.unit * editor_scale(canvas)
        room = canvas.area.viewport().rect()
        width = round(min(max(rect.width(), 240 * unit), room.width()))
        rows = min(max(round(self.document().size().height()), _FEWEST_LINES), _MOST_LINES)
        height = round(rows * line + 16 * unit)
        left = rect.right() - width if canvas.look.measures.is_mirrored else rect.left()
        top = max(0.0, min(rect.top(), room.height() - height))
        left = max(0.0, min(left, room.width() - width))
        self.setGeometry(round(left), round(top), width, height)
        if self.reason.text:
            self.reason.resize(self.reason.sizeHint())
            mirrored = canvas.look.measures.is_mirrored
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
            self._editors.leave(self, event.reason())

    def _on_changed(self) -> None:
        reason = self.edit.set(self.toPlainText())
        if (words := tr(reason or "")) != self.reason.text:
            self.reason.tell(reason)
            self.setAccessibleDescription(words)
            if words:
                self._editors.canvas.news.announced.emit(words)
        self.follow()
