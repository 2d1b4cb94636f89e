"""The keys of the find bar, for a window that has no actions for them."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QWidget

from .find_bar import FindBar


def add_find_shortcuts(bar: FindBar, window: QWidget) -> Sequence[QShortcut]:
    """Let Ctrl+F, F3 and Shift+F3 work in a whole window that has no such actions."""
    made = []
    for keys, done in (
        (QKeySequence(QKeySequence.StandardKey.Find), bar.open),
        (QKeySequence(Qt.Key.Key_F3), bar.find_next),
        (QKeySequence("Shift+F3"), bar.find_previous),
    ):
        shortcut = QShortcut(keys, window)
        shortcut.activated.connect(done)
        made.append(shortcut)
    return made
