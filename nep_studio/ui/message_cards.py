"""The place over the canvas where messages are shown, the newest below."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QGuiApplication, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QProgressBar,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from faults import Words
from nep_studio.ui.widgets.layouts import in_column, in_row

from .labels import labelled
from .messages import KIND_ICONS, Answer, Message
from .theme.colours import Theme
from .theme.icons import icon, icon_room
from .theme.look import Look

# A message as a card: icon, title, sentence, checklist, answers, and details to copy.


class MessageText(QWidget):
    """The words of a message: title, sentence, checklist, details."""

    def __init__(self, message: Message, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.title = _label(message.title, "heading")
        box = in_column(self.title, of=self, margins=0, spacing=self.fontMetrics().height() // 3)
        if message.sentence:
            box.addWidget(_label(message.sentence))
        for step in message.checklist:
            box.addWidget(ChecklistStep(step))
        if message.details:
            box.addWidget(Details(message.details))


class ChecklistStep(QWidget):
    """One thing to try, with a box before it."""

    def __init__(self, words: Words, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        mark = labelled(QLabel("\N{WHITE SQUARE}", alignment=Qt.AlignmentFlag.AlignTop), name="Try")
        in_row(mark, (_label(words), 1), of=self, margins=0)


class Details(QWidget):
    """The technical text, hidden until it is asked for, with a button that copies it."""

    def __init__(self, details: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.text = QPlainTextEdit(details, readOnly=True)
        self.text.setVisible(False)
        self.text.setFixedHeight(self.fontMetrics().height() * 7)
        self.show_button = _quiet_button("Show details")
        self.copy_button = _quiet_button("Copy details")
        self.copy_button.setVisible(False)
        self.show_button.clicked.connect(self._on_show_clicked)
        self.copy_button.clicked.connect(self._on_copy_clicked)
        in_column(in_row(self.show_button, self.copy_button, 1), self.text, of=self, margins=0)

    def _on_show_clicked(self) -> None:
        is_shown = self.text.isHidden()
        self.text.setVisible(is_shown)
        self.copy_button.setVisible(is_shown)
        labelled(self.show_button, text="Hide details" if is_shown else "Show details")

    def _on_copy_clicked(self) -> None:
        QGuiApplication.clipboard().setText(self.text.toPlainText())
        labelled(self.copy_button, text="Copied")


class MessageCard(QFrame):
    """A message over the canvas. It is ``closed`` by its cross, an answer, Esc, or by itself."""

    closed = Signal()

    def __init__(self, message: Message, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.message = message
        self.setProperty("kind", message.kind)
        self.setAccessibleName(message.spoken)
        button = labelled(QToolButton(), tip="Close", name="Close this message")
        button.setIcon(icon("x", theme))
        button.setIconSize(icon_room(button.fontMetrics().height()))
        self.close_button = button
        self.close_button.clicked.connect(self.closed)
        self.buttons: list[QPushButton] = []
        line = self.fontMetrics().height()
        sign, size, kind = QLabel(), round(line * 1.3), self.message.kind
        picture = icon(KIND_ICONS[kind], theme, kind)
        sign.setPixmap(picture.pixmap(QSize(size, size), self.devicePixelRatioF()))
        row = in_row((sign, 0, Qt.AlignmentFlag.AlignTop), of=self, spacing=line // 2)
        words = in_column(MessageText(self.message))
        if self.message.is_busy:
            bar = QProgressBar(textVisible=False)
            bar.setRange(0, 0)
            words.addWidget(bar)
        if self.message.answers:
            for answer in self.message.answers:
                answering = QPushButton(answer.words)
                if answer.look:
                    answering.setProperty("kind", answer.look)
                answering.clicked.connect(self.closed)
                answering.clicked.connect(lambda _=False, do=answer.do: do())
                self.buttons.append(answering)
            answers = in_row(*self.buttons, 1)
            words.addLayout(answers)
        row.addLayout(words, 1)
        row.addWidget(self.close_button, 0, Qt.AlignmentFlag.AlignTop)
        self.close_button.setVisible(not self.message.is_busy)

    def changeEvent(self, event: QEvent) -> None:
        """Take the room that the words need in another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.updateGeometry()


def _label(words: Words, role: str = "") -> QLabel:
    label = labelled(QLabel(wordWrap=True, textFormat=Qt.TextFormat.PlainText), text=words)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    if role:
        label.setProperty("role", role)
    return label


def _quiet_button(words: str) -> QPushButton:
    button = labelled(QPushButton(), text=words)
    button.setProperty("kind", "quiet")
    return button


MOST_CARDS = 3
READ_MS_PER_LETTER = 70
LEAST_READ_MS = 4000
WIDEST_LETTERS = 64


class MessageArea(QWidget):
    """Lies over the upper edge of ``host``; it takes no room from it and moves nothing."""

    def __init__(self, look: Look, host: QWidget) -> None:
        super().__init__(host)
        self._look, self._host = look, host
        self.cards: list[MessageCard] = []
        self._box = QVBoxLayout(self)
        self.hide()

    def show_message(self, message: Message) -> None:
        """Add a card; one that says the same is shown once."""
        for card in list(self.cards):
            if card.message.title == message.title and card.message.passes == message.passes:
                self._remove(card)
        while len(self.cards) >= MOST_CARDS:
            self._remove(next((c for c in self.cards if c.message.passes), self.cards[0]))
        card = MessageCard(message, self._look.theme, self)
        card.closed.connect(lambda: self._remove(card))
        self.cards.append(card)
        self._box.addWidget(card)
        if message.passes:
            timer = QTimer(card, singleShot=True)
            timer.setInterval(max(LEAST_READ_MS, len(message.spoken) * READ_MS_PER_LETTER))
            timer.timeout.connect(lambda: self._pass_away(card, timer))
            timer.start()
        self._host.installEventFilter(self)
        self.show()
        self._place()

    def withdraw(self, message: Message) -> None:
        """Take the card of a message away."""
        for card in [card for card in self.cards if card.message is message]:
            self._remove(card)

    def clear_passing(self) -> None:
        """Take away the cards that go by themselves."""
        for card in [card for card in self.cards if card.message.passes]:
            self._remove(card)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Stay at the upper edge of the host."""
        if watched is self._host and event.type() == QEvent.Type.Resize:
            self._place()
        return False

    def event(self, event: QEvent) -> bool:
        """Grow and shrink with the cards."""
        if event.type() == QEvent.Type.LayoutRequest:
            self._place()
        return super().event(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint a soft shadow under each card; an effect of Qt's would wake every hidden panel."""
        reach = self.fontMetrics().height() // 2
        colour = QColor(self._look.theme.colour("sprite_shadow"))
        at_edge = colour.alphaF() / 2  # as of a blurred edge, which is half as dark as the middle
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        for card in (card for card in self.cards if not card.isHidden()):
            for out in range(reach):  # it fades with the square of the distance
                colour.setAlphaF(at_edge * (2 * (reach - out) - 1) / reach**2)
                painter.setBrush(colour)
                room = card.geometry().adjusted(-out, 2 - out, out, 2 + out)
                painter.drawRoundedRect(room, reach, reach)
        painter.end()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Esc closes the newest card."""
        if event.key() == Qt.Key.Key_Escape and self.cards:
            self._remove(self.cards[-1])
            return
        super().keyPressEvent(event)

    def _pass_away(self, card: MessageCard, timer: QTimer) -> None:
        is_read = card.underMouse() or card.isAncestorOf(self.focusWidget() or self)
        if is_read or card.isHidden():
            timer.start()
        else:
            self._remove(card)

    def _remove(self, card: MessageCard) -> None:
        if card not in self.cards:
            return
        self.cards.remove(card)
        self._box.removeWidget(card)
        card.hide()
        card.deleteLater()
        if not self.cards:
            self._host.removeEventFilter(self)
        self.setVisible(bool(self.cards))
        self._place()

    def _place(self) -> None:
        if not self.cards:
            return
        widest = self.fontMetrics().averageCharWidth() * WIDEST_LETTERS
        width = min(self._host.width(), widest)
        # Older cards wait until newer ones are closed: squeezed together, none could be read
        margins = self._box.contentsMargins()
        inside = width - margins.left() - margins.right()
        room = self._host.height() - margins.top() - margins.bottom()
        for card in reversed(self.cards):
            has_room = card is self.cards[-1] or room >= card.heightForWidth(inside)
            card.setHidden(not has_room)
            room = room - card.heightForWidth(inside) - self._box.spacing() if has_room else 0
        height = self._box.heightForWidth(width) if self._box.hasHeightForWidth() else -1
        height = min(max(height, self._box.sizeHint().height() if height < 0 else height), 10_000)
        left = (self._host.width() - width) // 2
        self.setGeometry(left, 0, width, min(height, self._host.height()))
        self.move(QPoint(left, 0))
        self.raise_()
        self.update()


# A question that must be answered: a dialog with the answers as buttons.


class QuestionDialog(QDialog):
    """Asks; the last answer is what Esc and the window's cross mean."""

    def __init__(self, message: Message, parent: QWidget) -> None:
        super().__init__(parent)
        self.message = message
        self.setWindowTitle(QApplication.applicationDisplayName())
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.buttons = [self._button(answer) for answer in message.answers]
        self._answered: Answer | None = None
        line = self.fontMetrics().height()
        box = in_column(self._words(line), of=self, margins=line, spacing=line)
        row = in_row(1, *reversed(self.buttons))
        box.addLayout(row)
        self.setMinimumWidth(line * 24)
        for button in self.buttons:
            if button.isDefault():
                button.setFocus()  # Enter means what the eye is led to
        self.finished.connect(self._on_finished)

    def _words(self, line: int) -> QHBoxLayout:
        sign, kind = QLabel(), self.message.kind
        colour = self.palette().color(self.foregroundRole())
        size, picture = QSize(line * 2, line * 2), icon(KIND_ICONS[kind], colour)
        sign.setPixmap(picture.pixmap(size, self.devicePixelRatioF()))
        row = in_row(
            (sign, 0, Qt.AlignmentFlag.AlignTop), (MessageText(self.message), 1), spacing=line
        )
        return row

    def _button(self, answer: Answer) -> QPushButton:
        button = QPushButton(answer.words)
        button.setDefault(answer.look == "primary")  # which has its look, and moves with the focus
        if answer.look == "quiet":
            button.setProperty("kind", answer.look)
        button.clicked.connect(lambda: self._on_answered(answer))
        return button

    def _on_answered(self, answer: Answer) -> None:
        self._answered = answer
        self.accept()

    def _on_finished(self) -> None:
        """Do it once the dialog is gone, so that what follows may ask again."""
        (self._answered or self.message.answers[-1]).do()
