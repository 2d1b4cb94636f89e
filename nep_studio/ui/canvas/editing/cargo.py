"""What a person carries: blocks of the page, or new ones from elsewhere."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property, reduce
from typing import TYPE_CHECKING

from faults import Text
from nep_studio.blocks.operations.copying import Clip, delete, paste
from nep_studio.blocks.operations.moving import (
    Carried,
    create_and_drop,
    drop,
    enclose,
    move_by,
    pick_up,
    why_not_create,
    why_not_drop,
    why_not_enclose,
)
from nep_studio.blocks.operations.selection import members
from nep_studio.ui.canvas.layout.boxes import Box, Chain, Piece
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.canvas.layout.page import bounds_of

from .snapping import Ends, Point, Target, ends_of

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


class Cargo(ABC):
    """Blocks that are carried: how they look, where they fit, what a drop does.

    ``chains`` are laid out where the blocks were picked up; ``hidden`` are the blocks that the
    page does not show meanwhile.
    """

    chains: list[Chain]
    hidden: frozenset[str] = frozenset()

    @cached_property
    def bounds(self) -> Rect:
        """The rectangle around all of it, where it was picked up."""
        rects = (bounds_of(chain, chain.x, chain.y) for chain in self.chains)
        return reduce(Rect.united, rects)

    @cached_property
    def ends(self) -> Ends:
        """Where it can be joined to others: nowhere when it is several stacks."""
        return ends_of(self.chains[0]) if len(self.chains) == 1 else Ends()

    @property
    def count(self) -> int:
        """How many blocks it is, without those inside them."""
        return sum(len(chain.boxes) for chain in self.chains)

    @abstractmethod
    def why_not(self, canvas: CanvasHost, target: Target) -> Text | None:
        """Why it does not fit into a place, or None when it does."""

    @abstractmethod
    def why_not_on_page(self, canvas: CanvasHost) -> Text | None:
        """Why it cannot lie on the page that is shown, or None when it can."""

    @abstractmethod
    def join(
        self, canvas: CanvasHost, target: Target, beside: Point, at: Point | None
    ) -> list[str]:
        """Drop it into a place, as one step; gives the blocks to select. Raises EditRefused."""

    @abstractmethod
    def put(self, canvas: CanvasHost, dx: float, dy: float) -> list[str]:
        """Drop it on the page, so far from where it was picked up; gives the blocks to select."""

    @abstractmethod
    def throw_away(self, canvas: CanvasHost) -> Clip | None:
        """Drop it where blocks are deleted; gives what was deleted of the program."""


class PickedUp(Cargo):
    """Blocks of the page."""

    def __init__(
        self, canvas: CanvasHost, carried: Carried, selected: Collection[str] = ()
    ) -> None:
        project, layout = canvas.editor.project, canvas.page_layout.layout
        self._carried = carried
        self._selected = list(selected) or [carried.first]
        self._at: dict[str, Point] = {}
        self.chains, hidden = [], list[str]()
        for run in carried.runs:
            blocks = members(project, run)
            chain = layout.chain(blocks, shown=True)
            chain.x, chain.y = _corner(canvas, run.first)
            self._at[run.first] = chain.x, chain.y
            self.chains.append(chain)
            hidden += blocks
        self.hidden = frozenset(hidden)

    def why_not(self, canvas: CanvasHost, target: Target) -> Text | None:
        """Why it does not fit into a place, or None when it does."""
        if target.run is not None:
            block_type = canvas.editor.project.blocks[self._carried.first].type
            return why_not_enclose(canvas.editor, block_type, target.run)
        return why_not_drop(canvas.editor, self._carried, target.place, wrap=target.is_around)

    def why_not_on_page(self, canvas: CanvasHost) -> Text | None:
        """Blocks of a page can lie on it."""
        return None

    def join(
        self, canvas: CanvasHost, target: Target, beside: Point, at: Point | None
    ) -> list[str]:
        """Move the blocks into a place."""
        editor, wrap = canvas.editor, target.is_around
        if target.run is not None:
            enclose(editor, self._carried.first, target.run)
        else:
            drop(editor, self._carried, target.place, wrap=wrap, beside=beside, at=at)
        return self._selected

    def put(self, canvas: CanvasHost, dx: float, dy: float) -> list[str]:
        """Move the blocks on their page."""
        move_by(canvas.editor, self._carried.runs, dx, dy, self._at)
        return self._selected

    def throw_away(self, canvas: CanvasHost) -> Clip | None:
        """Delete the blocks."""
        return delete(canvas.editor, self.hidden)


@dataclass(frozen=True, slots=True)
class Grip:
    """Where a block was taken hold of: a point of a box that shows it, from its left upper corner.

    That box may be smaller than the block on the canvas, and its sentence in other rows.
    """

    box: Box
    x: float
    y: float

    def on(self, box: Box) -> Point:
        """The same point of the block where it is laid out as ``box``."""
        held = next((piece for piece in self.box.pieces if piece.holds(self.x, self.y)), None)
        for piece in box.pieces:
            if held is not None and _is_same(piece, held):
                x = piece.x + (self.x - held.x) * piece.width / held.width
                return x, piece.y + (self.y - held.y) * piece.height / held.height
        share_x, share_y = self.x / self.box.width, self.y / self.box.height
        return min(max(share_x, 0.0), 1.0) * box.width, min(max(share_y, 0.0), 1.0) * box.height


def _is_same(piece: Piece, other: Piece) -> bool:
    """Whether two layouts of a block show the same in these pieces."""
    words = piece.text == other.text or piece.piece != "words"
    return words and (piece.piece, piece.key, piece.kind) == (other.piece, other.key, other.kind)


class NewBlocks(Cargo):
    """Blocks that are not in the program yet: from the palette, or copies."""

    def __init__(
        self, canvas: CanvasHost, clip: Clip, at: Point, *, grip: Grip | None = None
    ) -> None:
        """Hold the blocks with their corner at ``at``, or where they were taken hold of there."""
        self._clip = clip
        project = clip.project
        self.layout = Layout(project, canvas.editor.language.of(project), canvas.look.measures)
        left, top = clip.corner
        self.chains = []
        for stack in clip.stacks:
            chain = self.layout.chain(stack.body)
            chain.x, chain.y = at[0] + stack.x - left, at[1] + stack.y - top
            self.chains.append(chain)
        self._at = at
        if grip is not None:
            # Shift the blocks so that the point of the first one that is held is at ``at``
            box = self.chains[0].boxes[0]
            x, y = grip.on(box)
            dx, dy = (box.width - x if box.is_mirrored else -x), -y
            for chain in self.chains:
                chain.x, chain.y = chain.x + dx, chain.y + dy
            self._at = self._at[0] + dx, self._at[1] + dy

    def why_not(self, canvas: CanvasHost, target: Target) -> Text | None:
        """Why it does not fit into a place, or None when it does."""
        if target.run is not None:
            block_type = self._clip.project.blocks[self._clip.roots[0][0]].type
            return why_not_enclose(canvas.editor, block_type, target.run)
        return why_not_create(canvas.editor, self._clip, target.place, wrap=target.is_around)

    def why_not_on_page(self, canvas: CanvasHost) -> Text | None:
        """Why blocks of another page cannot lie on this one."""
        place = canvas.editor.new_stack(canvas.page_layout.page, 0, 0)
        single = len(self._clip.stacks) == 1
        return why_not_create(canvas.editor, self._clip, place) if single else None

    def join(
        self, canvas: CanvasHost, target: Target, beside: Point, at: Point | None
    ) -> list[str]:
        """Make the blocks in a place."""
        editor, clip, wrap = canvas.editor, self._clip, target.is_around
        if target.run is None:
            new = create_and_drop(editor, clip, target.place, wrap=wrap, beside=beside, at=at)
            return [new[0]]
        with editor.transaction("add blocks"):
            [first] = create_and_drop(
                editor, clip, editor.new_stack(canvas.page_layout.page, *beside)
            )
            enclose(editor, first, target.run)
        return [first]

    def put(self, canvas: CanvasHost, dx: float, dy: float) -> list[str]:
        """Make the blocks on the page."""
        x, y = self._at[0] + dx, self._at[1] + dy
        return list(paste(canvas.editor, self._clip, canvas.page_layout.page, x, y))

    def throw_away(self, canvas: CanvasHost) -> Clip | None:
        """Let them go: they have never been in the program."""
        return None


def lift(canvas: CanvasHost, block: str, *, alone: bool = False) -> PickedUp:
    """Pick up a block with all below it, or alone, or the selection that it is one of."""
    selected = canvas.selection.ids if block in canvas.selection and not alone else ()
    if len(selected) == 1:
        selected = ()
    carried = pick_up(canvas.editor.project, block, alone=alone, selected=selected)
    return PickedUp(canvas, carried, selected)


def _corner(canvas: CanvasHost, block: str) -> Point:
    """Where a chain begins on the page whose first block this is."""
    placed = canvas.page_layout.placed(block)
    if placed is None:  # on another page, or inside a collapsed block
        stack = canvas.editor.project.stack_of(block)
        return stack.x, stack.y
    x = placed.x + placed.box.width if placed.box.is_mirrored else placed.x
    return x, placed.y
