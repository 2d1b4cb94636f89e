"""The page before a network is open: what opening means, and at which address."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QLabel, QWidget

from nep_studio.ui.watches.questions import column_in, hint, labelled, quiet_button
from nep_studio.ui.words import count_words, tr

from .places import Place


class ClosedPage(QWidget):
    """``look_again_asked``: this computer may be in a network by now."""

    look_again_asked = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.addresses = QComboBox()
        self.choice = labelled(tr("This computer is"), self.addresses)
        self.missing = hint(
            tr("This computer is in no network. Connect it to that of the other computers.")
        )
        self.again = quiet_button(tr("Look again"))
        self.restart_told = words_label("")
        self.again.clicked.connect(self.look_again_asked)
        box = column_in(self)
        box.setSpacing(self.fontMetrics().height() * 2 // 3)
        box.addWidget(words_label(tr("Only this computer takes part now"), "title"))
        box.addWidget(
            words_label(
                tr(
                    "When you open the network, other computers can take part: their nodes,"
                    " robots and watches talk with yours."
                )
            )
        )
        box.addWidget(
            words_label(
                tr(
                    "Only computers on which somebody types a code from this window come in, and"
                    " nobody else can read what is sent."
                )
            )
        )
        for widget in (self.choice, self.missing, self.again, self.restart_told):
            box.addWidget(widget)
        box.setAlignment(self.again, Qt.AlignmentFlag.AlignLeading)
        box.addStretch(1)

    def show_places(self, places: Sequence[Place], preferred: str = "") -> None:
        """Offer these; the first is the most likely one."""
        chosen = self.address or preferred
        self.addresses.clear()
        for place in places:
            self.addresses.addItem(place.words, place.address)
        self.addresses.setCurrentIndex(max(0, self.addresses.findData(chosen)))
        self.choice.setVisible(bool(places))
        self.missing.setVisible(not places)
        self.again.setVisible(not places)

    def show_running(self, nodes: int, *, is_program_running: bool) -> None:
        """Say what is started anew when the network is opened."""
        self.restart_told.setText(restart_words(nodes, is_program_running=is_program_running))
        self.restart_told.setVisible(bool(self.restart_told.text()))

    @property
    def address(self) -> str:
        """The address that is chosen; "" when there is none."""
        return self.addresses.currentData() or ""


def restart_words(nodes: int, *, is_program_running: bool) -> str:
    """What happens to what runs; nothing when nothing runs."""
    told = tr("The program is stopped for it; run it again afterwards.")
    begun = count_words(
        nodes, "1 node that runs is started anew.", "{n} nodes that run are started anew."
    )
    return " ".join(([told] if is_program_running else []) + ([begun] if nodes else []))


def words_label(words: str, role: str = "") -> QLabel:
    """Words over several lines."""
    label = QLabel(words)
    label.setWordWrap(True)
    label.setTextFormat(Qt.TextFormat.PlainText)
    if role:
        label.setProperty("role", role)
    return label
