"""A window below a field in which its value is chosen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QHideEvent, QKeyEvent
from PySide6.QtWidgets import QFrame, QVBoxLayout, QWidget

from nep_studio.blocks.values import FieldValue
from nep_studio.ui.screens import room_around

from .field_edit import Editing
from .places import beside, view_rect_of
from .reason import ReasonBubble

if TYPE_CHECKING:
    from .editors import FieldEditors


class FieldPopup(QFrame):
    """A popup: a press elsewhere, Enter or Tab keep the value, Esc restores it."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors.canvas, Qt.WindowType.Popup)
        self.edit, self._editors = edit, editors
        canvas = editors.canvas
        is_mirrored = canvas.measures.is_mirrored
        direction = Qt.LayoutDirection
        self.setLayoutDirection(direction.RightToLeft if is_mirrored else direction.LeftToRight)
        self.setAccessibleName(title)
        self.setObjectName("field_popup")
        self.line = self.fontMetrics().height()
        theme = canvas.theme
        self.setStyleSheet(
            f"#field_popup {{ background: {theme.colour('menu').name()};"
            f" color: {theme.colour('text').name()};"
            f" border: {max(1, self.line // 14)}px solid {theme.colour('field_line').name()}; }}"
        )
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(*(self.line // 2,) * 4)
        self.column.setSpacing(self.line // 2)
        self.reason = ReasonBubble(theme, self)
        self._is_over = False

    def first(self) -> QWidget:
        """The widget that has the keyboard at the start."""
        return self

    def show_editor(self) -> None:
        """Begin to edit."""
        self.column.addWidget(self.reason)
        self.follow()
        self.show()
        self.follow()  # its widgets know how large they are only now
        self.first().setFocus(Qt.FocusReason.PopupFocusReason)

    def follow(self) -> None:
        """Stay near the field, inside the screen."""
        canvas = self._editors.canvas
        rect = view_rect_of(canvas, self.edit.block, self.edit.key)
        if rect is None:
            return
        field = QRect(rect.toAlignedRect())
        field.moveTopLeft(canvas.viewport().mapToGlobal(field.topLeft()))
        self.ensurePolished()
        self.column.activate()
        self.adjustSize()
        mirrored = canvas.measures.is_mirrored
        self.move(beside(field, self.size(), room_around(canvas), is_mirrored=mirrored))

    def dispose(self) -> None:
        """Go away."""
        self._is_over = True
        self.hide()
        # a popup that still waits to be deleted must not be taken along by its canvas
        self.setParent(None, self.windowFlags())
        self.deleteLater()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter keeps, Esc restores."""
        if event.key() == Qt.Key.Key_Escape:
            self._editors.cancel()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._editors.close()
        else:
            super().keyPressEvent(event)

    def focusNextPrevChild(self, forward: bool) -> bool:
        """Tab goes from field to field."""
        self._editors.go(forward=forward)
        return True

    def hideEvent(self, event: QHideEvent) -> None:
        """A press elsewhere closes the popup, and keeps the value."""
        super().hideEvent(event)
        if not self._is_over:
            self._editors.close_if(self)

    def try_set(self, value: FieldValue) -> bool:
        """Set the field; say why not when it does not fit."""
        reason = self.edit.set(value)
        if reason != self.reason.text:
            self.reason.tell(reason)
            self.adjustSize()
            if reason:
                self._editors.canvas.announced.emit(reason)
        return not reason
