"""The page on which this computer joins the open network of another one."""

from __future__ import annotations

import threading

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import (
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_core import discovery
from nep_core.security.opening import DOOR_PORT
from nep_studio.ui.connecting.looking import Job, News
from nep_studio.ui.theme import Look, icon
from nep_studio.ui.watches.questions import column_in, hint, labelled
from nep_studio.ui.words import count_words, tr

from .closed_page import words_label

SEARCH_S = 3.0
CODE_DIGITS = 6
ROWS = 3
ADDRESS = Qt.ItemDataRole.UserRole


class NetworkSearch(Job):
    """Open networks that are announced around this computer; ``found`` gives all of them."""

    found = Signal(list)

    def start(self, seconds: float) -> None:
        """Look for some seconds."""

        def work(_cancelled: threading.Event, news: News) -> None:
            news.put(discovery.find(seconds))

        self._start(work, self.found.emit)


class JoinPage(QWidget):
    """``changed`` tells that another address or code is written."""

    changed = Signal()

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self.search = NetworkSearch(self)
        self.networks = QListWidget()
        self.told = hint("")
        self.progress = QProgressBar()
        self.again = QPushButton(tr("Look again"))
        self.again.setAutoDefault(False)
        self.address, self.code = QLineEdit(), QLineEdit()
        self.restart_told = words_label("")
        self._lay_out()
        self.search.found.connect(self._on_found)
        self.search.ended.connect(self._on_ended)
        self.again.clicked.connect(self.look)
        self.networks.currentItemChanged.connect(self._on_chosen)
        self.networks.itemClicked.connect(self._on_chosen)
        self.address.textChanged.connect(self.changed)
        self.code.textChanged.connect(self.changed)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.networks.setAccessibleName(tr("Open networks around here"))
        self.networks.setIconSize(QSize(round(line * 1.4), round(line * 1.4)))
        self.networks.setFixedHeight(round(line * 1.9) * ROWS)
        self.progress.setRange(0, 0)
        self.progress.setTextVisible(False)
        self.progress.setAccessibleName(tr("Looking for open networks…"))
        for field, example in ((self.address, "192.168.1.5"), (self.code, "123 456")):
            field.setPlaceholderText(example)
            field.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        box = column_in(self)
        box.setSpacing(line // 2)
        box.addWidget(words_label(tr("Join another computer"), "title"))
        box.addWidget(
            words_label(
                tr(
                    "On the other computer choose “Open to other computers…” in the menu Robots."
                    " It shows a code; type that one here."
                )
            )
        )
        self._add_search(box)
        box.addWidget(labelled(tr("Address of the other computer"), self.address))
        box.addWidget(labelled(tr("Code"), self.code))
        box.addWidget(self.restart_told)
        box.addStretch(1)

    def _add_search(self, box: QVBoxLayout) -> None:
        for widget in (self.networks, self.progress, self.told, self.again):
            box.addWidget(widget)
        box.setAlignment(self.again, Qt.AlignmentFlag.AlignLeading)

    def begin(self) -> None:
        """Look for networks, unless some have been found."""
        if not self.networks.count():
            self.look()

    def look(self) -> None:
        """Look for networks."""
        self.networks.clear()
        self.told.setText(tr("Looking for open networks…"))
        self.progress.show()
        self.again.setEnabled(False)
        self.search.start(SEARCH_S)

    @property
    def is_complete(self) -> bool:
        """Whether one may try to join."""
        digits = [letter for letter in self.code.text() if letter.isdigit()]
        return bool(self.address.text().strip()) and len(digits) == CODE_DIGITS

    def _on_found(self, found: list[discovery.Found]) -> None:
        for one in found:
            words = f"{one.computer}   {one.host}   {one.title}"
            item = QListWidgetItem(icon("monitor", self._look.theme), words)
            is_usual = one.door_port == DOOR_PORT
            item.setData(ADDRESS, one.host if is_usual else f"{one.host}:{one.door_port}")
            self.networks.addItem(item)
        if len(found) == 1 and not self.address.text():
            self.networks.setCurrentRow(0)

    def _on_ended(self, _problem: str) -> None:
        self.progress.hide()
        self.again.setEnabled(True)
        count = self.networks.count()
        nothing = tr("None was found. Type the address that the other computer shows.")
        words = count_words(count, "1 open network was found.", "{n} open networks were found.")
        self.told.setText(words if count else nothing)

    def _on_chosen(self, item: QListWidgetItem | None) -> None:
        if item is not None:
            self.address.setText(item.data(ADDRESS))
            self.code.setFocus()
