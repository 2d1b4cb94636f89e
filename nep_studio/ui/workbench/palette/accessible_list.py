"""The list of the palette as Qt's accessible interfaces, which screen readers ask.

Qt takes "nothing" from several of these methods; the stubs of PySide6 do not say so, hence the
``type: ignore[override]``.
"""

from __future__ import annotations

from typing import Protocol

from PySide6.QtCore import QObject, QPoint, QRect
from PySide6.QtGui import QAccessible, QAccessibleEvent, QAccessibleInterface
from PySide6.QtWidgets import QWidget

from nep_studio.ui.canvas.accessibility import ItemInterface, PaintedInterface
from nep_studio.ui.words import tr


class PaintedList(Protocol):
    """A widget that paints its items itself, and can say what they are."""

    accessible: object

    def item_count(self) -> int:
        """How many items there are."""

    def item_text(self, number: int) -> str:
        """What an item says."""

    def item_rect(self, number: int) -> QRect:
        """Where an item is on the screen."""

    def current_item(self) -> int:
        """The item that the keyboard is at, or -1."""


class ListInterface(PaintedInterface):
    """A painted list."""

    def __init__(self, widget: QWidget, items: PaintedList) -> None:
        super().__init__(widget, widget)
        self.items = items
        self._rows: dict[int, RowInterface] = {}

    def row(self, number: int) -> RowInterface:
        """The interface of an item, always the same one."""
        if number not in self._rows:
            self._rows[number] = RowInterface(self, number)
        return self._rows[number]

    def forget_rows(self) -> None:
        """Drop the items: Qt keeps pointers to them, and would follow these when it ends."""
        for row in self._rows.values():
            QAccessible.deleteAccessibleInterface(QAccessible.uniqueId(row))
        self._rows.clear()

    def role(self) -> QAccessible.Role:
        """A list."""
        return QAccessible.Role.List

    def text(self, kind: QAccessible.Text) -> str:
        """Its name, and how to use it."""
        if kind == QAccessible.Text.Name:
            return self.widget.accessibleName()
        if kind == QAccessible.Text.Description:
            own = self.widget.accessibleDescription()
            return own or tr("Arrow keys choose, Enter inserts, typing searches.")
        return ""

    def childCount(self) -> int:
        """How many items it has."""
        return self.items.item_count()

    def child(self, index: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """One of them."""
        return self.row(index) if 0 <= index < self.items.item_count() else None

    def indexOfChild(self, child: QAccessibleInterface) -> int:
        """The number of an item."""
        return child.number if isinstance(child, RowInterface) else -1

    def childAt(self, x: int, y: int) -> QAccessibleInterface | None:  # type: ignore[override]
        """The item at a place of the screen."""
        place = QPoint(x, y)
        for number in range(self.items.item_count()):
            if self.items.item_rect(number).contains(place):
                return self.row(number)
        return None

    def focusChild(self) -> QAccessibleInterface | None:  # type: ignore[override]
        """The item that the keyboard is at."""
        return self.child(self.items.current_item())


class RowInterface(ItemInterface):
    """One item of a painted list."""

    def __init__(self, outer: ListInterface, number: int) -> None:
        super().__init__(outer)
        self._list, self.number = outer, number

    def isValid(self) -> bool:
        """Whether the item is still there."""
        return self.number < self._list.items.item_count()

    def role(self) -> QAccessible.Role:
        """An item of a list."""
        return QAccessible.Role.ListItem

    def text(self, kind: QAccessible.Text) -> str:
        """What it says."""
        is_name = kind == QAccessible.Text.Name and self.isValid()
        return self._list.items.item_text(self.number) if is_name else ""

    def rect(self) -> QRect:
        """Where it is on the screen."""
        return self._list.items.item_rect(self.number)

    def state(self) -> QAccessible.State:
        """Whether the keyboard is at it, and whether it is in view."""
        state = QAccessible.State()
        state.focusable = state.selectable = True
        is_current = self._list.items.current_item() == self.number
        state.selected = is_current
        state.focused = is_current and self._list.widget.hasFocus()
        state.offscreen = not self.rect().intersects(self._list.rect())
        return state


_is_installed = False


def make_list_accessible(widget: QWidget, items: PaintedList) -> None:
    """Let screen readers find the items of a list that is painted."""
    global _is_installed
    if not _is_installed:
        QAccessible.installFactory(_factory)
        _is_installed = True
    items.accessible = made = ListInterface(widget, items)  # Qt holds it by pointer only
    widget.destroyed.connect(lambda: made.forget_rows())


def tell_current(items: PaintedList) -> None:
    """Tell a screen reader that the keyboard is at another item."""
    outer = items.accessible
    if QAccessible.isActive() and isinstance(outer, ListInterface):
        row = outer.focusChild()
        if row is not None:
            QAccessible.updateAccessibility(QAccessibleEvent(row, QAccessible.Event.Focus))


def _factory(class_name: str, item: QObject | None) -> QAccessibleInterface | None:
    found = getattr(item, "accessible", None)
    return found if isinstance(found, ListInterface) else None
