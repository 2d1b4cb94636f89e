"""Where a message is written and sent by hand."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeySequence, QShortcut, QTextCursor
from PySide6.QtWidgets import (
    QComboBox,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from nep_studio.ui.messages import announce
from nep_studio.ui.theme import Look, base_point_size, code_font, icon
from nep_studio.ui.words import tr

from .examples import NotAMessage, example_of, read_message
from .graph_words import one_line

MOST_SENT = 20

Send = Callable[[str, msgspec.Struct | dict[str, Any]], bool]
"""Sends a message; False when there is no network."""


class SendBox(QWidget):
    """An editor with the example of a topic; ``sent`` gives the topic. Ctrl+Enter sends."""

    sent = Signal(str)

    def __init__(self, send: Send, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._send, self._look = send, look
        self._topic = ""
        self._sent: list[tuple[str, str]] = []
        self._drafts: dict[str, str] = {}
        self.text = QPlainTextEdit()
        self.text.setAccessibleName(tr("The message, as JSON"))
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.text.setTabChangesFocus(True)
        self.note = QLabel()
        self.note.setWordWrap(True)
        self.note.setTextFormat(Qt.TextFormat.PlainText)
        self.history = QComboBox()
        self.history.setAccessibleName(tr("Messages that you have sent"))
        self.history.setSizeAdjustPolicy(
            QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        self.history.setMinimumContentsLength(8)
        self.send_button = QPushButton(tr("Send"))
        self.send_button.setProperty("kind", "primary")
        self.send_button.setToolTip(tr("Send this message now (Ctrl+Enter)"))
        self.example_button = QPushButton(tr("Example"))
        self.example_button.setProperty("kind", "quiet")
        self.example_button.setToolTip(tr("Write the example again"))
        self._lay_out()
        self.send_button.clicked.connect(self.send_now)
        self.example_button.clicked.connect(self._on_example_clicked)
        self.history.activated.connect(self._on_history_activated)
        for keys in ("Ctrl+Return", "Ctrl+Enter"):
            context = Qt.ShortcutContext.WidgetWithChildrenShortcut
            QShortcut(QKeySequence(keys), self, self.send_now, context=context)
        look.theme_changed.connect(self._on_theme_changed)
        self._on_theme_changed()
        self._show_history()

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.addWidget(self.history, 1)
        row.addWidget(self.example_button)
        row.addWidget(self.send_button)
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.addWidget(self.text, 1)
        box.addWidget(self.note)
        box.addLayout(row)

    def show_topic(self, topic: str, last: Any = None) -> None:
        """Write messages of this topic; what was begun for it before is there again."""
        if topic == self._topic:
            return
        if self._topic:
            self._drafts[self._topic] = self.text.toPlainText()
        self._topic = topic
        self.text.setPlainText(self._drafts.get(topic) or example_of(topic, last))
        self._say("")

    def send_now(self) -> None:
        """Check what is written and send it."""
        text = self.text.toPlainText()
        try:
            message = read_message(self._topic, text)
        except NotAMessage as error:
            self._say(tr(str(error)), is_wrong=True)
            self._go_to(error.line)
            return
        if not self._send(self._topic, message):
            words = tr("There is no network yet: press Run, or start a node, and send it again.")
            self._say(words, is_wrong=True)
            return
        self._sent = [one for one in self._sent if one != (self._topic, text)]
        self._sent = [(self._topic, text), *self._sent][:MOST_SENT]
        self._show_history()
        self._say(tr("Sent."))
        self.sent.emit(self._topic)

    def _say(self, words: str, *, is_wrong: bool = False) -> None:
        self.note.setText(words)
        self.note.setVisible(bool(words))
        colour = self._look.theme.colour("error" if is_wrong else "success").name()
        self.note.setStyleSheet(f"color: {colour}")
        announce(self, words)

    def _go_to(self, line: int) -> None:
        if line:
            block = self.text.document().findBlockByNumber(line - 1)
            self.text.setTextCursor(QTextCursor(block))
        self.text.setFocus()

    def _show_history(self) -> None:
        self.history.clear()
        self.history.addItem(tr("Sent before"))
        for topic, text in self._sent:
            self.history.addItem(f"{topic}  {one_line(' '.join(text.split()), 60)}", (topic, text))
        self.history.setEnabled(bool(self._sent))

    def _on_history_activated(self, index: int) -> None:
        data = self.history.itemData(index)
        if data:
            self.text.setPlainText(data[1])
            self.history.setCurrentIndex(0)
            self.text.setFocus()

    def _on_example_clicked(self) -> None:
        self.text.setPlainText(example_of(self._topic))
        self._say("")

    def _on_theme_changed(self) -> None:
        from PySide6.QtWidgets import QApplication

        app = QApplication.instance()
        assert isinstance(app, QApplication)
        self.text.setFont(code_font(base_point_size(app) * self._look.scale))
        self.example_button.setIcon(icon("rotate-ccw", self._look.theme))
