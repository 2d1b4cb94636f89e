"""A view of a page that can be scrolled and zoomed."""

from __future__ import annotations

from PySide6.QtCore import QPointF
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QScrollBar

from .index import Rect
from .measures import Measures
from .page import Placed
from .view import PageView

MARGIN = 160.0
"""How far a page can be scrolled past its last block, in pixels."""

BEGINNING_PX = 28.0
"""How far from the view's corner a page begins that is shown anew."""


class ScrollingView(PageView):
    """Moves the camera: by scroll bars, to a block, to the whole page."""

    _is_scrolling = False
    _width = 0
    """Of the viewport when the camera was last put where it is."""

    def lay_out_more(self) -> None:
        """Lay out more of a large page, and know its size better."""
        super().lay_out_more()
        self.update_scroll_bars()

    def move_camera(self, x: float, y: float) -> None:
        """Look at a place of the page with the view's corner."""
        self.camera.x, self.camera.y = x, y
        self._camera_moved()

    def pan(self, dx: float, dy: float) -> None:
        """Move the view by pixels."""
        scale = self.camera.scale
        self.move_camera(self.camera.x + dx / scale, self.camera.y + dy / scale)

    def zoom(self, scale: float, at: QPointF | None = None) -> None:
        """Zoom, so that a point of the view (its middle) stays where it is."""
        centre = at if at is not None else QPointF(self.viewport().rect().center())
        self.camera.zoom_at(centre, scale)
        self.sharpen.start()
        self._camera_moved()

    def fit(self, rect: Rect | None = None) -> None:
        """Zoom and move so that the whole page (or a part of it) can be seen."""
        self.page_layout.chains.lay_out_all()
        whole = rect or self.page_layout.bounds()
        if whole is None:
            return
        view, room = self.viewport().size(), 32.0
        wide = (view.width() - 2 * room) / max(whole.width, 1.0)
        high = (view.height() - 2 * room) / max(whole.height, 1.0)
        self.zoom(min(wide, high, 1.0))
        left = whole.x + whole.width / 2 - view.width() / 2 / self.camera.scale
        top = whole.y + whole.height / 2 - view.height() / 2 / self.camera.scale
        self.move_camera(left, top)

    def show_block(self, block_id: str) -> None:
        """Scroll, and change the page, so that a block can be seen."""
        project = self.editor.project
        if block_id not in project.blocks:
            return
        self.show_page(project.page_of(project.stack_of(block_id).id))
        placed = self.page_layout.placed(block_id)
        if placed is not None:
            self.show_rect(_head(placed, self.measures))

    def show_rect(self, rect: Rect) -> None:
        """Scroll just so far that a part of the page can be seen."""
        seen = self.visible_page_rect()
        margin = 24.0 / self.camera.scale
        dx = _shift(seen.x + margin, seen.right - margin, rect.x, rect.right)
        dy = _shift(seen.y + margin, seen.bottom - margin, rect.y, rect.bottom)
        if dx or dy:
            self.move_camera(self.camera.x + dx, self.camera.y + dy)

    def _camera_moved(self) -> None:
        self.camera.align(self.devicePixelRatioF())
        self.update_scroll_bars()
        self.viewport().update()
        self.view_changed.emit()

    def show_page(self, page: str) -> None:
        """Show another page, from its beginning."""
        if page == self.page:
            return
        super().show_page(page)
        self.show_beginning()

    def show_beginning(self) -> None:
        """Look at the corner of the blocks where reading begins; a note beside them may wait."""
        layout = self.page_layout
        bounds = layout.index.bounds() or layout.bounds() or Rect(0.0, 0.0, 0.0, 0.0)
        x, margin = bounds.x, BEGINNING_PX / self.camera.scale
        self._width = self.viewport().width()
        if self.measures.is_mirrored:
            x = bounds.right + 2 * margin - self.visible_page_rect().width
        self.move_camera(x - margin, bounds.y - margin)

    def repaint_all(self) -> None:
        """Paint everything anew; the page may be larger now."""
        super().repaint_all()
        self.update_scroll_bars()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the new size; the side where reading begins stays where it is."""
        super().resizeEvent(event)
        before, self._width = self._width, event.size().width()
        if self.measures.is_mirrored and before:
            self.camera.x += (before - self._width) / self.camera.scale
            self.camera.align(self.devicePixelRatioF())
        self.update_scroll_bars()

    def update_scroll_bars(self) -> None:
        """Let the scroll bars reach over the page, and say where the camera is."""
        scale, view = self.camera.scale, self.viewport().size()
        bounds, seen = self.page_layout.bounds(), self.visible_page_rect()
        whole = seen if bounds is None else bounds.grown(MARGIN / scale).united(seen)
        self._is_scrolling = True
        _set(self.horizontalScrollBar(), whole.x, whole.width, seen.x, view.width(), scale)
        _set(self.verticalScrollBar(), whole.y, whole.height, seen.y, view.height(), scale)
        self._is_scrolling = False

    def scrollContentsBy(self, dx: int, dy: int) -> None:
        """Follow a scroll bar."""
        if self._is_scrolling:
            return
        self.camera.x = self.horizontalScrollBar().value() / self.camera.scale
        self.camera.y = self.verticalScrollBar().value() / self.camera.scale
        self.camera.align(self.devicePixelRatioF())
        self.viewport().update()
        self.view_changed.emit()


def _set(
    bar: QScrollBar, start: float, length: float, value: float, page: int, scale: float
) -> None:
    first = int(start * scale)
    bar.setRange(first, max(first, int((start + length) * scale) - page))
    bar.setPageStep(page)
    bar.setSingleStep(40)
    bar.setValue(round(value * scale))


def _shift(low: float, high: float, start: float, end: float) -> float:
    """How far a view from ``low`` to ``high`` must move to show what is from start to end."""
    if start < low or end - start > high - low:
        return start - low
    return end - high if end > high else 0.0


def _head(placed: Placed, measures: Measures) -> Rect:
    """The first row of a block, which is what a person looks for."""
    rect = placed.rect
    return Rect(rect.x, rect.y, rect.width, min(rect.height, 2 * measures.row_height))
