"""The static layer: a picture of all that rests, repaired only where something has changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil, floor
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPixmap, QRegion

from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Camera, Rect
from nep_studio.ui.canvas.layout.page import boxes_of
from nep_studio.ui.theme.colours import Theme

if TYPE_CHECKING:
    from nep_studio.ui.canvas.view import PageView


PaintPage = Callable[[QPainter, Rect, Camera], None]
"""Paints what of the page is in a rectangle; the painter counts in canvas units."""


class StaticLayer:
    """A pixmap as large as the view, at the resolution of the screen."""

    def __init__(self, paint_page: PaintPage) -> None:
        self._paint_page = paint_page
        self._pixmap = QPixmap()
        self._camera = Camera()
        self._dirty = QRegion()
        self._ratio = 1.0
        self.is_outdated = True
        """Whether nothing in the picture is of use: it must not be shown, not even stretched."""

    def resize(self, size: QSize, ratio: float) -> None:
        """Take the size of the view, in pixels, and the screen's pixels for each of them."""
        self._ratio = ratio
        self._pixmap = QPixmap(size * ratio)
        self._pixmap.setDevicePixelRatio(ratio)
        self.invalidate_all()

    def invalidate(self, rect: QRectF) -> None:
        """Paint this part of the view again before it is next shown."""
        self._dirty += rect.toAlignedRect().adjusted(-2, -2, 2, 2) & self._view()

    def invalidate_all(self) -> None:
        """Paint everything again before it is next shown."""
        self._dirty = QRegion(self._view())
        self.is_outdated = True

    def is_sharp(self, camera: Camera) -> bool:
        """Whether the picture was painted at this zoom."""
        return self._camera.scale == camera.scale

    def scroll_to(self, camera: Camera) -> None:
        """Shift the picture to where the camera looks now; only the strips at the edges are new."""
        factor = camera.scale * self._ratio
        dx = round((self._camera.x - camera.x) * factor)
        dy = round((self._camera.y - camera.y) * factor)
        size = self._pixmap.size()
        if abs(dx) >= size.width() or abs(dy) >= size.height():
            self.invalidate_all()
        elif dx or dy:
            whole = self._pixmap.rect()
            exposed = QRegion(whole) - QRegion(whole.translated(dx, dy))
            self._pixmap.scroll(dx, dy, whole)
            shift = QPoint(round(dx / self._ratio), round(dy / self._ratio))
            self._dirty = self._dirty.translated(shift)
            for rect in rects_of(exposed):
                self.invalidate(_divided(rect, self._ratio))
        self._camera = replace(camera)

    def repair(self, camera: Camera) -> None:
        """Paint what is not up to date."""
        if not self.is_sharp(camera):
            self.invalidate_all()
            self._camera = replace(camera)
        elif self._camera != camera:
            self.scroll_to(camera)
        if self._dirty.isEmpty() or self._pixmap.isNull():
            return
        with QPainter(self._pixmap) as painter:
            for rect in _few_rects(self._dirty):
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
        if self.is_sharp(camera):
            ratio = self._ratio
            if ratio == int(ratio):  # whole pixels: nothing to resample
                times = int(ratio)
                first = QPoint(exposed.x() * times, exposed.y() * times)
                source_rect = QRect(first, exposed.size() * times)
                painter.drawPixmap(exposed.topLeft(), self._pixmap, source_rect)
                return
            source = QRectF(
                exposed.x() * ratio,
                exposed.y() * ratio,
                exposed.width() * ratio,
                exposed.height() * ratio,
            )
            painter.drawPixmap(QRectF(exposed), self._pixmap, source)
            return
        painter.fillRect(exposed, background)
        corner = camera.to_view(self._camera.x, self._camera.y)
        factor = camera.scale / self._camera.scale
        size = self._pixmap.deviceIndependentSize() * factor
        painter.drawPixmap(QRectF(corner, size), self._pixmap, QRectF(self._pixmap.rect()))

    def _view(self) -> QRect:
        return QRect(QPoint(0, 0), self._pixmap.deviceIndependentSize().toSize())


def rects_of(region: QRegion) -> list[QRect]:
    """The rectangles of a region."""
    rects: list[QRect] = list(region)  # type: ignore[call-overload]  # stubs lack __iter__
    return rects


def _few_rects(region: QRegion) -> list[QRect]:
    """The rectangles of a region, or the one around them when they are many."""
    rects = rects_of(region)
    return rects if len(rects) <= 4 else [region.boundingRect()]


def _divided(rect: QRect, ratio: float) -> QRectF:
    return QRectF(rect.x() / ratio, rect.y() / ratio, rect.width() / ratio, rect.height() / ratio)


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
    columns = range(int(rect.x // STEP), int(rect.right // STEP) + 2)
    rows = range(int(rect.y // STEP), int(rect.bottom // STEP) + 2)
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
    view: PageView, chains: list[Chain], bounds: Rect, held: QPointF | None = None
) -> Sprite:
    """Paint chains, whose places are on the page, into a picture with a soft shadow.

    ``held`` is the point of the page where a pointer holds them.
    """
    scale, ratio = view.camera.scale, view.devicePixelRatioF()
    if held is not None:
        bounds = _reachable(view, bounds, held)
    margin = 6.0 * view.measures.unit
    longest = LARGEST_PIXELS / (scale * ratio)
    width = min(bounds.width + 2 * margin, longest)
    height = min(bounds.height + 2 * margin, longest)
    left = bounds.right + margin - width if view.measures.is_mirrored else bounds.x - margin
    left, top = _on_pixel(view, left, bounds.y - margin)
    pixmap = QPixmap(max(1, ceil(width * scale * ratio)), max(1, ceil(height * scale * ratio)))
    pixmap.fill(Qt.GlobalColor.transparent)
    shown = Rect(left, top, width, height)
    with QPainter(pixmap) as painter:
        painter.scale(scale * ratio, scale * ratio)
        painter.translate(-left, -top)
        _paint_shadow(painter, view, chains, shown)
        for chain in chains:
            view.block_painter.paint(painter, boxes_of(chain, shown), scale)
    pixmap.setDevicePixelRatio(ratio)
    return Sprite(pixmap, width, height, scale, left, top)


def _on_pixel(view: PageView, x: float, y: float) -> tuple[float, float]:
    """The place of a whole pixel of the screen: the picture is then exactly that of the page."""
    camera, step = view.camera, view.camera.scale * view.devicePixelRatioF()
    return (
        camera.x + floor((x - camera.x) * step) / step,
        camera.y + floor((y - camera.y) * step) / step,
    )


def _reachable(view: PageView, bounds: Rect, held: QPointF) -> Rect:
    """What can come into view while the pointer, which is in it, holds this point."""
    seen = view.visible_page_rect()
    x, y = held.x() - seen.width, held.y() - seen.height
    near = Rect(x, y, 2 * seen.width, 2 * seen.height)
    return bounds.intersected(near) if bounds.touches(near) else bounds


def _paint_shadow(painter: QPainter, view: PageView, chains: list[Chain], shown: Rect) -> None:
    """Paint the outlines of the blocks darkly, a little lower."""
    colour = view.theme.colour("sprite_shadow")
    down = 3.0 * view.measures.unit
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    for chain in chains:
        left = QPointF(chain.x, chain.y)
        for box, y in zip(chain.boxes, chain.ys, strict=False):
            x = left.x() - box.width if chain.is_mirrored else left.x()
            if left.y() + y > shown.bottom:
                break
            painter.translate(x + down / 2, left.y() + y + down)
            painter.fillPath(view.block_painter.outlines.of(box), colour)
            painter.translate(-x - down / 2, -left.y() - y - down)
