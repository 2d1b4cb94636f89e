"""The carried blocks: painted once when they are picked up, then only moved."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRect, QRectF, Qt
from PySide6.QtGui import QPainter, QPixmap

from .boxes import Chain
from .camera import Camera
from .index import Rect
from .page import boxes_of

if TYPE_CHECKING:
    from .view import PageView

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
