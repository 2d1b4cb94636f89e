"""The blocks at which a program is to pause."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QObject, Signal

from nep_studio.blocks.generate.source_map import Code


class Breakpoints(QObject):
    """Ids of statement blocks; a block that is deleted is simply not met any more."""

    changed = Signal()

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.ids: frozenset[str] = frozenset()

    def toggle(self, blocks: Iterable[str]) -> None:
        """Pause at these blocks, or, if all of them are known already, no longer."""
        wanted = frozenset(blocks)
        self._set(self.ids - wanted if wanted <= self.ids else self.ids | wanted)

    def clear(self) -> None:
        """Pause nowhere."""
        self._set(frozenset())

    def lines(self, code: Code) -> tuple[int, ...]:
        """The lines of a program before which it pauses."""
        return tuple(sorted({line for block in self.ids if (line := code.stop_at(block))}))

    def _set(self, ids: frozenset[str]) -> None:
        if ids != self.ids:
            self.ids = ids
            self.changed.emit()
