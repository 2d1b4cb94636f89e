"""The questionnaire: ten items, who answers them, and a note on those that are open."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QPainter, QPaintEvent, QPen, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QButtonGroup,
    QComboBox,
    QDialog,
    QFrame,
    QLabel,
    QPushButton,
    QRadioButton,
    QScrollArea,
    QSizePolicy,
    QStyle,
    QVBoxLayout,
    QWidget,
)

from nep_studio.study.records import Reply, StudyFolder
from nep_studio.study.sus import BROOKE, PAPER, Answers, Questionnaire, questionnaire
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import room_around
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr

from .start import ParticipantFields

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
        room = self._circle_room()
        if self._is_beside:
            endless = QRect(room, 0, max(1, width - room), 10_000)
            tall = self.fontMetrics().boundingRect(endless, BESIDE, self.text()).height()
            return QRect(room, 0, endless.width(), max(tall, room))
        endless = QRect(0, room, width, 10_000)
        tall = self.fontMetrics().boundingRect(endless, BELOW, self.text()).height()
        return QRect(0, room, width, tall)

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
        self.setProperty("kind", "card")
        words = form.items[number]
        self.label = QLabel(tr("{number}. {item}", number=number + 1, item=words), wordWrap=True)
        self.label.setProperty("role", "heading")
        self.clear_button = QPushButton(tr("Leave open"))
        self.clear_button.setProperty("kind", "quiet")
        self.clear_button.setAccessibleDescription(words)
        self.buttons = [OptionButton(option, look) for option in form.options]
        self._group = QButtonGroup(self)
        for place, button in enumerate(self.buttons, 1):
            count = len(self.buttons)
            told = tr(
                "{option}, {place} of {count}", option=button.text(), place=place, count=count
            )
            button.setAccessibleName(told)
            button.setAccessibleDescription(words)
            self._group.addButton(button, place)
        self._lay_out()
        self._group.idToggled.connect(self._on_toggled)
        self.clear_button.clicked.connect(self.clear)
        self._show_clear()

    def _lay_out(self) -> None:
        head = in_row((self.label, 1), (self.clear_button, 0, Qt.AlignmentFlag.AlignTop))
        policy = self.clear_button.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.clear_button.setSizePolicy(policy)
        self._options = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        self._options.setSpacing(0)
        for button in self.buttons:
            self._options.addWidget(button, 1)
        in_column(head, self._options, of=self)

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
        self.which = QComboBox()
        self.rows: list[ItemRow] = []
        self.note = QLabel()
        self.save_button = QPushButton(tr("Save the answers"))
        self.cancel_button = QPushButton(tr("Cancel"))
        self.area = QScrollArea()
        replies, sitting = folder.replies(), folder.sitting()
        usual = replies[-1].questionnaire if replies else PAPER
        for form in (questionnaire(PAPER, tr), questionnaire(BROOKE, tr)):
            self.which.addItem(form.title, form.id)
        self.which.setCurrentIndex(self.which.findData(usual))
        self.which.setAccessibleName(tr("Which questionnaire"))
        if sitting is not None:
            self.participant_fields.show_sitting(sitting.participant, sitting.condition)
        self._lay_out()
        self._ask_items()
        self.which.currentIndexChanged.connect(self._ask_items)
        self.participant_fields.changed.connect(self._show_note)
        self.save_button.clicked.connect(self._on_save_clicked)
        self.cancel_button.clicked.connect(self.reject)

    def _lay_out(self) -> None:
        line = self.fontMetrics().height()
        self.area.setWidgetResizable(True)
        self.area.setFrameShape(QFrame.Shape.NoFrame)
        self.note.setWordWrap(True)
        self.save_button.setDefault(True)
        self.save_button.setProperty("kind", "primary")
        foot = in_row((self.note, 1), self.cancel_button, self.save_button)
        in_column((self.area, 1), foot, of=self)
        room = room_around(self).size()
        self.resize(min(line * 52, room.width()), min(line * 46, room.height()))

    def _ask_items(self) -> None:
        """Show the items of the chosen questionnaire, all open."""
        form = questionnaire(self.which.currentData(), tr)
        self.rows = [ItemRow(number, form, self._look) for number in range(len(form.items))]
        page = QWidget()
        box = QVBoxLayout(page)
        self.participant_fields.setParent(page)
        self.which.setParent(page)
        box.addWidget(self.which)
        box.addWidget(self.participant_fields)
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
        participant_fields = self.participant_fields
        chosen = list(self.answers())
        form = str(self.which.currentData())
        self.answered.emit(
            Reply(participant_fields.participant, participant_fields.chosen_condition, chosen, form)
        )
        self.accept()


def _instruction() -> QLabel:
    words = tr(
        "Say how much you agree with each sentence. Answer at once, do not think long. An item"
        " that you cannot answer may stay open. Keys: Tab to the next item, digits to answer."
    )
    label = QLabel(words, wordWrap=True)
    return label
