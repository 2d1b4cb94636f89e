"""The log panel: what happens, and what was told, on two tabs."""

from __future__ import annotations

import platform
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path

import msgspec
from PySide6.QtCore import QSize, Qt, qVersion
from PySide6.QtGui import QGuiApplication, QKeySequence, QShortcut, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QLabel,
    QLineEdit,
    QListView,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QScrollArea,
    QSplitter,
    QStackedLayout,
    QTabWidget,
    QToolButton,
    QWidget,
)

from faults.files import write_whole
from nep_core.wire import messages as m
from nep_studio import __version__
from nep_studio.blocks.language import Language
from nep_studio.run.timeline import Timeline
from nep_studio.ui.labels import explained, follow_words, labelled, labelled_items, plain_tip
from nep_studio.ui.message_cards import MessageText
from nep_studio.ui.messages import KIND_ICONS, Kind, LoggedMessage, Messages
from nep_studio.ui.node_style import TYPE_ICONS
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.icons import icon, icon_pixmap
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.choices import Choices
from nep_studio.ui.widgets.forms import hint
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import save_text
from nep_studio.ui.words import tr

from .lines import RUN, Line, LinePainter, LinesModel, part_of

# The buttons of a list that can be copied, saved and emptied.


class LogButtons(QWidget):
    """Copy, save, clear."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.copy, self.save, self.clear = QToolButton(), QToolButton(), QToolButton()
        explained(self.copy, "Copy")
        explained(self.save, "Save as text…")
        explained(self.clear, "Clear")
        in_row(self.copy, self.save, self.clear, of=self, margins=0)
        look.theme_changed.connect(self._dress)
        self._dress()

    def _dress(self) -> None:
        signs = {self.copy: "copy", self.save: "save", self.clear: "trash-2"}
        for button, name in signs.items():
            button.setIcon(icon(name, self._look.theme))


# What happens while a program runs, as a live list: who did what, and when.

MOST_AT_ONCE = 600
"""Of more messages in one batch the rest is counted only: the window must go on."""
MOST_WAITING = 1500
"""So many messages are kept for a panel that is hidden."""


class WhatHappens(QWidget):
    """The lines of the timeline; what comes while it is hidden is told when it is shown."""

    def __init__(
        self, runner: Runner, messages: Messages, language: Callable[[], Language], look: Look
    ) -> None:
        super().__init__()
        self._messages, self._look = messages, look
        self._language, self._timeline = language, Timeline(language(), tr)
        self._waiting: deque[tuple[float, msgspec.Struct | str]] = deque(maxlen=MOST_WAITING)
        """How long after the start what was heard; or words that stand between two runs."""
        self._started_s = time.time()
        self.model = LinesModel(self)
        self.list = labelled(QListView(uniformItemSizes=True), name="What happens")
        self.part = labelled(Choices(_parts), name="Whose lines are shown")
        self.search = labelled(
            QLineEdit(clearButtonEnabled=True),
            placeholder="Find in these lines",
            name="Find in these lines",
        )
        self.hint = hint("")
        self.hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.buttons = LogButtons(look)
        self._painter = LinePainter(self._look)
        self.list.setModel(self.model)
        self.list.setItemDelegate(self._painter)
        self.list.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        copy = QShortcut(QKeySequence(QKeySequence.StandardKey.Copy), self.list)
        copy.setContext(Qt.ShortcutContext.WidgetShortcut)
        copy.activated.connect(self.copy)
        self._lay_out()
        runner.arrived.connect(self._on_arrived)
        runner.state_changed.connect(self._on_state_changed)
        look.theme_changed.connect(self._dress)
        self._dress()
        follow_words(self, self._speak)

    def _lay_out(self) -> None:
        self.part.currentIndexChanged.connect(lambda: self.model.show_part(self.part.currentData()))
        self.search.textChanged.connect(self.model.search)
        self.model.modelReset.connect(self._show_hint)
        self.buttons.copy.clicked.connect(self.copy)
        self.buttons.save.clicked.connect(self._on_save_clicked)
        self.buttons.clear.clicked.connect(self.model.clear)
        self._stack = QStackedLayout()
        in_column(in_row(self.part, (self.search, 1), self.buttons), (self._stack, 1), of=self)
        self._stack.addWidget(self.list)  # now: it shows it, which would be a window of its own
        self._stack.addWidget(self.hint)

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
        write_whole(path, self.text())

    def _on_save_clicked(self) -> None:
        save_text(self.window(), self._messages, tr("what happened.txt"), self.save)

    # What happens

    def _on_arrived(self, batch: list[tuple[str, msgspec.Struct]]) -> None:
        elapsed_s = max(0.0, time.time() - self._started_s)
        for _, message in batch:
            match message:
                case m.ProgramState(event="line" | "value") | m.NodeState(event="alive"):
                    pass  # it is never told
                case _:
                    self._waiting.append((elapsed_s, message))
        if self.isVisible():
            self._take_waiting()

    def _on_state_changed(self, state: str) -> None:
        if state == "starting":
            self._started_s = time.time()
            self._waiting.append((0.0, tr("Run at {time}", time=time.strftime("%H:%M:%S"))))
            if self.isVisible():
                self._take_waiting()

    def _take_waiting(self) -> None:
        surplus = len(self._waiting) - MOST_AT_ONCE
        lines: list[Line] = []
        if surplus > 0:
            for _ in range(surplus):
                elapsed_s, _message = self._waiting.popleft()
            words = tr("{count} messages came too fast to be told one by one", count=surplus)
            lines.append(Line(elapsed_s, RUN, "", words))
        for elapsed_s, message in self._waiting:
            if isinstance(message, str):
                lines.append(Line(elapsed_s, RUN, "", message))
                continue
            part, told = part_of(message), self._timeline.lines(message)
            lines += [Line(elapsed_s, part, source, what) for source, what in told]
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
        labelled(
            self.hint,
            text="Press Run. Here you read who does what, while it happens."
            if is_empty
            else "No line has these words.",
        )
        self._stack.setCurrentWidget(self.hint)

    def showEvent(self, event: QShowEvent) -> None:
        """Tell what came meanwhile."""
        super().showEvent(event)
        self._take_waiting()
        self.list.scrollToBottom()

    def _speak(self) -> None:
        """Tell from now on in the words that are used; what was told stays as it was told."""
        self._timeline.language = self._language()
        self._show_hint()

    def _dress(self) -> None:
        theme = self._look.theme
        for index in range(1, self.part.count()):
            self.part.setItemIcon(index, icon(TYPE_ICONS[self.part.itemData(index)], theme))
        self.list.viewport().update()


def _parts() -> dict[object, str]:
    """Whose lines can be shown alone: the types of nodes, in words."""
    return {
        "": tr("Everything"),
        "perceptual": tr("What people do"),
        "cognitive": tr("The program"),
        "action": tr("The robots"),
        "sensory": tr("The sensors"),
    }


# All that the window has told since it was opened, to read again and to copy for support.

TOLD = Qt.ItemDataRole.UserRole


class ToldMessages(QWidget):
    """The messages of the one door, the newest first; beside them the chosen one in full."""

    def __init__(self, messages: Messages, look: Look) -> None:
        super().__init__()
        self._messages, self._look = messages, look
        self._shown = 0
        self.list = labelled(QListWidget(), name="Messages")
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.detail = QScrollArea(widgetResizable=True)
        self.detail.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.copy_button = labelled(QPushButton(), text="Copy all for support")
        self.hint = hint("What the window tells you is kept here until you close it.")
        self.hint.setAlignment(Qt.AlignmentFlag.AlignCenter)
        both = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False)
        for number, (part, share) in enumerate(((self.list, 2), (self.detail, 3))):
            both.addWidget(part)
            both.setStretchFactor(number, share)
        both.setSizes([2000, 3000])  # parts of what there is
        full = QWidget()
        in_column((both, 1), in_row(1, self.copy_button), of=full)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(self.hint)
        self._stack.addWidget(full)
        self.list.currentItemChanged.connect(self._on_chosen)
        self.copy_button.clicked.connect(self._on_copy_clicked)
        messages.told.connect(self._on_told)
        look.theme_changed.connect(self._dress)
        self._dress()
        follow_words(self, self._speak)

    def text(self) -> str:
        """All messages as text, with what a supporter asks for first."""
        about = (
            f"NEP Studio {__version__}, Python {platform.python_version()}, Qt {qVersion()},"
            f" {platform.platform()}"
        )
        return "\n\n".join([about, *map(_as_text, self._messages.history)]) + "\n"

    def minimumSizeHint(self) -> QSize:
        """The list may become small: it scrolls."""
        line = self.fontMetrics().height()
        return QSize(line * 12, line * 5)

    def showEvent(self, event: QShowEvent) -> None:
        """Fill the list, which rests while it is hidden."""
        super().showEvent(event)
        self._fill()

    def _on_told(self, told: LoggedMessage) -> None:
        if self.isVisible():
            self._insert(told)
            self._show_list()

    def _fill(self) -> None:
        self.list.clear()
        for told in self._messages.history:
            self._insert(told)
        self._show_list()

    def _speak(self) -> None:
        """Tell of the messages in other words; they themselves stay as they were told."""
        chosen = self.list.currentRow()
        self._fill()
        self.list.setCurrentRow(max(chosen, 0))

    def _insert(self, told: LoggedMessage) -> None:
        clock = time.strftime("%H:%M:%S", time.localtime(told.time_s))
        item = QListWidgetItem(f"{clock}  {told.message.title}")
        item.setData(TOLD, told)
        item.setToolTip(plain_tip(told.message.title))
        kind = told.message.kind
        item.setIcon(icon(KIND_ICONS[kind], self._look.theme.colour(kind)))
        spoken = f"{kind_word(kind)}, {clock}: {told.message.title}"
        item.setData(Qt.ItemDataRole.AccessibleTextRole, spoken)
        self.list.insertItem(0, item)
        if self.list.count() > (self._messages.history.maxlen or self.list.count()):
            self.list.takeItem(self.list.count() - 1)

    def _show_list(self) -> None:
        self._stack.setCurrentIndex(1 if self.list.count() else 0)
        if self.list.currentRow() < 0:
            self.list.setCurrentRow(0)

    def _on_chosen(self, item: QListWidgetItem | None) -> None:
        if item is None:
            self.detail.setWidget(QWidget())
            return
        told: LoggedMessage = item.data(TOLD)
        page, kind = QWidget(), told.message.kind
        side, ratio = round(self.fontMetrics().height() * 1.3), self.devicePixelRatioF()
        colour = self._look.theme.colour(kind)
        sign = QLabel(pixmap=icon_pixmap(KIND_ICONS[kind], colour, side, ratio))
        sign.setAccessibleName(kind_word(kind))
        row = in_row((sign, 0, Qt.AlignmentFlag.AlignTop), (MessageText(told.message), 1))
        in_column(row, 1, of=page)
        self.detail.setWidget(page)

    def _on_copy_clicked(self) -> None:
        QGuiApplication.clipboard().setText(self.text())
        self._messages.confirm(tr("All messages are copied"))

    def _dress(self) -> None:
        self.copy_button.setIcon(icon("copy", self._look.theme))
        if self.isVisible():
            self._fill()


def kind_word(kind: Kind) -> str:
    """A kind of message in a word: its colour never speaks alone."""
    words: dict[Kind, str] = {
        "info": tr("Note"),
        "success": tr("Done"),
        "warning": tr("Warning"),
        "error": tr("Error"),
    }
    return words[kind]


def _as_text(told: LoggedMessage) -> str:
    message = told.message
    when = time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(told.time_s))
    steps = [f"  [ ] {step}" for step in message.checklist]
    lines = [f"{when}  {message.kind}: {message.title}", message.sentence, *steps, message.details]
    return "\n".join(filter(None, lines))


class LogPage(QTabWidget):
    """Reads on while a program runs; it does no work while it is hidden."""

    def __init__(
        self, runner: Runner, messages: Messages, language: Callable[[], Language], look: Look
    ) -> None:
        super().__init__(documentMode=True)
        self.what_happens = WhatHappens(runner, messages, language, look)
        self.told = ToldMessages(messages, look)
        self.addTab(self.what_happens, "")
        self.addTab(self.told, "")
        labelled_items(self, "What happens", "Messages")

    def sizeHint(self) -> QSize:
        """Room for a few lines."""
        line = self.fontMetrics().height()
        return QSize(line * 30, line * 10)
