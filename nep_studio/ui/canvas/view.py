"""A view of one page of blocks: its layers, painted through a camera."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QEvent, QPoint, QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QFont, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QAbstractScrollArea, QWidget

from nep_studio.blocks.editor import Editor
from nep_studio.blocks.program import Changes
from nep_studio.ui.theme import Theme

from .background import paint_background
from .block_painter import BlockPainter
from .camera import Camera
from .index import Rect
from .layers import StaticLayer, rects_of
from .layout import Gap
from .measures import Measures
from .notes import Notes
from .overlay import Overlay, ProblemOverlay, SelectionOverlay
from .page import Hit, PageLayout
from .selection import Selection
from .sprite import Sprite
from .texts import TextWidths

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
