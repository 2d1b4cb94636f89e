"""The panel "Gestures" of the window: empty until it is shown for the first time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

if TYPE_CHECKING:
    from .page import TrainerPage


class TrainerPanel(QWidget):
    """Makes its page when it is shown: numpy is slow to load."""

    def __init__(self, make: Callable[[], TrainerPage]) -> None:
        super().__init__()
        self._make = make
        self.page: TrainerPage | None = None
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)

    def opened(self) -> TrainerPage:
        """What is in it; made now if it is not there yet."""
        if self.page is None:
            self.page = self._make()
            box = self.layout()
            if box is not None:
                box.addWidget(self.page)
        return self.page

    def sizeHint(self) -> QSize:
        """Room for the graph and a few takes."""
        line = self.fontMetrics().height()
        return QSize(line * 45, line * 22)

    def minimumSizeHint(self) -> QSize:
        """Less is of no use."""
        line = self.fontMetrics().height()
        return QSize(line * 14, line * 9)

    def showEvent(self, event: QShowEvent) -> None:
        """Open it."""
        self.opened()
        super().showEvent(event)
