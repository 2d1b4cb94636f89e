"""Shows where carried blocks would go: the slot, the head of a stack, the blocks to go around."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter, QPainterPath, QPen

from nep_studio.blocks.places import InBody, InInput, InStack, Place

from ..boxes import Chain
from ..index import Rect
from ..page import Placed
from ..snapping import Target, slots

if TYPE_CHECKING:
    from ..view import PageView


class DropOverlay:
    """A mark at the target, and a veil over the block that it would push out.

    The gap between blocks is no part of it: that is laid out with the page.
    """

    def __init__(self) -> None:
        self._target: Target | None = None
        self._path = QPainterPath()
        self._pushed: Placed | None = None
        self._rect: Rect | None = None

    def show(self, view: PageView, target: Target | None) -> None:
        """Mark a target, or nothing."""
        if target is self._target:
            return
        self._update(view)
        self._target, self._rect, self._pushed = target, None, None
        self._path = QPainterPath()
        if target is not None:
            self._mark(view, target)
        self._update(view)

    def paint(self, painter: QPainter, view: PageView) -> None:
        """Draw the mark."""
        if self._target is None:
            return
        colour = view.theme.colour("snap")
        if self._pushed is not None:
            veil = view.theme.colour("canvas")
            veil.setAlphaF(0.6)
            painter.fillPath(_outline(view, self._pushed), veil)
        filling = view.theme.colour("snap")
        filling.setAlphaF(0.25)
        painter.setPen(QPen(colour, 3 * view.measures.unit))
        painter.setBrush(filling if self._target.join == "input" else Qt.BrushStyle.NoBrush)
        painter.drawPath(self._path)

    def _mark(self, view: PageView, target: Target) -> None:
        unit = view.measures.unit
        if target.join == "input":
            self._mark_slot(view, target)
        elif target.join == "above":
            self._mark_line(view, target)
        elif target.join == "around":
            self._mark_around(view, target)
        if not self._path.isEmpty():
            self._rect = _page_rect(self._path.boundingRect()).grown(4 * unit)

    def _mark_slot(self, view: PageView, target: Target) -> None:
        place = target.place
        assert isinstance(place, InInput)
        owner = view.page_layout.placed(place.block)
        rect = dict(slots(owner)).get(place.slot) if owner is not None else None
        if owner is None or rect is None:
            return
        plug = next((plug for plug in owner.box.plugs if plug.key == place.slot), None)
        if plug is not None:
            self._pushed = Placed(plug.box, owner.x + plug.x, owner.y + plug.y)
            self._path = _outline(view, self._pushed)
            return
        piece = next(piece for piece in owner.box.pieces if piece.key == place.slot)
        outline = view.block_painter.outlines.slot(piece.shape, piece.width, piece.height)
        self._path = outline.translated(rect.x, rect.y)

    def _mark_line(self, view: PageView, target: Target) -> None:
        """A line along the top of a stack."""
        width = view.measures.narrowest * (-1 if view.measures.is_mirrored else 1)
        self._path.moveTo(target.x, target.y)
        self._path.lineTo(target.x + width, target.y)

    def _mark_around(self, view: PageView, target: Target) -> None:
        """A bracket beside the blocks that would go into the mouth."""
        rect = _blocks_below(view, target)
        if rect is None:
            return
        unit, is_mirrored = view.measures.unit, view.measures.is_mirrored
        side = rect.right + 7 * unit if is_mirrored else rect.x - 7 * unit
        far = rect.x if is_mirrored else rect.right
        self._path.moveTo(far, rect.y - 3 * unit)
        self._path.lineTo(side, rect.y - 3 * unit)
        self._path.lineTo(side, rect.bottom + 5 * unit)
        self._path.lineTo(far, rect.bottom + 5 * unit)

    def _update(self, view: PageView) -> None:
        if self._rect is not None:
            view.update_page(self._rect)


def _blocks_below(view: PageView, target: Target) -> Rect | None:
    """Where the blocks are that would go into the mouth: a run, or the rest of the chain."""
    chain = _chain_at(view, target.place)
    if chain is None or not isinstance(target.place, InStack | InBody):
        return None
    first = target.place.index
    last = first + target.run.count if target.run is not None else len(chain.boxes)
    width = max(box.reach for box in chain.boxes[first:last])
    x = target.x - width if chain.is_mirrored else target.x
    return Rect(x, target.y, width, chain.ys[last] - chain.ys[first])


def _chain_at(view: PageView, place: Place) -> Chain | None:
    """The chain of a place, as it is laid out."""
    if isinstance(place, InStack):
        return view.page_layout.chains.get(place.stack)
    if not isinstance(place, InBody):
        return None
    owner = view.page_layout.placed(place.block)
    mouths = owner.box.mouths if owner is not None else []
    return next((mouth for mouth in mouths if mouth.key == place.slot), None)


def _outline(view: PageView, placed: Placed) -> QPainterPath:
    return view.block_painter.outlines.of(placed.box).translated(placed.x, placed.y)


def _page_rect(rect: QRectF) -> Rect:
    return Rect(rect.x(), rect.y(), rect.width(), rect.height())
