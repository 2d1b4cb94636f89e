"""What is shown while blocks are carried: where they would go, why not, and they themselves."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPaintEvent, QPalette, QPen
from PySide6.QtWidgets import QLabel, QWidget

from nep_studio.blocks.places import InBody, InInput, InStack, Place
from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.page import Placed
from nep_studio.ui.canvas.painting.shapes import slot_path
from nep_studio.ui.theme.colours import Theme

from .snapping import Target, slots

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


class DragMarks:
    """The marks of one canvas.

    ``delete_area`` says whether a place on the screen takes blocks away (the palette, the trash).
    """

    def __init__(self, host: CanvasHost) -> None:
        self.bubble = Bubble(host.area.viewport())
        self.bubble.dress(host.look.theme)
        self.floating = FloatingPicture(host)
        self.drop_overlay = DropOverlay()
        self.delete_area: Callable[[QPoint], bool] = lambda point: False


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

    def show(self, view: CanvasHost, target: Target | None) -> None:
        """Mark a target, or nothing."""
        if target is self._target:
            return
        self._update(view)
        view.layers.show_overlay(self, is_shown=target is not None)
        self._target, self._rect, self._pushed = target, None, None
        self._path = QPainterPath()
        if target is not None:
            self._mark(view, target)
        self._update(view)

    def paint(self, painter: QPainter, view: CanvasHost) -> None:
        """Draw the mark."""
        if self._target is None:
            return
        colour = view.look.theme.colour("snap")
        if self._pushed is not None:
            veil = view.look.theme.colour("canvas")
            veil.setAlphaF(0.6)
            painter.fillPath(_outline(view, self._pushed), veil)
        filling = view.look.theme.colour("snap")
        filling.setAlphaF(0.25)
        painter.setPen(QPen(colour, 3 * view.look.measures.unit))
        painter.setBrush(filling if self._target.join == "input" else Qt.BrushStyle.NoBrush)
        painter.drawPath(self._path)

    def _mark(self, view: CanvasHost, target: Target) -> None:
        unit = view.look.measures.unit
        if target.join == "input":
            self._mark_slot(view, target)
        elif target.join == "above":
            # A line along the top of a stack
            width = view.look.measures.narrowest * (-1 if view.look.measures.is_mirrored else 1)
            self._path.moveTo(target.x, target.y)
            self._path.lineTo(target.x + width, target.y)
        elif target.join == "around":
            self._mark_around(view, target)
        if not self._path.isEmpty():
            self._rect = _page_rect(self._path.boundingRect()).grown(4 * unit)

    def _mark_slot(self, view: CanvasHost, target: Target) -> None:
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
        outline = slot_path(piece.shape, piece.width, piece.height, view.look.measures.unit)
        self._path = outline.translated(rect.x, rect.y)

    def _mark_around(self, view: CanvasHost, target: Target) -> None:
        """A bracket beside the blocks that would go into the mouth."""
        rect = _blocks_below(view, target)
        if rect is None:
            return
        unit, is_mirrored = view.look.measures.unit, view.look.measures.is_mirrored
        side = rect.right + 7 * unit if is_mirrored else rect.x - 7 * unit
        far = rect.x if is_mirrored else rect.right
        self._path.moveTo(far, rect.y - 3 * unit)
        self._path.lineTo(side, rect.y - 3 * unit)
        self._path.lineTo(side, rect.bottom + 5 * unit)
        self._path.lineTo(far, rect.bottom + 5 * unit)

    def _update(self, view: CanvasHost) -> None:
        if self._rect is not None:
            view.layers.update_page(self._rect)


def _blocks_below(view: CanvasHost, target: Target) -> Rect | None:
    """Where the blocks are that would go into the mouth: a run, or the rest of the chain."""
    chain = _chain_at(view, target.place)
    if chain is None or not isinstance(target.place, InStack | InBody):
        return None
    first = target.place.index
    last = first + target.run.count if target.run is not None else len(chain.boxes)
    width = max(box.reach for box in chain.boxes[first:last])
    x = target.x - width if chain.is_mirrored else target.x
    return Rect(x, target.y, width, chain.ys[last] - chain.ys[first])


def _chain_at(view: CanvasHost, place: Place) -> Chain | None:
    """The chain of a place, as it is laid out."""
    if isinstance(place, InStack):
        return view.page_layout.chains.get(place.stack)
    if not isinstance(place, InBody):
        return None
    owner = view.page_layout.placed(place.block)
    mouths = owner.box.mouths if owner is not None else []
    return next((mouth for mouth in mouths if mouth.key == place.slot), None)


def _outline(view: CanvasHost, placed: Placed) -> QPainterPath:
    return view.look.block_painter.outlines.of(placed.box).translated(placed.x, placed.y)


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
            margins = self.contentsMargins()
            sides = margins.left() + margins.right() + 2
            widest = self.fontMetrics().averageCharWidth() * WIDEST_LETTERS
            width = min(widest, self.fontMetrics().horizontalAdvance(self.text()) + sides)
            self.resize(width, max(1, self.heightForWidth(width)))
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


# Carried blocks outside the view: over the palette, on their way to the canvas or to the trash.


class FloatingPicture(QLabel):
    """The picture of the carried blocks, shown over the whole window."""

    def __init__(self, canvas: CanvasHost) -> None:
        super().__init__(canvas.area)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setScaledContents(True)
        self.hide()

    def follow(self, canvas: CanvasHost, pointer: QPointF) -> None:
        """Show the carried blocks where they are, if the pointer is not in the view."""
        sprite, view = canvas.layers.sprite, canvas.area.viewport()
        if sprite is None or view.rect().contains(pointer.toPoint()):
            self.hide()
            return
        window = canvas.area.window()
        if self.parentWidget() is not window:
            self.setParent(window)
        if self.pixmap().cacheKey() != sprite.pixmap.cacheKey():
            self.setPixmap(sprite.pixmap)
        scale = canvas.sight.camera.scale
        self.resize(round(sprite.width * scale), round(sprite.height * scale))
        corner = canvas.sight.camera.to_view(sprite.x, sprite.y).toPoint()
        self.move(view.mapTo(window, corner))
        self.show()
        self.raise_()
