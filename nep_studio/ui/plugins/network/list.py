"""The same network as a table: for screen readers, and for those who like lists."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTreeWidget, QTreeWidgetItem, QWidget

from nep_studio.run.node_board import NodeStatus
from nep_studio.ui.network_feed import Seen
from nep_studio.ui.network_words import ago_words, names, rate_words
from nep_studio.ui.node_style import state_look, type_words
from nep_studio.ui.words import tr

from .graph import Graph, Key

KEY = Qt.ItemDataRole.UserRole


class NetworkList(QTreeWidget):
    """Nodes and topics under two heads; Enter or a double click opens one."""

    topic_chosen = Signal(str)
    node_chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName(tr("Network as a list"))
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setHeaderLabels(
            [
                tr("Name"),
                tr("Messages"),
                tr("So far"),
                tr("Lost"),
                tr("Last one"),
                tr("From"),
                tr("To"),
            ]
        )
        self.header().setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        self.topics = self._head(tr("Topics"))
        self.nodes = self._head(tr("Nodes"))
        self._rows: dict[Key, QTreeWidgetItem] = {}
        self.itemActivated.connect(self._on_activated)
        self.itemClicked.connect(self._on_activated)
        line = self.fontMetrics().height()
        for column, lines in enumerate((14, 8, 6, 5, 7, 16, 16)):
            self.setColumnWidth(column, lines * line)

    def show_graph(self, graph: Graph, seen: Seen, statuses: Mapping[str, NodeStatus]) -> None:
        """Show this; rows that are still there stay where they are."""
        for key in [key for key in self._rows if key not in set(graph.keys)]:
            head = self.topics if key[0] == "topic" else self.nodes
            head.removeChild(self._rows.pop(key))
        for name in graph.topics:
            topic = seen.topics[name]
            words = (
                rate_words(topic.rate_hz),
                str(topic.count),
                str(topic.lost) if topic.lost else "",
                ago_words(topic.last_s),
                names(topic.publishers),
                names(topic.subscribers),
            )
            self._fill(("topic", name), self.topics, words)
        for name in graph.nodes:
            node, status = seen.nodes[name], statuses.get(name)
            state = state_look(status).word if status else type_words("")
            words = (
                rate_words(node.rate_hz),
                state,
                "",
                "",
                names(node.hears),
                names(node.publishes),
            )
            self._fill(("node", name), self.nodes, words)

    def _head(self, words: str) -> QTreeWidgetItem:
        item = QTreeWidgetItem(self, [words])
        item.setExpanded(True)
        item.setFirstColumnSpanned(True)
        return item

    def _fill(self, key: Key, head: QTreeWidgetItem, words: tuple[str, ...]) -> None:
        item = self._rows.get(key)
        if item is None:
            item = self._rows[key] = QTreeWidgetItem(head, [key[1]])
            item.setData(0, KEY, key)
        for column, text in enumerate(words, 1):
            if item.text(column) != text:
                item.setText(column, text)

    def _on_activated(self, item: QTreeWidgetItem) -> None:
        key = item.data(0, KEY)
        if key:
            (self.topic_chosen if key[0] == "topic" else self.node_chosen).emit(key[1])
