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
        self._ids: dict[str, None] = {}
        self._cursor = ""

    def __contains__(self, block_id: str) -> bool:
        return block_id in self._ids

    def __len__(self) -> int:
        return len(self._ids)

    @property
    def ids(self) -> tuple[str, ...]:
        """The selected blocks."""
        return tuple(self._ids)

    @property
    def cursor(self) -> str:
        """The block that the keyboard is at; empty when there is none."""
        return self._cursor

    def set(self, ids: Iterable[str], cursor: str | None = None) -> None:
        """Select these blocks and no others; the cursor goes to the last, or where it is said."""
        new = dict.fromkeys(ids)
        at = cursor if cursor is not None else next(reversed(new), "")
        if list(new) == list(self._ids) and at == self._cursor:
            return
        self._ids, self._cursor = new, at
        self.changed.emit()

    def toggle(self, block_id: str) -> None:
        """Add a block to the selection, or take it out."""
        ids = [i for i in self._ids if i != block_id]
        self.set(ids if block_id in self._ids else [*ids, block_id], block_id)

    def clear(self) -> None:
        """Select nothing."""
        self.set((), "")

    def keep(self, known: Container[str]) -> None:
        """Drop the blocks that are not there any more."""
        if self._ids or self._cursor:
            cursor = self._cursor if self._cursor in known else ""
            self.set([i for i in self._ids if i in known], cursor)
