"""A window below a field in which its value is chosen."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QHideEvent, QKeyEvent, QPainter, QPen
from PySide6.QtWidgets import (
    QApplication,
    QFrame,
    QLineEdit,
    QPushButton,
    QWidget,
)

from nep_studio.blocks.slots import FieldValue
from nep_studio.ui.canvas.painting.shapes import slot_path
from nep_studio.ui.widgets.forms import plain_label, room_around
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

from .field_edit import Editing, ReasonBubble, beside, piece_of, view_rect_of

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

    from .editors import FieldEditors


class FieldPopup(QFrame):
    """A popup: a press elsewhere, Enter or Tab keep the value, Esc restores it."""

    def __init__(self, editors: FieldEditors, edit: Editing, title: str) -> None:
        super().__init__(editors.canvas.area, Qt.WindowType.Popup)
        self.edit, self._editors = edit, editors
        canvas = editors.canvas
        is_mirrored = canvas.look.measures.is_mirrored
        direction = Qt.LayoutDirection
        self.setLayoutDirection(direction.RightToLeft if is_mirrored else direction.LeftToRight)
        self.setAccessibleName(title)
        self.setObjectName("field_popup")
        self.line = self.fontMetrics().height()
        theme = canvas.look.theme
        self.setStyleSheet(
            f"#field_popup {{ background: {theme.colour('menu').name()};"
            f" color: {theme.colour('text').name()};"
            f" border: {max(1, self.line // 14)}px solid {theme.colour('field_line').name()}; }}"
        )
        self.column = in_column(of=self, margins=self.line // 2, spacing=self.line // 2)
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
        field.moveTopLeft(canvas.area.viewport().mapToGlobal(field.topLeft()))
        self.ensurePolished()
        self.column.activate()
        self.adjustSize()
        mirrored = canvas.look.measures.is_mirrored
        self.move(beside(field, self.size(), room_around(canvas.area), is_mirrored=mirrored))

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
        if (words := tr(reason or "")) != self.reason.text:
            self.reason.tell(reason)
            self.adjustSize()
            if words:
                self._editors.canvas.news.announced.emit(words)
        return not reason


# A question inside a popup: a name to type, or something to agree to.


class Question(QWidget):
    """Words, a line to type in where a name is asked for, and two buttons."""

    def __init__(
        self,
        words: str,
        yes: str,
        *,
        answered: Callable[[str], None],
        refused: Callable[[], None],
        name: str | None = None,
    ) -> None:
        super().__init__()
        self._answered, self._refused = answered, refused
        self.words = words
        label = plain_label(words, parent=self)
        width = 15 * self.fontMetrics().height()
        label.setFixedWidth(width)
        label.setFixedHeight(label.heightForWidth(width))
        self.name = QLineEdit(name or "", self)
        self.name.setAccessibleName(words)
        self.name.setVisible(name is not None)
        self.name.selectAll()
        self.yes, self.no = QPushButton(yes, self), QPushButton(tr("Cancel"), self)
        self.yes.setProperty("kind", "primary" if name is not None else "stop")
        self.yes.clicked.connect(self._on_yes)
        self.no.clicked.connect(refused)
        in_column(label, self.name, in_row(1, self.no, self.yes), of=self, margins=0)

    def first(self) -> QWidget:
        """The widget that has the keyboard at the start."""
        return self.no if self.name.isHidden() else self.name

    def focusNextPrevChild(self, forward: bool) -> bool:
        """Tab goes round inside the question."""
        order = [w for w in (self.name, self.no, self.yes) if not w.isHidden()]
        here = self.focusWidget()
        at = order.index(here) if here in order else 0
        order[(at + (1 if forward else -1)) % len(order)].setFocus(Qt.FocusReason.TabFocusReason)
        return True

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter agrees (or presses the button it is on), Esc does not."""
        if event.key() == Qt.Key.Key_Escape:
            self._refused()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            if self.no.hasFocus():
                self._refused()
            else:
                self._on_yes()
        else:
            super().keyPressEvent(event)

    def _on_yes(self) -> None:
        self._answered(self.name.text())


# Who has the keyboard when an editor over the canvas closes.


def give_back_focus(canvas: QWidget, closing: QWidget) -> None:
    """Let the canvas have the keyboard again, unless a person has just gone elsewhere with it."""
    focus = QApplication.focusWidget()
    if focus is None or closing is focus or closing.isAncestorOf(focus):
        canvas.setFocus(Qt.FocusReason.OtherFocusReason)


# The line around the field whose popup is open.


class FieldRing:
    """Shows which field is being edited."""

    def __init__(self, editors: FieldEditors) -> None:
        self._editors = editors

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the line around the field that is edited, in its shape."""
        if (editor := self._editors.widget) is None:
            return
        found = piece_of(view, editor.edit.block, editor.edit.key)
        if found is None:
            return
        placed, piece = found
        painter.setPen(QPen(view.look.theme.colour("focus"), 3 * view.look.measures.unit))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        x, y = placed.x + piece.x, placed.y + piece.y
        painter.translate(x, y)
        painter.drawPath(slot_path(piece.shape, piece.width, piece.height, view.look.measures.unit))
        painter.translate(-x, -y)
