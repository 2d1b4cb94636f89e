"""The results of a study: the paper's table, the score of each person, and files to take away."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QDialog,
    QHeaderView,
    QLabel,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QTabWidget,
    QWidget,
)

from nep_studio.study.records import Spread, StudyFolder, Summary, summarize
from nep_studio.study.sus import BROOKE, PAPER, questionnaire
from nep_studio.ui.widgets.forms import room_around
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr


class ResultsDialog(QDialog):
    """Shows what was answered; the buttons ask for files, or for all to be deleted."""

    answers_asked = Signal()
    events_asked = Signal()
    deletion_asked = Signal()

    def __init__(self, folder: StudyFolder, parent: QWidget) -> None:
        super().__init__(parent)
        self._folder = folder
        self.setWindowTitle(tr("Results of the study"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.which = QComboBox()
        self.overall = QLabel()
        self.items = _table([tr("Question"), tr("Mean"), tr("Deviation")])
        self.people = _table(
            [tr("Participant"), tr("Condition"), tr("Score"), tr("Items left open")]
        )
        self.note = QLabel()
        self.answers_button = QPushButton(tr("Save the answers…"))
        self.events_button = QPushButton(tr("Save the events…"))
        self.delete_button = QPushButton(tr("Delete all…"))
        self.close_button = QPushButton(tr("Close"))
        for form in (questionnaire(PAPER, tr), questionnaire(BROOKE, tr)):
            self.which.addItem(form.title, form.id)
        replies = self._folder.replies()
        self.which.setCurrentIndex(
            self.which.findData(replies[-1].questionnaire if replies else PAPER)
        )
        self.which.setAccessibleName(tr("Which questionnaire"))
        self._lay_out()
        self._connect()
        self.refresh()

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.overall.setProperty("role", "title")
        self.overall.setWordWrap(True)
        self.note.setProperty("role", "hint")
        self.note.setWordWrap(True)
        tabs = QTabWidget(documentMode=True)
        tabs.addTab(self.items, tr("Questions"))
        tabs.addTab(self.people, tr("Participants"))
        foot = in_row(
            self.delete_button, 1, self.answers_button, self.events_button, self.close_button
        )
        self.close_button.setDefault(True)
        in_column(self.which, self.overall, tabs, self.note, foot, of=self)
        room = room_around(self).size()
        self.resize(min(line * 44, room.width()), min(line * 32, room.height()))

    def _connect(self) -> None:
        self.which.currentIndexChanged.connect(self.refresh)
        self.answers_button.clicked.connect(self.answers_asked)
        self.events_button.clicked.connect(self.events_asked)
        self.delete_button.clicked.connect(self.deletion_asked)
        self.close_button.clicked.connect(self.accept)

    def refresh(self) -> None:
        """Read the files again."""
        replies, events = self._folder.replies(), self._folder.events()
        summary = summarize(replies, questionnaire(self.which.currentData(), tr))
        self.overall.setText(_overall_words(summary))
        _fill(self.items, [_item_row(*row) for row in _numbered(summary)])
        _fill(self.people, _people_rows(summary))
        self.note.setText(_note_words(summary))
        self.answers_button.setEnabled(bool(replies))
        self.events_button.setEnabled(bool(events))
        self.delete_button.setEnabled(self._folder.folder.exists())


def _numbered(summary: Summary) -> list[tuple[str, Spread]]:
    items = zip(summary.questionnaire.items, summary.items, strict=True)
    return [
        (tr("{number}. {item}", number=number, item=words), spread)
        for number, (words, spread) in enumerate(items, 1)
    ]


def _item_row(words: str, spread: Spread) -> list[str]:
    if not spread.count:
        return [words, "", ""]
    return [words, f"{spread.mean:.1f}", f"{spread.deviation:.2f}"]


def _people_rows(summary: Summary) -> list[list[str]]:
    return [
        [one.participant, one.condition, f"{one.score:.1f}", str(one.open_items or "")]
        for one in summary.replies
    ]


def _overall_words(summary: Summary) -> str:
    if not summary.overall.count:
        return tr("Nobody has answered this questionnaire yet.")
    return tr("Overall SUS score (out of 100): {score}", score=f"{summary.overall.mean:.1f}")


def _note_words(summary: Summary) -> str:
    """What the numbers are of, and the score of each condition."""
    if not summary.overall.count:
        return ""
    count, deviation = summary.overall.count, f"{summary.overall.deviation:.1f}"
    lines = [
        count_words(
            count,
            "1 questionnaire; the deviation of the scores is {deviation}.",
            "{n} questionnaires; the deviation of the scores is {deviation}.",
            deviation=deviation,
        ),
        tr("Deviations are those of the people asked (divided by their number), as in the paper."),
    ]
    for condition, spread in summary.by_condition.items():
        if condition:
            score = f"{spread.mean:.1f}"
            lines.append(tr("{condition}: {score}", condition=condition, score=score))
    return "\n".join(lines)


def _table(titles: Sequence[str]) -> QTableWidget:
    table = QTableWidget(0, len(titles))
    table.setHorizontalHeaderLabels(list(titles))
    table.verticalHeader().hide()
    table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    table.setShowGrid(False)
    table.setWordWrap(True)
    header = table.horizontalHeader()
    header.setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
    header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
    return table


def _fill(table: QTableWidget, rows: Sequence[Sequence[str]]) -> None:
    table.setRowCount(len(rows))
    for number, row in enumerate(rows):
        for column, words in enumerate(row):
            item = QTableWidgetItem(words)
            if column and words.replace(".", "").isdecimal():
                side = Qt.AlignmentFlag.AlignTrailing | Qt.AlignmentFlag.AlignVCenter
                item.setTextAlignment(side)
            table.setItem(number, column, item)
    table.resizeRowsToContents()
