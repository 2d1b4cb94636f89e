"""Puts widgets below each other, in as many columns as there is room for."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout, QWidget

COLUMN_LINES = 17
"""A column is at least so wide, in lines of text."""
MOST_COLUMNS = 5


class Columns(QWidget):
    """Keeps the widgets in their order: down the first column, then down the next.

    Each column is a widget: a layout within a layout is not told that something has grown.
    """

    def __init__(self, widgets: Sequence[QWidget], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._widgets = list(widgets)
        self.count = 0
        line = self.fontMetrics().height()
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        self._row.setSpacing(line)
        self._holders = [QWidget(self) for _ in range(MOST_COLUMNS)]
        self._columns = [QVBoxLayout(holder) for holder in self._holders]
        for holder, column in zip(self._holders, self._columns, strict=True):
            column.setContentsMargins(0, 0, 0, 0)
            column.setSpacing(line // 4)
            self._row.addWidget(holder, 1)
        self.spread(1)

    def spread(self, count: int) -> None:
        """Use so many columns, about equally high."""
        if count == self.count:
            return
        self.count = count
        for column in self._columns:
            while column.count():
                column.takeAt(0)
        left = sum(widget.sizeHint().height() for widget in self._widgets)
        number, filled = 0, 0
        for widget in self._widgets:
            height = widget.sizeHint().height()
            if filled and filled + height / 2 > left / (count - number) and number < count - 1:
                left, filled, number = left - filled, 0, number + 1
            self._columns[number].addWidget(widget)
            filled += height
        for number, column in enumerate(self._columns):
            column.addStretch(1)
            self._holders[number].setVisible(number < count)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Use the room that there is."""
        super().resizeEvent(event)
        line = self.fontMetrics().height()
        fitting = event.size().width() // (COLUMN_LINES * line)
        self.spread(min(max(fitting, 1), MOST_COLUMNS, len(self._widgets)))
