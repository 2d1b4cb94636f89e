"""The carried blocks: painted once when they are picked up, then only moved."""

from __future__ import annotations

from dataclasses import dataclass
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


def make_sprite(view: PageView, chains: list[Chain], bounds: Rect) -> Sprite:
    """Paint chains, whose places are on the page, into a picture with a soft shadow."""
    scale, ratio = view.camera.scale, view.devicePixelRatioF()
    margin = 6.0 * view.measures.unit
    longest = LARGEST_PIXELS / (scale * ratio)
    width = min(bounds.width + 2 * margin, longest)
    height = min(bounds.height + 2 * margin, longest)
    left = bounds.right + margin - width if view.measures.is_mirrored else bounds.x - margin
    top = bounds.y - margin
    pixmap = QPixmap(max(1, round(width * scale * ratio)), max(1, round(height * scale * ratio)))
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
