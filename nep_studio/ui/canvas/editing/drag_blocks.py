"""Carry blocks: they follow the pointer, snap where they fit, and land where they are let go."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QMimeData, QObject, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QWidget

from faults import Text
from nep_studio.blocks.errors import EditRefused, ProjectFileError
from nep_studio.blocks.operations.copying import Clip, copy, from_text
from nep_studio.blocks.operations.moving import GAP, bumped, reporter_of, without_hat
from nep_studio.blocks.operations.moving import Box as PageBox
from nep_studio.blocks.operations.selection import Run, runs
from nep_studio.blocks.places import InBody, InInput, InStack
from nep_studio.blocks.program import FARTHEST
from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Gap
from nep_studio.ui.canvas.layout.page import Hit
from nep_studio.ui.canvas.painting.layers import make_sprite
from nep_studio.ui.words import count_words, tr

from .cargo import Cargo, Grip, NewBlocks
from .gesture import TOUCH_DRAG_PX, AutoScroll, Gesture, Pointer
from .snapping import Ground, Point, Snap, Target, search

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


# Drop carried blocks: into the place that is shown, or where they lie on the page.

LEAST_SEEN_PX = 48.0
"""How much of dropped blocks is inside the view at least, so that they are not lost."""

BESIDE = 30.0
"""How far below and beside the dropped blocks those are put that were pushed out."""


def land(canvas: CanvasHost, cargo: Cargo, snap: Snap, dx: float, dy: float) -> None:
    """Drop the blocks, as one step, and select them; the canvas says it when that is refused."""
    target, dropped = snap.target, list[str]()
    if target is None:
        dx, dy = _into_view(canvas, cargo.bounds, dx, dy)
        if snap.reason or _lies_on_blocks(canvas, cargo.chains[0], dx, dy):
            dx, dy = _bumped(canvas, cargo.bounds, dx, dy)
    try:
        if target is not None:
            beside, at = _beside(cargo, dx, dy), _new_top(cargo, target)
            dropped = cargo.join(canvas, target, beside, at)
        elif dx or dy or not cargo.hidden:
            dropped = cargo.put(canvas, dx, dy)
    except EditRefused as refusal:
        canvas.news.refused.emit(refusal.sentence)
    if dropped:
        canvas.selection.set(dropped, dropped[0])
    if target is None and snap.reason:
        canvas.news.refused.emit(snap.reason)


def _into_view(canvas: CanvasHost, bounds: Rect, dx: float, dy: float) -> Point:
    """The way, changed so that the beginning of the blocks is in the view, and on the page."""
    seen = canvas.sight.visible_page_rect()
    right, bottom = seen.x + seen.width, seen.y + seen.height
    least = LEAST_SEEN_PX / canvas.sight.camera.scale
    if canvas.look.measures.is_mirrored:
        x = min(max(bounds.right + dx, seen.x + least), right) - bounds.width
    else:
        x = min(max(bounds.x + dx, seen.x), right - least)
    y = min(max(bounds.y + dy, seen.y), bottom - least)
    x, y = (min(max(length, -FARTHEST), FARTHEST) for length in (x, y))
    return x - bounds.x, y - bounds.y


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
    x, y = (min(max(length, -FARTHEST), FARTHEST) for length in (x, y))
    return x, y


def _lies_on_blocks(canvas: CanvasHost, chain: Chain, dx: float, dy: float) -> bool:
    """Whether the first dropped block would cover others."""
    box = chain.boxes[0]
    x = chain.x - box.width if chain.is_mirrored else chain.x
    head = Rect(x + dx, chain.y + dy, box.width, box.height)
    return any(
        placed.rect.touches(head) and placed.box.block for placed in canvas.page_layout.boxes(head)
    )


def _bumped(canvas: CanvasHost, bounds: Rect, dx: float, dy: float) -> Point:
    """The way, changed so that the blocks lie clear of all stacks."""
    layout = canvas.page_layout
    box = PageBox(bounds.x + dx, bounds.y + dy, bounds.width, bounds.height)
    while True:  # each round goes right or down past the stacks that are near, and never back
        near = layout.near(Rect(*box).grown(GAP))  # laid out: where they wait they seem larger
        clear = bumped(box, {stack: PageBox(*layout.index.rects[stack]) for stack in near})
        if clear is None:
            return box.x - bounds.x, box.y - bounds.y
        box = box._replace(x=clear[0], y=clear[1])


LARGEST_GAP = 0.35
"""How much of the view's height a gap takes at most, however long the carried stack is."""


class DragBlocks(Gesture):
    """Blocks in the hand. Nothing changes in the program until they are dropped."""

    def __init__(self, canvas: CanvasHost, cargo: Cargo, grabbed: QPointF) -> None:
        self.cargo = cargo
        self.snap = Snap()
        self.is_over_delete_area = False
        self._grabbed = grabbed
        self._reasons: dict[tuple[object, str], Text | None] = {}
        self._run = _selected_run(canvas, cargo)
        self._last = Pointer(canvas.sight.camera.to_view(grabbed.x(), grabbed.y()), grabbed)
        sprite = make_sprite(canvas, cargo.chains, cargo.bounds, grabbed)
        canvas.layers.set_sprite(sprite)
        self._corner = sprite.x, sprite.y
        canvas.layers.set_preview(cargo.hidden, None)
        self._ends = cargo.ends
        self._ground = Ground(canvas.page_layout)
        self._page_reason = cargo.why_not_on_page(canvas)
        self._scroll = AutoScroll(canvas, canvas.pointing.repeat)
        canvas.area.viewport().setCursor(Qt.CursorShape.ClosedHandCursor)

    def move(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Bring the blocks along, and show where they would go."""
        self._last = pointer
        way = pointer.page - self._grabbed
        dx, dy = way.x(), way.y()
        canvas.layers.move_sprite(self._corner[0] + dx, self._corner[1] + dy)
        place = canvas.area.viewport().mapToGlobal(pointer.view.toPoint())
        self._show_delete_area(canvas, canvas.marks.delete_area(place))
        snap = Snap()
        if not self.is_over_delete_area:
            snap = search(
                self._ground,
                self._ends.moved(dx, dy),
                lambda target: self._why_not(canvas, target),
                scale=canvas.sight.camera.scale,
                current=self.snap.target,
                run=self._run,
            )
        if snap != self.snap:
            self.snap = snap
            gap = self._gap(canvas, snap.target) if snap.target is not None else None
            if gap is not None:
                self._ground.remember(_stack_of(canvas, gap.owner))
            canvas.layers.set_preview(self.cargo.hidden, gap)
            canvas.marks.drop_overlay.show(canvas, snap.target)
        canvas.marks.bubble.say(self._words(), pointer.view.toPoint())
        canvas.marks.floating.follow(canvas, pointer.view)
        self._scroll.follow(pointer.view, is_resting=self.is_over_delete_area)

    def release(self, canvas: CanvasHost, pointer: Pointer) -> None:
        """Drop the blocks where they are shown."""
        if pointer.view != self._last.view:
            self.move(canvas, pointer)
        way = pointer.page - self._grabbed
        dx, dy = way.x(), way.y()
        self._end(canvas)
        is_inside = canvas.area.viewport().rect().contains(pointer.view.toPoint())
        if self.is_over_delete_area or not (is_inside or self.cargo.hidden):
            _throw_away(canvas, self.cargo)  # new blocks that never came in are let go too
        elif self._page_reason and self.snap.target is None:
            canvas.news.refused.emit(self._page_reason)
        else:
            land(canvas, self.cargo, self.snap, dx, dy)

    def cancel(self, canvas: CanvasHost) -> None:
        """Show the page as it was: nothing has changed."""
        self._end(canvas)

    def _why_not(self, canvas: CanvasHost, target: Target) -> Text | None:
        """Why the blocks do not fit; asked once for each place."""
        key = (target.place, target.join)
        if key not in self._reasons:
            self._reasons[key] = self.cargo.why_not(canvas, target)
        return self._reasons[key]

    def _gap(self, canvas: CanvasHost, target: Target) -> Gap | None:
        """Room in the chain, for blocks that go between others."""
        place = target.place
        if target.join != "below" or isinstance(place, InInput):
            return None
        chain = self.cargo.chains[0]
        highest = canvas.sight.visible_page_rect().height * LARGEST_GAP
        size = min(chain.width, canvas.look.measures.widest), min(chain.height, highest)
        if isinstance(place, InStack):
            return Gap(place.stack, "", place.index, *size)
        assert isinstance(place, InBody)
        return Gap(place.block, place.slot, place.index, *size)

    def _show_delete_area(self, canvas: CanvasHost, is_over: bool) -> None:
        if is_over == self.is_over_delete_area:
            return
        self.is_over_delete_area = is_over
        shape = Qt.CursorShape.ForbiddenCursor if is_over else Qt.CursorShape.ClosedHandCursor
        canvas.area.viewport().setCursor(shape)
        canvas.news.delete_area_entered.emit(is_over)

    def _words(self) -> str:
        """What the bubble says."""
        if self.is_over_delete_area and self.cargo.hidden:
            return count_words(
                self.cargo.count, "Let go to delete 1 block", "Let go to delete {n} blocks"
            )
        is_silent = self.is_over_delete_area or self.snap.target is not None
        return "" if is_silent else tr(self.snap.reason or self._page_reason or "")

    def _end(self, canvas: CanvasHost) -> None:
        self._scroll.end()
        canvas.marks.bubble.hide()
        canvas.marks.floating.hide()
        canvas.marks.drop_overlay.show(canvas, None)
        canvas.layers.set_sprite(None)
        canvas.layers.set_preview(frozenset(), None)
        canvas.area.viewport().unsetCursor()
        if self.is_over_delete_area:
            canvas.news.delete_area_entered.emit(False)


def _throw_away(canvas: CanvasHost, cargo: Cargo) -> None:
    """Delete carried blocks that were dropped where blocks are deleted."""
    thrown: list[Clip | None] = []
    if canvas.attempt(lambda: thrown.append(cargo.throw_away(canvas))) and thrown[0] is not None:
        canvas.news.blocks_deleted.emit(thrown[0])


def _selected_run(canvas: CanvasHost, cargo: Cargo) -> Run | None:
    """Selected blocks that a carried C block can go around: one run, and not carried itself."""
    selected = canvas.selection.ids
    if cargo.ends.mouth is None or not selected or not cargo.hidden.isdisjoint(selected):
        return None
    chosen = runs(canvas.editor.project, selected)
    return without_hat(canvas.editor, chosen[0]) if len(chosen) == 1 else None


def _stack_of(canvas: CanvasHost, owner: str) -> str:
    project = canvas.editor.project
    return owner if owner in project.stacks else project.stack_of(owner).id


# New blocks that are dragged in from elsewhere: from the palette, or from another window.


class ExternalDrag(QObject):
    """Watches the mouse of the widget where the press was, until its button comes up.

    Before the mouse has moved far enough the widget has its press for itself, as for a click.
    """

    def __init__(
        self, canvas: CanvasHost, clip: Clip, pressed: QPoint, source: QWidget, grip: Grip | None
    ) -> None:
        super().__init__(canvas.area)
        self._canvas = canvas
        self._clip, self._grip = clip, grip
        self._pressed = pressed
        self._gesture: DragBlocks | None = None
        source.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take the moves and the release once blocks are carried."""
        if isinstance(event, QMouseEvent):
            if event.type() == QEvent.Type.MouseMove:
                return self._move(event.globalPosition().toPoint())
            if event.type() == QEvent.Type.MouseButtonRelease:
                watched.removeEventFilter(self)
                self.deleteLater()
                place = event.globalPosition().toPoint()
                if self._gesture is not None and self._canvas.pointing.gesture is self._gesture:
                    self._canvas.pointing.release_at(_in_view(self._canvas, place))
                return self._gesture is not None
        return False

    def _move(self, place: QPoint) -> bool:
        way = place - self._pressed
        if self._gesture is None:
            if way.manhattanLength() < TOUCH_DRAG_PX:
                return False
            self._gesture = carry_in(self._canvas, self._clip, self._pressed, self._grip)
        if self._canvas.pointing.gesture is self._gesture:
            self._canvas.pointing.move_to(_in_view(self._canvas, place))
        return True


def carry_in(canvas: CanvasHost, clip: Clip, place: QPoint, grip: Grip | None = None) -> DragBlocks:
    """Begin to carry new blocks at a place of the screen, held where they were taken hold of.

    Of blocks that come from elsewhere nobody knows where: they are held by their first row.
    """
    view, measures = _in_view(canvas, place), canvas.look.measures
    page, row = canvas.sight.to_page(view), measures.row_height
    at = page.x(), page.y()
    if grip is None:
        at = at[0] + (row if measures.is_mirrored else -row), at[1] - row / 2
    cargo = NewBlocks(canvas, clip, at, grip=grip)
    gesture = DragBlocks(canvas, cargo, page)
    canvas.area.setFocus()
    canvas.pointing.begin(gesture)
    canvas.pointing.take_over(view)
    return gesture


def clip_in(canvas: CanvasHost, data: QMimeData) -> Clip | None:
    """The blocks in what is dragged over the canvas, or None when there are none."""
    text = data.text() if data.hasText() and not data.hasUrls() else ""
    if not text.lstrip().startswith("{"):
        return None
    try:
        clip = from_text(text, canvas.editor.language)
    except ProjectFileError:
        return None
    return clip if clip.stacks else None


def _in_view(canvas: CanvasHost, place: QPoint) -> QPointF:
    return QPointF(canvas.area.viewport().mapFromGlobal(place))


# New blocks that are pulled out of others: a variable out of a header, or a copy.

HEADERS = ("hat", "c")
"""The shapes of blocks that give a name to what runs inside them."""


def pulled_out(canvas: CanvasHost, hit: Hit) -> NewBlocks | None:
    """The reporter that is pulled out of a parameter, or of the variable of a header; or None."""
    editor, piece = canvas.editor, hit.piece
    if piece is None or piece.kind not in ("parameter", "variable"):
        return None
    definition = editor.language.definitions.get(hit.placed.box.type)
    if definition is None or (piece.kind == "variable" and definition.shape not in HEADERS):
        return None
    clip = reporter_of(editor.project, editor.language, hit.block, piece.key)
    if clip is None:
        return None
    right = piece.x + (piece.width if canvas.look.measures.is_mirrored else 0.0)
    return NewBlocks(canvas, clip, (hit.placed.x + right, hit.placed.y + piece.y))


def copy_of(canvas: CanvasHost, hit: Hit) -> NewBlocks:
    """A copy of a block, or of the selection that it is one of, lying on the original."""
    editor, selection = canvas.editor, canvas.selection
    ids = selection.ids if hit.block in selection else (hit.block,)
    clip = copy(editor.project, editor.language, ids, canvas.page_layout.corners(ids))
    return NewBlocks(canvas, clip, clip.corner)
