"""A message as a card: icon, title, sentence, checklist, answers, and details to copy."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QColor, QGuiApplication
from PySide6.QtWidgets import (
    QFrame,
    QGraphicsDropShadowEffect,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QProgressBar,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.actions_icons import icon_room
from nep_studio.ui.messages import KIND_ICONS, Answer, Message
from nep_studio.ui.theme import Theme, icon, icon_pixmap
from nep_studio.ui.words import tr


class MessageText(QWidget):
    """The words of a message: title, sentence, checklist, details."""

    def __init__(self, message: Message, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(self.fontMetrics().height() // 3)
        self.title = _label(message.title, "heading")
        box.addWidget(self.title)
        if message.sentence:
            box.addWidget(_label(message.sentence))
        for step in message.checklist:
            box.addWidget(ChecklistStep(step))
        if message.details:
            box.addWidget(Details(message.details))


class ChecklistStep(QWidget):
    """One thing to try, with a box before it."""

    def __init__(self, words: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        mark = QLabel("\N{WHITE SQUARE}")
        mark.setAlignment(Qt.AlignmentFlag.AlignTop)
        mark.setAccessibleName(tr("Try"))
        row.addWidget(mark)
        row.addWidget(_label(words), 1)


class Details(QWidget):
    """The technical text, hidden until it is asked for, with a button that copies it."""

    def __init__(self, details: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.text = QPlainTextEdit(details)
        self.text.setReadOnly(True)
        self.text.setVisible(False)
        self.text.setFixedHeight(self.fontMetrics().height() * 7)
        self.show_button = _quiet_button(tr("Show details"))
        self.copy_button = _quiet_button(tr("Copy details"))
        self.copy_button.setVisible(False)
        self.show_button.clicked.connect(self._on_show_clicked)
        self.copy_button.clicked.connect(self._on_copy_clicked)
        buttons = QHBoxLayout()
        buttons.addWidget(self.show_button)
        buttons.addWidget(self.copy_button)
        buttons.addStretch(1)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addLayout(buttons)
        box.addWidget(self.text)

    def _on_show_clicked(self) -> None:
        is_shown = self.text.isHidden()
        self.text.setVisible(is_shown)
        self.copy_button.setVisible(is_shown)
        self.show_button.setText(tr("Hide details") if is_shown else tr("Show details"))

    def _on_copy_clicked(self) -> None:
        QGuiApplication.clipboard().setText(self.text.toPlainText())
        self.copy_button.setText(tr("Copied"))


class MessageCard(QFrame):
    """A message over the canvas. It is ``closed`` by its cross, an answer, Esc, or by itself."""

    closed = Signal()

    def __init__(self, message: Message, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.message = message
        self.setProperty("kind", message.kind)
        self.setAccessibleName(message.spoken)
        self.close_button = _cross(theme)
        self.close_button.clicked.connect(self.closed)
        self.buttons = [self._button(answer) for answer in message.answers]
        self._fill(theme)
        self._add_shadow(theme)

    def _fill(self, theme: Theme) -> None:
        line = self.fontMetrics().height()
        row = QHBoxLayout(self)
        row.setSpacing(line // 2)
        sign, size = QLabel(), round(line * 1.3)
        kind = self.message.kind
        ratio = self.devicePixelRatioF()
        sign.setPixmap(icon_pixmap(KIND_ICONS[kind], theme.colour(kind), size, ratio))
        row.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        words = QVBoxLayout()
        words.addWidget(MessageText(self.message))
        if self.message.is_busy:
            words.addWidget(_endless_progress())
        if self.buttons:
            answers = QHBoxLayout()
            for button in self.buttons:
                answers.addWidget(button)
            answers.addStretch(1)
            words.addLayout(answers)
        row.addLayout(words, 1)
        row.addWidget(self.close_button, 0, Qt.AlignmentFlag.AlignTop)
        self.close_button.setVisible(not self.message.is_busy)

    def _button(self, answer: Answer) -> QPushButton:
        button = QPushButton(answer.words)
        if answer.look:
            button.setProperty("kind", answer.look)
        button.clicked.connect(self.closed)
        button.clicked.connect(lambda: answer.do())
        return button

    def _add_shadow(self, theme: Theme) -> None:
        shadow = QGraphicsDropShadowEffect(self)
        shadow.setBlurRadius(self.fontMetrics().height() * 1.2)
        shadow.setOffset(0, 2)
        shadow.setColor(QColor(theme.colour("sprite_shadow")))
        self.setGraphicsEffect(shadow)

    def changeEvent(self, event: QEvent) -> None:
        """Take the room that the words need in another font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.updateGeometry()


def _cross(theme: Theme) -> QToolButton:
    button = QToolButton()
    button.setIcon(icon("x", theme))
    button.setIconSize(icon_room(button.fontMetrics().height()))
    button.setToolTip(tr("Close"))
    button.setAccessibleName(tr("Close this message"))
    return button


def _endless_progress() -> QProgressBar:
    bar = QProgressBar()
    bar.setRange(0, 0)
    bar.setTextVisible(False)
    return bar


def _label(words: str, role: str = "") -> QLabel:
    label = QLabel(words)
    label.setWordWrap(True)
    label.setTextFormat(Qt.TextFormat.PlainText)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    if role:
        label.setProperty("role", role)
    return label


def _quiet_button(words: str) -> QPushButton:
    button = QPushButton(words)
    button.setProperty("kind", "quiet")
    return button
