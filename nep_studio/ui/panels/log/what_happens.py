"""What happens while a program runs, as a live list: who did what, and when."""

from __future__ import annotations

import time
from collections import deque
from pathlib import Path

import msgspec
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QKeySequence, QShortcut, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListView,
    QStackedLayout,
    QVBoxLayout,
    QWidget,
)

from nep_core import messages as m
from nep_studio.blocks.language import Language
from nep_studio.timeline import Timeline
from nep_studio.ui.messages import Messages
from nep_studio.ui.panels.nodes.looks import TYPE_ICONS
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme import Look, icon
from nep_studio.ui.words import tr

from .buttons import LogButtons
from .lines import RUN, Line, LinesModel, part_of
from .painting import LinePainter
from .saving import save_text

MOST_AT_ONCE = 600
"""Of more messages in one batch the rest is counted only: the window must go on."""
MOST_WAITING = 1500
"""So many messages are kept for a panel that is hidden."""


class WhatHappens(QWidget):
    """The lines of the timeline; what comes while it is hidden is told when it is shown."""

    def __init__(self, runner: Runner, messages: Messages, language: Language, look: Look) -> None:
        super().__init__()
        self._messages, self._look = messages, look
        self._timeline = Timeline(language, tr)
        self._waiting: deque[tuple[float, msgspec.Struct]] = deque(maxlen=MOST_WAITING)
        self._started_s = time.time()
        self.model = LinesModel(self)
        self.list = QListView()
        self.part = QComboBox()
        self.search = QLineEdit()
        self.hint = QLabel()
        self.buttons = LogButtons(look)
        self._set_up_list()
        self._set_up_filters()
        self._lay_out()
        runner.arrived.connect(self._on_arrived)
        runner.state_changed.connect(self._on_state_changed)
        look.theme_changed.connect(self._dress)
        self._dress()
        self._show_hint()

    def _set_up_list(self) -> None:
        self._painter = LinePainter(self._look)
        self.list.setModel(self.model)
        self.list.setItemDelegate(self._painter)
        self.list.setUniformItemSizes(True)
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setAccessibleName(tr("What happens"))
        copy = QShortcut(QKeySequence(QKeySequence.StandardKey.Copy), self.list)
        copy.setContext(Qt.ShortcutContext.WidgetShortcut)
        copy.activated.connect(self.copy)

    def _set_up_filters(self) -> None:
        parts = {
            "": tr("Everything"),
            "perceptual": tr("What people do"),
            "cognitive": tr("The program"),
            "action": tr("The robots"),
            "sensory": tr("The sensors"),
        }
        for part, words in parts.items():
            self.part.addItem(words, part)
        self.part.setAccessibleName(tr("Whose lines are shown"))
        self.part.currentIndexChanged.connect(lambda: self.model.show_part(self.part.currentData()))
        self.search.setPlaceholderText(tr("Find in these lines"))
        self.search.setAccessibleName(tr("Find in these lines"))
        self.search.setClearButtonEnabled(True)
        self.search.textChanged.connect(self.model.search)
        self.model.modelReset.connect(self._show_hint)
        self.buttons.copy.clicked.connect(self.copy)
        self.buttons.save.clicked.connect(self._on_save_clicked)
        self.buttons.clear.clicked.connect(self.model.clear)

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        row.addWidget(self.part)
        row.addWidget(self.search, 1)
        row.addWidget(self.buttons)
        self.hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.hint.setWordWrap(True)
        self.hint.setProperty("role", "hint")
        self._stack = QStackedLayout()
        self._stack.addWidget(self.list)
        self._stack.addWidget(self.hint)
        box = QVBoxLayout(self)
        box.addLayout(row)
        box.addLayout(self._stack, 1)

    # What a person asks for

    def text(self) -> str:
        """The lines that are chosen, or all that are shown."""
        rows = sorted(index.row() for index in self.list.selectedIndexes())
        shown = self.model.lines()
        lines = [shown[row] for row in rows] if len(rows) > 1 else shown
        return "".join(f"{line.words}\n" for line in lines)

    def copy(self) -> None:
        """Copy them."""
        QGuiApplication.clipboard().setText(self.text())

    def save(self, path: Path) -> None:
        """Write them to a file; raises OSError."""
        path.write_text(self.text(), encoding="utf-8")

    def _on_save_clicked(self) -> None:
        save_text(self.window(), self._messages, tr("what happened.txt"), self.save)

    # What happens

    def _on_arrived(self, batch: list[tuple[str, msgspec.Struct]]) -> None:
        now_s = time.time()
        self._waiting.extend((now_s, message) for _, message in batch if _is_told(message))
        if self.isVisible():
            self._take_waiting()

    def _on_state_changed(self, state: str) -> None:
        if state == "starting":
            self._take_waiting()
            self._started_s = time.time()
            clock = time.strftime("%H:%M:%S")
            self._add([Line(0.0, RUN, "", tr("Run at {time}", time=clock))])

    def _take_waiting(self) -> None:
        surplus = len(self._waiting) - MOST_AT_ONCE
        lines: list[Line] = []
        if surplus > 0:
            for _ in range(surplus):
                time_s, _message = self._waiting.popleft()
            words = tr("{count} messages came too fast to be told one by one", count=surplus)
            lines.append(Line(max(0.0, time_s - self._started_s), RUN, "", words))
        for time_s, message in self._waiting:
            elapsed_s, part = max(0.0, time_s - self._started_s), part_of(message)
            told = self._timeline.lines(message)
            lines += [Line(elapsed_s, part, who, what) for who, what in told]
        self._waiting.clear()
        self._add(lines)

    def _add(self, lines: list[Line]) -> None:
        if not lines:
            return
        bar = self.list.verticalScrollBar()
        is_at_end = bar.value() >= bar.maximum() - bar.singleStep()
        self.model.add(lines)
        self._show_hint()
        if is_at_end:
            self.list.scrollToBottom()

    def _show_hint(self) -> None:
        if self.model.rowCount():
            self._stack.setCurrentWidget(self.list)
            return
        is_empty = self.model.total == 0
        begin = tr("Press Run. Here you read who does what, while it happens.")
        self.hint.setText(begin if is_empty else tr("No line has these words."))
        self._stack.setCurrentWidget(self.hint)

    def showEvent(self, event: QShowEvent) -> None:
        """Tell what came meanwhile."""
        super().showEvent(event)
        self._take_waiting()
        self.list.scrollToBottom()

    def _dress(self) -> None:
        theme = self._look.theme
        for index in range(1, self.part.count()):
            self.part.setItemIcon(index, icon(TYPE_ICONS[self.part.itemData(index)], theme))
        self.list.viewport().update()


def _is_told(message: msgspec.Struct) -> bool:
    """Whether a message may become a line: lines of code, values and heartbeats never do."""
    match message:
        case m.ProgramState(event="line" | "value") | m.NodeState(event="alive"):
            return False
    return True
