"""Walk from block to block with the keyboard; what is arrived at is selected, shown and told."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from nep_studio.blocks.program import Project

from ..accessibility.descriptions import described, position
from . import navigation
from .carrying import reading_order

if TYPE_CHECKING:
    from ..canvas import Canvas

Way = Callable[[Project, Sequence[str], str], str]
"""From a block to another one, given the stacks in the order of reading."""


class Walk:
    """The cursor of one canvas."""

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas
        self._anchor = ""

    def cursor(self) -> str:
        """The block that the keyboard is at, when the page shows it."""
        canvas = self._canvas
        cursor = canvas.selection.cursor
        if cursor in canvas.editor.project.blocks and canvas.page_layout.placed(cursor):
            return cursor
        return ""

    def _first(self) -> str:
        stacks = reading_order(self._canvas)
        return self._canvas.editor.project.stacks[stacks[0]].body[0] if stacks else ""

    def go(self, way: Way) -> None:
        """Go one block further."""
        cursor, project = self.cursor(), self._canvas.editor.project
        if not cursor:
            self._arrive(self._first())
        else:
            self._arrive(way(project, reading_order(self._canvas), cursor))

    def sideways(self, step: int) -> None:
        """Go into the block (1, to the right) or out of it; the other way round when mirrored."""
        is_inward = (step > 0) != self._canvas.measures.is_mirrored
        way = navigation.inward if is_inward else navigation.outward
        cursor = self.cursor()
        self._arrive(way(self._canvas.editor.project, cursor) if cursor else self._first())

    def go_to_end(self, index: int) -> None:
        """Go to the first (0) or the last (-1) block of the stack."""
        cursor = self.cursor()
        if cursor:
            self._arrive(self._canvas.editor.project.stack_of(cursor).body[index])

    def go_to_stack(self, index: int) -> None:
        """Go to the first (0) or the last (-1) stack of the page."""
        stacks = reading_order(self._canvas)
        if stacks:
            self._arrive(self._canvas.editor.project.stacks[stacks[index]].body[0])

    def extend(self, way: Way) -> None:
        """Stretch the selection from where it began to the next block."""
        canvas, cursor = self._canvas, self.cursor()
        if not cursor:
            return
        if len(canvas.selection) <= 1 or self._anchor not in canvas.selection:
            self._anchor = navigation.statement_of(canvas.editor.project, cursor)
        stacks = reading_order(canvas)
        target = way(canvas.editor.project, stacks, cursor)
        blocks = navigation.between(canvas.editor.project, stacks, self._anchor, target)
        canvas.selection.set(blocks, target)
        canvas.show_block(target)

    def _arrive(self, block_id: str) -> None:
        canvas = self._canvas
        if not block_id:
            return
        canvas.selection.set([block_id])
        canvas.show_block(block_id)
        told = described(canvas.editor, block_id)
        canvas.announced.emit(f"{told}. {position(canvas.editor.project, block_id)}")
