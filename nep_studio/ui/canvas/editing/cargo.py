"""What a person carries: blocks of the page, or new ones from elsewhere."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPaintEvent, QPalette, QPen
from PySide6.QtWidgets import QLabel, QWidget

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
from nep_studio.blocks.places import InBody, InInput, InStack, Place
from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.canvas.layout.page import Placed
from nep_studio.ui.theme.colours import Theme

from .snapping import Ends, Point, Target, ends_of, slots

if TYPE_CHECKING:
    from nep_studio.ui.canvas.canvas import Canvas
    from nep_studio.ui.canvas.view import PageView


class Cargo(ABC):
    """Blocks that are carried: how they look, where they fit, what a drop does.

    ``chains`` are laid out where the blocks were picked up; ``hidden`` are the blocks that the
    page does not show meanwhile.
    """

    chains: list[Chain]
    hidden: frozenset[str] = frozenset()

    @property
    def bounds(self) -> Rect:
        """The rectangle around all of it, where it was picked up."""
        rect = bounds_of(self.chains[0])
        for chain in self.chains[1:]:
            rect = rect.united(bounds_of(chain))
        return rect

    @property
    def ends(self) -> Ends:
        """Where it can be joined to others: nowhere when it is several stacks."""
        return ends_of(self.chains[0]) if len(self.chains) == 1 else Ends()

    @property
    def count(self) -> int:
        """How many blocks it is, without those inside them."""
        return sum(len(chain.boxes) for chain in self.chains)

    @abstractmethod
    def why_not(self, canvas: Canvas, target: Target) -> Text | None:
        """Why it does not fit into a place, or None when it does."""

    @abstractmethod
    def why_not_on_page(self, canvas: Canvas) -> Text | None:
        """Why it cannot lie on the page that is shown, or None when it can."""

    @abstractmethod
    def join(self, canvas: Canvas, target: Target, beside: Point, at: Point | None) -> list[str]:
        """Drop it into a place, as one step; gives the blocks to select. Raises EditRefused."""

    @abstractmethod
    def put(self, canvas: Canvas, dx: float, dy: float) -> list[str]:
        """Drop it on the page, so far from where it was picked up; gives the blocks to select."""

    @abstractmethod
    def throw_away(self, canvas: Canvas) -> Clip | None:
        """Drop it where blocks are deleted; gives what was deleted of the program."""


class PickedUp(Cargo):
    """Blocks of the page."""

    def __init__(self, canvas: Canvas, carried: Carried, selected: Collection[str] = ()) -> None:
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

    def why_not(self, canvas: Canvas, target: Target) -> Text | None:
        """Why it does not fit into a place, or None when it does."""
        if target.run is not None:
            block_type = canvas.editor.project.blocks[self._carried.first].type
            return why_not_enclose(canvas.editor, block_type, target.run)
        return why_not_drop(canvas.editor, self._carried, target.place, wrap=target.is_around)

    def why_not_on_page(self, canvas: Canvas) -> Text | None:
        """Blocks of a page can lie on it."""
        return None

    def join(self, canvas: Canvas, target: Target, beside: Point, at: Point | None) -> list[str]:
        """Move the blocks into a place."""
        editor, wrap = canvas.editor, target.is_around
        if target.run is not None:
            enclose(editor, self._carried.first, target.run)
        else:
            drop(editor, self._carried, target.place, wrap=wrap, beside=beside, at=at)
        return self._selected

    def put(self, canvas: Canvas, dx: float, dy: float) -> list[str]:
        """Move the blocks on their page."""
        move_by(canvas.editor, self.hidden, dx, dy, self._at)
        return self._selected

    def throw_away(self, canvas: Canvas) -> Clip | None:
        """Delete the blocks."""
        return delete(canvas.editor, self.hidden)


class NewBlocks(Cargo):
    """Blocks that are not in the program yet: from the palette, or copies."""

    def __init__(self, canvas: Canvas, clip: Clip, at: Point, *, hold: Point | None = None) -> None:
        """Hold the blocks with their corner at ``at``, or by a point inside them there."""
        self._clip = clip
        project = clip.project
        self.layout = Layout(project, canvas.editor.language.of(project), canvas.measures)
        left, top = clip.corner
        self.chains = []
        for stack in clip.stacks:
            chain = self.layout.chain(stack.body)
            chain.x, chain.y = at[0] + stack.x - left, at[1] + stack.y - top
            self.chains.append(chain)
        self._at = at
        if hold is not None:
            self._hold(canvas, hold)

    def _hold(self, canvas: Canvas, hold: Point) -> None:
        """Shift the blocks so that a point of the first one is where its corner was."""
        box = self.chains[0].boxes[0]
        side = 1 if canvas.measures.is_mirrored else -1
        dx, dy = side * min(hold[0], box.width / 2), -min(hold[1], box.height / 2)
        for chain in self.chains:
            chain.x, chain.y = chain.x + dx, chain.y + dy
        self._at = self._at[0] + dx, self._at[1] + dy

    def why_not(self, canvas: Canvas, target: Target) -> Text | None:
        """Why it does not fit into a place, or None when it does."""
        if target.run is not None:
            block_type = self._clip.project.blocks[self._clip.roots[0][0]].type
            return why_not_enclose(canvas.editor, block_type, target.run)
        return why_not_create(canvas.editor, self._clip, target.place, wrap=target.is_around)

    def why_not_on_page(self, canvas: Canvas) -> Text | None:
        """Why blocks of another page cannot lie on this one."""
        place = canvas.editor.new_stack(canvas.page, 0, 0)
        single = len(self._clip.stacks) == 1
        return why_not_create(canvas.editor, self._clip, place) if single else None

    def join(self, canvas: Canvas, target: Target, beside: Point, at: Point | None) -> list[str]:
        """Make the blocks in a place."""
        editor, clip, wrap = canvas.editor, self._clip, target.is_around
        if target.run is None:
            new = create_and_drop(editor, clip, target.place, wrap=wrap, beside=beside, at=at)
            return [new[0]]
        with editor.transaction("add blocks"):
            [first] = create_and_drop(editor, clip, editor.new_stack(canvas.page, *beside))
            enclose(editor, first, target.run)
        return [first]

    def put(self, canvas: Canvas, dx: float, dy: float) -> list[str]:
        """Make the blocks on the page."""
        x, y = self._at[0] + dx, self._at[1] + dy
        return list(paste(canvas.editor, self._clip, canvas.page, x, y))

    def throw_away(self, canvas: Canvas) -> Clip | None:
        """Let them go: they have never been in the program."""
        return None


def lift(canvas: Canvas, block: str, *, alone: bool = False) -> PickedUp:
    """Pick up a block with all below it, or alone, or the selection that it is one of."""
    selected = canvas.selection.ids if block in canvas.selection and not alone else ()
    if len(selected) == 1:
        selected = ()
    carried = pick_up(canvas.editor.project, block, alone=alone, selected=selected)
    return PickedUp(canvas, carried, selected)


def bounds_of(chain: Chain) -> Rect:
    """The rectangle around a chain whose x and y are on the page."""
    left = chain.x - chain.width if chain.is_mirrored else chain.x
    return Rect(left, chain.y, chain.width, chain.height)


def _corner(canvas: Canvas, block: str) -> Point:
    """Where a chain begins on the page whose first block this is."""
    placed = canvas.page_layout.placed(block)
    if placed is None:  # on another page, or inside a collapsed block
        stack = canvas.editor.project.stack_of(block)
        return stack.x, stack.y
    x = placed.x + placed.box.width if placed.box.is_mirrored else placed.x
    return x, placed.y


# Shows where carried blocks would go: the slot, the head of a stack, the blocks to go around.


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


# A small bubble beside the pointer: why something does not fit here, what letting go does.

OFFSET_PX = 18
WIDEST_LETTERS = 44


class Bubble(QLabel):
    """One sentence, shown over the view; it never takes the mouse."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._view = parent
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setForegroundRole(QPalette.ColorRole.WindowText)
        self._fill = QColor()
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.hide()

    def dress(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        palette = self.palette()
        self._fill = theme.colour("tooltip")
        palette.setColor(QPalette.ColorRole.WindowText, theme.colour("tooltip_text"))
        self.setPalette(palette)
        margin = self.fontMetrics().height() // 3
        self.setContentsMargins(2 * margin, margin, 2 * margin, margin)

    def say(self, text: str, at: QPoint) -> None:
        """Show a sentence beside a point of the view, inside the view; an empty one hides it."""
        if not text:
            self.hide()
            return
        if text != self.text():
            self.setText(text)
            self._take_size()
        room = self._view.rect()
        place = at + QPoint(OFFSET_PX, OFFSET_PX)
        if place.x() + self.width() > room.right():
            place.setX(at.x() - OFFSET_PX - self.width())
        if place.y() + self.height() > room.bottom():
            place.setY(at.y() - OFFSET_PX - self.height())
        self.move(max(0, place.x()), max(0, place.y()))
        self.show()
        self.raise_()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the sentence on a rounded ground."""
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self._fill)
            radius = self.fontMetrics().height() / 3
            painter.drawRoundedRect(self.rect(), radius, radius)
        super().paintEvent(event)

    def _take_size(self) -> None:
        margins = self.contentsMargins()
        sides = margins.left() + margins.right() + 2
        widest = self.fontMetrics().averageCharWidth() * WIDEST_LETTERS
        width = min(widest, self.fontMetrics().horizontalAdvance(self.text()) + sides)
        self.resize(width, max(1, self.heightForWidth(width)))


# Carried blocks outside the view: over the palette, on their way to the canvas or to the trash.


class FloatingPicture(QLabel):
    """The picture of the carried blocks, shown over the whole window."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setScaledContents(True)
        self.hide()

    def follow(self, canvas: Canvas, pointer: QPointF) -> None:
        """Show the carried blocks where they are, if the pointer is not in the view."""
        sprite, view = canvas.sprite, canvas.viewport()
        if sprite is None or view.rect().contains(pointer.toPoint()):
            self.hide()
            return
        window = canvas.window()
        if self.parentWidget() is not window:
            self.setParent(window)
        if self.pixmap().cacheKey() != sprite.pixmap.cacheKey():
            self.setPixmap(sprite.pixmap)
        scale = canvas.camera.scale
        self.resize(round(sprite.width * scale), round(sprite.height * scale))
        corner = canvas.camera.to_view(sprite.x, sprite.y).toPoint()
        self.move(view.mapTo(window, corner))
        self.show()
        self.raise_()
