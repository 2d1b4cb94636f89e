"""The sensors panel beside the canvas; what draws in it is loaded when it is opened."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

if TYPE_CHECKING:
    from .workspace import Workspace


class SensorsPanel(QWidget):
    """Empty until it is shown for the first time: numpy and pyqtgraph are slow to load."""

    def __init__(self, make: Callable[[], Workspace]) -> None:
        super().__init__()
        self._make = make
        self.workspace: Workspace | None = None
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)

    def opened(self) -> Workspace:
        """What is in it; made now if it is not there yet."""
        if self.workspace is None:
            self.workspace = self._make()
            box = self.layout()
            if box is not None:
                box.addWidget(self.workspace)
        return self.workspace

    def sizeHint(self) -> QSize:
        """Room for two plots and the list of curves."""
        line = self.fontMetrics().height()
        return QSize(line * 45, line * 16)

    def minimumSizeHint(self) -> QSize:
        """Less is of no use."""
        line = self.fontMetrics().height()
        return QSize(line * 12, line * 7)

    def showEvent(self, event: QShowEvent) -> None:
        """Open it."""
        self.opened()
        super().showEvent(event)
