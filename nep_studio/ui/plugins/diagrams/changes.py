"""What a person does to the program on a diagram: each is one step of the editor's history."""

from __future__ import annotations

from collections.abc import Callable

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.operations import states
from nep_studio.blocks.operations.copying import clip_of
from nep_studio.blocks.operations.moving import GAP, Box, Point, pushed_apart
from nep_studio.blocks.states import BEGINS, DONE
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.workbench.placing import free_place


class Changes:
    """Changes the program that a canvas shows; new blocks go where there is room for them.

    Each raises EditRefused, with nothing changed, and gives the block that is to be shown.
    """

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas

    @property
    def _editor(self) -> Editor:
        return self._canvas.editor

    def free_name(self, machine: str) -> str:
        """What a new state may be called."""
        return states.free_state_name(self._editor, machine)

    def add_state(self, name: str, machine: str, near: str = "") -> str:
        """Add a state, below the block ``near`` if one is given."""
        page, at = self._place(BEGINS, near)
        return states.add_state(self._editor, name, machine, page, at)

    def add_arrow(self, start: str, end: str, machine: str, near: str = "") -> str:
        """Let the program go from a state to another one when all is done."""
        page, at = self._place(DONE, near)
        return states.add_arrow(self._editor, start, end, machine, page, at)

    def add_tree(self) -> str:
        """Begin a behaviour tree."""
        page, at = self._place(states.TREE, "")
        return states.add_tree(self._editor, page, at)

    def rename_state(self, machine: str, old: str, new: str) -> None:
        """Give a state another name, everywhere."""
        states.rename_state(self._editor, machine, old, new)

    def delete_arrow(self, block: str) -> Callable[[], None]:
        """What deletes an arrow."""
        return lambda: states.delete_arrow(self._editor, block)

    def delete_state(self, machine: str, name: str) -> Callable[[], None]:
        """What deletes a state with its arrows."""
        return lambda: states.delete_state(self._editor, machine, name)

    def _place(self, block_type: str, near: str) -> tuple[str, Point]:
        """A page and a free place on it: below the stack of a block, else where one looks."""
        canvas, project = self._canvas, self._editor.project
        is_near = near in project.blocks
        page = project.page_of(near) if is_near else canvas.page
        if project.kind_of_page(page) != "behaviour":
            page = "behaviour"
        if page != canvas.page:
            canvas.show_page(page)
        clip = clip_of(self._editor.language, block_type)
        if not is_near:
            place = free_place(canvas, clip)
            return page, (place.x(), place.y())
        measures = canvas.look.measures
        layout = Layout(clip.project, self._editor.language.of(clip.project), measures)
        chain = layout.chain(clip.roots[0])
        rects = canvas.page_layout.index.rects
        stack = rects[project.stack_of(near).id]
        wanted = Box(stack.x, stack.y + stack.height + GAP, chain.width, chain.height)
        others = [Box(one.x, one.y, one.width, one.height) for one in rects.values()]
        found = pushed_apart(wanted, others)
        return page, (found.x + (found.width if measures.is_mirrored else 0.0), found.y)
