"""What runs: a card for each node, and the log of one beside them."""

from __future__ import annotations

import time
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

from PySide6.QtCore import QMetaObject, QObject, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QHideEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QPushButton,
    QScrollArea,
    QSplitter,
    QStackedWidget,
    QWidget,
)

from nep_studio.run.plan import PlannedNode
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.network_feed import NetworkFeed
from nep_studio.ui.theme.icons import fit_icons
from nep_studio.ui.theme.look import Look
from nep_studio.ui.widgets.forms import hint
from nep_studio.ui.widgets.layouts import InLines, in_column, in_row

from .card import LINES_WIDE, Entry, NodeCard, entries_of
from .log_view import LogView

if TYPE_CHECKING:
    from nep_studio.ui.running.runner import Runner


# Cards side by side, in as many columns as there is room for.


class CardGrid(QScrollArea):
    """Scrolls down, never sideways."""

    def __init__(self) -> None:
        super().__init__()
        self.cards: list[NodeCard] = []
        self._columns = 0
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        labelled(self, name="Nodes")
        self._inner = QWidget()
        self._grid = QGridLayout(self._inner)
        self.setWidget(self._inner)

    def show_cards(self, cards: Sequence[NodeCard]) -> None:
        """Show these cards, in this order; others are thrown away."""
        for card in self.cards:
            if card not in cards:
                self._grid.removeWidget(card)
                card.deleteLater()
        self.cards = list(cards)
        self._columns = 0
        self._arrange()

    def sizeHint(self) -> QSize:
        """Room for a row of cards."""
        line = self.fontMetrics().height()
        return QSize(line * LINES_WIDE * 2, line * 11)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take as many columns as there is room for."""
        super().resizeEvent(event)
        self._arrange()

    def _arrange(self) -> None:
        wide = self.fontMetrics().height() * LINES_WIDE
        columns = max(1, self.viewport().width() // wide)
        if columns == self._columns:
            return
        for column in range(self._columns):
            self._grid.setColumnStretch(column, 0)
        self._columns = columns
        for place, card in enumerate(self.cards):
            self._grid.addWidget(card, place // columns, place % columns)
        for before, card in pairwise(self.cards):
            QWidget.setTabOrder(before, card)
        for column in range(columns):
            self._grid.setColumnStretch(column, 1)
        for row in range(self._grid.rowCount()):
            self._grid.setRowStretch(row, 0)
        self._grid.setRowStretch(-(-len(self.cards) // columns), 1)


FIGURES_S = 1.0


class NodesPage(InLines):
    """Shows the nodes of a runner while it is visible; its buttons ask for what they say.

    ``start_asked``, ``stop_asked`` and ``restart_asked`` give a name.
    """

    start_asked = Signal(str)
    stop_asked = Signal(str)
    restart_asked = Signal(str)

    usual_lines = (40, 11)
    """Room for a row of cards and a log."""

    def __init__(self, runner: Runner, feed: NetworkFeed, look: Look) -> None:
        super().__init__()
        self._runner, self._feed, self._look = runner, feed, look
        self._planned: list[PlannedNode] = []
        self._figures_s = 0.0
        self.grid = CardGrid()
        self.log = LogView(look)
        self.log.hide()
        self.empty = _Empty()
        self._soon = QTimer(self, singleShot=True, interval=50)
        self._soon.timeout.connect(self.refresh)
        self.views = QStackedWidget()
        self.views.addWidget(self.empty)
        self.views.addWidget(self.grid)
        self.split = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False)
        self.split.addWidget(self.views)
        self.split.addWidget(self.log)
        in_column(self.split, of=self, margins=0)
        self._connect()
        follow_words(self, self.refresh)

    def _connect(self) -> None:
        self._heard: list[QMetaObject.Connection] = []
        """What of the news is listened to: nothing while the panel is hidden."""
        self._feed.changed.connect(self._on_seen)
        self._look.theme_changed.connect(self._on_theme_changed)
        self.log.closed.connect(self._on_log_closed)

    @property
    def cards(self) -> list[NodeCard]:
        """The cards, in their order."""
        return self.grid.cards

    def card(self, name: str) -> NodeCard | None:
        """The card of a node."""
        return next((card for card in self.cards if card.entry.name == name), None)

    def open_log(self, name: str) -> None:
        """Show what a node writes."""
        runner = self._runner
        self.log.show_log(name, runner.log_file(name), lambda: runner.log_of(name))
        if not self.log.isVisible():
            self.log.show()
            wide = self.split.width()
            self.split.setSizes([wide * 9 // 20, wide * 11 // 20])
        self.log.text.setFocus()

    def refresh_plan(self) -> None:
        """Look again which nodes the project needs."""
        if self.isVisible():
            self._planned = self._runner.planned()
            self.refresh()

    def refresh(self) -> None:
        """Show how the nodes are doing; cards that stay are only told."""
        if not self.isVisible():
            return
        entries = entries_of(
            self._runner.board.nodes,
            self._planned,
            self._runner.started,
            self._feed.seen.nodes,
        )
        if [one.name for one in entries] != [card.entry.name for card in self.cards]:
            known = {card.entry.name: card for card in self.cards}
            self.grid.show_cards([known.get(one.name) or self._card(one) for one in entries])
        for entry, card in zip(entries, self.cards, strict=True):
            card.show_entry(entry)
        self.views.setCurrentWidget(self.grid if entries else self.empty)

    def showEvent(self, event: QShowEvent) -> None:
        """Look at the nodes."""
        super().showEvent(event)
        self._feed.watch(self)
        if not self._heard:
            runner = self._runner
            news = runner.nodes_changed, runner.state_changed, runner.connected, runner.disconnected
            self._heard = [signal.connect(self._on_nodes_changed) for signal in news]
        self.refresh_plan()

    def hideEvent(self, event: QHideEvent) -> None:
        """Look at nothing."""
        super().hideEvent(event)
        self._feed.unwatch(self)
        while self._heard:
            QObject.disconnect(self._heard.pop())

    def _card(self, entry: Entry) -> NodeCard:
        card = NodeCard(entry, self._look, self)
        card.start_asked.connect(self.start_asked)
        card.stop_asked.connect(self.stop_asked)
        card.restart_asked.connect(self.restart_asked)
        card.log_asked.connect(self.open_log)
        card.moved.connect(lambda step: self._on_moved(card, step))
        fit_icons(card)
        return card

    def _on_moved(self, card: NodeCard, step: int) -> None:
        place = self.cards.index(card) + step
        if 0 <= place < len(self.cards):
            self.cards[place].setFocus(Qt.FocusReason.TabFocusReason)
            self.grid.ensureWidgetVisible(self.cards[place])

    def _on_nodes_changed(self) -> None:
        if not self._soon.isActive():
            self._soon.start()

    def _on_seen(self) -> None:
        """Figures that change five times a second cannot be read."""
        if time.monotonic() - self._figures_s >= FIGURES_S:
            self._figures_s = time.monotonic()
            self.refresh()

    def _on_log_closed(self) -> None:
        self.log.hide()
        card = self.card(self.log.node)
        if card is not None:
            card.setFocus()

    def _on_theme_changed(self) -> None:
        for card in self.cards:
            card.redraw()


class _Empty(QWidget):
    """What stands here while the project needs no node and none is there."""

    def __init__(self) -> None:
        super().__init__()
        words = hint(
            "Here you see the nodes of your project: what they do, how they are, "
            "and what they write. Most come by themselves from your rules and robots."
        )
        words.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.page_button = labelled(QPushButton(), text="Go to the Robots page")
        in_column(1, words, in_row(1, self.page_button, 1), 1, of=self)
