"""Who takes part in a study, and under which condition: a code, never a name."""

from __future__ import annotations

from PySide6.QtCore import QRegularExpression, Signal
from PySide6.QtGui import QRegularExpressionValidator
from PySide6.QtWidgets import QComboBox, QFormLayout, QLabel, QLineEdit, QWidget

from nep_studio.study.order import conditions_for, next_code, participant_number
from nep_studio.study.records import StudyFolder
from nep_studio.ui.words import tr

CODE = r"[\p{L}\p{N}_-]{1,20}"


class Who(QWidget):
    """The participant's code, the conditions, and the one that is next in their order."""

    changed = Signal()

    def __init__(self, folder: StudyFolder, *, may_change_conditions: bool) -> None:
        super().__init__()
        self._folder = folder
        self._shown: list[str] = []
        self.code = QLineEdit(next_code(folder.participants()))
        self.code.setValidator(QRegularExpressionValidator(QRegularExpression(CODE)))
        self.conditions = QLineEdit(", ".join(folder.conditions()))
        self.conditions.setPlaceholderText(tr("Such as: blocks, text"))
        self.condition = QComboBox()
        self.order = QLabel()
        self._lay_out(may_change_conditions)
        self.code.textChanged.connect(self._on_changed)
        self.conditions.textChanged.connect(self._on_changed)
        self._on_changed()

    def _lay_out(self, may_change_conditions: bool) -> None:
        self._form = QFormLayout(self)
        self._form.setContentsMargins(0, 0, 0, 0)
        self._form.addRow(tr("Participant"), self.code)
        self._form.addRow("", _hint(tr("A code, not a name. Its number decides the order.")))
        if may_change_conditions:
            self._form.addRow(tr("Conditions"), self.conditions)
        self._form.addRow(tr("Condition now"), self.condition)
        self.order.setProperty("role", "hint")
        self.order.setWordWrap(True)
        self._form.addRow("", self.order)

    @property
    def participant(self) -> str:
        """The code; "" while it is none."""
        return self.code.text() if self.code.hasAcceptableInput() else ""

    @property
    def chosen_condition(self) -> str:
        """The condition; "" where there is only one."""
        return str(self.condition.currentData() or "")

    def all_conditions(self) -> list[str]:
        """The conditions that are compared."""
        named = [one.strip() for one in self.conditions.text().split(",")]
        return list(dict.fromkeys(filter(None, named)))

    def show_sitting(self, participant: str, condition: str) -> None:
        """Show the participant and condition of a study that goes on."""
        self.code.setText(participant)
        if condition and self.condition.findData(condition) < 0:
            self.condition.addItem(condition, condition)
            self._form.setRowVisible(self.condition, True)
        self.condition.setCurrentIndex(self.condition.findData(condition))

    def _on_changed(self) -> None:
        conditions = self.all_conditions()
        number = participant_number(self.participant)
        ordered = conditions_for(number or 1, conditions)
        done = self._folder.conditions_done(self.participant) if self.participant else set()
        self.condition.clear()
        for place, condition in enumerate(ordered, 1):
            words = tr("{place}. {condition}", place=place, condition=condition)
            self.condition.addItem(words, condition)
        left = [condition for condition in ordered if condition not in done]
        self.condition.setCurrentIndex(self.condition.findData(left[0]) if left else 0)
        self._form.setRowVisible(self.condition, bool(conditions))
        self._form.setRowVisible(self.order, bool(conditions))
        self.order.setText(self._order_words(number, ordered))
        self.changed.emit()

    def _order_words(self, number: int | None, ordered: list[str]) -> str:
        if number is None:
            return tr("The code has no number: the order is that of the first participant.")
        order = ", ".join(ordered)
        return tr("The order for {participant}: {order}", participant=self.participant, order=order)


def _hint(words: str) -> QLabel:
    label = QLabel(words)
    label.setProperty("role", "hint")
    label.setWordWrap(True)
    return label
