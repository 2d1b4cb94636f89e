"""The static layer: a picture of all that rests, repaired only where something has changed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QPoint, QRect, QRectF, QSize
from PySide6.QtGui import QColor, QPainter, QPixmap, QRegion

from .camera import Camera
from .index import Rect

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
