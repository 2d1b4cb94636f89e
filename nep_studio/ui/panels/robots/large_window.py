"""A window of its own for the scene of the robots, for a room full of people."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QCloseEvent, QKeyEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from nep_studio.ui.screens import room_around
from nep_studio.ui.words import tr

SHARE = 0.8


class LargeWindow(QWidget):
    """Holds a widget until it is closed; F11 fills the screen. ``closed`` tells of the end."""

    closed = Signal()

    def __init__(self, held: QWidget, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.setWindowTitle(tr("Robots"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        line = self.fontMetrics().height()
        box = QVBoxLayout(self)
        box.setContentsMargins(line // 2, line // 2, line // 2, line // 2)
        box.addWidget(held)
        held.show()
        self.resize(room_around(parent).size() * SHARE)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Fill the screen, or leave it."""
        if event.key() == Qt.Key.Key_F11:
            self.setWindowState(self.windowState() ^ Qt.WindowState.WindowFullScreen)
        elif event.key() == Qt.Key.Key_Escape and self.isFullScreen():
            self.showNormal()
        elif event.key() == Qt.Key.Key_Escape:
            self.close()
        else:
            super().keyPressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Give the widget back."""
        super().closeEvent(event)
        self.closed.emit()
