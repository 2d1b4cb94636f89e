"""All that the window has told since it was opened, to read again and to copy for support."""

from __future__ import annotations

import platform
import time

from PySide6.QtCore import QSize, Qt, qVersion
from PySide6.QtGui import QGuiApplication, QShowEvent
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QScrollArea,
    QSplitter,
    QStackedLayout,
    QVBoxLayout,
    QWidget,
)

from nep_studio import __version__
from nep_studio.ui.messages import KIND_ICONS, Kind, Messages, Told
from nep_studio.ui.messages_card import MessageText
from nep_studio.ui.theme import Look, icon, icon_pixmap
from nep_studio.ui.words import tr

TOLD = Qt.ItemDataRole.UserRole


class ToldMessages(QWidget):
    """The messages of the one door, the newest first; beside them the chosen one in full."""

    def __init__(self, messages: Messages, look: Look) -> None:
        super().__init__()
        self._messages, self._look = messages, look
        self._shown = 0
        self.list = QListWidget()
        self.list.setAccessibleName(tr("Messages"))
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.detail = QScrollArea()
        self.detail.setWidgetResizable(True)
        self.detail.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.copy_button = QPushButton(tr("Copy all for support"))
        self.hint = QLabel(tr("What the window tells you is kept here until you close it."))
        self._lay_out()
        self.list.currentItemChanged.connect(self._on_chosen)
        self.copy_button.clicked.connect(self._on_copy_clicked)
        messages.told.connect(self._on_told)
        look.theme_changed.connect(self._dress)
        self._dress()

    def _lay_out(self) -> None:
        self.hint.setProperty("role", "hint")
        self.hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.hint.setWordWrap(True)
        both = QSplitter(Qt.Orientation.Horizontal)
        both.setChildrenCollapsible(False)
        both.addWidget(self.list)
        both.addWidget(self.detail)
        for number, part in enumerate((2, 3)):
            both.setStretchFactor(number, part)
        both.setSizes([2000, 3000])  # parts of what there is
        full = QWidget()
        box = QVBoxLayout(full)
        box.addWidget(both, 1)
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(self.copy_button)
        box.addLayout(row)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self.hint)
        self._stack.addWidget(full)

    def text(self) -> str:
        """All messages as text, with what a supporter asks for first."""
        about = (
            f"NEP Studio {__version__}, Python {platform.python_version()}, Qt {qVersion()},"
            f" {platform.platform()}"
        )
        return "\n\n".join([about, *map(_as_text, self._messages.history)]) + "\n"

    def minimumSizeHint(self) -> QSize:
        """The list may become small: it scrolls."""
        line = self.fontMetrics().height()
        return QSize(line * 12, line * 5)

    def showEvent(self, event: QShowEvent) -> None:
        """Fill the list, which rests while it is hidden."""
        super().showEvent(event)
        self._fill()

    def _on_told(self, told: Told) -> None:
        if self.isVisible():
            self._insert(told)
            self._show_list()

    def _fill(self) -> None:
        self.list.clear()
        for told in self._messages.history:
            self._insert(told)
        self._show_list()

    def _insert(self, told: Told) -> None:
        item = QListWidgetItem(f"{_clock(told)}  {told.message.title}")
        item.setData(TOLD, told)
        item.setToolTip(told.message.title)
        kind = told.message.kind
        item.setIcon(icon(KIND_ICONS[kind], self._look.theme.colour(kind)))
        spoken = f"{kind_word(kind)}, {_clock(told)}: {told.message.title}"
        item.setData(Qt.ItemDataRole.AccessibleTextRole, spoken)
        self.list.insertItem(0, item)
        if self.list.count() > (self._messages.history.maxlen or self.list.count()):
            self.list.takeItem(self.list.count() - 1)

    def _show_list(self) -> None:
        self._stack.setCurrentIndex(1 if self.list.count() else 0)
        if self.list.currentRow() < 0:
            self.list.setCurrentRow(0)

    def _on_chosen(self, item: QListWidgetItem | None) -> None:
        if item is None:
            self.detail.setWidget(QWidget())
            return
        told: Told = item.data(TOLD)
        page = QWidget()
        box = QVBoxLayout(page)
        row = QHBoxLayout()
        sign, side = QLabel(), round(self.fontMetrics().height() * 1.3)
        kind = told.message.kind
        colour, ratio = self._look.theme.colour(kind), self.devicePixelRatioF()
        sign.setPixmap(icon_pixmap(KIND_ICONS[kind], colour, side, ratio))
        sign.setAccessibleName(kind_word(kind))
        row.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(MessageText(told.message), 1)
        box.addLayout(row)
        box.addStretch(1)
        self.detail.setWidget(page)

    def _on_copy_clicked(self) -> None:
        QGuiApplication.clipboard().setText(self.text())
        self._messages.confirm(tr("All messages are copied"))

    def _dress(self) -> None:
        self.copy_button.setIcon(icon("copy", self._look.theme))
        if self.isVisible():
            self._fill()


def kind_word(kind: Kind) -> str:
    """A kind of message in a word: its colour never speaks alone."""
    words: dict[Kind, str] = {
        "info": tr("Note"),
        "success": tr("Done"),
        "warning": tr("Warning"),
        "error": tr("Error"),
    }
    return words[kind]


def _clock(told: Told) -> str:
    return time.strftime("%H:%M:%S", time.localtime(told.time_s))


def _as_text(told: Told) -> str:
    message = told.message
    when = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(told.time_s))
    steps = [f"  [ ] {step}" for step in message.checklist]
    lines = [f"{when}  {message.kind}: {message.title}", message.sentence, *steps, message.details]
    return "\n".join(filter(None, lines))
