"""The two dialogs of the Help menu: the keyboard shortcuts, and what this program is."""

from __future__ import annotations

import platform
from collections.abc import Iterable

from PySide6.QtCore import QKeyCombination, QSize, Qt, qVersion
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from nep_studio import __version__
from nep_studio.ui.theme.icons import application_icon
from nep_studio.ui.words import tr


class ShortcutsDialog(QDialog):
    """A table of what each key does; it is read from the actions, so that it is always true."""

    def __init__(self, rows: Iterable[tuple[str, str]], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("Keyboard shortcuts"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        known = list(rows)
        self.table = QTableWidget(len(known), 2)
        self.table.setHorizontalHeaderLabels([tr("What it does"), tr("Keys")])
        self.table.setAccessibleName(self.windowTitle())
        self.table.verticalHeader().hide()
        self.table.setShowGrid(False)
        self.table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        for number, row in enumerate(known):
            for column, words in enumerate(row):
                self.table.setItem(number, column, QTableWidgetItem(words))
        self.table.resizeColumnsToContents()
        self.table.horizontalHeader().setStretchLastSection(True)
        line = self.fontMetrics().height()
        box = QVBoxLayout(self)
        box.addWidget(self.table)
        box.addWidget(_closer(self), 0, Qt.AlignmentFlag.AlignTrailing)
        self.resize(line * 28, line * 30)


class AboutDialog(QDialog):
    """What this program is, which version, and whose work is in it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("About NEP Studio"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        line = self.fontMetrics().height()
        sign = QLabel()
        side = QSize(line * 5, line * 5)
        sign.setPixmap(application_icon().pixmap(side, self.devicePixelRatioF()))
        title = QLabel(f"NEP Studio {__version__}")
        title.setProperty("role", "title")
        words = QLabel("\n\n".join(self.words()))
        words.setWordWrap(True)
        words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line // 2)
        box.addWidget(sign)
        box.addWidget(title)
        box.addWidget(words)
        box.addWidget(_closer(self), 0, Qt.AlignmentFlag.AlignTrailing)
        self.setMinimumWidth(line * 26)

    @staticmethod
    def words() -> list[str]:
        """The text."""
        return [
            tr("Give a social robot its behaviour with blocks, without programming."),
            tr("Free software under the MIT licence. Font: Atkinson Hyperlegible. Icons: Lucide."),
            f"Python {platform.python_version()}, Qt {qVersion()}, {platform.system()}",
        ]


FIRST_RARE_KEY = Qt.Key.Key_Back
"""From here on come keys such as “Undo” and “Open”, which hardly a keyboard has."""


def shortcuts_of(actions: Iterable[QAction]) -> list[tuple[str, str]]:
    """What the actions with keys do, and the keys that a keyboard has."""
    native = QKeySequence.SequenceFormat.NativeText
    return [
        (
            action.iconText().replace("&", ""),
            ", ".join(dict.fromkeys(key.toString(native) for key in keys)),
        )
        for action in actions
        if (keys := [key for key in action.shortcuts() if _is_on_keyboards(key)])
    ]


def _is_on_keyboards(keys: QKeySequence) -> bool:
    first: QKeyCombination = keys[0]  # type: ignore[index]  # stubs lack __getitem__
    return first.key() < FIRST_RARE_KEY


def on_the_canvas() -> list[tuple[str, str]]:
    """What the mouse does on the canvas."""
    return [
        (tr("Move a block with those below it"), tr("Drag")),
        (tr("Select several blocks"), tr("Drag on the empty page, or Shift and click")),
        (tr("Move the page"), tr("Wheel, or drag with the middle button")),
        (tr("Zoom"), tr("Ctrl and wheel")),
        (tr("What the selected block does"), "F1"),
    ]


def _closer(dialog: QDialog) -> QPushButton:
    button = QPushButton(tr("Close"))
    button.clicked.connect(dialog.accept)
    button.setDefault(True)
    return button
