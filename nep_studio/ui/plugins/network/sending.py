"""Where a message is written and sent by hand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut, QTextCursor
from PySide6.QtWidgets import (
    QApplication,
    QComboBox,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QWidget,
)

from faults import FaultError, Words, text_of
from nep_core.wire import messages as m
from nep_core.wire.frames import CANNOT_DECODE
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.messages import announce
from nep_studio.ui.node_style import one_line, pretty
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look, base_point_size, code_font
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

# Messages to begin with when one is sent by hand, and the check of what was written.

EXAMPLES: Mapping[str, Mapping[str, Any]] = {
    m.NODE_STATE: {"node": "my_node", "type": "sensory", "event": "ready", "description": ""},
    m.IMU: {
        "source": "by_hand",
        "rate_hz": 50.0,
        "t": [0.0, 0.02],
        "acc": [[0.0, 0.0, 9.81], [0.1, 0.0, 9.8]],
        "gyr": [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    },
    m.HUMAN_BEHAVIOR: {"human_state": "gesture_karate", "certainty": 0.95, "source": "by_hand"},
    m.ACTION_REQUEST: {
        "id": "by_hand_1",
        "robots": ["NAO"],
        "action": "say",
        "args": {"text": "Hello"},
        "priority": 0,
    },
    m.ACTION_RESULT: {"id": "by_hand_1", "robot": "NAO", "state": "done", "description": ""},
    m.ROBOT_STATE: {"robot": "NAO", "joints": {"HeadYaw": 0.0}, "posture": "posture_stand"},
    m.PROGRAM_STATE: {"program": "program", "event": "value", "values": {"score": "1"}},
    m.PROGRAM_CONTROL: {"command": "pause", "program": "program"},
    m.GESTURE_REQUEST: {"gesture": "karate", "person": -1},
    m.SENSE_REQUEST: {"robot": "NAO", "sense": "head_front", "value": 1.0},
    m.SURROUNDINGS: {"things": [{"id": "ball1", "kind": "ball", "place": [0.5, 0.0, 0.05]}]},
    m.EXPECTED_WORDS: {"words": ["hello", "goodbye"]},
}
"""One for each topic that has a struct; what the struct adds by itself is left out."""


class NotAMessage(FaultError):
    """What was written cannot be sent; ``line`` is where it is wrong (0: not known)."""

    def __init__(self, reason: Words, line: int = 0, /, **values: object) -> None:
        super().__init__(text_of(reason, **values))
        self.line = line


def example_of(topic: str, last: Any = None) -> str:
    """A message of a topic to begin with: its example, else the last one heard."""
    if topic in EXAMPLES:
        return pretty(dict(EXAMPLES[topic]))
    return pretty(last) if last is not None and not isinstance(last, bytes) else "{\n  \n}"


def read_message(topic: str, text: str) -> msgspec.Struct | dict[str, Any]:
    """What was written, as the struct of its topic or as a dictionary; raises NotAMessage."""
    try:
        data = msgspec.json.decode(text.encode())
    except CANNOT_DECODE as error:
        raise _not_json(text, str(error)) from error
    if not isinstance(data, dict):
        raise NotAMessage("A message begins and ends with a curly bracket.")
    kind = m.BY_TOPIC.get(topic)
    if kind is None:
        return data
    unknown = [key for key in data if key not in kind.__struct_fields__]
    if unknown:
        values = {"topic": topic, "unknown": unknown[0], "known": ", ".join(kind.__struct_fields__)}
        raise NotAMessage("{topic} has no “{unknown}”. It has: {known}.", **values)
    try:
        return msgspec.convert(data, kind)
    except msgspec.ValidationError as error:
        raise NotAMessage(f"{error}.".replace("`", "“", 1).replace("`", "”", 1)) from error


def _not_json(text: str, reason: str) -> NotAMessage:
    """Say where JSON is broken: msgspec names the byte."""
    _, _, tail = reason.partition("(byte ")
    place = int(tail.rstrip(")")) if tail.rstrip(")").isdigit() else -1
    if place < 0:
        return NotAMessage("This is not complete JSON: a bracket or a quote is missing.")
    line = text.encode()[:place].count(b"\n") + 1
    return NotAMessage("This is not JSON: look at line {line}.", line, line=line)


MOST_SENT = 20
SENT = "Sent."
NO_NETWORK = "There is no network yet: press Run, or start a node, and send it again."

Send = Callable[[str, msgspec.Struct | dict[str, Any]], bool]
"""Sends a message; False when there is no network."""


class SendBox(QWidget):
    """An editor with the example of a topic. Ctrl+Enter sends."""

    def __init__(self, send: Send, look: Look) -> None:
        super().__init__()
        self._send, self._look = send, look
        self._topic = ""
        self._sent: list[tuple[str, str]] = []
        self._drafts: dict[str, str] = {}
        self.text = QPlainTextEdit(tabChangesFocus=True)
        labelled(self.text, name="The message, as JSON")
        self.text.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.note = QLabel(wordWrap=True, textFormat=Qt.TextFormat.PlainText)
        self.history = QComboBox(
            sizeAdjustPolicy=QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon
        )
        labelled(self.history, name="Messages that you have sent")
        self.history.setMinimumContentsLength(8)
        self.send_button, self.example_button = QPushButton(), QPushButton()
        labelled(self.send_button, text="Send", tip="Send this message now (Ctrl+Enter)")
        self.send_button.setProperty("kind", "primary")
        labelled(self.example_button, text="Example", tip="Write the example again")
        self.example_button.setProperty("kind", "quiet")
        row = in_row((self.history, 1), self.example_button, self.send_button)
        in_column((self.text, 1), self.note, row, of=self, margins=0)
        self.send_button.clicked.connect(self.send_now)
        self.example_button.clicked.connect(self._on_example_clicked)
        self.history.activated.connect(self._on_history_activated)
        for keys in ("Ctrl+Return", "Ctrl+Enter"):
            context = Qt.ShortcutContext.WidgetWithChildrenShortcut
            QShortcut(QKeySequence(keys), self, self.send_now, context=context)
        look.theme_changed.connect(self._on_theme_changed)
        self._on_theme_changed()
        follow_words(self, self._show_history)

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
            self._say(error.sentence, is_wrong=True)
            self._go_to(error.line)
            return
        if not self._send(self._topic, message):
            self._say(NO_NETWORK, is_wrong=True)
            return
        self._sent = [one for one in self._sent if one != (self._topic, text)]
        self._sent = [(self._topic, text), *self._sent][:MOST_SENT]
        self._show_history()
        self._say(SENT)

    def _say(self, words: Words, *, is_wrong: bool = False) -> None:
        labelled(self.note, text=words)
        self.note.setVisible(bool(words))
        colour = self._look.theme.colour("error" if is_wrong else "success").name()
        self.note.setStyleSheet(f"color: {colour}")
        announce(self, tr(words))

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
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        self.text.setFont(code_font(base_point_size(app) * self._look.scale))
        self.example_button.setIcon(icon("rotate-ccw", self._look.theme))
