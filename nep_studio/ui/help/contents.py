"""The contents of the help as a tree, and what a search found as a list."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QIcon, QKeyEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QListWidget,
    QListWidgetItem,
    QStackedWidget,
    QTreeWidget,
    QTreeWidgetItem,
    QTreeWidgetItemIterator,
    QWidget,
)

from nep_studio.help.index import Hit
from nep_studio.ui.theme import Theme, UnknownIcon, icon
from nep_studio.ui.words import tr

from .book import Content
from .page_names import BLOCK, CATEGORY, NODE, split

PAGE = Qt.ItemDataRole.UserRole
KIND_ICONS = {BLOCK: "blocks", CATEGORY: "layers", NODE: "network"}


class ContentsView(QStackedWidget):
    """The tree, or what was found. ``chosen`` brings the name of a page."""

    chosen = Signal(str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.tree = QTreeWidget()
        self.tree.setHeaderHidden(True)
        self.tree.setUniformRowHeights(True)
        self.tree.setAccessibleName(tr("Contents of the help"))
        self.found = FoundList()
        self.found.setAccessibleName(tr("Pages found"))
        self.found.setUniformItemSizes(True)
        for view in (self.tree, self.found):
            view.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
            view.setTextElideMode(Qt.TextElideMode.ElideRight)
            view.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
            self.addWidget(view)
        self.tree.itemClicked.connect(self._on_tree_used)
        self.tree.itemActivated.connect(self._on_tree_used)
        self.found.itemClicked.connect(self._on_found_used)
        self.found.itemActivated.connect(self._on_found_used)

    def fill(self, contents: Iterable[Content], theme: Theme) -> None:
        """Show these contents."""
        self._size_icons()
        self.tree.clear()
        for content in contents:
            item = _item(content, theme)
            self.tree.addTopLevelItem(item)
            item.setExpanded(True)

    def mark(self, name: str) -> None:
        """Show in the tree which page is shown."""
        page = split(name)[0]
        if page == self._marked():
            return
        each = QTreeWidgetItemIterator(self.tree)
        while (item := each.value()) is not None:
            if item.data(0, PAGE) == page and item.childCount() == 0:
                self.tree.setCurrentItem(item)
                self.tree.scrollToItem(item)
                return
            each += 1

    def show_found(self, hits: Iterable[Hit], typed: str, theme: Theme) -> None:
        """Show what a search found, the best first."""
        self.found.clear()
        for hit in hits:
            item = QListWidgetItem(_icon(_kind_icon(hit.page), theme), hit.title)
            item.setData(PAGE, hit.page)
            item.setToolTip(hit.title)
            self.found.addItem(item)
        if self.found.count():
            self.found.setCurrentRow(0)
        else:
            words = tr("Nothing says “{typed}”. Try another word.", typed=typed)
            nothing = QListWidgetItem(words)
            nothing.setFlags(Qt.ItemFlag.NoItemFlags)
            self.found.addItem(nothing)
        self.setCurrentWidget(self.found)

    def show_contents(self) -> None:
        """Show the tree again."""
        self.setCurrentWidget(self.tree)

    def choose_found(self) -> None:
        """Choose what is marked among what was found."""
        item = self.found.currentItem()
        if item is not None and item.data(PAGE):
            self.chosen.emit(item.data(PAGE))

    def _size_icons(self) -> None:
        side = self.fontMetrics().height()
        self.tree.setIconSize(QSize(side, side))
        self.found.setIconSize(QSize(side, side))

    def _marked(self) -> str:
        item = self.tree.currentItem()
        return str(item.data(0, PAGE)) if item is not None else ""

    def _on_tree_used(self, item: QTreeWidgetItem, column: int) -> None:
        if item.parent() is None:
            item.setExpanded(not item.isExpanded())
        else:
            self.chosen.emit(item.data(0, PAGE))

    def _on_found_used(self, item: QListWidgetItem) -> None:
        if item.data(PAGE):
            self.chosen.emit(item.data(PAGE))


class FoundList(QListWidget):
    """A list whose first row is left upwards with the arrow key."""

    left_upwards = Signal()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Go back to the search from the first row."""
        if event.key() == Qt.Key.Key_Up and self.currentRow() <= 0:
            self.left_upwards.emit()
        else:
            super().keyPressEvent(event)


def _item(content: Content, theme: Theme) -> QTreeWidgetItem:
    item = QTreeWidgetItem([content.title])
    item.setData(0, PAGE, content.page)
    item.setToolTip(0, content.title)
    if content.icon:
        item.setIcon(0, _icon(content.icon, theme))
    item.addChildren([_item(inner, theme) for inner in content.inside])
    return item


def _icon(name: str, theme: Theme) -> QIcon:
    try:
        return icon(name, theme)
    except UnknownIcon:  # a manifest may name one that this program does not have
        return icon("box", theme)


def _kind_icon(page: str) -> str:
    kinds = (name for kind, name in KIND_ICONS.items() if page.startswith(kind))
    return next(kinds, "book-open")
