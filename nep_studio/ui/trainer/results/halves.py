"""Two parts beside each other where there is room, else one below the other."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QBoxLayout, QVBoxLayout, QWidget


class Halves(QWidget):
    """``first`` and ``second`` are columns; ``wide_lines`` is the width, in lines of text, from
    which on they are beside each other.
    """

    def __init__(self, wide_lines: float, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._wide_lines = wide_lines
        self._box = QBoxLayout(QBoxLayout.Direction.TopToBottom, self)
        self._box.setContentsMargins(0, 0, 0, 0)
        self.first, self.second = self._column(), self._column()

    @property
    def is_wide(self) -> bool:
        """Whether they are beside each other."""
        return self._box.direction() != QBoxLayout.Direction.TopToBottom

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Put them where there is room."""
        super().resizeEvent(event)
        line = self.fontMetrics().height()
        has_room = self.width() >= self._wide_lines * line
        down, beside = QBoxLayout.Direction.TopToBottom, QBoxLayout.Direction.LeftToRight
        if has_room != self.is_wide:
            self._box.setDirection(beside if has_room else down)
            self._box.setSpacing(line if has_room else -1)

    def add(self, *widgets: QWidget) -> None:
        """Add widgets to the first column."""
        for widget in widgets:
            self.first.addWidget(widget)

    def add_beside(self, *widgets: QWidget) -> None:
        """Add widgets to the second column."""
        for widget in widgets:
            self.second.addWidget(widget)

    def _column(self) -> QVBoxLayout:
        holder = QWidget()
        column = QVBoxLayout(holder)
        column.setContentsMargins(0, 0, 0, 0)
        column.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._box.addWidget(holder, 1)
        return column
