"""The computers that are let in, each with a button, and those that were refused."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QDateTime, QLocale, Qt, Signal
from PySide6.QtWidgets import QGridLayout, QPushButton, QVBoxLayout, QWidget

from nep_core.security.keys import Computer
from nep_studio.refusals import Refusal
from nep_studio.ui.connecting.steps import card_around
from nep_studio.ui.watches.questions import hint
from nep_studio.ui.words import language_code, tr

from .closed_page import words_label
from .refusal_words import refusal_sentence, refusal_steps

MOST_REFUSALS = 4
"""So many are shown with what to do; the others are told in the messages."""


class ComputersList(QWidget):
    """``remove_asked`` gives the name of a computer."""

    remove_asked = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.buttons: dict[str, QPushButton] = {}
        self._shown: Sequence[Computer] | None = None
        self._box = QVBoxLayout(self)
        self._box.setContentsMargins(0, 0, 0, 0)

    def show_computers(self, computers: Sequence[Computer]) -> None:
        """Show these."""
        if computers == self._shown:
            return
        self._shown, self.buttons = computers, {}
        _clear(self._box)
        if not computers:
            self._box.addWidget(hint(tr("None yet. The code above lets one in.")))
            return
        rows = QWidget()
        grid = QGridLayout(rows)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(0, 1)
        for number, computer in enumerate(computers):
            grid.addWidget(words_label(_computer_words(computer)), number, 0)
            button = self.buttons[computer.name] = QPushButton(tr("Remove"))
            button.setAutoDefault(False)
            button.setAccessibleName(tr("Remove “{name}”", name=computer.name))
            button.clicked.connect(lambda _=False, name=computer.name: self.remove_asked.emit(name))
            grid.addWidget(button, number, 1)
        self._box.addWidget(rows)


class RefusedList(QWidget):
    """Who knocked and was not let in, the newest first; hidden when nobody did."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.told: list[str] = []
        self._shown: Sequence[Refusal] | None = None
        self._box = QVBoxLayout(self)
        self._box.setContentsMargins(0, 0, 0, 0)
        self.hide()

    def show_refusals(self, refusals: Sequence[Refusal], keys: Path) -> None:
        """Show these, with what to do."""
        if refusals == self._shown:
            return
        self._shown = refusals
        _clear(self._box)
        self.told = []
        self._box.addWidget(words_label(tr("Not let in"), "heading"))
        for refusal in refusals[:MOST_REFUSALS]:
            steps = (f"•  {step}" for step in refusal_steps(refusal, keys))
            first = f"{_clock(refusal.time_s)}   {refusal_sentence(refusal)}"
            self.told.append("\n".join([first, *steps]))
            label = words_label(self.told[-1])
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            self._box.addWidget(card_around(label, "warning"))
        self.setVisible(bool(refusals))


def _computer_words(computer: Computer) -> str:
    return f"{computer.name}   {computer.address}   {_clock(computer.since)}"


def _clock(time_s: float) -> str:
    """A time of today by the clock, another one with its day."""
    moment = QDateTime.fromSecsSinceEpoch(round(time_s))
    locale, short = QLocale(language_code()), QLocale.FormatType.ShortFormat
    is_today = moment.date() == QDateTime.currentDateTime().date()
    return locale.toString(moment.time() if is_today else moment, short)


def _clear(box: QVBoxLayout) -> None:
    while (item := box.takeAt(0)) is not None:
        widget = item.widget()
        if widget is not None:
            widget.hide()
            widget.deleteLater()
