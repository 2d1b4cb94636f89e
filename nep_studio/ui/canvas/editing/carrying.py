"""Carry blocks with the keyboard: the arrow keys go from place to place, Enter puts them down."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nep_studio.blocks.places import InBody, InInput, InStack, Place, place_of
from nep_studio.blocks.program import Project
from nep_studio.blocks.text import sentence
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Gap
from nep_studio.ui.canvas.painting.layers import make_sprite
from nep_studio.ui.words import tr

from .cargo import Cargo
from .gesture import Gesture
from .marks import DropOverlay
from .snapping import Target, seams, slots

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost

FREE_STEP = 32.0
"""How far an arrow key with Ctrl moves blocks that lie by themselves, in canvas units."""

EVERYWHERE = Rect(-2e6, -2e6, 4e6, 4e6)


class KeyboardCarry(Gesture):
    """Blocks in the hand of the keyboard: the mouse neither moves them nor puts them down."""

    def __init__(self, canvas: CanvasHost, cargo: Cargo, first: str) -> None:
        self._cargo = cargo
        self._target: Target | None = None
        self._dx = self._dy = 0.0
        self._overlay = DropOverlay()
        canvas.layers.show_overlay(self._overlay)
        origin = place_of(canvas.editor.project, first, 1)
        canvas.layers.set_preview(cargo.hidden, None)
        sprite = make_sprite(canvas, cargo.chains, cargo.bounds)
        canvas.layers.set_sprite(sprite)
        self._inset = sprite.x - cargo.bounds.x, sprite.y - cargo.bounds.y
        self._targets = self._reading_order(canvas)
        places = [target.place for target in self._targets]
        self._index = places.index(origin) if origin in places else -1
        canvas.news.announced.emit(
            tr("Picked up. Arrow keys choose a place, Enter puts down, Escape puts back.")
        )

    def step(self, canvas: CanvasHost, by: int) -> None:
        """Go to the next place that takes the blocks, or to the one before."""
        index = self._index + by
        while 0 <= index < len(self._targets):
            target = self._targets[index]
            if self._cargo.why_not(canvas, target) is None:
                self._index = index
                self._show(canvas, target)
                return
            index += by
        canvas.news.announced.emit(tr("There is no further place."))

    def shift(self, canvas: CanvasHost, dx: float, dy: float) -> None:
        """Let the blocks lie by themselves, and move them on the page."""
        self._target = None
        self._dx += dx * FREE_STEP
        self._dy += dy * FREE_STEP
        canvas.layers.set_preview(self._cargo.hidden, None)
        self._overlay.show(canvas, None)
        bounds = self._cargo.bounds
        self._move_sprite(canvas, bounds.x + self._dx, bounds.y + self._dy)
        canvas.news.announced.emit(tr("by itself on the page"))

    def drop(self, canvas: CanvasHost) -> None:
        """Put the blocks down where they are shown."""
        self._end(canvas)
        bounds, target = self._cargo.bounds, self._target
        made: list[str] = []

        def change() -> None:
            if target is None:
                made.extend(self._cargo.put(canvas, self._dx, self._dy))
            else:
                beside = (bounds.right + FREE_STEP, target.y)
                made.extend(self._cargo.join(canvas, target, beside, None))

        if canvas.attempt(change):
            canvas.selection.set(made)
            canvas.show_block(made[0])
            canvas.news.announced.emit(tr("Put down {place}.", place=self._told(canvas, target)))

    def cancel(self, canvas: CanvasHost) -> None:
        """Put the blocks back."""
        self._end(canvas)
        canvas.news.announced.emit(tr("Put back."))

    def _end(self, canvas: CanvasHost) -> None:
        canvas.pointing.gesture = None
        canvas.layers.set_preview(frozenset(), None)
        canvas.layers.set_sprite(None)
        self._overlay.show(canvas, None)
        canvas.layers.show_overlay(self._overlay, is_shown=False)

    def _reading_order(self, canvas: CanvasHost) -> list[Target]:
        """Every seam or slot of the page, fitting or not, in the order of reading."""
        ends, layout = self._cargo.ends, canvas.page_layout
        found: list[Target] = []
        if ends.output is not None:
            for placed in layout.boxes(EVERYWHERE):
                for key, rect in slots(placed):
                    place = InInput(placed.box.block, key)
                    found.append(Target(place, "input", rect.x, rect.y))
        for stack, chain in layout.chains.items():
            for seam in seams(stack, chain, EVERYWHERE.y, EVERYWHERE.bottom):
                if seam.is_head and ends.bottom is not None:
                    found.append(Target(seam.place, "above", seam.x, seam.y))
                elif not seam.is_head and ends.top is not None:
                    found.append(Target(seam.place, "below", seam.x, seam.y))
        order = {stack: n for n, stack in enumerate(reading_order(canvas))}
        project, side = canvas.editor.project, -1 if canvas.look.measures.is_mirrored else 1
        found.sort(key=lambda t: (order[_stack_of(project, t.place)], t.y, side * t.x))
        return found

    def _move_sprite(self, canvas: CanvasHost, x: float, y: float) -> None:
        """Show the corner of the blocks there; their picture has a margin."""
        canvas.layers.move_sprite(x + self._inset[0], y + self._inset[1])

    def _show(self, canvas: CanvasHost, target: Target) -> None:
        self._target = target
        rect = self._cargo.bounds
        gap = None
        if target.join != "input" and isinstance(target.place, InStack | InBody):
            owner = target.place.stack if isinstance(target.place, InStack) else target.place.block
            slot = "" if isinstance(target.place, InStack) else target.place.slot
            chain = self._cargo.chains[0]
            gap = Gap(owner, slot, target.place.index, chain.boxes[0].width, chain.height)
        canvas.layers.set_preview(self._cargo.hidden, gap)
        self._overlay.show(canvas, target if gap is None else None)
        canvas.sight.show_rect(Rect(target.x, target.y, min(rect.width, 300.0), 80.0))
        unit = canvas.look.measures.unit
        left = target.x - rect.width if canvas.look.measures.is_mirrored else target.x
        side = -1 if canvas.look.measures.is_mirrored else 1
        self._move_sprite(canvas, left + side * 12 * unit, target.y + 4 * unit)
        canvas.news.announced.emit(self._told(canvas, target))

    def _told(self, canvas: CanvasHost, target: Target | None) -> str:
        """A place in words: after which block, inside which one, in which slot."""
        if target is None:
            return tr("by itself on the page")
        place, project = target.place, canvas.editor.project

        def said(block: str) -> str:
            return sentence(project, canvas.editor.language, block)

        if isinstance(place, InInput):
            return tr("into the slot {slot} of {block}", slot=place.slot, block=said(place.block))
        if isinstance(place, InBody) and place.index == 0:
            return tr("first inside {block}", block=said(place.block))
        chain = _chain_at(canvas, place, self._cargo.hidden)
        index = place.index if isinstance(place, InBody | InStack) else 0
        if index == 0:
            return tr("above {block}", block=said(chain[0]))
        return tr("after {block}", block=said(chain[index - 1]))


def reading_order(canvas: CanvasHost) -> list[str]:
    """The stacks of the page from top to bottom; beside each other, as the language is read."""
    side = -1 if canvas.look.measures.is_mirrored else 1
    stacks = canvas.editor.project.pages.get(canvas.page_layout.page, [])
    return [stack.id for stack in sorted(stacks, key=lambda stack: (stack.y, side * stack.x))]


def _stack_of(project: Project, place: Place) -> str:
    if isinstance(place, InStack):
        return place.stack
    assert isinstance(place, InBody | InInput)
    return project.stack_of(place.block).id


def _chain_at(canvas: CanvasHost, place: Place, hidden: frozenset[str]) -> list[str]:
    """The blocks at a place, without those that are carried."""
    project = canvas.editor.project
    if isinstance(place, InStack):
        chain = project.stacks[place.stack].body
    else:
        assert isinstance(place, InBody)
        chain = project.blocks[place.block].bodies.get(place.slot, [])
    return [block for block in chain if block not in hidden]
