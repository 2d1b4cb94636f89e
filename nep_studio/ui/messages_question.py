"""A question that must be answered: a dialog with the answers as buttons."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.messages import KIND_ICONS, Answer, Message
from nep_studio.ui.messages_card import MessageText
from nep_studio.ui.theme import icon_pixmap


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
        box = QVBoxLayout(self)
        box.setContentsMargins(line, line, line, line)
        box.setSpacing(line)
        box.addLayout(self._words(line))
        row = QHBoxLayout()
        row.addStretch(1)
        for button in reversed(self.buttons):
            row.addWidget(button)
        box.addLayout(row)
        self.setMinimumWidth(line * 24)
        for button in self.buttons:
            if button.isDefault():
                button.setFocus()  # Enter means what the eye is led to
        self.finished.connect(self._on_finished)

    def _words(self, line: int) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(line)
        sign, kind = QLabel(), self.message.kind
        colour = self.palette().color(self.foregroundRole())
        sign.setPixmap(icon_pixmap(KIND_ICONS[kind], colour, line * 2, self.devicePixelRatioF()))
        row.addWidget(sign, 0, Qt.AlignmentFlag.AlignTop)
        row.addWidget(MessageText(self.message), 1)
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
