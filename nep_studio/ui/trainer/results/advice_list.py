"""Shows what the findings mean: a sentence each, with a button for what helps."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from nep_studio.ui.panels.flow import FlowLayout
from nep_studio.ui.theme import Look
from nep_studio.ui.trainer.results.advice_parts import Advice, Kind, What
from nep_studio.ui.trainer.results.labels import Sign, Words
from nep_studio.ui.words import count_words, tr

MOST_SHOWN = 4
"""So many at once; the rest is shown when it is asked for."""
_SIGNS: dict[Kind, tuple[str, str]] = {
    "problem": ("triangle-alert", "warning"),
    "tip": ("lightbulb", "info"),
    "good": ("circle-check", "success"),
}


def _kind_words(kind: Kind) -> str:
    words = {"problem": tr("To do better"), "tip": tr("A tip"), "good": tr("Well done")}
    return words[kind]


def _button_words(what: What) -> str:
    words = {
        "record": tr("Record more"),
        "everyday": tr("Record everyday movement"),
        "gesture": tr("Add a gesture"),
        "point": tr("Set the point"),
        "takes": tr("Show the takes"),
        "try": tr("Try it out"),
    }
    return words.get(what, "")


class AdviceList(QWidget):
    """``asked`` gives the Advice whose button was pressed, ``takes_asked`` the ids of takes."""

    asked = Signal(object)
    takes_asked = Signal(object)

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._advice: tuple[Advice, ...] = ()
        self._shows_all = False
        self.rows: list[AdviceRow] = []
        self.more = QPushButton()
        self.more.setProperty("kind", "quiet")
        self.more.clicked.connect(self._on_more)
        self._box = QVBoxLayout(self)
        self._box.setContentsMargins(0, 0, 0, 0)
        self._box.addWidget(self.more, 0, Qt.AlignmentFlag.AlignLeading)
        self.more.hide()

    def show_advice(self, advice: Sequence[Advice]) -> None:
        """Show these; nothing is built again when they are the same."""
        if tuple(advice) != self._advice:
            self._advice, self._shows_all = tuple(advice), False
            self._fill()

    def _fill(self) -> None:
        for row in self.rows:
            row.hide()
            row.deleteLater()
        most = len(self._advice) if self._shows_all else MOST_SHOWN
        self.rows = [AdviceRow(one, self._look, self) for one in self._advice[:most]]
        for at, row in enumerate(self.rows):
            self._box.insertWidget(at, row)
        hidden = len(self._advice) - len(self.rows)
        self.more.setVisible(hidden > 0)
        self.more.setText(count_words(hidden, "1 more tip", "{n} more tips"))

    def _on_more(self) -> None:
        self._shows_all = True
        self._fill()
        if self.rows and self.rows[MOST_SHOWN:]:
            self.rows[MOST_SHOWN].button.setFocus()


class AdviceRow(QWidget):
    """One sentence, and the buttons below it."""

    def __init__(self, advice: Advice, look: Look, of: AdviceList) -> None:
        super().__init__(of)
        self.advice = advice
        self.setAccessibleName(f"{_kind_words(advice.kind)}: {advice.words}")
        sign = Sign(look, self)
        sign.show_icon(*_SIGNS[advice.kind])
        sign.setToolTip(_kind_words(advice.kind))
        self.words = Words(advice.words)
        self.button = QPushButton(_button_words(advice.what))
        self.button.setProperty("kind", "quiet")
        self.button.setAccessibleDescription(advice.words)
        self.button.clicked.connect(lambda: of.asked.emit(advice))
        self.button.setVisible(bool(advice.what))
        self.show_takes = QPushButton(_button_words("takes"))
        self.show_takes.setProperty("kind", "quiet")
        self.show_takes.setAccessibleDescription(advice.words)
        self.show_takes.clicked.connect(lambda: of.takes_asked.emit(advice.takes))
        self.show_takes.setVisible(bool(advice.takes) and advice.what != "takes")
        words = QVBoxLayout()
        words.setSpacing(0)
        words.addWidget(self.words)
        buttons = FlowLayout()
        buttons.addWidget(self.button)
        buttons.addWidget(self.show_takes)
        words.addLayout(buttons)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        row.addLayout(words, 1)
