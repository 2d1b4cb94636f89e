"""The page Network: the graph or the list of what talks, and the messages of one topic."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QLabel,
    QPushButton,
    QSplitter,
    QStackedWidget,
    QToolButton,
    QTreeWidget,
    QTreeWidgetItem,
    QWidget,
)

from nep_studio.run.node_board import NodeStatus
from nep_studio.ui.labels import explained, follow_words, labelled, plain_tip
from nep_studio.ui.network_feed import NetworkFeed, Seen
from nep_studio.ui.node_style import ago_words, names, rate_words, state_look, type_words
from nep_studio.ui.running.runner import Runner
from nep_studio.ui.theme.icons import icon
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.drawing_board import ZOOM_STEP
from nep_studio.ui.widgets.forms import plain_label
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import count_words, tr

from .graph import Graph, Key, graph_of
from .graph_view import GraphView
from .topics import TopicPane


class NetworkWorkspace(QWidget):
    """Looks at the network while it is visible.

    Whoever can do it is connected with its buttons, views and ``pane``. ``sharing_button`` asks
    which other computers come in, ``empty`` is the first step where nothing is there to see.
    """

    def __init__(self, feed: NetworkFeed, runner: Runner, look: Look) -> None:
        super().__init__()
        self._feed, self._runner, self._look = feed, runner, look
        self.graph = GraphView(look)
        self.list = NetworkList()
        self.pane = TopicPane(runner, look)
        self.pane.hide()
        self.empty = _Empty()
        self.summary = QLabel()
        self.summary.setProperty("role", "hint")
        self.sharing_button = QToolButton(
            toolButtonStyle=Qt.ToolButtonStyle.ToolButtonTextBesideIcon
        )
        self.sharing_button.hide()
        self._sharing_icon = ""
        self.list_button = _tool("As a list", is_checkable=True)
        self.whole_button = _tool("Show everything", is_checkable=True)
        labelled(self.whole_button, tip="Show the studio itself and /node_state too")
        self.larger_button, self.smaller_button = _tool("Zoom in"), _tool("Zoom out")
        self.fit_button = _tool("Show all")
        self._lay_out()
        self._connect()
        self._on_theme_changed()
        follow_words(self, self._say)

    def _lay_out(self) -> None:
        tools = (self.whole_button, self.list_button, self.smaller_button, self.larger_button)
        bar = in_row((self.summary, 1), self.sharing_button, *tools, self.fit_button)
        self.views = QStackedWidget()
        for widget in (self.empty, self.graph, self.list):
            self.views.addWidget(widget)
        left = QWidget()
        self.summary.setIndent(self.fontMetrics().height() // 2)
        in_column(bar, (self.views, 1), of=left, margins=0)
        split = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False)
        split.addWidget(left)
        split.addWidget(self.pane)
        split.setStretchFactor(0, 3)
        split.setStretchFactor(1, 2)
        in_column(split, of=self, margins=0)

    def _connect(self) -> None:
        self._feed.changed.connect(self._on_changed)
        for view in (self.graph, self.list):
            view.topic_chosen.connect(self.open_topic)
        self.list_button.toggled.connect(self._on_list_toggled)
        self.whole_button.toggled.connect(lambda: self._on_changed(self._feed.seen))
        self.larger_button.clicked.connect(lambda: self.graph.zoom(ZOOM_STEP))
        self.smaller_button.clicked.connect(lambda: self.graph.zoom(1 / ZOOM_STEP))
        self.fit_button.clicked.connect(self.graph.fit)
        self.pane.bar.close_button.clicked.connect(self._on_pane_closed)
        self._look.theme_changed.connect(self._on_theme_changed)

    def _say(self) -> None:
        self._on_changed(self._feed.seen)

    def show_sharing(self, words: str, more: str, icon_name: str) -> None:
        """Say that the network is open to other computers; no ``words`` when it is not."""
        self.sharing_button.setVisible(bool(words))
        self.sharing_button.setText(words)
        self.sharing_button.setToolTip(plain_tip(more or words))
        self.sharing_button.setAccessibleName(words)
        self.sharing_button.setAccessibleDescription(more)
        self._sharing_icon = icon_name
        self._on_theme_changed()

    def open_topic(self, topic: str) -> None:
        """Show the messages of a topic."""
        self.pane.show_topic(topic, self._feed.seen.topics.get(topic))
        self.pane.show()

    def showEvent(self, event: QShowEvent) -> None:
        """Look at the network."""
        super().showEvent(event)
        self._feed.watch(self)
        self._on_changed(self._feed.seen)

    def hideEvent(self, event: QHideEvent) -> None:
        """Look at nothing."""
        super().hideEvent(event)
        self._feed.unwatch(self)

    def _on_changed(self, seen: Seen) -> None:
        if not self.isVisible():
            return
        statuses = self._runner.board.nodes
        types = {name: status.type for name, status in statuses.items()}
        graph = graph_of(seen, types, is_whole=self.whole_button.isChecked())
        is_empty = not graph.nodes
        chosen = self.list if self.list_button.isChecked() else self.graph
        self.views.setCurrentWidget(self.empty if is_empty else chosen)
        is_joined = any(status.is_there for status in statuses.values())
        self.empty.tell(is_up=seen.is_up, is_joined=is_joined)
        if not is_empty:
            chosen.show_graph(graph, seen, statuses)
        nodes = count_words(len(graph.nodes), "1 node", "{n} nodes")
        topics = count_words(len(graph.topics), "1 topic", "{n} topics")
        self.summary.setText("" if is_empty else f"{nodes} · {topics}")
        topic = seen.topics.get(self.pane.topic)
        if topic is not None and self.pane.isVisible():
            self.pane.tell(topic)

    def _on_list_toggled(self, is_list: bool) -> None:
        for button in (self.larger_button, self.smaller_button, self.fit_button):
            button.setEnabled(not is_list)
        self._on_changed(self._feed.seen)

    def _on_pane_closed(self) -> None:
        self.pane.hide()
        self.graph.setFocus()

    def _on_theme_changed(self) -> None:
        icons = {
            self.list_button: "list",
            self.whole_button: "eye",
            self.larger_button: "zoom-in",
            self.smaller_button: "zoom-out",
            self.fit_button: "maximize",
        }
        if self._sharing_icon:
            icons[self.sharing_button] = self._sharing_icon
        for button, name in icons.items():
            button.setIcon(icon(name, self._look.theme))


class _Empty(QWidget):
    """What stands here while nothing talks."""

    def __init__(self) -> None:
        super().__init__()
        self.words = plain_label(alignment=Qt.AlignmentFlag.AlignCenter)
        self.words.setProperty("role", "hint")
        self.run_button = labelled(QPushButton(), text="Run")
        self.run_button.setProperty("kind", "run")
        in_column(1, self.words, in_row(1, self.run_button, 1), 2, of=self)
        self.tell(is_up=False, is_joined=False)
        follow_words(self, self._say)

    def tell(self, *, is_up: bool, is_joined: bool) -> None:
        """Say what belongs here and how one begins; nodes that have joined are seen in a moment."""
        self._is_up, self._is_joined = is_up, is_joined
        self.run_button.setVisible(not (is_up or is_joined))
        self._say()

    def _say(self) -> None:
        belongs = tr("Here you see which nodes run and what they tell each other.")
        waits = tr("No node has joined the network yet.")
        begin = tr("Press Run: the nodes of your project start.")
        now = waits if self._is_up else begin
        self.words.setText(belongs if self._is_joined else f"{belongs}\n{now}")


def _tool(words: str, *, is_checkable: bool = False) -> QToolButton:
    button = labelled(explained(QToolButton(), words), text=words)
    button.setCheckable(is_checkable)
    return button


# The same network as a table: for screen readers, and for those who like lists.

KEY = Qt.ItemDataRole.UserRole


class NetworkList(QTreeWidget):
    """Nodes and topics under two heads; Enter or a double click opens one."""

    topic_chosen = Signal(str)
    node_chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        labelled(self, name="Network as a list")
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.header().setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        self.topics, self.nodes = self._head(), self._head()
        follow_words(self, self._say)
        self._rows: dict[Key, QTreeWidgetItem] = {}
        self.itemActivated.connect(self._on_activated)
        self.itemClicked.connect(self._on_activated)
        line = self.fontMetrics().height()
        for column, lines in enumerate((14, 8, 6, 5, 7, 16, 16)):
            self.setColumnWidth(column, lines * line)

    def _say(self) -> None:
        counts = (tr("Messages"), tr("So far"), tr("Lost"), tr("Last one"))
        self.setHeaderLabels((tr("Name"), *counts, tr("From"), tr("To")))
        self.topics.setText(0, tr("Topics"))
        self.nodes.setText(0, tr("Nodes"))

    def show_graph(self, graph: Graph, seen: Seen, statuses: Mapping[str, NodeStatus]) -> None:
        """Show this; rows that are still there stay where they are."""
        for key in self._rows.keys() - set(graph.keys):
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
            ends = names(node.hears), names(node.publishes)
            self._fill(("node", name), self.nodes, (rate_words(node.rate_hz), state, "", "", *ends))

    def _head(self) -> QTreeWidgetItem:
        item = QTreeWidgetItem(self)
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
