"""Who has the keyboard when an editor over the canvas closes."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QWidget


def give_back_focus(canvas: QWidget, closing: QWidget) -> None:
    """Let the canvas have the keyboard again, unless a person has just gone elsewhere with it."""
    focus = QApplication.focusWidget()
    if focus is None or closing is focus or closing.isAncestorOf(focus):
        canvas.setFocus(Qt.FocusReason.OtherFocusReason)
