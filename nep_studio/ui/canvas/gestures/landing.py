"""Drop carried blocks: into the place that is shown, or where they lie on the page."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from nep_studio.blocks.operations.bump import bumped
from nep_studio.blocks.operations.spacing import GAP
from nep_studio.blocks.operations.spacing import Box as PageBox
from nep_studio.blocks.places import InStack
from nep_studio.blocks.program import FARTHEST

from ..boxes import Chain
from ..index import Rect
from ..snapping import Point, Snap, Target
from .cargo import Cargo

if TYPE_CHECKING:
    from ..canvas import Canvas

LEAST_SEEN_PX = 48.0
"""How much of dropped blocks is inside the view at least, so that they are not lost."""

BESIDE = 30.0
"""How far below and beside the dropped blocks those are put that were pushed out."""


def land(canvas: Canvas, cargo: Cargo, snap: Snap, dx: float, dy: float) -> None:
    """Drop the blocks, as one step, and select them; the canvas says it when that is refused."""
    if (target := snap.target) is not None:
        beside, at = _beside(cargo, dx, dy), _new_top(cargo, target)
        _do(canvas, lambda: cargo.join(canvas, target, beside, at))
        return
    dx, dy = _into_view(canvas, cargo.bounds, dx, dy)
    if snap.reason or _lies_on_blocks(canvas, cargo.chains[0], dx, dy):
        dx, dy = _bumped(canvas, cargo.bounds, dx, dy)
    if dx or dy or not cargo.hidden:
        _do(canvas, lambda: cargo.put(canvas, dx, dy))
    if snap.reason:
        canvas.refused.emit(snap.reason)


def _do(canvas: Canvas, drop: Callable[[], list[str]]) -> None:
    """Drop, and select what was dropped."""
    dropped: list[str] = []
    if canvas.attempt(lambda: dropped.extend(drop())):
        canvas.selection.set(dropped, dropped[0])


def _beside(cargo: Cargo, dx: float, dy: float) -> Point:
    """Where blocks go that are pushed out: beside the dropped ones."""
    chain = cargo.chains[0]
    side = -1 if chain.is_mirrored else 1
    return chain.x + dx + side * (chain.width + BESIDE), chain.y + dy + BESIDE


def _new_top(cargo: Cargo, target: Target) -> Point | None:
    """Where a stack begins that gets new blocks on top, so that its old ones stay in place."""
    place, chain = target.place, cargo.chains[0]
    if not isinstance(place, InStack) or place.index > 0:
        return None
    x, y = target.x, target.y
    if target.join == "above":
        y -= chain.height
    else:
        mouth = cargo.ends.mouth
        assert mouth is not None
        x, y = x - (mouth[0] - chain.x), y - (mouth[1] - chain.y)
    return _within(x), _within(y)


def _into_view(canvas: Canvas, bounds: Rect, dx: float, dy: float) -> Point:
    """The way, changed so that the beginning of the blocks is in the view, and on the page."""
    seen = canvas.visible_page_rect()
    least = LEAST_SEEN_PX / canvas.camera.scale
    x, y = bounds.x + dx, bounds.y + dy
    if canvas.measures.is_mirrored:
        right = min(max(bounds.right + dx, seen.x + least), seen.right)
        x = right - bounds.width
    else:
        x = min(max(x, seen.x), seen.right - least)
    y = min(max(y, seen.y), seen.bottom - least)
    return _within(x) - bounds.x, _within(y) - bounds.y


def _lies_on_blocks(canvas: Canvas, chain: Chain, dx: float, dy: float) -> bool:
    """Whether the first dropped block would cover others."""
    box = chain.boxes[0]
    x = chain.x - box.width if chain.is_mirrored else chain.x
    head = Rect(x + dx, chain.y + dy, box.width, box.height)
    return any(
        placed.rect.touches(head) and placed.box.block for placed in canvas.page_layout.boxes(head)
    )


def _bumped(canvas: Canvas, bounds: Rect, dx: float, dy: float) -> Point:
    """The way, changed so that the blocks lie clear of all stacks."""
    layout = canvas.page_layout
    box = PageBox(bounds.x + dx, bounds.y + dy, bounds.width, bounds.height)
    while True:  # each round goes right or down past the stacks that are near, and never back
        near = layout.near(Rect(*box).grown(GAP))  # laid out: where they wait they seem larger
        clear = bumped(box, {stack: PageBox(*layout.index.rect(stack)) for stack in near})
        if clear is None:
            return box.x - bounds.x, box.y - bounds.y
        box = box._replace(x=clear[0], y=clear[1])


def _within(length: float) -> float:
    return min(max(length, -FARTHEST), FARTHEST)
