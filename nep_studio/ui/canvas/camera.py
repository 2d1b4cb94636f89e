"""Where the person looks: which part of the page is in the view, and how large."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF

from .index import Rect

SMALLEST, LARGEST = 0.1, 4.0
"""How far out and in a person can zoom."""


@dataclass
class Camera:
    """``x`` and ``y`` are the canvas place at the view's top left corner."""

    x: float = 0.0
    y: float = 0.0
    scale: float = 1.0

    def to_page(self, point: QPointF) -> QPointF:
        """A point of the view, in pixels, on the page."""
        return QPointF(point.x() / self.scale + self.x, point.y() / self.scale + self.y)

    def to_view(self, x: float, y: float) -> QPointF:
        """A point of the page in the view."""
        return QPointF((x - self.x) * self.scale, (y - self.y) * self.scale)

    def view_rect(self, rect: Rect) -> QRectF:
        """A rectangle of the page in the view."""
        return QRectF(self.to_view(rect.x, rect.y), self.to_view(rect.right, rect.bottom))

    def page_rect(self, rect: QRectF) -> Rect:
        """A rectangle of the view on the page."""
        corner = self.to_page(rect.topLeft())
        return Rect(corner.x(), corner.y(), rect.width() / self.scale, rect.height() / self.scale)

    def zoom_at(self, point: QPointF, scale: float) -> None:
        """Zoom so that what is under a point of the view stays there."""
        before = self.to_page(point)
        self.scale = min(max(scale, SMALLEST), LARGEST)
        self.x = before.x() - point.x() / self.scale
        self.y = before.y() - point.y() / self.scale

    def align(self, ratio: float) -> None:
        """Put the corner on a whole device pixel, so that a scrolled picture stays sharp."""
        step = self.scale * ratio
        self.x = round(self.x * step) / step
        self.y = round(self.y * step) / step
