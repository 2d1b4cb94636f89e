"""Which part of the page is seen: a camera that is moved by scroll bars, fingers and commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QPointF, QRectF

from .layout.index import Camera, Rect
from .layout.page import Hit, Placed

if TYPE_CHECKING:
    from .host import CanvasHost

MARGIN = 160.0
"""How far a page can be scrolled past its last block, in pixels."""

BEGINNING_PX = 28.0
"""How far from the view's corner a page begins that is shown anew."""


class Sight:
    """Moves the camera of one canvas, and says what is where in its view."""

    def __init__(self, host: CanvasHost) -> None:
        self.camera = Camera()
        self._host = host
        self._viewport = host.area.viewport()
        self._is_scrolling = False
        self._width = 0
        """Of the viewport when the camera was last put where it is."""
        self.covered = 0
        """So many pixels of its foot lie under something: what is to be seen goes above them."""

    # What is where

    def to_page(self, point: QPointF | QPoint) -> QPointF:
        """A point of the viewport on the page."""
        return self.camera.to_page(QPointF(point))

    def hit(self, point: QPointF | QPoint) -> Hit | None:
        """What is under a point of the viewport."""
        at = self.to_page(point)
        return self._host.page_layout.hit(at.x(), at.y())

    def view_rect_of(self, block_id: str) -> QRectF | None:
        """Where a block is in the viewport; None when the page does not show it."""
        placed = self._host.page_layout.placed(block_id)
        return self.camera.view_rect(placed.rect) if placed is not None else None

    def visible_page_rect(self) -> Rect:
        """The part of the page in the view."""
        return self.camera.page_rect(QRectF(self._viewport.rect()))

    # Moves

    def move_camera(self, x: float, y: float) -> None:
        """Look at a place of the page with the view's corner."""
        self.camera.x, self.camera.y = x, y
        self._moved()

    def pan(self, dx: float, dy: float) -> None:
        """Move the view by pixels."""
        scale = self.camera.scale
        self.move_camera(self.camera.x + dx / scale, self.camera.y + dy / scale)

    def zoom(self, scale: float, at: QPointF | None = None) -> None:
        """Zoom, so that a point of the view (its middle) stays where it is."""
        centre = at if at is not None else QPointF(self._viewport.rect().center())
        self.camera.zoom_at(centre, scale)
        self._host.layers.sharpen.start()
        self._moved()

    def fit(self, rect: Rect | None = None) -> None:
        """Zoom and move so that the whole page (or a part of it) can be seen."""
        layout = self._host.page_layout
        layout.chains.lay_out_all()
        whole = rect or layout.bounds()
        if whole is None:
            return
        view, room = self._viewport.size(), 32.0
        wide = (view.width() - 2 * room) / max(whole.width, 1.0)
        high = (view.height() - 2 * room) / max(whole.height, 1.0)
        self.zoom(min(wide, high, 1.0))
        left = whole.x + whole.width / 2 - view.width() / 2 / self.camera.scale
        top = whole.y + whole.height / 2 - view.height() / 2 / self.camera.scale
        self.move_camera(left, top)

    def show_head(self, placed: Placed) -> None:
        """Scroll just so far that the first row of a block can be seen."""
        # The first row of a block, which is what a person looks for
        measures = self._host.look.measures
        rect = placed.rect
        self.show_rect(Rect(rect.x, rect.y, rect.width, min(rect.height, 2 * measures.row_height)))

    def show_rect(self, rect: Rect) -> None:
        """Scroll just so far that a part of the page can be seen."""
        seen = self.visible_page_rect()
        margin = 24.0 / self.camera.scale
        dx = _shift(seen.x + margin, seen.right - margin, rect.x, rect.right)
        foot = seen.bottom - margin - self.covered / self.camera.scale
        dy = _shift(seen.y + margin, foot, rect.y, rect.bottom)
        if dx or dy:
            self.move_camera(self.camera.x + dx, self.camera.y + dy)

    def show_beginning(self) -> None:
        """Look at the corner of the blocks where reading begins; a note beside them may wait."""
        layout = self._host.page_layout
        bounds = layout.index.bounds() or layout.bounds() or Rect(0.0, 0.0, 0.0, 0.0)
        x, margin = bounds.x, BEGINNING_PX / self.camera.scale
        self._width = self._viewport.width()
        if self._host.look.measures.is_mirrored:
            x = bounds.right + 2 * margin - self.visible_page_rect().width
        self.move_camera(x - margin, bounds.y - margin)

    def take_width(self, width: int) -> None:
        """The view has another width; the side where reading begins stays where it is."""
        before, self._width = self._width, width
        if self._host.look.measures.is_mirrored and before:
            self.camera.x += (before - width) / self.camera.scale
            self.camera.align(self._host.area.devicePixelRatioF())
        self.update_scroll_bars()

    # Scroll bars

    def update_scroll_bars(self) -> None:
        """Let the scroll bars reach over the page, and say where the camera is."""
        scale, view, area = self.camera.scale, self._viewport.size(), self._host.area
        bounds, seen = self._host.page_layout.bounds(), self.visible_page_rect()
        bounds = seen if bounds is None else bounds
        whole = bounds.grown(MARGIN / scale).united(seen)
        self._is_scrolling = True
        for bar, start, length, value, page, is_all_seen in (
            (
                *(area.horizontalScrollBar(), whole.x, whole.width, seen.x, view.width()),
                seen.x <= bounds.x and bounds.right <= seen.right,
            ),
            (
                *(area.verticalScrollBar(), whole.y, whole.height, seen.y, view.height()),
                seen.y <= bounds.y and bounds.bottom <= seen.bottom,
            ),
        ):
            if is_all_seen:
                start, length = value, 0.0
            first = int(start * scale)
            bar.setRange(first, max(first, int((start + length) * scale) - page))
            bar.setPageStep(page)
            bar.setSingleStep(40)
            bar.setValue(round(value * scale))
        self._is_scrolling = False

    def follow_scroll_bars(self) -> None:
        """A person has moved a scroll bar."""
        if self._is_scrolling:
            return
        area = self._host.area
        self.camera.x = area.horizontalScrollBar().value() / self.camera.scale
        self.camera.y = area.verticalScrollBar().value() / self.camera.scale
        self.camera.align(area.devicePixelRatioF())
        self._tell()

    def _moved(self) -> None:
        self.camera.align(self._host.area.devicePixelRatioF())
        self.update_scroll_bars()
        self._tell()

    def _tell(self) -> None:
        self._viewport.update()
        self._host.news.view_changed.emit()


def _shift(low: float, high: float, start: float, end: float) -> float:
    """How far a view from ``low`` to ``high`` must move to show what is from start to end."""
    if start < low or end - start > high - low:
        return start - low
    return end - high if end > high else 0.0
