"""The list of the palette, out of which blocks are dragged, clicked and chosen by keys."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QHelpEvent, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QToolTip, QWidget

from nep_studio.blocks.operations.copying import Clip
from nep_studio.ui.canvas.canvas import Canvas

from .entries import Entry
from .letters import is_letter
from .shelf_view import ShelfView
from .tips import tip


class Shelf(ShelfView):
    """A list of entries to take from. A click or Enter chooses one; ``typed`` brings a letter."""

    chosen = Signal(object)
    menu_asked = Signal(object, QPoint)
    typed = Signal(str)

    def __init__(self, canvas: Canvas, parent: QWidget | None = None) -> None:
        super().__init__(canvas, parent)
        self._pressed: QPoint | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.viewport().setMouseTracking(True)

    @property
    def marked_type(self) -> str:
        """The type of the block under the mouse, or else at the keyboard; empty when none."""
        entries = self.entries  # first: with them comes which one it is
        number = self._hovered if self._hovered >= 0 else self._current
        sample = entries[number].sample if number >= 0 else ""
        return self._stock.project.blocks[sample].type if sample else ""

    # Mouse

    def clip_of(self, entry: Entry) -> Clip | None:
        """The blocks of an entry."""
        if entry.snippet is not None:
            return entry.snippet.clip
        return self._stock.clip(entry.sample) if entry.sample else None

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a click or a drag."""
        number = self._entry_at(event.position())
        if event.button() != Qt.MouseButton.LeftButton or number < 0:
            return
        self._go_to(number)
        self._pressed = event.position().toPoint()
        clip = self.clip_of(self.entries[number])
        if clip is not None:
            self._canvas.begin_external_drag(
                clip, event.globalPosition().toPoint(), self.viewport()
            )

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Choose what was clicked."""
        pressed, self._pressed = self._pressed, None
        number = self._entry_at(event.position())
        is_left = event.button() == Qt.MouseButton.LeftButton
        if is_left and pressed is not None and number == self._current and number >= 0:
            self.chosen.emit(self.entries[number])

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Show what is under the mouse."""
        self._hover(self._entry_at(event.position()))

    def leaveEvent(self, event: QEvent) -> None:
        """Nothing is under the mouse any more."""
        self._hover(-1)
        super().leaveEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu of an entry."""
        is_key = event.reason() == QContextMenuEvent.Reason.Keyboard
        number = self.current_item() if is_key else self._entry_at(QPointF(event.pos()))
        if number >= 0:
            place = self.rect_of(number).center() if is_key else event.pos()
            self.menu_asked.emit(self.entries[number], self.viewport().mapToGlobal(place))

    def viewportEvent(self, event: QEvent) -> bool:
        """Tell what a block does."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            number = self._entry_at(QPointF(event.pos()))
            entry = self.entries[number] if number >= 0 else None
            if entry is None or not entry.sample:
                QToolTip.hideText()
                return True
            words = tip(self._stock, entry.sample)
            QToolTip.showText(event.globalPos(), words, self.viewport(), self.rect_of(number))
            return True
        return super().viewportEvent(event)

    def _entry_at(self, point: QPointF) -> int:
        """The entry under a point of the viewport, or -1."""
        place = QPointF(point.x(), point.y() + self.verticalScrollBar().value())
        number = self._layout.at(place.y())
        if number < 0 or not self.entries[number].is_choosable:
            return -1
        rect = self._layout.block_rect(self._layout.spots[number]).adjusted(-6, -2, 6, 2)
        return number if rect.contains(place) else -1

    def _hover(self, number: int) -> None:
        if number != self._hovered:
            self._hovered = number
            self.viewport().update()

    # Keyboard

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Arrows choose, Enter inserts, letters go to the search."""
        key = event.key()
        steps = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1}
        if key in steps:
            self.choose_next(steps[Qt.Key(key)])
        elif key in (Qt.Key.Key_Home, Qt.Key.Key_End):
            self._current = -1 if key == Qt.Key.Key_Home else len(self.entries)
            self.verticalScrollBar().setValue(0 if key == Qt.Key.Key_Home else 10**6)
            self.choose_next(1 if key == Qt.Key.Key_Home else -1)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.current is not None:
            self.chosen.emit(self.current)
        elif is_letter(event):
            self.typed.emit(event.text())
        else:
            super().keyPressEvent(event)
