"""The application, which macOS asks to open files instead of naming them when it starts it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Signal
from PySide6.QtGui import QFileOpenEvent
from PySide6.QtWidgets import QApplication


class Application(QApplication):
    """Tells which files the system asks it to open, as after a double click in the Finder."""

    file_asked_for = Signal(str)

    def event(self, event: QEvent) -> bool:
        """Tell it; all other events go their way."""
        if isinstance(event, QFileOpenEvent):
            self.file_asked_for.emit(event.file())
            return True
        return super().event(event)
