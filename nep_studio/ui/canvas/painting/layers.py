"""The layers of a canvas: a picture of all that rests, repaired only where something has changed,
the overlays drawn over it, and the sprite of what is carried.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from math import ceil, floor
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QPointF, QRect, QRectF, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QPainter, QPen, QPixmap, QRegion

from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Camera, Rect
from nep_studio.ui.canvas.layout.layout import Gap
from nep_studio.ui.canvas.layout.page import boxes_of
from nep_studio.ui.theme.colours import Theme

from .overlay import Overlay

if TYPE_CHECKING:
    from nep_studio.ui.canvas.host import CanvasHost


PaintPage = Callable[[QPainter, Rect, Camera], None]
"""Paints what of the page is in a rectangle; the painter counts in canvas units."""


class StaticLayer:
    """A pixmap as large as the view, at the resolution of the screen."""

    def __init__(self, paint_page: PaintPage) -> None:
        self._paint_page = paint_page
        self._pixmap = QPixmap()
        self._view = QRect()
        self.camera = Camera()
        """What the picture was painted for."""
        self._dirty = QRegion()
        self._ratio = 1.0
        self.is_outdated = True
        """Whether nothing in the picture is of use: it must not be shown, not even stretched."""

    def resize(self, size: QSize, ratio: float) -> None:
        """Take the size of the view, in pixels, and the screen's pixels for each of them."""
        self._ratio = ratio
        self._pixmap = QPixmap(size * ratio)
        self._pixmap.setDevicePixelRatio(ratio)
        self._view = QRect(QPoint(0, 0), self._pixmap.deviceIndependentSize().toSize())
        self.invalidate_all()

    def invalidate(self, rect: QRectF) -> None:
        """Paint this part of the view again before it is next shown."""
        self._dirty += rect.toAlignedRect().adjusted(-2, -2, 2, 2) & self._view

    def invalidate_all(self) -> None:
        """Paint everything again before it is next shown."""
        self._dirty = QRegion(self._view)
        self.is_outdated = True

    def scroll_to(self, camera: Camera) -> None:
        """Shift the picture to where the camera looks now; only the strips at the edges are new."""
        factor = camera.scale * self._ratio
        dx = round((self.camera.x - camera.x) * factor)
        dy = round((self.camera.y - camera.y) * factor)
        size = self._pixmap.size()
        if abs(dx) >= size.width() or abs(dy) >= size.height():
            self.invalidate_all()
        elif dx or dy:
            whole = self._pixmap.rect()
            exposed = QRegion(whole) - QRegion(whole.translated(dx, dy))
            self._pixmap.scroll(dx, dy, whole)
            moved = [_scaled(rect, self._ratio) for rect in rects_of(self._dirty)]
            self._dirty = QRegion()
            for rect in (
                *(one.translated(dx, dy) for one in moved),
                *map(QRectF, rects_of(exposed)),
            ):
                self.invalidate(_scaled(rect, 1 / self._ratio))
        self.camera = replace(camera)

    def repair(self, camera: Camera) -> None:
        """Paint what is not up to date."""
        if self.camera.scale != camera.scale:
            self.invalidate_all()
            self.camera = replace(camera)
        elif self.camera != camera:
            self.scroll_to(camera)
        if self._dirty.isEmpty() or self._pixmap.isNull():
            return
        with QPainter(self._pixmap) as painter:
            # The rectangles of a region, or the one around them when they are many
            region = self._dirty
            rects = rects_of(region)
            for rect in rects if len(rects) <= 4 else [region.boundingRect()]:
                painter.save()
                painter.setClipRect(rect)
                painter.scale(camera.scale, camera.scale)
                painter.translate(-camera.x, -camera.y)
                self._paint_page(painter, camera.page_rect(QRectF(rect)), camera)
                painter.restore()
        self._dirty = QRegion()
        self.is_outdated = False

    def draw(self, painter: QPainter, camera: Camera, exposed: QRect, background: QColor) -> None:
        """Put the picture into the view, stretched when it was painted at another zoom."""
        if self.camera.scale == camera.scale:
            # The whole picture, cut by the painter to what is painted: a part of it has no whole
            # pixels where the screen has one and a quarter for each, and would be resampled
            painter.drawPixmap(0, 0, self._pixmap)
            return
        painter.fillRect(exposed, background)
        corner = camera.to_view(self.camera.x, self.camera.y)
        factor = camera.scale / self.camera.scale
        size = self._pixmap.deviceIndependentSize() * factor
        painter.drawPixmap(QRectF(corner, size), self._pixmap, QRectF(self._pixmap.rect()))


def rects_of(region: QRegion) -> list[QRect]:
    """The rectangles of a region."""
    rects: list[QRect] = list(region)  # type: ignore[call-overload]  # stubs lack __iter__
    return rects


def _scaled(rect: QRect | QRectF, by: float) -> QRectF:
    return QRectF(rect.x() * by, rect.y() * by, rect.width() * by, rect.height() * by)


# The canvas behind the blocks: plain, with dots that let the eye measure.

STEP = 32.0
"""How far the dots are apart, in canvas units."""

SMALLEST_DOT_SCALE = 0.5


def paint_background(painter: QPainter, rect: Rect, camera: Camera, theme: Theme) -> None:
    """Paint what is behind the blocks in a part of the page."""
    pixel = 1.0 / camera.scale
    whole = QRectF(rect.x, rect.y, rect.width, rect.height).adjusted(-pixel, -pixel, pixel, pixel)
    painter.fillRect(whole, theme.colour("canvas"))
    if camera.scale < SMALLEST_DOT_SCALE:
        return
    columns = range(int(rect.x // STEP), int((rect.x + rect.width) // STEP) + 2)
    rows = range(int(rect.y // STEP), int((rect.y + rect.height) // STEP) + 2)
    painter.setPen(QPen(theme.colour("canvas_dot"), 2.0))
    painter.drawPoints([QPointF(x * STEP, y * STEP) for x in columns for y in rows])


# The carried blocks: painted once when they are picked up, then only moved.

LARGEST_PIXELS = 4096
"""A sprite is never larger than this, however long the carried stack is."""


@dataclass
class Sprite:
    """A picture of chains of blocks; ``x`` and ``y`` are where its corner is on the page.

    ``scale`` is the zoom at which it was painted.
    """

    pixmap: QPixmap
    width: float
    height: float
    scale: float
    x: float = 0.0
    y: float = 0.0

    def paint(self, painter: QPainter, camera: Camera, ratio: float) -> None:
        """Draw it; the painter counts in canvas units.

        At the zoom it was made for it is put on whole pixels of the screen, which is several times
        faster than a picture that must be resampled.
        """
        if camera.scale == self.scale:
            corner = camera.to_view(self.x, self.y) * ratio
            at = QPointF(round(corner.x()) / ratio, round(corner.y()) / ratio)
            painter.resetTransform()
            painter.drawPixmap(at, self.pixmap)
            return
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, False)
        place = QRectF(self.x, self.y, self.width, self.height)
        painter.drawPixmap(place, self.pixmap, QRectF(self.pixmap.rect()))

    def view_rect(self, camera: Camera) -> QRect:
        """Where it is in the view, with a pixel around it."""
        rect = camera.view_rect(Rect(self.x, self.y, self.width, self.height))
        return rect.toAlignedRect().adjusted(-2, -2, 2, 2)


def make_sprite(
    view: CanvasHost, chains: list[Chain], bounds: Rect, held: QPointF | None = None
) -> Sprite:
    """Paint chains, whose places are on the page, into a picture with a soft shadow.

    ``held`` is the point of the page where a pointer holds them.
    """
    scale, ratio = view.sight.camera.scale, view.area.devicePixelRatioF()
    if held is not None:
        bounds = _reachable(view, bounds, held)
    margin = 6.0 * view.look.measures.unit
    longest = LARGEST_PIXELS / (scale * ratio)
    width = min(bounds.width + 2 * margin, longest)
    height = min(bounds.height + 2 * margin, longest)
    left = bounds.right + margin - width if view.look.measures.is_mirrored else bounds.x - margin
    # The place of a whole pixel of the screen: the picture is then exactly that of the page
    y = bounds.y - margin
    camera, step = view.sight.camera, view.sight.camera.scale * view.area.devicePixelRatioF()
    left, top = (
        camera.x + floor((left - camera.x) * step) / step,
        camera.y + floor((y - camera.y) * step) / step,
    )
    pixmap = QPixmap(max(1, ceil(width * scale * ratio)), max(1, ceil(height * scale * ratio)))
    pixmap.fill(Qt.GlobalColor.transparent)
    shown = Rect(left, top, width, height)
    with QPainter(pixmap) as painter:
        painter.scale(scale * ratio, scale * ratio)
        painter.translate(-left, -top)
        _paint_shadow(painter, view, chains, shown)
        for chain in chains:
            view.look.block_painter.paint(painter, boxes_of(chain, shown), scale)
    pixmap.setDevicePixelRatio(ratio)
    return Sprite(pixmap, width, height, scale, left, top)


def _reachable(view: CanvasHost, bounds: Rect, held: QPointF) -> Rect:
    """What can come into view while the pointer, which is in it, holds this point."""
    seen = view.sight.visible_page_rect()
    x, y = held.x() - seen.width, held.y() - seen.height
    near = Rect(x, y, 2 * seen.width, 2 * seen.height)
    return bounds.intersected(near) if bounds.touches(near) else bounds


def _paint_shadow(painter: QPainter, view: CanvasHost, chains: list[Chain], shown: Rect) -> None:
    """Paint the outlines of the blocks darkly, a little lower."""
    colour = view.look.theme.colour("sprite_shadow")
    down = 3.0 * view.look.measures.unit
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    for chain in chains:
        left = QPointF(chain.x, chain.y)
        for box, y in zip(chain.boxes, chain.ys, strict=False):
            x = left.x() - box.width if chain.is_mirrored else left.x()
            if left.y() + y > shown.bottom:
                break
            painter.translate(x + down / 2, left.y() + y + down)
            painter.fillPath(view.look.block_painter.outlines.of(box), colour)
            painter.translate(-x - down / 2, -left.y() - y - down)


# All layers of a canvas, one over the other.

SHARPEN_MS = 80
"""How long zooming must rest before the blocks are painted anew at their new size."""


class Layers:
    """What rests, the overlays over it, and what is carried."""

    def __init__(self, host: CanvasHost, overlays: list[Overlay]) -> None:
        self.overlays = overlays
        self.sprite: Sprite | None = None
        self.sharpen = QTimer(host.area, singleShot=True, interval=SHARPEN_MS)
        self._host = host
        self._viewport = host.area.viewport()
        self._rest = StaticLayer(self._paint_page)
        self.sharpen.timeout.connect(self._viewport.update)

    def show_overlay(self, overlay: Overlay, *, is_shown: bool = True) -> None:
        """Draw an overlay over the page from now on, or no more."""
        if is_shown and overlay not in self.overlays:
            self.overlays.append(overlay)
        elif not is_shown and overlay in self.overlays:
            self.overlays.remove(overlay)

    def resize(self) -> None:
        """Take the size of the view and the resolution of its screen."""
        self._rest.resize(self._viewport.size(), self._host.area.devicePixelRatioF())

    def repaint_all(self) -> None:
        """Paint everything anew."""
        self._rest.invalidate_all()
        self._viewport.update()

    def repaint_page(self, rects: Iterable[Rect]) -> None:
        """Paint these parts of the page anew.

        What lies over moved blocks reaches far beside them (a glow, badges, outlines, counts): it
        is drawn again wherever it is, over the picture of what rests.
        """
        camera, margin = self._host.sight.camera, 4 * self._host.look.measures.unit
        changed = [camera.view_rect(rect.grown(margin)) for rect in rects]
        if changed and self._rest.camera.scale == camera.scale:
            self._rest.scroll_to(camera)  # the places are those of where it looks now
        for rect in changed:
            self._rest.invalidate(rect)
        if changed:
            self._viewport.update()

    def update_page(self, rect: Rect) -> None:
        """Draw the overlays of a part of the page again; the blocks rest."""
        view = self._host.sight.camera.view_rect(rect)
        self._viewport.update(view.toAlignedRect().adjusted(-4, -4, 4, 4))

    def set_preview(self, hidden: frozenset[str], gap: Gap | None) -> None:
        """Show the page without some blocks, and with a gap where they would go."""
        page_layout = self._host.page_layout
        if (hidden, gap) != (page_layout.layout.hidden, page_layout.layout.gap):
            self.repaint_page(page_layout.update(page_layout.layout.preview(hidden, gap)))

    def set_sprite(self, sprite: Sprite | None) -> None:
        """Show carried blocks over everything, or none."""
        camera = self._host.sight.camera
        for shown in (self.sprite, sprite):
            if shown is not None:
                self._viewport.update(shown.view_rect(camera))
        self.sprite = sprite

    def move_sprite(self, x: float, y: float) -> None:
        """Carry the blocks to another place of the page."""
        if self.sprite is not None:
            camera = self._host.sight.camera
            before = self.sprite.view_rect(camera)
            self.sprite.x, self.sprite.y = x, y
            # One rectangle: a region of two is clipped piece by piece, which costs more.
            self._viewport.update(before.united(self.sprite.view_rect(camera)))

    def paint(self, region: QRegion) -> None:
        """Draw the layers: what rests, what is over it, what is carried."""
        camera, is_zooming = self._host.sight.camera, self.sharpen.isActive()
        if not is_zooming or self._rest.is_outdated or self._rest.camera.scale == camera.scale:
            self._rest.repair(camera)
        with QPainter(self._viewport) as painter:  # ended also when a drawing fails
            exposed, background = region.boundingRect(), self._host.look.theme.colour("canvas")
            self._rest.draw(painter, camera, exposed, background)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.scale(camera.scale, camera.scale)
            painter.translate(-camera.x, -camera.y)
            for overlay in self.overlays:
                overlay.paint(painter, self._host)
            if self.sprite is not None:
                self.sprite.paint(painter, camera, self._host.area.devicePixelRatioF())

    def _paint_page(self, painter: QPainter, rect: Rect, camera: Camera) -> None:
        host, look = self._host, self._host.look
        paint_background(painter, rect, camera, look.theme)
        host.notes.paint_resting(painter, rect, camera.scale)
        boxes = host.page_layout.boxes(rect.grown(8 * look.measures.unit))
        look.block_painter.paint(painter, boxes, camera.scale)
