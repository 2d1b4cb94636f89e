"""Cards side by side, in as many columns as there is room for."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QGridLayout, QScrollArea, QWidget

from nep_studio.ui.words import tr

from .card import LINES_WIDE, NodeCard


class CardGrid(QScrollArea):
    """Scrolls down, never sideways."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.cards: list[NodeCard] = []
        self._columns = 0
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setAccessibleName(tr("Nodes"))
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
        before: QWidget | None = None
        for place, card in enumerate(self.cards):
            self._grid.addWidget(card, place // columns, place % columns)
            if before is not None:
                QWidget.setTabOrder(before, card)
            before = card
        for column in range(columns):
            self._grid.setColumnStretch(column, 1)
        for row in range(self._grid.rowCount()):
            self._grid.setRowStretch(row, 0)
        self._grid.setRowStretch(-(-len(self.cards) // columns), 1)
