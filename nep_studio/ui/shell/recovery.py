"""Offers work that was not saved when the program ended without warning."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QDateTime, QLocale, QSize, Qt
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.editor import Editor
from nep_studio.project.journal import Recoverable
from nep_studio.ui.canvas.block_pictures import picture_of
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.words import count_words, is_right_to_left, tr
from nep_studio.ui.workbench.workbench import block_font

WIDTH_LINES, HEIGHT_LINES = 26, 13


class RecoveryDialog(QDialog):
    """A list of what can be restored; nothing is thrown away unless the person says so."""

    def __init__(
        self,
        found: Sequence[Recoverable],
        studio: Studio,
        restore: Callable[[Recoverable], object],
        parent: QWidget,
    ) -> None:
        super().__init__(parent)
        self._found, self._studio, self._restore = list(found), studio, restore
        self.setWindowTitle(tr("Restore your work"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.list = QListWidget()
        self.picture = QLabel()
        self.restore_button = QPushButton(tr("Restore"))
        self.look_button = QPushButton(tr("Look"))
        self.discard_button = QPushButton(tr("Discard"))
        self.later_button = QPushButton(tr("Decide later"))
        self._lay_out()
        self._connect()
        self._fill()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line // 2)
        box.addWidget(_label(tr("Some work was not saved"), "title"))
        sentence = tr("NEP Studio ended without warning. This is what you had done until then.")
        box.addWidget(_label(sentence, "hint"))
        box.addWidget(self.list, 1)
        box.addWidget(self.picture)
        self.picture.hide()
        self.picture.setAccessibleName(tr("The blocks of this project"))
        row = QHBoxLayout()
        for button in (self.discard_button, self.look_button):
            row.addWidget(button)
        row.addStretch(1)
        for button in (self.later_button, self.restore_button):
            row.addWidget(button)
        box.addLayout(row)
        self.restore_button.setProperty("kind", "primary")
        self.restore_button.setDefault(True)
        self.list.setMinimumSize(line * WIDTH_LINES, line * 5)
        self.list.setAccessibleName(tr("Work that was not saved"))

    def _connect(self) -> None:
        self.list.itemDoubleClicked.connect(self._on_restore)
        self.list.currentRowChanged.connect(self._on_row_changed)
        self.restore_button.clicked.connect(self._on_restore)
        self.look_button.clicked.connect(self._on_look)
        self.discard_button.clicked.connect(self._on_discard)
        self.later_button.clicked.connect(self.reject)

    def _fill(self) -> None:
        theme = self._studio.look.theme
        for work in self._found:
            blocks = count_words(len(work.project.blocks), "1 block", "{n} blocks")
            words = f"{work.name}   —   {_when(work.time)}, {blocks}"
            item = QListWidgetItem(icon("history", theme), words)
            item.setToolTip(str(work.path or tr("It had no file yet.")))
            self.list.addItem(item)
        self.list.setCurrentRow(0)

    def _chosen(self) -> Recoverable | None:
        row = self.list.currentRow()
        return self._found[row] if 0 <= row < len(self._found) else None

    def _on_row_changed(self) -> None:
        if self.picture.isVisible():
            self._on_look()

    def _on_restore(self) -> None:
        work = self._chosen()
        if work is not None:
            self.accept()
            self._restore(work)

    def _on_look(self) -> None:
        work = self._chosen()
        if work is None:
            self.picture.hide()
            return
        line = self.fontMetrics().height()
        language = self._studio.language
        picture = picture_of(
            Editor(work.project, language),
            self._studio.look.theme,
            block_font(self._studio),
            QSize(max(self.list.width(), line * WIDTH_LINES), line * HEIGHT_LINES),
            self.devicePixelRatioF(),
            is_mirrored=is_right_to_left(),
        )
        self.picture.setPixmap(picture)
        self.picture.show()

    def _on_discard(self) -> None:
        work, row = self._chosen(), self.list.currentRow()
        if work is None:
            return
        work.discard()
        del self._found[row]
        self.list.takeItem(row)
        if not self._found:
            self.reject()


def _label(words: str, role: str) -> QLabel:
    label = QLabel(words)
    label.setWordWrap(True)
    label.setProperty("role", role)
    return label


def _when(time: float) -> str:
    moment = QDateTime.fromSecsSinceEpoch(int(time))
    return QLocale().toString(moment, QLocale.FormatType.ShortFormat)
