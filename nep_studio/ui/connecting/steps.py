"""The steps of the way to a robot, each with a sign and a sentence that says how it went."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtWidgets import QFrame, QGridLayout, QLabel, QVBoxLayout, QWidget

from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nodes.action.naoqi.probe import Check

SIGNS = {
    "waiting": ("circle-dashed", "muted"),
    "trying": ("refresh-cw", "info"),
    "ok": ("circle-check", "success"),
    "failed": ("circle-alert", "error"),
}


def step_questions() -> dict[str, str]:
    """What each step asks, by its name in the probe, in their order."""
    return {
        "name": tr("Is the address known?"),
        "port": tr("Does something answer there?"),
        "naoqi": tr("Is it a NAOqi robot?"),
        "login": tr("Does it let us in?"),
        "services": tr("Can it do what the blocks ask for?"),
        "robot": tr("How is it?"),
    }


def state_words() -> dict[str, str]:
    """How a step is, for those who cannot see its sign."""
    return {
        "waiting": tr("not tried yet"),
        "trying": tr("trying…"),
        "ok": tr("all right"),
        "failed": tr("did not work"),
    }


class StepsView(QFrame):
    """One row for each step; below the one that failed stands what to try."""

    def __init__(self, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._look = look
        self._questions = step_questions()
        self.setProperty("kind", "card")
        self._signs: dict[str, QLabel] = {}
        self._words: dict[str, QLabel] = {}
        self.states: dict[str, str] = {}
        self.advice = QLabel()
        self.advice_card = card_around(self.advice, "warning")
        self._lay_out()
        self.clear()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        grid = QGridLayout()
        grid.setColumnStretch(1, 1)
        grid.setVerticalSpacing(line // 3)
        for row, step in enumerate(self._questions):
            sign, words = QLabel(), QLabel()
            words.setWordWrap(True)
            words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            grid.addWidget(sign, row, 0, Qt.AlignmentFlag.AlignTop)
            grid.addWidget(words, row, 1)
            self._signs[step], self._words[step] = sign, words
        self.advice.setWordWrap(True)
        self.advice.setTextFormat(Qt.TextFormat.PlainText)
        self.advice.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        box = QVBoxLayout(self)
        box.setContentsMargins(line // 2, line // 2, line // 2, line // 2)
        box.setSpacing(line // 2)
        box.addLayout(grid)
        box.addWidget(self.advice_card)

    def clear(self) -> None:
        """No step has been tried."""
        for step in self._questions:
            self._show(step, "waiting", self._questions[step])
        self.advice_card.hide()

    def begin(self) -> None:
        """The first step is being tried."""
        self.clear()
        self._try(next(iter(self._questions)))

    def take(self, check: Check) -> None:
        """Show how a step went, and that the next one is being tried."""
        self._show(check.step, "ok" if check.is_ok else "failed", tr(check.sentence))
        if not check.is_ok:
            lines = [tr("Try this, in this order:"), *(f"•  {tr(it)}" for it in check.checklist)]
            self.advice.setText("\n".join(lines))
            self.advice_card.setVisible(bool(check.checklist))
            return
        steps = list(self._questions)
        later = steps[steps.index(check.step) + 1 :]
        if later:
            self._try(later[0])

    def _try(self, step: str) -> None:
        self._show(step, "trying", self._questions[step])

    def _show(self, step: str, state: str, words: str) -> None:
        name, colour = SIGNS[state]
        side = round(self.fontMetrics().height() * 1.1)
        picture = icon(name, self._look.theme.colour(colour))
        self._signs[step].setPixmap(picture.pixmap(QSize(side, side), self.devicePixelRatioF()))
        self._words[step].setText(words)
        self._words[step].setProperty("role", "hint" if state == "waiting" else "")
        self._words[step].style().polish(self._words[step])
        self._words[step].setAccessibleName(f"{words} {state_words()[state]}")
        self.states[step] = state


def card_around(label: QLabel, kind: str) -> QFrame:
    """Put words into a card of a colour."""
    card = QFrame()
    card.setProperty("kind", kind)
    room = label.fontMetrics().height() // 2
    box = QVBoxLayout(card)
    box.setContentsMargins(room, room, room, room)
    box.addWidget(label)
    return card
