"""The questionnaire, item by item, and the results of a study."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent, QPen, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QBoxLayout,
    QButtonGroup,
    QComboBox,
    QDialog,
    QFrame,
    QHeaderView,
    QLabel,
    QPushButton,
    QRadioButton,
    QScrollArea,
    QSizePolicy,
    QStyle,
    QTableWidget,
    QTableWidgetItem,
    QTabWidget,
    QWidget,
)

from nep_studio.study.records import (
    BROOKE,
    PAPER,
    Questionnaire,
    Reply,
    StudyFolder,
    Summary,
    questionnaire,
    summarize,
)
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import fit_on_screen, hint, plain_label, styled
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr

from .start import ParticipantFields

# The results of a study: the paper's table, the score of each person, and files to take away.


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
        replies = folder.replies()
        self.which = _questionnaires(replies)
        self.overall = styled(QLabel(wordWrap=True), role="title")
        self.items = _table([tr("Question"), tr("Mean"), tr("Deviation")])
        self.people = _table(
            [tr("Participant"), tr("Condition"), tr("Score"), tr("Items left open")]
        )
        self.note = hint("")
        self.answers_button = QPushButton(tr("Save the answers…"))
        self.events_button = QPushButton(tr("Save the events…"))
        self.delete_button = QPushButton(tr("Delete all…"))
        self.close_button = QPushButton(tr("Close"), default=True)
        tabs = QTabWidget(documentMode=True)
        tabs.addTab(self.items, tr("Questions"))
        tabs.addTab(self.people, tr("Participants"))
        foot = in_row(
            self.delete_button, 1, self.answers_button, self.events_button, self.close_button
        )
        in_column(self.which, self.overall, tabs, self.note, foot, of=self)
        fit_on_screen(self, 44, 32)
        self.which.currentIndexChanged.connect(self.refresh)
        self.answers_button.clicked.connect(self.answers_asked)
        self.events_button.clicked.connect(self.events_asked)
        self.delete_button.clicked.connect(self.deletion_asked)
        self.close_button.clicked.connect(self.accept)
        self.refresh()

    def refresh(self) -> None:
        """Read the files again."""
        replies, events = self._folder.replies(), self._folder.events()
        summary = summarize(replies, questionnaire(self.which.currentData(), tr))
        self.overall.setText(_overall_words(summary))
        _fill(self.items, _item_rows(summary))
        people = [
            [one.participant, one.condition, f"{one.score:.1f}", str(one.open_items or "")]
            for one in summary.replies
        ]
        _fill(self.people, people)
        self.note.setText(_note_words(summary))
        self.answers_button.setEnabled(bool(replies))
        self.events_button.setEnabled(bool(events))
        self.delete_button.setEnabled(self._folder.folder.exists())


def _questionnaires(replies: Sequence[Reply]) -> QComboBox:
    """A choice of questionnaires; at first it is the one that was answered last."""
    which = QComboBox()
    which.setAccessibleName(tr("Which questionnaire"))
    for form in (questionnaire(PAPER, tr), questionnaire(BROOKE, tr)):
        which.addItem(form.title, form.id)
    which.setCurrentIndex(which.findData(replies[-1].questionnaire if replies else PAPER))
    return which


def _item_rows(summary: Summary) -> list[list[str]]:
    items = zip(summary.questionnaire.items, summary.items, strict=True)
    return [
        [
            tr("{number}. {item}", number=number, item=words),
            f"{spread.mean:.1f}" if spread.count else "",
            f"{spread.deviation:.2f}" if spread.count else "",
        ]
        for number, (words, spread) in enumerate(items, 1)
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
    table.setHorizontalHeaderLabels(titles)
    table.verticalHeader().hide()
    table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    table.setShowGrid(False)
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


# One item of the questionnaire, with its options in a row.

_WRAPPED = Qt.TextFlag.TextWordWrap.value
BELOW = Qt.AlignmentFlag.AlignHCenter.value | Qt.AlignmentFlag.AlignTop.value | _WRAPPED
BESIDE = Qt.AlignmentFlag.AlignLeading.value | Qt.AlignmentFlag.AlignVCenter.value | _WRAPPED


class OptionButton(QRadioButton):
    """One option: a circle, and its words below, or beside it where there is little room."""

    def __init__(self, words: str, look: Look) -> None:
        super().__init__(words)
        self._look = look
        self._is_beside = False
        policy = QSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        policy.setHeightForWidth(True)
        self.setSizePolicy(policy)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def set_beside(self, is_beside: bool) -> None:
        """Put the words beside the circle, or below it."""
        self._is_beside = is_beside
        self.updateGeometry()

    @property
    def least_width(self) -> int:
        """As wide as its longest word."""
        metrics = self.fontMetrics()
        widest = max(metrics.horizontalAdvance(word) for word in self.text().split())
        return widest + metrics.height()

    def sizeHint(self) -> QSize:
        """Room for the circle and the words."""
        width = self.least_width + self._is_beside * self._circle_room()
        return QSize(width, self.heightForWidth(width))

    def minimumSizeHint(self) -> QSize:
        """All of its words are seen."""
        return QSize(self.sizeHint().width(), self._circle_room())

    def heightForWidth(self, width: int) -> int:
        """As many lines as the words need."""
        return self._words_rect(width).bottom() + self.fontMetrics().height() // 3

    def hitButton(self, place: QPoint) -> bool:
        """The words can be clicked too."""
        return self.rect().contains(place)

    def _circle_room(self) -> int:
        return round(self.fontMetrics().height() * 1.8)

    def _words_rect(self, width: int) -> QRect:
        """Where the words are, as if one reads from the left."""
        room, is_beside = self._circle_room(), self._is_beside
        endless = QRect(0, room, width, 10_000)
        if is_beside:
            endless = QRect(room, 0, max(1, width - room), 10_000)
        flags = BESIDE if is_beside else BELOW
        tall = self.fontMetrics().boundingRect(endless, flags, self.text()).height()
        endless.setHeight(max(tall, room) if is_beside else tall)
        return endless

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw circle and words."""
        theme, line = self._look.theme, self.fontMetrics().height()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.underMouse():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("hover"))
            painter.drawRoundedRect(self.rect(), line / 3, line / 3)
        self._paint_circle(painter)
        painter.setPen(theme.colour("text"))
        words = QStyle.visualRect(
            self.layoutDirection(), self.rect(), self._words_rect(self.width())
        )
        painter.drawText(words, BESIDE if self._is_beside else BELOW, self.text())
        if self.hasFocus():
            painter.setPen(QPen(theme.colour("focus"), max(2.0, line / 9)))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(2, 2, -2, -2), line / 3, line / 3)

    def _paint_circle(self, painter: QPainter) -> None:
        theme, line, room = self._look.theme, self.fontMetrics().height(), self._circle_room()
        space = QRect(0, 0, room if self._is_beside else self.width(), room)
        circle = QRectF(0, 0, line, line)
        circle.moveCenter(
            QRectF(QStyle.visualRect(self.layoutDirection(), self.rect(), space)).center()
        )
        painter.setPen(QPen(theme.colour("field_line"), max(1.5, line / 12)))
        painter.setBrush(theme.colour("accent" if self.isChecked() else "field"))
        painter.drawEllipse(circle)
        if self.isChecked():
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(theme.colour("accent_text"))
            painter.drawEllipse(circle.center(), line * 0.2, line * 0.2)


class ItemRow(QFrame):
    """One item. Digits choose an option, Backspace leaves it open; ``changed`` tells of both."""

    changed = Signal()

    def __init__(self, number: int, form: Questionnaire, look: Look) -> None:
        super().__init__()
        words = form.items[number]
        told = tr("{number}. {item}", number=number + 1, item=words)
        self.label = styled(plain_label(told), role="heading")
        self.clear_button = styled(QPushButton(tr("Leave open")), kind="quiet")
        self.clear_button.setAccessibleDescription(words)
        self.buttons = [OptionButton(option, look) for option in form.options]
        self._group = QButtonGroup(self)
        self._options = in_row(*((button, 1) for button in self.buttons), spacing=0)
        count = len(self.buttons)
        for place, button in enumerate(self.buttons, 1):
            option = button.text()
            told = tr("{option}, {place} of {count}", option=option, place=place, count=count)
            button.setAccessibleName(told)
            button.setAccessibleDescription(words)
            self._group.addButton(button, place)
        head = in_row((self.label, 1), (self.clear_button, 0, Qt.AlignmentFlag.AlignTop))
        policy = self.clear_button.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.clear_button.setSizePolicy(policy)
        in_column(head, self._options, of=styled(self, kind="card"))
        self._group.idToggled.connect(self._on_toggled)
        self.clear_button.clicked.connect(self.clear)
        self._show_clear()

    def fit(self, width: int) -> None:
        """Put the options in a row where there is room for it, else one below the other."""
        margins = self.contentsMargins()
        needed = max(button.least_width for button in self.buttons) * len(self.buttons)
        is_beside = needed + margins.left() + margins.right() + self.fontMetrics().height() > width
        direction = QBoxLayout.Direction
        self._options.setDirection(direction.TopToBottom if is_beside else direction.LeftToRight)
        for button in self.buttons:
            button.set_beside(is_beside)

    @property
    def answer(self) -> int | None:
        """The option that is chosen, from 1; None while it is open."""
        chosen = self._group.checkedId()
        return chosen if chosen > 0 else None

    def choose(self, option: int) -> None:
        """Choose an option, from 1."""
        button = self._group.button(option)
        if button is not None:
            button.setChecked(True)
            button.setFocus()

    def clear(self) -> None:
        """Leave the item open."""
        chosen = self._group.checkedButton()
        if chosen is None:
            return
        self._group.setExclusive(False)
        chosen.setChecked(False)
        self._group.setExclusive(True)
        if self.clear_button.hasFocus():
            self.buttons[0].setFocus()
        self._show_clear()
        self.changed.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Answer by a digit."""
        if event.text().isdecimal() and 1 <= int(event.text()) <= len(self.buttons):
            self.choose(int(event.text()))
        elif event.key() in (Qt.Key.Key_Backspace, Qt.Key.Key_Delete):
            self.clear()
        else:
            super().keyPressEvent(event)

    def _on_toggled(self, option: int, is_chosen: bool) -> None:
        if is_chosen:
            self._show_clear()
            self.changed.emit()

    def _show_clear(self) -> None:
        self.clear_button.setVisible(self.answer is not None)


class QuestionnaireDialog(QDialog):
    """Asks the ten items; ``answered`` gives the Reply."""

    answered = Signal(object)

    def __init__(self, folder: StudyFolder, look: Look, parent: QWidget) -> None:
        super().__init__(parent)
        self._look = look
        self.setWindowTitle(tr("Questionnaire"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.participant_fields = ParticipantFields(folder, may_change_conditions=False)
        self.which = _questionnaires(folder.replies())
        self.rows: list[ItemRow] = []
        self.note = plain_label()
        self.save_button = styled(QPushButton(tr("Save the answers"), default=True), kind="primary")
        self.cancel_button = QPushButton(tr("Cancel"))
        self.area = QScrollArea(widgetResizable=True)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        if (sitting := folder.sitting()) is not None:
            self.participant_fields.show_sitting(sitting.participant, sitting.condition)
        foot = in_row((self.note, 1), self.cancel_button, self.save_button)
        in_column((self.area, 1), foot, of=self)
        fit_on_screen(self, 52, 46)
        self._ask_items()
        self.which.currentIndexChanged.connect(self._ask_items)
        self.participant_fields.changed.connect(self._show_note)
        self.save_button.clicked.connect(self._on_save_clicked)
        self.cancel_button.clicked.connect(self.reject)

    def _ask_items(self) -> None:
        """Show the items of the chosen questionnaire, all open."""
        form = questionnaire(self.which.currentData(), tr)
        self.rows = [ItemRow(number, form, self._look) for number in range(len(form.items))]
        for row in self.rows:
            row.changed.connect(self._show_note)
        words = tr(
            "Say how much you agree with each sentence. Answer at once, do not think long. An item"
            " that you cannot answer may stay open. Keys: Tab to the next item, digits to answer."
        )
        page, about = QWidget(), QLabel(words, wordWrap=True)
        in_column(self.which, self.participant_fields, about, *self.rows, 1, of=page)
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

    def _show_note(self) -> None:
        left = sum(row.answer is None for row in self.rows)
        is_empty = left == len(self.rows)
        if not self.participant_fields.participant:
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
        self.save_button.setEnabled(bool(self.participant_fields.participant) and not is_empty)

    def _on_save_clicked(self) -> None:
        fields, form = self.participant_fields, str(self.which.currentData())
        chosen = [row.answer for row in self.rows]
        self.answered.emit(Reply(fields.participant, fields.chosen_condition, chosen, form))
        self.accept()
