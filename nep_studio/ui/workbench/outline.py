"""The outline beside the canvas: choose a row, and the canvas shows its block."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import (
    QAbstractItemModel,
    QItemSelectionModel,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    Qt,
)
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import QAbstractItemView, QTreeView, QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Changes
from nep_studio.blocks.text import sentence
from nep_studio.ui.canvas.accessibility import described
from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.labels import labelled
from nep_studio.ui.theme.colours import PLACEHOLDER, Theme
from nep_studio.ui.widgets.forms import EmptyHint

# The blocks of a page as rows of a tree, read from the program each time they are asked for.

Index = QModelIndex | QPersistentModelIndex

BLOCK = Qt.ItemDataRole.UserRole
"""The role under which a row tells the id of its block."""

PAGE = ""
"""The owner of the rows at the top."""


class OutlineModel(QAbstractItemModel):
    """Rows are blocks: the first of each stack at the top, with the rest of the stack under it.

    What is plugged into a block is part of its sentence, and has no row of its own. There are no
    rows, and nothing is followed, until it is ``awake``, that is, until somebody looks.
    """

    def __init__(self, editor: Editor, theme: Theme, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._editor = editor
        self._theme = theme
        self._page = "behaviour"
        self._numbers: dict[str, int] = {}
        self._ids: list[str] = []
        self._rows: dict[str, dict[str, int]] = {}
        self._in_order: dict[str, list[str]] = {}
        """The blocks under a row, each with its number, and the same as a list."""
        self.is_awake = False

    def set_awake(self, is_awake: bool) -> None:
        """Have rows and follow the program, or rest."""
        if is_awake == self.is_awake:
            return
        history = self._editor.history
        self.beginResetModel()
        self.is_awake = is_awake
        self._rows.clear()
        (history.listen if is_awake else history.unlisten)(self._on_changes)
        self.endResetModel()

    def show_page(self, page: str) -> None:
        """Show the blocks of another page."""
        self.beginResetModel()
        self._page = page
        self._rows.clear()
        self.endResetModel()

    def index_of(self, block_id: str) -> QModelIndex:
        """The row of a block, or of the block around it when it is plugged in."""
        project = self._editor.project
        if block_id not in project.blocks or not self.is_awake:
            return QModelIndex()
        if project.page_of(block_id) != self._page:
            return QModelIndex()
        while block_id in project.blocks:
            owner = self._owner_of(block_id)
            if owner is not None:
                return self.createIndex(self._children(owner)[block_id], 0, self._number(block_id))
            block_id = project.parents[block_id].owner
        return QModelIndex()

    def index(self, row: int, column: int, parent: Index | None = None) -> QModelIndex:
        """The index of a row."""
        owner = self._id(parent)
        if column != 0 or not 0 <= row < len(self._children(owner)):
            return QModelIndex()
        return self.createIndex(row, 0, self._number(self._in_order[owner][row]))

    def parent(self, index: Index | None = None) -> QModelIndex:  # type: ignore[override]
        """The row that a row is under."""
        if index is None or not index.isValid():
            return QModelIndex()
        owner = self._owner_of(self._id(index))
        return self.index_of(owner) if owner else QModelIndex()

    def rowCount(self, parent: Index | None = None) -> int:
        """How many rows are under a row."""
        return len(self._children(self._id(parent)))

    def columnCount(self, parent: Index | None = None) -> int:
        """One column."""
        return 1

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        """What a row says, and how it looks."""
        block_id = self._id(index)
        block = self._editor.project.blocks.get(block_id)
        if block is None:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return sentence(self._editor.project, self._editor.language, block_id)
        if role == Qt.ItemDataRole.AccessibleTextRole:
            return described(self._editor, block_id)
        if role == Qt.ItemDataRole.DecorationRole:
            definition = self._editor.language.definitions.get(block.type)
            colour = definition.category.colour if definition is not None else PLACEHOLDER
            return self._theme.block(colour).fill
        if role == Qt.ItemDataRole.ForegroundRole and block.disabled:
            return self._theme.colour("muted")
        return block_id if role == BLOCK else None

    def _id(self, index: Index | None) -> str:
        return self._ids[index.internalId()] if index is not None and index.isValid() else PAGE

    def _number(self, block_id: str) -> int:
        if block_id not in self._numbers:
            self._numbers[block_id] = len(self._ids)
            self._ids.append(block_id)
        return self._numbers[block_id]

    def _owner_of(self, block_id: str) -> str | None:
        """The block whose row this one's is under; empty at the top, None when it has no row."""
        project = self._editor.project
        parent = project.parents[block_id]
        if not parent.slot:
            first = project.stacks[parent.owner].body[0]
            return PAGE if first == block_id else first
        return parent.owner if parent.slot in project.blocks[parent.owner].bodies else None

    def _children(self, owner: str) -> dict[str, int]:
        """The rows under a row, each with its number."""
        if owner not in self._rows:
            ids = self._in_order[owner] = self._blocks_under(owner)
            self._rows[owner] = {block_id: row for row, block_id in enumerate(ids)}
        return self._rows[owner]

    def _blocks_under(self, owner: str) -> list[str]:
        project = self._editor.project
        if not self.is_awake:
            return []
        if owner == PAGE:
            return [stack.body[0] for stack in project.pages.get(self._page, [])]
        if owner not in project.blocks:
            return []
        inside = [i for chain in project.blocks[owner].bodies.values() for i in chain]
        parent = project.parents[owner]
        if not parent.slot and project.stacks[parent.owner].body[0] == owner:
            inside += project.stacks[parent.owner].body[1:]
        return inside

    def _on_changes(self, changes: Changes) -> None:
        """Tell of new words, or begin anew when rows have come, gone or moved."""
        if not changes.whole and all(map(self._is_up_to_date, self._changed_rows(changes))):
            for owner in changes.owners:
                index = self.index_of(owner)
                if index.isValid():  # an owner may be a stack
                    self.dataChanged.emit(index, index)
            return
        self.beginResetModel()
        self._rows.clear()
        self.endResetModel()

    def _changed_rows(self, changes: Changes) -> Iterator[str]:
        """Under which rows a step may have brought others: looking at all would cost at each key.

        What is below the first block of a stack is under its row.
        """
        stacks = self._editor.project.stacks
        for owner in changes.owners:
            yield from stacks[owner].body[:1] if owner in stacks else [owner]
        if any(owner not in self._editor.project.blocks for owner in changes.owners):
            yield PAGE

    def _is_up_to_date(self, owner: str) -> bool:
        return owner not in self._rows or self._in_order[owner] == self._blocks_under(owner)


class Outline(QTreeView):
    """The blocks of the canvas's page as a tree; both show the same block."""

    def __init__(self, canvas: CanvasHost, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self._rows = OutlineModel(canvas.editor, canvas.look.theme, self)
        self._is_following = False
        self._is_new_page = True
        self._unfolded: set[str] = set()
        self._empty: EmptyHint | None = None
        self._take_rows()
        self._empty = EmptyHint(self, "The blocks of this page are listed here.")
        self.setHeaderHidden(True)
        self.setUniformRowHeights(True)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        labelled(self, name="Outline")
        self.expanded.connect(lambda index: self._unfolded.add(index.data(BLOCK)))
        self.collapsed.connect(lambda index: self._unfolded.discard(index.data(BLOCK)))
        self.activated.connect(self._on_activated)
        canvas.news.page_changed.connect(self._on_page_changed)
        canvas.selection.changed.connect(self._on_selection_changed)
        self._on_page_changed(canvas.page_layout.page)

    def refresh(self) -> None:
        """Follow another project or another theme of the canvas."""
        self._rows.set_awake(False)
        self._rows.deleteLater()
        self._rows = OutlineModel(self._canvas.editor, self._canvas.look.theme, self)
        self._take_rows()
        self._rows.set_awake(self.isVisible())
        self._on_page_changed(self._canvas.page_layout.page)

    def showEvent(self, event: QShowEvent) -> None:
        """Follow the program while somebody looks; unfold a page that is seen the first time."""
        super().showEvent(event)
        self._rows.set_awake(True)
        if self._is_new_page:
            self._on_page_changed(self._canvas.page_layout.page)

    def hideEvent(self, event: QHideEvent) -> None:
        """Rest when nobody looks."""
        super().hideEvent(event)
        self._rows.set_awake(False)

    def _take_rows(self) -> None:
        self.setModel(self._rows)
        self._rows.modelReset.connect(self._on_rows_reset)
        self.selectionModel().currentChanged.connect(self._on_current_changed)
        if self._empty is not None:
            self._empty.follow()

    def _on_rows_reset(self) -> None:
        """Unfold the rows again that were unfolded, and go back to the block of the canvas."""
        for block_id in list(self._unfolded):
            self.expand(self._rows.index_of(block_id))
        self._on_selection_changed()

    def _on_page_changed(self, page: str) -> None:
        self._rows.show_page(page)
        self._is_new_page = not self._rows.is_awake
        self.expandToDepth(0)

    def _on_current_changed(self, current: QModelIndex, before: QModelIndex) -> None:
        block_id = current.data(BLOCK)
        if self._is_following or not block_id:
            return
        self._is_following = True
        self._canvas.show_block(block_id)
        self._canvas.selection.set([block_id])
        self._is_following = False

    def _on_activated(self, index: QModelIndex) -> None:
        """Enter: go on with this block on the canvas."""
        self._canvas.area.setFocus()

    def _on_selection_changed(self) -> None:
        if self._is_following or not self._rows.is_awake:
            return
        index = self._rows.index_of(self._canvas.selection.cursor)
        if index.isValid() and index != self.currentIndex():
            self._is_following = True
            flag = QItemSelectionModel.SelectionFlag.ClearAndSelect
            self.selectionModel().setCurrentIndex(index, flag)
            self.scrollTo(index)
            self._is_following = False
