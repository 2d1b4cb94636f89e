"""A stack that grows pushes away what it would cover, as a part of the step that made it grow."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.blocks.edits.project import MoveStack
from nep_studio.blocks.operations.moving import NEAREST, Box, make_way
from nep_studio.blocks.program import FARTHEST
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import MOST_STACKS_AT_ONCE

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

LEAST_GROWN = 0.5
"""A stack that is hardly larger, in canvas units, has not grown."""


class MakingWay:
    """Called at the end of each step of the program that one canvas shows.

    The page is still laid out as before the step then. Only what is shown is known: on another
    page nothing moves, nor when a step changed very much, such as a whole program in Python.
    """

    def __init__(self, canvas: CanvasHost) -> None:
        self._canvas = canvas

    def __call__(self) -> None:
        """Let the stacks that have grown in this step push others away."""
        canvas, changes = self._canvas, self._canvas.editor.project.changes
        is_too_much = changes.whole or len(changes.stacks) > MOST_STACKS_AT_ONCE
        if is_too_much or len(canvas.page_layout.chains) < 2:
            return
        grown = self._grown(changes.stacks, changes.owners)
        if not any(self._is_near_others(stack, box) for stack, box in grown.items()):
            return
        side = -1 if canvas.look.measures.is_mirrored else 1
        for stack, box in make_way(self._before() | _old(grown, canvas), grown).items():
            x, y = (min(max(length, -FARTHEST), FARTHEST) for length in (side * box.x, box.y))
            canvas.editor.apply(MoveStack(stack, x, y))

    def _grown(self, stacks: set[str], owners: set[str]) -> dict[str, Box]:
        """The stacks that are larger than they were, with the room that they take now."""
        project, layout = self._canvas.editor.project, self._canvas.page_layout
        layout.layout.forget(owners)
        grown = {}
        for stack_id in stacks & layout.index.rects.keys():
            stack, was = project.stacks.get(stack_id), layout.index.rects[stack_id]
            if stack is None or stack_id in layout.chains.waiting:
                continue
            chain = layout.layout.chain(stack.body, owner=stack_id)
            height = chain.height + layout.layout.measures.notch_depth
            if max(height - was.height, chain.width - was.width) > LEAST_GROWN:
                grown[stack_id] = self._box(stack.x, stack.y, chain.width, height)
        return grown

    def _is_near_others(self, stack_id: str, box: Box) -> bool:
        """Whether a stack that has grown touches another one."""
        left = -box.x - box.width if self._canvas.look.measures.is_mirrored else box.x
        rect = Rect(left, box.y, box.width, box.height).grown(NEAREST)
        return any(other != stack_id for other in self._canvas.page_layout.index.near(rect))

    def _before(self) -> dict[str, Box]:
        """The room that each stack of the page takes which this step has not moved."""
        project, layout = self._canvas.editor.project, self._canvas.page_layout
        boxes = {}
        for stack in project.pages.get(layout.page, ()):
            if stack.id not in layout.chains or stack.id in layout.chains.waiting:
                continue
            chain, rect = layout.chains[stack.id], layout.index.rects[stack.id]
            if (chain.x, chain.y) == (stack.x, stack.y):
                boxes[stack.id] = self._box(stack.x, stack.y, rect.width, rect.height)
        return boxes

    def _box(self, x: float, y: float, width: float, height: float) -> Box:
        """A box on a page that is read from left to right."""
        return Box(-x if self._canvas.look.measures.is_mirrored else x, y, width, height)


def _old(grown: dict[str, Box], canvas: CanvasHost) -> dict[str, Box]:
    """The room that grown stacks took before, where they lay then."""
    layout = canvas.page_layout
    side = -1 if canvas.look.measures.is_mirrored else 1
    boxes = {}
    for stack in grown:
        chain, rect = layout.chains[stack], layout.index.rects[stack]
        boxes[stack] = Box(side * chain.x, chain.y, rect.width, rect.height)
    return boxes
