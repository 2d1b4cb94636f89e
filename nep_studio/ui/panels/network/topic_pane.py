"""The messages of one topic: the last ones, one of them in full, and one to send by hand."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any, Protocol

import msgspec
from PySide6.QtCore import QItemSelectionModel, QModelIndex, Qt, QTimer, Signal
from PySide6.QtGui import QGuiApplication, QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QFileDialog,
    QLabel,
    QListView,
    QMenu,
    QPlainTextEdit,
    QSplitter,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from nep_core.messages import BY_TOPIC
from nep_studio.ui.running.tap import Heard, Tap
from nep_studio.ui.theme import Look
from nep_studio.ui.words import count_words, tr

from .graph_words import as_json, names, pretty, rate_words
from .heard_list import HeardList
from .saving import number_fields, save
from .seen import TopicSeen
from .send_box import SendBox
from .topic_bar import TopicBar

SHOW_MS = 50
"""Twenty times a second is as fast as anybody can see."""


class Talks(Protocol):
    """Brings messages and sends them: a runner."""

    def tap(
        self, topic: str, *, kind: type[Any] | None = None, most: int = 2000, parent: Any
    ) -> Tap:
        """Hear a topic."""

    def send(self, topic: str, message: msgspec.Struct | dict[str, Any]) -> bool:
        """Send a message."""


class TopicPane(QWidget):
    """Hears its topic while it is visible. ``plot_requested`` gives the topic and a field."""

    plot_requested = Signal(str, str)
    saving_failed = Signal(str, str)

    def __init__(self, talks: Talks, look: Look, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._talks = talks
        self._tap: Tap | None = None
        self._is_paused = False
        self.topic = ""
        self.folder = Path.home()
        self.heard = HeardList(self)
        self.bar = TopicBar(look)
        self.about = QLabel()
        self.about.setWordWrap(True)
        self.about.setProperty("role", "hint")
        self.list = QListView()
        self.list.setModel(self.heard)
        self.list.setUniformItemSizes(True)
        self.list.setAccessibleName(tr("Messages, the newest first"))
        self.list.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.full = QPlainTextEdit()
        self.full.setReadOnly(True)
        self.full.setAccessibleName(tr("The message in full"))
        self.full.setLayoutDirection(Qt.LayoutDirection.LeftToRight)
        self.send_box = SendBox(talks.send, look)
        self._later = QTimer(self, singleShot=True, interval=SHOW_MS)
        self._later.timeout.connect(self._on_later)
        self._lay_out()
        self._connect()

    def _lay_out(self) -> None:
        split = QSplitter(Qt.Orientation.Vertical)
        split.addWidget(self.list)
        split.addWidget(self.full)
        split.setChildrenCollapsible(False)
        self.tabs = QTabWidget()
        self.tabs.setDocumentMode(True)
        self.tabs.addTab(split, tr("Messages"))
        self.tabs.addTab(self.send_box, tr("Send by hand"))
        box = QVBoxLayout(self)
        for widget in (self.bar, self.about):
            box.addWidget(widget)
        box.addWidget(self.tabs, 1)

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
            self.topic = topic
            self.bar.show_topic(topic)
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
        index = self.list.currentIndex()
        heard: Heard | None = index.data(Qt.ItemDataRole.UserRole) if index.isValid() else None
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
            self._tap = self._talks.tap(self.topic, kind=kind, parent=self)
            self._tap.arrived.connect(self._on_arrived)

    def _stop(self) -> None:
        if self._tap is not None:
            self._tap.close()
            self._tap = None
        self._later.stop()

    def _on_arrived(self, batch: list[Heard]) -> None:
        if self._is_paused:
            return
        self.heard.add(batch)
        if not self._later.isActive():
            self._later.start()

    def _on_later(self) -> None:
        self.heard.refresh()
        if self.heard.shown:
            self._show(self.heard.shown[0])
        else:
            self.full.clear()

    def _show(self, heard: Heard) -> None:
        self.full.setPlainText(pretty(heard.message))

    def _on_chosen(self, index: QModelIndex) -> None:
        """Reading one message stops the stream, or it would be gone."""
        if index.isValid():
            self.bar.pause_button.setChecked(True)
            self._show(index.data(Qt.ItemDataRole.UserRole))

    def _on_current_changed(self, index: QModelIndex) -> None:
        if index.isValid() and self.list.hasFocus():
            self._on_chosen(index)

    def _on_pause_toggled(self, is_on: bool) -> None:
        self._is_paused = is_on
        if not is_on:
            self.list.selectionModel().setCurrentIndex(
                QModelIndex(), QItemSelectionModel.SelectionFlag.Clear
            )

    def _on_filter_changed(self, words: str) -> None:
        self.heard.filter = words.strip()
        self._on_later()

    def _on_save_clicked(self) -> None:
        name = self.topic.strip("/").replace("/", "_") or "messages"
        dialog = QFileDialog(self, tr("Save messages"), str(self.folder / f"{name}.csv"))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setNameFilters([tr("Table (*.csv)"), tr("JSON lines (*.jsonl)")])
        dialog.filterSelected.connect(
            lambda chosen: dialog.setDefaultSuffix("jsonl" if "jsonl" in chosen else "csv")
        )
        dialog.setDefaultSuffix("csv")
        dialog.selectFile(f"{name}.csv")
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.fileSelected.connect(lambda path: self.save_to(Path(path)))
        dialog.open()

    def _on_plot_menu(self) -> None:
        menu: QMenu = self.bar.plot_menu
        menu.clear()
        last = self.heard.shown[0].message if self.heard.shown else None
        for field in number_fields(last):
            menu.addAction(field, partial(self.plot_requested.emit, self.topic, field))
        if menu.isEmpty():
            menu.addAction(tr("There are no numbers in these messages")).setEnabled(False)
