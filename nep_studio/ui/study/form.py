"""The questionnaire: ten items, who answers them, and a note on those that are open."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from nep_studio.study.records import Reply, StudyFolder
from nep_studio.study.sus import BROOKE, PAPER, Answers, questionnaire
from nep_studio.ui.screens import room_around
from nep_studio.ui.theme import Look
from nep_studio.ui.words import count_words, tr

from .scale import ItemRow
from .who import Who


class QuestionnaireDialog(QDialog):
    """Asks the ten items; ``answered`` gives the Reply."""

    answered = Signal(object)

    def __init__(self, folder: StudyFolder, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look
        self.setWindowTitle(tr("Questionnaire"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.who = Who(folder, may_change_conditions=False)
        self.which = QComboBox()
        self.rows: list[ItemRow] = []
        self.note = QLabel()
        self.save_button = QPushButton(tr("Save the answers"))
        self.cancel_button = QPushButton(tr("Cancel"))
        self.area = QScrollArea()
        replies, sitting = folder.replies(), folder.sitting()
        self._fill_which(replies[-1].questionnaire if replies else PAPER)
        if sitting is not None:
            self.who.show_sitting(sitting.participant, sitting.condition)
        self._lay_out()
        self._ask_items()
        self.which.currentIndexChanged.connect(self._ask_items)
        self.who.changed.connect(self._show_note)
        self.save_button.clicked.connect(self._on_save_clicked)
        self.cancel_button.clicked.connect(self.reject)

    def _fill_which(self, usual: str) -> None:
        for form in (questionnaire(PAPER, tr), questionnaire(BROOKE, tr)):
            self.which.addItem(form.title, form.id)
        self.which.setCurrentIndex(self.which.findData(usual))
        self.which.setAccessibleName(tr("Which questionnaire"))

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.area.setWidgetResizable(True)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        self.note.setWordWrap(True)
        self.save_button.setDefault(True)
        self.save_button.setProperty("kind", "primary")
        foot = QHBoxLayout()
        foot.addWidget(self.note, 1)
        foot.addWidget(self.cancel_button)
        foot.addWidget(self.save_button)
        box = QVBoxLayout(self)
        box.addWidget(self.area, 1)
        box.addLayout(foot)
        room = room_around(self).size()
        self.resize(min(line * 52, room.width()), min(line * 46, room.height()))

    def _ask_items(self) -> None:
        """Show the items of the chosen questionnaire, all open."""
        form = questionnaire(self.which.currentData(), tr)
        self.rows = [ItemRow(number, form, self._look) for number in range(len(form.items))]
        page = QWidget()
        box = QVBoxLayout(page)
        self.who.setParent(page)
        self.which.setParent(page)
        box.addWidget(self.which)
        box.addWidget(self.who)
        box.addWidget(_instruction())
        for row in self.rows:
            row.changed.connect(self._show_note)
            box.addWidget(row)
        box.addStretch(1)
        old = self.area.takeWidget()
        self.area.setWidget(page)
        if old is not None:
            old.deleteLater()
        self._fit()
        self._show_note()

    def _fit(self) -> None:
        line = self.fontMetrics().height()
        for row in self.rows:
            row.fit(self.area.viewport().width() - 2 * line)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Lay the options out as there is room."""
        super().resizeEvent(event)
        self._fit()

    def showEvent(self, event: QShowEvent) -> None:
        """Lay the options out in the room that there is."""
        super().showEvent(event)
        self._fit()

    def answers(self) -> Answers:
        """What is chosen now."""
        return [row.answer for row in self.rows]

    def _show_note(self) -> None:
        left = sum(answer is None for answer in self.answers())
        is_empty = left == len(self.rows)
        if not self.who.participant:
            words = tr("The participant needs a code of letters and digits.")
        elif is_empty:
            words = tr("Nothing is answered yet.")
        elif left:
            words = count_words(
                left,
                "1 item is open. It counts as the option in the middle.",
                "{n} items are open. They count as the option in the middle.",
            )
        else:
            words = tr("All items are answered.")
        self.note.setText(words)
        self.save_button.setEnabled(bool(self.who.participant) and not is_empty)

    def _on_save_clicked(self) -> None:
        who = self.who
        chosen = list(self.answers())
        form = str(self.which.currentData())
        self.answered.emit(Reply(who.participant, who.chosen_condition, chosen, form))
        self.accept()


def _instruction() -> QLabel:
    words = tr(
        "Say how much you agree with each sentence. Answer at once, do not think long. An item"
        " that you cannot answer may stay open. Keys: Tab to the next item, digits to answer."
    )
    label = QLabel(words)
    label.setWordWrap(True)
    return label
