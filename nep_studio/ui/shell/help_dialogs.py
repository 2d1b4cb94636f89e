"""The two dialogs of the Help menu: the keyboard shortcuts, and what this program is."""

from __future__ import annotations

import platform
from collections.abc import Iterable

from PySide6.QtCore import QSize, Qt, qVersion
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


def _closer(dialog: QDialog) -> QPushButton:
    button = QPushButton(tr("Close"))
    button.clicked.connect(dialog.accept)
    button.setDefault(True)
    return button
