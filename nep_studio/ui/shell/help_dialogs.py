"""Dialogs of the menus: keyboard shortcuts, this program, and what changed since it was saved."""

from __future__ import annotations

import platform
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt, qVersion
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHeaderView,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QWidget,
)

from nep_studio import __version__
from nep_studio.blocks.errors import BlocksError
from nep_studio.blocks.files import load
from nep_studio.blocks.operations.finding import Difference, compare
from nep_studio.blocks.program import Project
from nep_studio.ui.documents import Document
from nep_studio.ui.theme.icons import application_icon
from nep_studio.ui.widgets.forms import fit_on_screen, styled
from nep_studio.ui.widgets.layouts import in_column
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from .main_window import MainWindow


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
        self.table.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.ResizeToContents)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeading | Qt.AlignmentFlag.AlignVCenter)
        closer = (_closer(self), 0, Qt.AlignmentFlag.AlignTrailing)
        line = self.fontMetrics().height()
        in_column(self.table, closer, of=self, margins=line, spacing=line // 2)
        fit_on_screen(self, 40, 30)


class AboutDialog(QDialog):
    """What this program is, which version, and whose work is in it."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(tr("About NEP Studio"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        line = self.fontMetrics().height()
        side = QSize(line * 5, line * 5)
        sign = QLabel(pixmap=application_icon().pixmap(side, self.devicePixelRatioF()))
        title = styled(QLabel(f"NEP Studio {__version__}"), role="title")
        words = QLabel("\n\n".join(self.words()), wordWrap=True)
        words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        closer = (_closer(self), 0, Qt.AlignmentFlag.AlignTrailing)
        in_column(sign, title, words, closer, of=self, margins=line, spacing=line // 2)
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
    button = QPushButton(tr("Close"), default=True)
    button.clicked.connect(dialog.accept)
    return button


# A list of what is different from the saved version; a click on a line shows the block.

WIDTH_LINES, HEIGHT_LINES = 30, 20


class ComparingDialog(QDialog):
    """Stays open beside the blocks, so that one difference after the other can be looked at."""

    def __init__(
        self,
        document: Document,
        saved: Project,
        show_block: Callable[[str], object],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self._document, self._show_block = document, show_block
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Compare with the saved version"))
        self.differences = compare(saved, document.project, document.editor.language)
        self.list = QListWidget()
        self.list.setWordWrap(True)
        self.list.setAccessibleName(tr("What is different"))
        for difference in self.differences:
            item = QListWidgetItem(_words(difference))
            item.setData(Qt.ItemDataRole.UserRole, difference.block)
            if difference.what == "removed":
                item.setToolTip(tr("It is not there any more, so it cannot be shown."))
            self.list.addItem(item)
        self.list.itemClicked.connect(self._on_item_chosen)
        self.list.itemActivated.connect(self._on_item_chosen)
        line = self.fontMetrics().height()
        self.words = QLabel(self._told(), wordWrap=True)
        close = QPushButton(tr("Close"), autoDefault=False)  # Enter shows the block of a line
        close.clicked.connect(self.close)
        closer = (close, 0, Qt.AlignmentFlag.AlignTrailing)
        in_column(self.words, (self.list, 1), closer, of=self, margins=line, spacing=line // 2)
        self.list.setVisible(bool(self.differences))
        fit_on_screen(self, WIDTH_LINES, HEIGHT_LINES if self.differences else 6)
        document.destroyed.connect(self.close)

    def _told(self) -> str:
        if self.differences:
            return tr("Since you saved, these blocks are different. Click one to see it.")
        return tr("The blocks say the same as in the file. Only places, notes or names differ.")

    def _on_item_chosen(self, item: QListWidgetItem) -> None:
        block = item.data(Qt.ItemDataRole.UserRole)
        if block in self._document.project.blocks:
            self._show_block(block)


def compare_with_saved(window: MainWindow) -> None:
    """Show what is different between the project of a window and its file."""
    document = window.files.document
    if document is None or document.path is None:
        return
    try:
        saved = load(document.path, document.editor.language)
    except BlocksError as error:
        window.messages.tell_error(error)
        return

    dialog = ComparingDialog(document, saved, window.workbench.show_block, window)
    window.studio.words_changed.connect(dialog.reject)  # it speaks the language of before
    dialog.show()


def _words(difference: Difference) -> str:
    now, before = difference.sentence, difference.before
    if difference.what == "changed" and before == now:
        return tr("Changed in its comment or its state: “{now}”", now=now)
    return {
        "added": tr("New: “{now}”", now=now),
        "removed": tr("Taken away: “{now}”", now=now),
        "moved": tr("Moved: “{now}”", now=now),
        "changed": tr("Changed: “{before}” is now “{now}”", before=before, now=now),
    }[difference.what]
