"""The stacks of a page as chains of boxes, each laid out when somebody first looks at it."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping

from .boxes import Chain
from .garbage import paused_garbage_collection
from .index import GridIndex, Rect
from .layout import Layout

MOST_AT_ONCE = 600
"""A page with fewer blocks is laid out at once."""


class Stacks(Mapping[str, Chain]):
    """Chains by stack, and in ``index`` where they are.

    Of a stack that is not laid out yet the index has a rectangle that is large enough, but for
    blocks very deep inside each other; ``outgrown`` are the places of those that were larger.
    """

    def __init__(self, layout: Layout) -> None:
        self.index = GridIndex()
        self.outgrown: list[Rect] = []
        self._layout = layout
        self._chains: dict[str, Chain] = {}
        self._waiting: dict[str, None] = {}

    def begin(self, stack_ids: Iterable[str]) -> None:
        """Forget all, and take these stacks."""
        self.index = GridIndex()
        self._chains.clear()
        self._waiting.clear()
        counts = {stack: self._count(stack) for stack in stack_ids}
        if sum(counts.values()) <= MOST_AT_ONCE:
            for stack in counts:
                self.lay_out(stack)
            return
        for stack, count in counts.items():
            self._wait(stack, count)

    def __getitem__(self, stack_id: str) -> Chain:
        if stack_id in self._waiting:
            self.lay_out(stack_id)
        return self._chains[stack_id]

    def __iter__(self) -> Iterator[str]:
        return iter([*self._chains, *self._waiting])

    def __len__(self) -> int:
        return len(self._chains) + len(self._waiting)

    def __contains__(self, stack_id: object) -> bool:
        return stack_id in self._chains or stack_id in self._waiting

    @property
    def is_waiting(self) -> bool:
        """Whether stacks wait to be laid out."""
        return bool(self._waiting)

    def postpone(self, stack_id: str) -> None:
        """Lay a stack out anew when somebody next looks at it."""
        self.drop(stack_id)
        self._wait(stack_id, self._count(stack_id))

    def near(self, rect: Rect) -> list[str]:
        """The stacks that touch a rectangle, all of them laid out."""
        with paused_garbage_collection():
            for stack_id in list(self.index.near(rect)):
                if stack_id in self._waiting:
                    self.lay_out(stack_id)
        return list(self.index.near(rect))

    def drop(self, stack_id: str) -> Chain | None:
        """Take a stack out; gives its chain when it was laid out."""
        self._waiting.pop(stack_id, None)
        self.index.remove(stack_id)
        return self._chains.pop(stack_id, None)

    def lay_out(self, stack_id: str) -> None:
        """Lay a stack out now; one whose blocks are all carried has no chain."""
        assumed = self.index.rect(stack_id) if stack_id in self._waiting else None
        self.drop(stack_id)
        stack, chain = self._layout.project.stacks[stack_id], self._layout.stack(stack_id)
        if not chain.boxes:
            return
        chain.x, chain.y = stack.x, stack.y
        self._chains[stack_id] = chain
        left = stack.x - (chain.width if chain.is_mirrored else 0.0)
        tab = self._layout.measures.notch_depth
        rect = Rect(left, stack.y, chain.width, chain.height + tab)
        self.index.set(stack_id, rect)
        if assumed is not None and rect.united(assumed) != assumed:
            self.outgrown.append(rect)

    def lay_out_some(self, seconds: float) -> bool:
        """Lay out stacks that wait, for so long; whether others wait still."""
        end = time.perf_counter() + seconds
        with paused_garbage_collection():
            while self._waiting and time.perf_counter() < end:
                self.lay_out(next(iter(self._waiting)))
        return bool(self._waiting)

    def lay_out_all(self) -> None:
        """Lay out all stacks that wait."""
        self.lay_out_some(float("inf"))

    def _wait(self, stack_id: str, count: int) -> None:
        self._waiting[stack_id] = None
        self.index.set(stack_id, self._enough(stack_id, count))

    def _count(self, stack_id: str) -> int:
        """How many blocks a stack has."""
        project = self._layout.project
        blocks, waiting = project.blocks, list(project.stacks[stack_id].body)
        count = 0
        while waiting:
            block = blocks[waiting.pop()]
            count += 1
            if block.inputs or block.bodies:
                waiting.extend(block.children())
        return count

    def _enough(self, stack_id: str, count: int) -> Rect:
        """A rectangle that holds a stack, however its sentences are broken into rows."""
        stack, measures = self._layout.project.stacks[stack_id], self._layout.measures
        width = 2 * measures.widest
        left = stack.x - (width if measures.is_mirrored else 0.0)
        return Rect(left, stack.y, width, (count + 2) * 2 * measures.row_height)
