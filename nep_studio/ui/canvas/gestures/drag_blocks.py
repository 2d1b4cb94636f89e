"""Carry blocks: they follow the pointer, snap where they fit, and land where they are let go."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt

from nep_studio.blocks.operations.enclosing import without_hat
from nep_studio.blocks.operations.selection import Run, runs
from nep_studio.blocks.places import InBody, InInput, InStack
from nep_studio.ui.words import count_words, tr

from ..layout import Gap
from ..snapping import Ground, Snap, Target, search
from ..sprite import make_sprite
from .auto_scroll import AutoScroll
from .cargo import Cargo, bounds_of
from .gesture import Pointer
from .landing import land

if TYPE_CHECKING:
    from ..canvas import Canvas

LARGEST_GAP = 0.35
"""How much of the view's height a gap takes at most, however long the carried stack is."""


class DragBlocks:
    """Blocks in the hand. Nothing changes in the program until they are dropped."""

    def __init__(self, canvas: Canvas, cargo: Cargo, grabbed: QPointF) -> None:
        self.cargo = cargo
        self.snap = Snap()
        self.is_over_delete_area = False
        self._grabbed = grabbed
        self._reasons: dict[tuple[object, str], str | None] = {}
        self._run = _selected_run(canvas, cargo)
        self._last = Pointer(canvas.camera.to_view(grabbed.x(), grabbed.y()), grabbed)
        canvas.set_sprite(make_sprite(canvas, cargo.chains, cargo.bounds, grabbed))
        assert canvas.sprite is not None
        self._corner = canvas.sprite.x, canvas.sprite.y
        canvas.set_preview(cargo.hidden, None)
        self._ends = cargo.ends
        self._ground = Ground(canvas.page_layout)
        self._page_reason = cargo.why_not_on_page(canvas) or ""
        self._scroll = AutoScroll(canvas, canvas.pointing.repeat)
        canvas.viewport().setCursor(Qt.CursorShape.ClosedHandCursor)

    def move(self, canvas: Canvas, pointer: Pointer) -> None:
        """Bring the blocks along, and show where they would go."""
        self._last = pointer
        dx, dy = self._way(pointer)
        canvas.move_sprite(self._corner[0] + dx, self._corner[1] + dy)
        place = canvas.viewport().mapToGlobal(pointer.view.toPoint())
        self._show_delete_area(canvas, canvas.delete_area(place))
        snap = Snap() if self.is_over_delete_area else self._search(canvas, dx, dy)
        if snap != self.snap:
            self._show(canvas, snap)
        canvas.bubble.say(self._words(), pointer.view.toPoint())
        canvas.floating.follow(canvas, pointer.view)
        self._scroll.follow(pointer.view, is_resting=self.is_over_delete_area)

    def release(self, canvas: Canvas, pointer: Pointer) -> None:
        """Drop the blocks where they are shown."""
        if pointer.view != self._last.view:
            self.move(canvas, pointer)
        dx, dy = self._way(pointer)
        self._end(canvas)
        is_inside = canvas.viewport().rect().contains(pointer.view.toPoint())
        if self.is_over_delete_area or not (is_inside or self.cargo.hidden):
            canvas.throw_away(self.cargo)  # new blocks that never came in are let go too
        elif self._page_reason and self.snap.target is None:
            canvas.refused.emit(self._page_reason)
        else:
            land(canvas, self.cargo, self.snap, dx, dy)

    def cancel(self, canvas: Canvas) -> None:
        """Show the page as it was: nothing has changed."""
        self._end(canvas)

    def _search(self, canvas: Canvas, dx: float, dy: float) -> Snap:
        return search(
            self._ground,
            self._ends.moved(dx, dy),
            lambda target: self._why_not(canvas, target),
            scale=canvas.camera.scale,
            current=self.snap.target,
            run=self._run,
        )

    def _why_not(self, canvas: Canvas, target: Target) -> str | None:
        """Why the blocks do not fit; asked once for each place."""
        key = (target.place, target.join)
        if key not in self._reasons:
            self._reasons[key] = self.cargo.why_not(canvas, target)
        return self._reasons[key]

    def _show(self, canvas: Canvas, snap: Snap) -> None:
        self.snap = snap
        gap = self._gap(canvas, snap.target) if snap.target is not None else None
        if gap is not None:
            self._ground.remember(_stack_of(canvas, gap.owner))
        canvas.set_preview(self.cargo.hidden, gap)
        canvas.drop_overlay.show(canvas, snap.target)

    def _gap(self, canvas: Canvas, target: Target) -> Gap | None:
        """Room in the chain, for blocks that go between others."""
        place = target.place
        if target.join != "below" or isinstance(place, InInput):
            return None
        rect = bounds_of(self.cargo.chains[0])
        highest = canvas.visible_page_rect().height * LARGEST_GAP
        size = min(rect.width, canvas.measures.widest), min(rect.height, highest)
        if isinstance(place, InStack):
            return Gap(place.stack, "", place.index, *size)
        assert isinstance(place, InBody)
        return Gap(place.block, place.slot, place.index, *size)

    def _show_delete_area(self, canvas: Canvas, is_over: bool) -> None:
        if is_over == self.is_over_delete_area:
            return
        self.is_over_delete_area = is_over
        shape = Qt.CursorShape.ForbiddenCursor if is_over else Qt.CursorShape.ClosedHandCursor
        canvas.viewport().setCursor(shape)
        canvas.delete_area_entered.emit(is_over)

    def _words(self) -> str:
        """What the bubble says."""
        if self.is_over_delete_area:
            if not self.cargo.hidden:
                return ""
            return count_words(
                self.cargo.count, "Let go to delete 1 block", "Let go to delete {n} blocks"
            )
        return "" if self.snap.target is not None else tr(self.snap.reason or self._page_reason)

    def _way(self, pointer: Pointer) -> tuple[float, float]:
        return pointer.page.x() - self._grabbed.x(), pointer.page.y() - self._grabbed.y()

    def _end(self, canvas: Canvas) -> None:
        self._scroll.end()
        canvas.bubble.hide()
        canvas.floating.hide()
        canvas.drop_overlay.show(canvas, None)
        canvas.set_sprite(None)
        canvas.set_preview(frozenset(), None)
        canvas.viewport().unsetCursor()
        if self.is_over_delete_area:
            canvas.delete_area_entered.emit(False)


def _selected_run(canvas: Canvas, cargo: Cargo) -> Run | None:
    """Selected blocks that a carried C block can go around: one run, and not carried itself."""
    selected = canvas.selection.ids
    if cargo.ends.mouth is None or not selected or not cargo.hidden.isdisjoint(selected):
        return None
    chosen = runs(canvas.editor.project, selected)
    return without_hat(canvas.editor, chosen[0]) if len(chosen) == 1 else None


def _stack_of(canvas: Canvas, owner: str) -> str:
    project = canvas.editor.project
    return owner if owner in project.stacks else project.stack_of(owner).id
