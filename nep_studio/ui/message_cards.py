"""The place at the foot of the canvas where messages are shown, the newest below."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, QPoint, QRect, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QGuiApplication, QKeyEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QFrame,
    QLabel,
    QPlainTextEdit,
    QProgressBar,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from faults import Words
from nep_studio.ui.widgets.forms import styled
from nep_studio.ui.widgets.layouts import Flow, in_column, in_row

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
        self.show_button = labelled(styled(QPushButton(), kind="quiet"), text="Show details")
        self.copy_button = labelled(styled(QPushButton(), kind="quiet"), text="Copy details")
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
        styled(self, kind=message.kind).setAccessibleName(message.spoken)
        self.close_button = labelled(QToolButton(), tip="Close", name="Close this message")
        self.close_button.setIcon(icon("x", theme))
        self.close_button.setIconSize(icon_room(self.close_button.fontMetrics().height()))
        self.close_button.clicked.connect(self.closed)
        if message.is_busy and message.answers:  # what goes on is not only hidden
            self.close_button.clicked.connect(message.answers[-1].do)
        self.buttons: list[QPushButton] = []
        line = self.fontMetrics().height()
        size, kind, top = round(line * 1.3), message.kind, Qt.AlignmentFlag.AlignTop
        picture = icon(KIND_ICONS[kind], theme, kind)
        sign = QLabel(pixmap=picture.pixmap(QSize(size, size), self.devicePixelRatioF()))
        words = in_column(MessageText(message))
        if message.is_busy:
            words.addWidget(QProgressBar(textVisible=False, minimum=0, maximum=0))
        for answer in message.answers:
            button = styled(QPushButton(answer.words), kind=answer.look)
            button.clicked.connect(self.closed)
            button.clicked.connect(lambda _=False, do=answer.do: do())
            self.buttons.append(button)
        if self.buttons:
            words.addLayout(Flow(spacing=line // 2, widgets=self.buttons))
        in_row((sign, 0, top), (words, 1), (self.close_button, 0, top), of=self, spacing=line // 2)

    def changeEvent(self, event: QEvent) -> None:
        """Take the room that the words need in another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.updateGeometry()


class Sentence(QLabel):
    """Words in a card, of which a name without an end widens no card beyond the window."""

    def minimumSizeHint(self) -> QSize:
        """Room for a few words."""
        least, most = (
            super().minimumSizeHint(),
            LEAST_LETTERS * self.fontMetrics().averageCharWidth(),
        )
        return QSize(min(least.width(), most), least.height())


LEAST_LETTERS = 24


def _label(words: Words, role: str = "") -> QLabel:
    flags = Qt.TextInteractionFlag.TextSelectableByMouse
    label = Sentence(wordWrap=True, textFormat=Qt.TextFormat.PlainText, textInteractionFlags=flags)
    return labelled(styled(label, role=role), text=words)


MOST_CARDS = 3
READ_MS_PER_LETTER = 70
LEAST_READ_MS = 4000
WIDEST_LETTERS = 64


class MessageArea(QWidget):
    """Lies over the foot of ``host``; it takes no room from it and moves nothing.

    ``covers`` tells how many pixels of the foot it lies over now; ``shown`` that a card has come.
    """

    covers = Signal(int)
    shown = Signal()

    def __init__(self, look: Look, host: QWidget) -> None:
        super().__init__(host)
        self._look, self._host = look, host
        self._ground = host
        host.installEventFilter(self)
        self.cards: list[MessageCard] = []
        self._box = QVBoxLayout(self)
        self.hide()

    def lie_over(self, ground: QWidget) -> None:
        """Lie over this part of the host as long as it is shown."""
        self._ground = ground
        ground.installEventFilter(self)
        self._place()

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
        self.show()
        self._place()
        self.shown.emit()

    def close_newest(self) -> bool:
        """Close the newest card; False when there is none."""
        if not self.cards:
            return False
        self.cards[-1].close_button.click()
        return True

    def withdraw(self, message: Message) -> None:
        """Take the card of a message away."""
        for card in [card for card in self.cards if card.message is message]:
            self._remove(card)

    def clear_passing(self) -> None:
        """Take away the cards that go by themselves."""
        for card in [card for card in self.cards if card.message.passes]:
            self._remove(card)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Stay at the foot of what it lies over."""
        if event.type() in _MOVES:
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
        if event.key() == Qt.Key.Key_Escape and self.close_newest():
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
        self.setVisible(bool(self.cards))
        self._place()

    def _place(self) -> None:
        if not self.cards:
            self.covers.emit(0)
            return
        ground = self._ground if self._ground.isVisible() else self._host
        view = QRect(ground.mapTo(self._host, QPoint()), ground.size())
        widest = self.fontMetrics().averageCharWidth() * WIDEST_LETTERS
        width = min(view.width(), widest)
        # Older cards wait until newer ones are closed: squeezed together, none could be read
        margins = self._box.contentsMargins()
        inside = width - margins.left() - margins.right()
        room = view.height() - margins.top() - margins.bottom()
        for card in reversed(self.cards):
            has_room = card is self.cards[-1] or room >= card.heightForWidth(inside)
            card.setHidden(not has_room)
            room = room - card.heightForWidth(inside) - self._box.spacing() if has_room else 0
        height = self._box.heightForWidth(width) if self._box.hasHeightForWidth() else -1
        height = min(self._box.sizeHint().height() if height < 0 else height, view.height())
        # At the side where reading begins: in the other corner are the trash and the small map
        is_mirrored = self.layoutDirection() == Qt.LayoutDirection.RightToLeft
        left = view.right() + 1 - width if is_mirrored else view.left()
        self.setGeometry(left, view.bottom() + 1 - height, width, height)
        self.raise_()
        self.update()
        self.covers.emit(height if ground is self._ground else 0)


_MOVES = (QEvent.Type.Resize, QEvent.Type.Move, QEvent.Type.Show, QEvent.Type.Hide)


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
        picture = icon(KIND_ICONS[message.kind], self.palette().color(self.foregroundRole()))
        size = QSize(line * 2, line * 2)
        sign = QLabel(pixmap=picture.pixmap(size, self.devicePixelRatioF()))
        words = ((sign, 0, Qt.AlignmentFlag.AlignTop), (MessageText(message), 1))
        foot = in_row(1, *reversed(self.buttons))
        in_column(in_row(*words, spacing=line), foot, of=self, margins=line, spacing=line)
        self.setMinimumWidth(line * 24)
        for button in self.buttons:
            if button.isDefault():
                button.setFocus()  # Enter means what the eye is led to
        self.finished.connect(self._on_finished)

    def _button(self, answer: Answer) -> QPushButton:
        # The default has its own look, which moves with the focus
        button = QPushButton(answer.words, default=answer.look == "primary")
        if answer.look == "quiet":
            styled(button, kind=answer.look)
        button.clicked.connect(lambda: self._on_answered(answer))
        return button

    def _on_answered(self, answer: Answer) -> None:
        self._answered = answer
        self.accept()

    def _on_finished(self) -> None:
        """Do it once the dialog is gone, so that what follows may ask again."""
        (self._answered or self.message.answers[-1]).do()
