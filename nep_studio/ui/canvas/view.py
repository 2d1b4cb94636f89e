"""A view of one page of blocks: its layers, painted through a camera."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, cast

from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import (
    QDragEnterEvent,
    QDragLeaveEvent,
    QDragMoveEvent,
    QDropEvent,
    QFont,
    QPainter,
    QPaintEvent,
    QResizeEvent,
)
from PySide6.QtWidgets import QAbstractScrollArea, QScrollBar, QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Changes
from nep_studio.ui.theme.colours import Theme

from .editing.commands import Selection
from .editing.drag_blocks import carry_in, clip_in, project_files
from .layout.boxes import Measures, TextWidths
from .layout.index import Camera, Rect
from .layout.layout import Gap
from .layout.page import Hit, PageLayout, Placed
from .painting.layers import Sprite, StaticLayer, paint_background, rects_of
from .painting.notes import Notes
from .painting.overlay import Overlay, ProblemOverlay, SelectionOverlay
from .painting.painter import BlockPainter

if TYPE_CHECKING:
    from .canvas import Canvas


SHARPEN_MS = 80
"""How long zooming must rest before the blocks are painted anew at their new size."""

SLICE_S = 0.006
"""How long stacks out of view are laid out at a time."""


class PageView(QAbstractScrollArea):
    """Shows a page of blocks, and paints again what a step of the editor has changed."""

    page_changed = Signal(str)
    view_changed = Signal()
    layout_changed = Signal()

    def __init__(
        self,
        editor: Editor,
        theme: Theme,
        *,
        font: QFont | None = None,
        is_mirrored: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.editor = editor
        self.camera = Camera()
        self.selection = Selection(self)
        self.problems = ProblemOverlay()
        self.notes = Notes(self)
        self.overlays: list[Overlay] = [self.notes, SelectionOverlay(), self.problems]
        self.sprite: Sprite | None = None
        self.accessible: object = None
        self._layer = StaticLayer(self._paint_page)
        self.sharpen = QTimer(self, singleShot=True, interval=SHARPEN_MS)
        self.sharpen.timeout.connect(self.viewport().update)
        self._rest = QTimer(self, interval=0)
        self._rest.timeout.connect(self.lay_out_more)
        self.set_look(theme, font or self.font(), is_mirrored=is_mirrored)
        editor.history.listen(self._on_changes)
        self.selection.changed.connect(self.viewport().update)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.viewport().setMouseTracking(True)
        self.setFrameShape(QAbstractScrollArea.Shape.NoFrame)

    def set_look(self, theme: Theme, font: QFont, *, is_mirrored: bool) -> None:
        """Show the blocks with this theme, this font, and from this side."""
        self.theme = theme
        self.block_font = QFont(font)
        self.block_font.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
        self.badge_font = QFont(self.block_font)
        self.badge_font.setBold(True)
        self.badge_font.setPointSizeF(max(1.0, self.block_font.pointSizeF() * 0.8))
        widths = TextWidths(self.block_font)
        self.measures = Measures(widths.line, widths, is_mirrored=is_mirrored)
        page = self.page
        self.block_painter = BlockPainter(
            theme, self.editor.language, self.measures, self.block_font
        )
        self.page_layout = PageLayout(self.editor.project, self.editor.language, self.measures)
        if page != self.page_layout.page:
            self.page_layout.show(page)
        self.repaint_all()

    @property
    def page(self) -> str:
        """The page that is shown."""
        layout: PageLayout | None = getattr(self, "page_layout", None)
        return layout.page if layout is not None else "behaviour"

    def show_page(self, page: str) -> None:
        """Show another page."""
        if page == self.page:
            return
        self.selection.clear()
        self.page_layout.show(page)
        self.repaint_all()
        self.page_changed.emit(page)

    def set_editor(self, editor: Editor) -> None:
        """Show another project."""
        self.editor.history.unlisten(self._on_changes)
        self.editor = editor
        editor.history.listen(self._on_changes)
        self.selection.clear()
        self.page_layout.page = "behaviour"
        self.set_look(self.theme, self.block_font, is_mirrored=self.measures.is_mirrored)
        self.page_changed.emit(self.page)

    # What is where

    def to_page(self, point: QPointF | QPoint) -> QPointF:
        """A point of the viewport on the page."""
        return self.camera.to_page(QPointF(point))

    def hit(self, point: QPointF | QPoint) -> Hit | None:
        """What is under a point of the viewport."""
        at = self.to_page(point)
        return self.page_layout.hit(at.x(), at.y())

    def view_rect_of(self, block_id: str) -> QRectF | None:
        """Where a block is in the viewport; None when the page does not show it."""
        placed = self.page_layout.placed(block_id)
        return self.camera.view_rect(placed.rect) if placed is not None else None

    def visible_page_rect(self) -> Rect:
        """The part of the page in the view."""
        return self.camera.page_rect(QRectF(self.viewport().rect()))

    # Painting

    def lay_out_more(self) -> None:
        """Lay out, while nobody waits, some of the stacks of a large page that are out of view."""
        chains = self.page_layout.chains
        if not chains.lay_out_some(SLICE_S):
            self._rest.stop()
        outgrown, chains.outgrown = chains.outgrown, []
        self.repaint_page(outgrown)

    def repaint_all(self) -> None:
        """Paint everything anew."""
        self._rest.start()
        self.notes.refresh()
        self._layer.invalidate_all()
        self.viewport().update()
        self.layout_changed.emit()

    def repaint_page(self, rects: Iterable[Rect]) -> None:
        """Paint these parts of the page anew."""
        margin = 4 * self.measures.unit
        for rect in rects:
            view = self.camera.view_rect(rect.grown(margin))
            self._layer.invalidate(view)
            self.viewport().update(view.toAlignedRect().adjusted(-2, -2, 2, 2))

    def update_page(self, rect: Rect) -> None:
        """Draw the overlays of a part of the page again; the blocks rest."""
        self.viewport().update(self.camera.view_rect(rect).toAlignedRect().adjusted(-4, -4, 4, 4))

    def set_preview(self, hidden: frozenset[str], gap: Gap | None) -> None:
        """Show the page without some blocks, and with a gap where they would go."""
        if (hidden, gap) != (self.page_layout.layout.hidden, self.page_layout.layout.gap):
            self.repaint_page(self.page_layout.preview(hidden, gap))

    def set_sprite(self, sprite: Sprite | None) -> None:
        """Show carried blocks over everything, or none."""
        if self.sprite is not None:
            self.viewport().update(self.sprite.view_rect(self.camera))
        self.sprite = sprite
        self.update_sprite()

    def update_sprite(self) -> None:
        """Draw the carried blocks where they are now."""
        if self.sprite is not None:
            self.viewport().update(self.sprite.view_rect(self.camera))

    def move_sprite(self, x: float, y: float) -> None:
        """Carry the blocks to another place of the page."""
        if self.sprite is not None:
            before = self.sprite.view_rect(self.camera)
            self.sprite.x, self.sprite.y = x, y
            # One rectangle: a region of two is clipped piece by piece, which costs more.
            self.viewport().update(before.united(self.sprite.view_rect(self.camera)))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the layers: what rests, what is over it, what is carried."""
        layer, is_zooming = self._layer, self.sharpen.isActive()
        if not is_zooming or layer.is_outdated or layer.is_sharp(self.camera):
            layer.repair(self.camera)
        with QPainter(self.viewport()) as painter:  # ended also when a drawing fails
            self._paint_layers(painter, event)

    def _paint_layers(self, painter: QPainter, event: QPaintEvent) -> None:
        for rect in rects_of(event.region()):
            self._layer.draw(painter, self.camera, rect, self.theme.colour("canvas"))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.scale(self.camera.scale, self.camera.scale)
        painter.translate(-self.camera.x, -self.camera.y)
        for overlay in self.overlays:
            overlay.paint(painter, self)
        if self.sprite is not None:
            self.sprite.paint(painter, self.camera, self.devicePixelRatioF())

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Take the picture in the new size."""
        self._layer.resize(self.viewport().size(), self.devicePixelRatioF())
        super().resizeEvent(event)

    def viewportEvent(self, event: QEvent) -> bool:
        """Paint at the new resolution when the window moves to another screen."""
        if event.type() == QEvent.Type.DevicePixelRatioChange:
            self._layer.resize(self.viewport().size(), self.devicePixelRatioF())
        return super().viewportEvent(event)

    def _on_changes(self, changes: Changes) -> None:
        self.repaint_page(self.page_layout.change(changes))
        if self.page_layout.chains.is_waiting:
            self._rest.start()
        self.repaint_page(self.notes.change(changes))
        self.selection.keep(i for i in self.selection.ids if i in self.editor.project.blocks)
        self.layout_changed.emit()

    def _paint_page(self, painter: QPainter, rect: Rect, camera: Camera) -> None:
        paint_background(painter, rect, camera, self.theme)
        self.notes.paint_resting(painter, rect, camera.scale)
        boxes = self.page_layout.boxes(rect.grown(8 * self.measures.unit))
        self.block_painter.paint(painter, boxes, camera.scale)


# A view of a page that can be scrolled and zoomed.

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


# A view onto which blocks and project files can be dropped from other windows.


class DropTarget(ScrollingView):
    """Blocks from outside are carried like those of the page; a file is only told of."""

    file_dropped = Signal(str)

    def __init__(
        self,
        editor: Editor,
        theme: Theme,
        *,
        font: QFont | None = None,
        is_mirrored: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(editor, theme, font=font, is_mirrored=is_mirrored, parent=parent)
        self.viewport().setAcceptDrops(True)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take project files, and the text of blocks."""
        canvas = cast("Canvas", self)
        if project_files(event.mimeData()):
            event.acceptProposedAction()
            return
        clip = clip_in(canvas, event.mimeData())
        if clip is not None:
            carry_in(canvas, clip, self.viewport().mapToGlobal(event.position().toPoint()))
            event.setDropAction(Qt.DropAction.CopyAction)
            event.accept()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        """Bring the blocks along."""
        cast("Canvas", self).pointing.move_to(event.position())
        event.accept()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """The blocks have left again."""
        cast("Canvas", self).cancel_gesture()

    def dropEvent(self, event: QDropEvent) -> None:
        """Put the blocks where they are, or tell which file was dropped."""
        files = project_files(event.mimeData())
        for path in files:
            self.file_dropped.emit(path)
        if not files:
            cast("Canvas", self).pointing.release_at(event.position())
        event.setDropAction(Qt.DropAction.CopyAction)
        event.accept()
