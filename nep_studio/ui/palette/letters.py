"""Which keys write something."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

COMMANDS = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.MetaModifier


def is_letter(event: QKeyEvent) -> bool:
    """Whether a key writes a letter, a digit or a sign, and is no command."""
    letter = event.text()
    is_written = letter.isprintable() and bool(letter.strip())
    return is_written and not event.modifiers() & COMMANDS
