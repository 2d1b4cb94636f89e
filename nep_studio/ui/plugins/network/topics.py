"""The messages of one topic: the last ones, one in full, as files, and one to send by hand."""

from __future__ import annotations

import csv
import io
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
from PySide6.QtCore import (
    QAbstractListModel,
    QItemSelectionModel,
    QModelIndex,
    QObject,
    Qt,
    QTimer,
    Signal,
)
from PySide6.QtGui import QGuiApplication, QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QLineEdit,
    QListView,
    QMenu,
    QPlainTextEdit,
    QSplitter,
    QTabWidget,
    QToolButton,
    QWidget,
)

from faults.files import write_whole
from nep_core.wire.messages import BY_TOPIC
from nep_studio.study.records import without_formula
from nep_studio.ui.labels import follow_words, labelled, labelled_items, plain_tip
from nep_studio.ui.network_feed import TopicSeen
from nep_studio.ui.node_style import as_json, names, one_line, pretty, rate_words
from nep_studio.ui.running.runner import Heard, Runner, Tap
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import ElidedLabel, plain_label
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.widgets.questions import ask_for_path
from nep_studio.ui.words import count_words, tr

from .sending import SendBox

# Messages as files: JSON lines, or a table of their numbers and words as CSV.


def as_json_lines(messages: Iterable[Heard]) -> str:
    """One line a message: when, from whom, and the message."""
    lines = (
        msgspec.json.encode(
            {"time": one.time_s, "sender": one.sender, "message": _json_safe(one.message)}
        ).decode()
        for one in messages
    )
    return "".join(f"{line}\n" for line in lines)


def as_csv(messages: Iterable[Heard]) -> str:
    """One row a message; a column for each value in it, named by its way: “joints.HeadYaw”."""
    rows = [
        {"time": _moment(one.time_s), "sender": one.sender, **dict(values_of(one.message))}
        for one in messages
    ]
    columns = list(dict.fromkeys(key for row in rows for key in row))
    out = io.StringIO()
    writer = csv.DictWriter(out, columns, lineterminator="\n")
    writer.writerow({name: without_formula(name) for name in columns})
    writer.writerows({name: without_formula(value) for name, value in row.items()} for row in rows)
    return out.getvalue()


def save(messages: Iterable[Heard], path: Path) -> None:
    """Write messages as the ending of the file's name says; raises OSError."""
    text = as_csv(messages) if path.suffix.lower() == ".csv" else as_json_lines(messages)
    write_whole(path, text)


def values_of(message: Any, way: str = "") -> Iterator[tuple[str, object]]:
    """All single values in a message with the way to each; a list is one value, as JSON."""
    data = msgspec.to_builtins(message) if isinstance(message, msgspec.Struct) else message
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield from values_of(value, f"{way}.{key}" if way else str(key))
    elif isinstance(data, list | tuple | bytes):
        yield way or "message", as_json(data)
    else:
        yield way or "message", data


def number_fields(message: Any) -> list[str]:
    """The ways to the numbers in a message, and to lists of numbers: what can be plotted."""
    data = msgspec.to_builtins(message) if isinstance(message, msgspec.Struct) else message
    return list(_numbers(data, "")) if isinstance(data, Mapping) else []


def _numbers(data: Any, way: str) -> Iterator[str]:
    if isinstance(data, Mapping):
        for key, value in data.items():
            yield from _numbers(value, f"{way}.{key}" if way else str(key))
    elif _is_number(data) or _is_row(data):
        yield way


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_row(value: object) -> bool:
    """Whether it is a list of numbers, or of lists of numbers such as samples."""
    if not isinstance(value, list | tuple) or not value:
        return False
    return all(_is_number(one) or (isinstance(one, list | tuple) and _is_row(one)) for one in value)


def _json_safe(message: Any) -> Any:
    return as_json(message) if isinstance(message, bytes) else message


def _moment(time_s: float) -> str:
    return datetime.fromtimestamp(time_s).isoformat(timespec="milliseconds")


# The head of a topic's pane: its name, a filter, and what can be done with its messages.


class TopicBar(QWidget):
    """Has no behaviour of its own; the pane connects its buttons."""

    def __init__(self, look: Look) -> None:
        super().__init__()
        self._look = look
        self.title = ElidedLabel()
        self.title.setProperty("role", "heading")
        self.pause_button = _tool("Pause", tip="Stop the list, to read it")
        self.pause_button.setCheckable(True)
        self.copy_button = _tool("Copy", tip="Copy the chosen message, or all of them")
        self.save_button = _tool("Save as…", tip="Save the messages as a table or JSON lines")
        self.plot_button = _tool("Plot", tip="Show a number of these messages as a curve")
        self.plot_menu = QMenu(self.plot_button)
        self.plot_button.setMenu(self.plot_menu)
        self.plot_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.close_button = labelled(QToolButton(), tip="Close", name="Close these messages")
        self.filter = QLineEdit(clearButtonEnabled=True)
        labelled(
            self.filter, placeholder="Show only messages with…", name="Show only messages with…"
        )
        tools = self.pause_button, self.copy_button, self.save_button, self.plot_button
        head, below = in_row((self.title, 1), self.close_button), in_row(*tools, (self.filter, 1))
        in_column(head, below, of=self, margins=0)
        look.theme_changed.connect(self._on_theme_changed)
        self._on_theme_changed()

    def _on_theme_changed(self) -> None:
        icons = {
            self.pause_button: "pause",
            self.copy_button: "copy",
            self.save_button: "download",
            self.plot_button: "chart-line",
            self.close_button: "x",
        }
        for button, name in icons.items():
            button.setIcon(icon(name, self._look.theme))


def _tool(words: str, *, tip: str) -> QToolButton:
    return labelled(QToolButton(), text=words, name=words, tip=tip)


# The last messages of a topic as a list; however fast they come, only some are drawn.

KEPT = 500
"""So many messages of a topic are kept to look at."""

Index = QModelIndex


class HeardList(QAbstractListModel):
    """What is shown is what was there at the last ``refresh``, the newest first."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._kept: deque[Heard] = deque(maxlen=KEPT)
        self.shown: list[Heard] = []
        """What is in the list, the newest first."""
        self.filter = ""
        self.count = 0

    def clear(self) -> None:
        """Forget all."""
        self._kept.clear()
        self.count = 0
        self.refresh()

    def add(self, batch: Sequence[Heard]) -> None:
        """Keep the newest of these; they are not shown yet."""
        self.count += len(batch)
        self._kept.extend(batch[-KEPT:])

    def refresh(self) -> None:
        """Show what has come."""
        wanted = self.filter.casefold()
        self.beginResetModel()
        self.shown = [
            one
            for one in reversed(self._kept)
            if not wanted or wanted in f"{one.sender} {as_json(one.message)}".casefold()
        ]
        self.endResetModel()

    def rowCount(self, parent: Index | Any = QModelIndex()) -> int:  # noqa: B008  Qt's default
        """How many are shown."""
        return 0 if parent.isValid() else len(self.shown)

    def data(self, index: Index | Any, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """The line of a message, or all of it."""
        if not index.isValid() or index.row() >= len(self.shown):
            return None
        heard = self.shown[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return f"{clock(heard.time_s)}  {heard.sender}  {one_line(heard.message)}"
        if role == Qt.ItemDataRole.ToolTipRole:
            return plain_tip(pretty(heard.message)[:4000])
        return heard if role == Qt.ItemDataRole.UserRole else None


def clock(time_s: float) -> str:
    """The time of day to the millisecond."""
    return datetime.fromtimestamp(time_s).strftime("%H:%M:%S.%f")[:-3]


SHOW_MS = 50
"""Twenty times a second is as fast as anybody can see."""


class TopicPane(QWidget):
    """Hears its topic while it is visible. ``plot_requested`` gives the topic and a field."""

    plot_requested = Signal(str, str)
    saving_failed = Signal(str, str)

    def __init__(self, runner: Runner, look: Look) -> None:
        super().__init__()
        self._runner = runner
        self._tap: Tap | None = None
        self._seen: TopicSeen | None = None
        self.topic = ""
        self.heard = HeardList(self)
        self.bar = TopicBar(look)
        self.about = plain_label()
        self.about.setProperty("role", "hint")
        self.list = labelled(QListView(uniformItemSizes=True), name="Messages, the newest first")
        self.list.setModel(self.heard)
        self.list.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.full = labelled(QPlainTextEdit(readOnly=True), name="The message in full")
        self.full.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.send_box = SendBox(runner.send, look)
        self._later = QTimer(self, singleShot=True, interval=SHOW_MS)
        self._later.timeout.connect(self._on_later)
        self._lay_out()
        self._connect()
        follow_words(self, self._say)

    def _say(self) -> None:
        if self._seen is not None:
            self.tell(self._seen)

    def _lay_out(self) -> None:
        split = QSplitter(Qt.Orientation.Vertical, childrenCollapsible=False)
        split.addWidget(self.list)
        split.addWidget(self.full)
        self.tabs = QTabWidget(documentMode=True)
        self.tabs.addTab(split, "")
        self.tabs.addTab(self.send_box, "")
        labelled_items(self.tabs, "Messages", "Send by hand")
        in_column(self.bar, self.about, (self.tabs, 1), of=self)

    def _connect(self) -> None:
        bar = self.bar
        bar.pause_button.toggled.connect(self._on_pause_toggled)
        bar.filter.textChanged.connect(self._on_filter_changed)
        bar.copy_button.clicked.connect(self.copy)
        bar.save_button.clicked.connect(self._on_save_clicked)
        bar.plot_menu.aboutToShow.connect(self._on_plot_menu)
        self.list.clicked.connect(self._on_chosen)
        self.list.activated.connect(self._on_chosen)
        self.list.selectionModel().currentChanged.connect(self._on_current_changed)

    @property
    def is_hearing(self) -> bool:
        """Whether messages are being heard: only while it is visible."""
        return self._tap is not None

    def show_topic(self, topic: str, seen: TopicSeen | None = None) -> None:
        """Show the messages of a topic, which is heard from now on."""
        if topic != self.topic:
            self._stop()
            self.topic, self._seen = topic, None
            self.about.clear()
            self.bar.title.set_words(topic)
            self.heard.clear()
            self.full.clear()
            self.bar.pause_button.setChecked(False)
            self.send_box.show_topic(topic, seen.last if seen else None)
            if self.isVisible():
                self._start()
        if seen is not None:
            self.tell(seen)

    def tell(self, seen: TopicSeen) -> None:
        """Say how the topic is doing."""
        self._seen = seen
        words = [
            rate_words(seen.rate_hz),
            count_words(seen.count, "1 message", "{n} messages"),
            tr("from {names}", names=names(seen.publishers)),
            tr("to {names}", names=names(seen.subscribers)),
        ]
        if seen.lost:
            words.append(count_words(seen.lost, "1 message was lost", "{n} messages were lost"))
        self.about.setText(" · ".join(words))

    def copy(self) -> None:
        """Copy the message that is shown in full, else all in the list."""
        heard: Heard | None = self.list.currentIndex().data(Qt.ItemDataRole.UserRole)
        if heard is not None:
            text = pretty(heard.message)
        else:
            text = "\n".join(as_json(one.message) for one in reversed(self.heard.shown))
        QGuiApplication.clipboard().setText(text)

    def save_to(self, path: Path) -> None:
        """Save what is in the list, oldest first, as CSV or JSON lines."""
        try:
            save(list(reversed(self.heard.shown)), path)
        except OSError as error:
            self.saving_failed.emit(str(path), error.strerror or str(error))

    def showEvent(self, event: QShowEvent) -> None:
        """Hear the topic."""
        super().showEvent(event)
        self._start()

    def hideEvent(self, event: QHideEvent) -> None:
        """Hear nothing while nobody looks."""
        super().hideEvent(event)
        self._stop()

    def _start(self) -> None:
        if self.topic and self._tap is None:
            kind = BY_TOPIC.get(self.topic)
            self._tap = self._runner.tap(self.topic, kind=kind, parent=self)
            self._tap.arrived.connect(self._on_arrived)

    def _stop(self) -> None:
        if self._tap is not None:
            self._tap.close()
            self._tap = None
        self._later.stop()

    def _on_arrived(self, batch: list[Heard]) -> None:
        if self.bar.pause_button.isChecked():
            return
        self.heard.add(batch)
        if not self._later.isActive():
            self._later.start()

    def _on_later(self) -> None:
        self.heard.refresh()
        shown = self.heard.shown
        self.full.setPlainText(pretty(shown[0].message) if shown else "")

    def _on_chosen(self, index: QModelIndex) -> None:
        """Reading one message stops the stream, or it would be gone."""
        if index.isValid():
            self.bar.pause_button.setChecked(True)
            self.full.setPlainText(pretty(index.data(Qt.ItemDataRole.UserRole).message))

    def _on_current_changed(self, index: QModelIndex) -> None:
        if index.isValid() and self.list.hasFocus():
            self._on_chosen(index)

    def _on_pause_toggled(self, is_on: bool) -> None:
        if not is_on:
            nothing, clear = QModelIndex(), QItemSelectionModel.SelectionFlag.Clear
            self.list.selectionModel().setCurrentIndex(nothing, clear)

    def _on_filter_changed(self, words: str) -> None:
        self.heard.filter = words.strip()
        self._on_later()

    def _on_save_clicked(self) -> None:
        name = self.topic.strip("/").replace("/", "_") or "messages"
        place, table = Path.home() / f"{name}.csv", tr("Table (*.csv)")
        kinds = table, tr("JSON lines (*.jsonl)")
        dialog = ask_for_path(self, tr("Save messages"), place, self.save_to, "save", kinds)
        dialog.filterSelected.connect(
            lambda chosen: dialog.setDefaultSuffix("jsonl" if "jsonl" in chosen else "csv")
        )

    def _on_plot_menu(self) -> None:
        menu = self.bar.plot_menu
        menu.clear()
        last = self.heard.shown[0].message if self.heard.shown else None
        for field in number_fields(last):
            menu.addAction(field, partial(self.plot_requested.emit, self.topic, field))
        if menu.isEmpty():
            menu.addAction(tr("There are no numbers in these messages")).setEnabled(False)
