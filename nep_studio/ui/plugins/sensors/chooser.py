"""Lets a person choose which numbers of which topics are plotted."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QSortFilterProxyModel, Qt, Signal
from PySide6.QtGui import QHideEvent, QShowEvent, QStandardItem, QStandardItemModel
from PySide6.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QDialogButtonBox,
    QLabel,
    QLineEdit,
    QTreeView,
    QVBoxLayout,
    QWidget,
)

from nep_core.wire.messages import IMU
from nep_studio.ui.network_feed import NetworkFeed, Seen
from nep_studio.ui.words import tr

from .feed import Field, SensorFeed, numbers_in

_FIELD = int(Qt.ItemDataRole.UserRole)
_WIDTH_LINES, _HEIGHT_LINES = 28, 22


class FieldChooser(QDialog):
    """All topics with numbers in their last message; a box before each number plots it."""

    chosen = Signal()

    def __init__(self, feed: SensorFeed, network: NetworkFeed, parent: QWidget) -> None:
        super().__init__(parent)
        self._feed, self._network = feed, network
        self._items: dict[Field, QStandardItem] = {}
        self._topics: dict[str, QStandardItem] = {}
        self.setWindowTitle(tr("Choose what is plotted"))
        self.search = QLineEdit()
        self.search.setPlaceholderText(tr("Find a number"))
        self.search.setClearButtonEnabled(True)
        self.hint = QLabel(tr("Numbers appear here as soon as a node sends some."))
        self.hint.setProperty("role", "hint")
        self.hint.setWordWrap(True)
        self._make_tree()
        buttons = QDialogButtonBox()
        close = buttons.addButton(tr("Close"), QDialogButtonBox.ButtonRole.AcceptRole)
        close.clicked.connect(self.accept)
        box = QVBoxLayout(self)
        for widget in (self.search, self.hint, self.tree, buttons):
            box.addWidget(widget)
        line = self.fontMetrics().height()
        self.resize(line * _WIDTH_LINES, line * _HEIGHT_LINES)
        network.changed.connect(self._on_changed)

    def _make_tree(self) -> None:
        self.model = QStandardItemModel(0, 2, self)
        self.model.setHorizontalHeaderLabels([tr("Number"), tr("Last value")])
        self.model.itemChanged.connect(self._on_item_changed)
        self._found = QSortFilterProxyModel(self)
        self._found.setSourceModel(self.model)
        self._found.setRecursiveFilteringEnabled(True)
        self._found.setAutoAcceptChildRows(True)
        self._found.setFilterCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
        self.search.textChanged.connect(self._on_search_changed)
        self.tree = QTreeView()
        self.tree.setModel(self._found)
        self.tree.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.tree.setAccessibleName(tr("Numbers that nodes send"))
        self.tree.setUniformRowHeights(True)

    def show_topic(self, topic: str) -> None:
        """Show the numbers of one topic."""
        self.search.setText(topic)

    def show_messages(self, messages: Mapping[str, Any]) -> None:
        """List the numbers in the last messages of topics."""
        is_new = False
        for topic in sorted(messages):
            numbers = {} if topic == IMU else numbers_in(messages[topic])
            for path, value in numbers.items():
                is_new |= self._show(Field(topic, path), value)
        self.hint.setVisible(not self._items)
        if is_new:
            self.tree.expandAll()
            self.tree.resizeColumnToContents(0)

    def _show(self, field: Field, value: float) -> bool:
        """Show one number; whether it was not there before."""
        item = self._items.get(field)
        is_new = item is None
        if item is None:
            item = self._items[field] = self._added(field)
        shown = item.parent().child(item.row(), 1)
        words = f"{value:.6g}"
        if shown.text() != words:
            shown.setText(words)
        return is_new

    def _added(self, field: Field) -> QStandardItem:
        item = QStandardItem(field.path)
        item.setCheckable(True)
        is_plotted = field in self._feed.fields
        item.setCheckState(Qt.CheckState.Checked if is_plotted else Qt.CheckState.Unchecked)
        item.setData(field, _FIELD)
        topic = self._topics.get(field.topic)
        if topic is None:
            topic = self._topics[field.topic] = QStandardItem(field.topic)
            self.model.appendRow([topic, QStandardItem()])
        topic.appendRow([item, QStandardItem()])
        return item

    def _on_item_changed(self, item: QStandardItem) -> None:
        field = item.data(_FIELD)
        if not isinstance(field, Field):
            return
        is_wanted = item.checkState() == Qt.CheckState.Checked
        if is_wanted and field not in self._feed.fields:
            self._feed.plot(field)
            self.chosen.emit()
        elif not is_wanted:
            self._feed.leave(field)

    def _on_search_changed(self, words: str) -> None:
        self._found.setFilterFixedString(words)
        self.tree.expandAll()

    def _on_changed(self, seen: Seen) -> None:
        if self.isVisible():
            heard = {name: one.last for name, one in seen.topics.items() if one.last is not None}
            self.show_messages(heard)

    def showEvent(self, event: QShowEvent) -> None:
        """Look at the network."""
        super().showEvent(event)
        self._network.watch(self)
        self._on_changed(self._network.seen)

    def hideEvent(self, event: QHideEvent) -> None:
        """Look no more."""
        super().hideEvent(event)
        self._network.unwatch(self)
