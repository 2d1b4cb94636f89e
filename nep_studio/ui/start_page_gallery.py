"""The gallery of examples: cards, a search, and tags to choose from."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QShowEvent
from PySide6.QtWidgets import (
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from nep_studio.blocks.errors import BlocksError
from nep_studio.examples import Example, examples
from nep_studio.ui.app import Studio
from nep_studio.ui.messages import announce
from nep_studio.ui.start_page_examples import CARD_LINES, Card
from nep_studio.ui.start_page_flow import Flow
from nep_studio.ui.start_page_words import search_text, tag_words
from nep_studio.ui.theme import icon
from nep_studio.ui.words import count_words, is_right_to_left, tr

FEWEST_WITH_TAG = 2
"""A tag of fewer examples is found by the search only."""


SETTLED_MS = 120
"""So long after its last change a size counts as settled."""


class SearchLine(QLineEdit):
    """Where a person types what an example is about; ``left_downwards`` goes to the cards."""

    left_downwards = Signal()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter and Down go on to the cards, Escape empties the line."""
        if event.key() in (Qt.Key.Key_Down, Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.left_downwards.emit()
        elif event.key() == Qt.Key.Key_Escape and self.text():
            self.clear()
        else:
            super().keyPressEvent(event)


class Gallery(QWidget):
    """Cards of all examples. ``opened`` and ``try_requested`` give the file of one."""

    opened = Signal(Path)
    try_requested = Signal(Path)
    focus_moved = Signal(QWidget)

    def __init__(self, studio: Studio, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._studio = studio
        self._unbuilt = list(examples())
        self._cards: dict[Path, Card] = {}
        self._shown: list[Card] = []
        self.tag_buttons: dict[str, QPushButton] = {}
        self._columns = self._wide = 0
        self._unpainted: list[Path] = []
        self._has_pictures = True
        self._painting = QTimer(self, interval=0)
        self._painting.timeout.connect(self._on_paint_next)
        self._settling = QTimer(self, singleShot=True, interval=SETTLED_MS)
        self._settling.timeout.connect(self._on_settled)
        self._fill()

    def _fill(self) -> None:
        line = self.fontMetrics().height()
        box = QVBoxLayout(self)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(line // 2)
        box.addLayout(self._search_row(line))
        box.addWidget(self._tag_row(line))
        self.nothing = QLabel(tr("No example is about this. Try fewer words."))
        self.nothing.setProperty("role", "hint")
        self.nothing.setWordWrap(True)
        self.nothing.hide()
        box.addWidget(self.nothing)
        self._grid = QGridLayout()
        self._grid.setSpacing(line)
        self._grid.setAlignment(Qt.AlignmentFlag.AlignLeading | Qt.AlignmentFlag.AlignTop)
        box.addLayout(self._grid)

    @property
    def cards(self) -> dict[Path, Card]:
        """The cards of all examples by file."""
        while self._unbuilt:
            self._build_next()
        return self._cards

    @property
    def is_complete(self) -> bool:
        """Whether all cards are made."""
        return not self._unbuilt

    @property
    def shown(self) -> list[Card]:
        """The cards that are about what is searched for."""
        return self._shown if self.cards else []

    def _search_row(self, line: int) -> QHBoxLayout:
        row = QHBoxLayout()
        self.search = SearchLine()
        self.search.setPlaceholderText(tr("Find an example"))
        self.search.setAccessibleName(tr("Find an example"))
        self.search.setClearButtonEnabled(True)
        self.search.addAction(
            icon("search", self._studio.look.theme), QLineEdit.ActionPosition.LeadingPosition
        )
        self.search.setMaximumWidth(line * 18)
        self.search.textChanged.connect(self._on_filter_changed)
        self.search.left_downwards.connect(self._on_left_search)
        row.addWidget(self.search)
        row.addStretch(1)
        return row

    def _tag_row(self, line: int) -> QWidget:
        row = QWidget()
        policy = QSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Minimum)
        policy.setHeightForWidth(True)
        row.setSizePolicy(policy)
        flow = Flow(row, spacing=line // 3)
        counts = Counter(tag for example in examples() for tag in example.tags)
        for tag in (tag for tag, count in counts.items() if count >= FEWEST_WITH_TAG):
            button = self.tag_buttons[tag] = QPushButton(tag_words(tag))
            button.setCheckable(True)
            button.clicked.connect(lambda _=False, tag=tag: self._on_tag_clicked(tag))
            flow.addWidget(button)
        return row

    def _build_next(self) -> None:
        """Make one more card; all at once would keep the window waiting."""
        example = self._unbuilt.pop(0)
        path = example.path
        card = self._cards[path] = Card(example, self._studio.look)
        card.clicked.connect(lambda: self.opened.emit(path))
        card.try_requested.connect(lambda: self.try_requested.emit(path))
        card.moved_on.connect(lambda side: self._on_moved(card, side))
        self._unpainted.append(path)
        self._shown.append(card)
        if self._columns:
            card.set_width(self._wide)
            self._put(card, len(self._shown) - 1)

    # Which cards, and where

    def show_in(self, width: int) -> None:
        """Put as many cards beside each other as there is room for."""
        line = self.fontMetrics().height()
        columns = max(1, (width + line) // (round(line * CARD_LINES) + line))
        self._wide = max((width + line) // columns - line, line * 8)
        for card in self._cards.values():
            card.set_width(self._wide)
        if columns != self._columns:
            self._columns = columns
            self._place()
        self._settling.start()

    def _place(self) -> None:
        for card in self._cards.values():
            self._grid.removeWidget(card)
            card.setVisible(card in self._shown)
        for number, card in enumerate(self._shown):
            self._put(card, number)
        self.nothing.setVisible(not self._shown and not self._unbuilt)

    def _put(self, card: Card, number: int) -> None:
        self._grid.addWidget(card, number // self._columns, number % self._columns)
        card.show()

    def _on_filter_changed(self) -> None:
        wanted = self.search.text().casefold().split()
        tags = {tag for tag, button in self.tag_buttons.items() if button.isChecked()}
        self._shown = [card for card in self.cards.values() if _fits(card.example, wanted, tags)]
        self._place()
        announce(self.search, count_words(len(self.shown), "1 example", "{n} examples"))

    def _on_tag_clicked(self, tag: str) -> None:
        """At most one tag is chosen; the chosen one clicked again is chosen no more."""
        for other, button in self.tag_buttons.items():
            button.setChecked(other == tag and button.isChecked())
        self._on_filter_changed()

    def _on_left_search(self) -> None:
        if self.shown:
            self._focus(self.shown[0])

    def _on_moved(self, card: Card, side: str) -> None:
        at, is_mirrored = self.shown.index(card), is_right_to_left()
        forward = -1 if is_mirrored else 1
        to = at + {"left": -forward, "right": forward, "up": -self._columns}.get(
            side, self._columns
        )
        if 0 <= to < len(self.shown):
            self._focus(self.shown[to])
        elif side == "up":
            self.search.setFocus(Qt.FocusReason.BacktabFocusReason)
            self.focus_moved.emit(self.search)

    def _focus(self, card: Card) -> None:
        card.setFocus(Qt.FocusReason.TabFocusReason)
        self.focus_moved.emit(card)

    # Pictures

    def wait_with_pictures(self) -> None:
        """Paint none before ``paint_pictures``: they need all that paints blocks."""
        self._has_pictures = False

    def paint_pictures(self) -> None:
        """Paint them from now on."""
        self._has_pictures = True
        self._painting.start()

    def showEvent(self, event: QShowEvent) -> None:
        """Go on painting."""
        super().showEvent(event)
        self._painting.start()

    def _on_settled(self) -> None:
        """Paint the pictures that are smaller or larger than their cards once more."""
        self._unpainted = [path for path, card in self._cards.items() if not card.is_painted()]
        self._painting.start()

    def _on_paint_next(self) -> None:
        """Make one card or paint one picture at a time, so that the window is there at once."""
        if self._unbuilt and self.isVisible():
            self._build_next()
            return
        if not self._unpainted or not self._has_pictures or not self.isVisible():
            self._painting.stop()
            return
        self._paint(self._unpainted.pop(0))

    def _paint(self, path: Path) -> None:
        from nep_studio.blocks.editor import Editor  # all of the blocks: after the first page
        from nep_studio.blocks.files import load
        from nep_studio.ui.main_window_workbench import block_font
        from nep_studio.ui.pictures import picture_of

        card, language = self._cards[path], self._studio.language
        try:
            editor = Editor(load(path, language), language)
        except BlocksError:
            return  # it is told when somebody opens it
        picture = picture_of(
            editor,
            self._studio.look.theme,
            block_font(self._studio),
            card.picture_size(),
            self.devicePixelRatioF(),
            is_mirrored=is_right_to_left(),
        )
        card.show_picture(picture)


def _fits(example: Example, wanted: list[str], tags: set[str]) -> bool:
    """Whether an example has the chosen tag and all words that were typed."""
    if not tags <= set(example.tags):
        return False
    text = search_text(example)
    return all(word in text for word in wanted)
