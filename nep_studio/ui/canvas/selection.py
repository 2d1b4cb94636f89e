"""Which blocks are selected, and which one the keyboard is at."""

from __future__ import annotations

from collections.abc import Container, Iterable

from PySide6.QtCore import QObject, Signal


class Selection(QObject):
    """Blocks in the order in which they were selected; ``cursor`` is the keyboard's block.

    Selecting a block means the block itself with what is inside it.
    """

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.ids: tuple[str, ...] = ()
        """The selected blocks."""
        self.cursor = ""
        """The block that the keyboard is at; empty when there is none."""
        self._known: frozenset[str] = frozenset()

    def __contains__(self, block_id: str) -> bool:
        return block_id in self._known

    def set(self, ids: Iterable[str], cursor: str | None = None) -> None:
        """Select these blocks and no others; the cursor goes to the last, or where it is said."""
        new = tuple(dict.fromkeys(ids))
        at = cursor if cursor is not None else (new[-1] if new else "")
        if new == self.ids and at == self.cursor:
            return
        self.ids, self.cursor, self._known = new, at, frozenset(new)
        self.changed.emit()

    def toggle(self, block_id: str) -> None:
        """Add a block to the selection, or take it out."""
        ids = [i for i in self.ids if i != block_id]
        self.set(ids if block_id in self.ids else [*ids, block_id], block_id)

    def clear(self) -> None:
        """Select nothing."""
        self.set((), "")

    def keep(self, known: Container[str]) -> None:
        """Drop the blocks that are not there any more."""
        if self.ids or self.cursor:
            cursor = self.cursor if self.cursor in known else ""
            self.set([i for i in self.ids if i in known], cursor)
