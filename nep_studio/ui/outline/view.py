"""The outline beside the canvas: choose a row, and the canvas shows its block."""

from __future__ import annotations

from PySide6.QtCore import QItemSelectionModel, QModelIndex
from PySide6.QtWidgets import QAbstractItemView, QTreeView, QWidget

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.words import tr

from .model import BLOCK, OutlineModel


class Outline(QTreeView):
    """The blocks of the canvas's page as a tree; both show the same block."""

    def __init__(self, canvas: Canvas, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self._rows = OutlineModel(canvas.editor, canvas.theme, self)
        self._is_following = False
        self._unfolded: set[str] = set()
        self._take_rows()
        self.setHeaderHidden(True)
        self.setUniformRowHeights(True)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setAccessibleName(tr("Outline"))
        self.expanded.connect(lambda index: self._unfolded.add(index.data(BLOCK)))
        self.collapsed.connect(lambda index: self._unfolded.discard(index.data(BLOCK)))
        self.activated.connect(self._on_activated)
        canvas.page_changed.connect(self._on_page_changed)
        canvas.selection.changed.connect(self._on_selection_changed)
        self._on_page_changed(canvas.page)

    def refresh(self) -> None:
        """Follow another project, another theme or another language of the canvas."""
        self._rows.close()
        self._rows.deleteLater()
        self._rows = OutlineModel(self._canvas.editor, self._canvas.theme, self)
        self._take_rows()
        self._on_page_changed(self._canvas.page)

    def _take_rows(self) -> None:
        self.setModel(self._rows)
        self._rows.modelReset.connect(self._on_rows_reset)
        self.selectionModel().currentChanged.connect(self._on_current_changed)

    def _on_rows_reset(self) -> None:
        """Unfold the rows again that were unfolded, and go back to the block of the canvas."""
        for block_id in list(self._unfolded):
            self.expand(self._rows.index_of(block_id))
        self._on_selection_changed()

    def _on_page_changed(self, page: str) -> None:
        self._rows.show_page(page)
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
        self._canvas.setFocus()

    def _on_selection_changed(self) -> None:
        if self._is_following:
            return
        index = self._rows.index_of(self._canvas.selection.cursor)
        if index.isValid() and index != self.currentIndex():
            self._is_following = True
            flag = QItemSelectionModel.SelectionFlag.ClearAndSelect
            self.selectionModel().setCurrentIndex(index, flag)
            self.scrollTo(index)
            self._is_following = False
