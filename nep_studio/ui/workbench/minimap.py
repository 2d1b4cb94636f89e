"""The minimap: all stacks of the page in small, and which part of it is in view."""

from __future__ import annotations

from bisect import bisect_right

from PySide6.QtCore import QPointF, QRectF, Qt, QTimer
from PySide6.QtGui import QMouseEvent, QPainter, QPaintEvent, QPen, QPixmap, QShowEvent, QWheelEvent
from PySide6.QtWidgets import QLabel, QWidget

from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.layout.boxes import Chain
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.labels import follow_words, labelled
from nep_studio.ui.widgets.layouts import InLines
from nep_studio.ui.words import tr

DRAW_MS = 150
"""How long the program must rest before the small picture is painted again."""

MARGIN = 10
LARGEST_SCALE = 0.2
INDENT_SCALE = 0.05
"""From this scale on the blocks inside others are drawn too."""


class Minimap(InLines):
    """Lies over the lower corner of a canvas. A press looks there; the frame can be dragged."""

    usual_lines = (12.0, 8.0)

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas)
        self.canvas = canvas
        self._picture = QPixmap()
        self._whole = Rect(0.0, 0.0, 1.0, 1.0)
        self._scale = 1.0
        self._is_stale = True
        self._grip: QPointF | None = None
        self.below = 0
        """How much room is left free under it, in pixels."""
        self._later = QTimer(self, singleShot=True, interval=DRAW_MS)
        self._later.timeout.connect(self._on_rested)
        canvas.news.layout_changed.connect(self._on_layout_changed)
        canvas.news.view_changed.connect(self._on_view_changed)
        canvas.news.page_changed.connect(self.refresh)
        canvas.news.resized.connect(self._take_place)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        labelled(self, name="Minimap: a press looks there", tip="Minimap: a press looks there")
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Take the theme, the direction and the page of the canvas."""
        self._is_stale = True
        self._take_place()
        self.update()

    def draw_now(self) -> None:
        """Paint the small picture; the cost is by its pixels, not by the number of blocks."""
        self._is_stale = False
        ratio = self.devicePixelRatioF()
        self._picture = QPixmap(self.size() * ratio)
        self._picture.setDevicePixelRatio(ratio)
        self._picture.fill(self.canvas.look.theme.colour("panel"))
        layout = self.canvas.page_layout
        bounds = layout.bounds()
        if bounds is None:
            self._whole, self._scale = Rect(0.0, 0.0, 1.0, 1.0), 1.0
            return
        self._whole = bounds.grown(max(bounds.width, bounds.height) * 0.02 + 20.0)
        wide, high = self.width() / self._whole.width, self.height() / self._whole.height
        self._scale = min(wide, high, LARGEST_SCALE)
        with QPainter(self._picture) as painter:
            painter.setPen(Qt.PenStyle.NoPen)
            for chain in layout.chains.values():
                corner = self._to_map(chain.x, chain.y)
                self._draw_chain(painter, chain, corner.x(), corner.y())

    def _draw_chain(self, painter: QPainter, chain: Chain, x: float, y: float) -> None:
        """One bar for each row of pixels at most, in the colour of the block that is there."""
        scale, painted = self._scale, self.canvas.look.block_painter
        least = 1.0 / scale
        height = 0.0
        while height < chain.height:
            number = min(bisect_right(chain.ys, height), len(chain.boxes)) - 1
            box, top = chain.boxes[number], chain.ys[number]
            end = max(chain.ys[number + 1], height + least)
            if box.block:
                left = x - box.width * scale if chain.is_mirrored else x
                rect = QRectF(left, y + top * scale, box.width * scale, (end - top) * scale)
                painter.fillRect(rect, painted.look_of(box)[0].fill)
                if scale >= INDENT_SCALE:
                    for mouth in box.mouths:
                        inner = left + mouth.x * scale
                        self._draw_chain(painter, mouth, inner, y + (top + mouth.y) * scale)
            height = end

    # Where things are

    def _to_map(self, x: float, y: float) -> QPointF:
        """A place of the page in the small picture, which is in the middle of the widget."""
        left = (self.width() - self._whole.width * self._scale) / 2
        top = (self.height() - self._whole.height * self._scale) / 2
        return QPointF(
            left + (x - self._whole.x) * self._scale, top + (y - self._whole.y) * self._scale
        )

    def to_page(self, point: QPointF) -> QPointF:
        """A place of the small picture on the page."""
        corner = self._to_map(self._whole.x, self._whole.y)
        way = (point - corner) / self._scale
        return QPointF(self._whole.x + way.x(), self._whole.y + way.y())

    def view_frame(self) -> QRectF:
        """The part of the page in view, in the small picture."""
        seen = self.canvas.sight.visible_page_rect()
        return QRectF(self._to_map(seen.x, seen.y), self._to_map(seen.right, seen.bottom))

    # Painting

    def paintEvent(self, event: QPaintEvent) -> None:
        """Show the picture and the frame of the view."""
        if self._is_stale or self._picture.isNull():
            self.draw_now()
        theme = self.canvas.look.theme
        with QPainter(self) as painter:
            painter.drawPixmap(0, 0, self._picture)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            shade = theme.colour("accent")
            shade.setAlphaF(0.14)
            painter.setPen(QPen(theme.colour("accent"), 2))
            painter.setBrush(shade)
            whole = QRectF(self.rect()).adjusted(1, 1, -1, -1)
            if self.canvas.page_layout.bounds() is not None:
                painter.drawRoundedRect(self.view_frame().intersected(whole), 3, 3)
            painter.setPen(QPen(theme.colour("field_line"), 1))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)

    # Mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Look there, or take hold of the frame."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        frame = self.view_frame()
        if frame.contains(event.position()):
            self._grip = event.position() - frame.center()
        else:
            self._grip = QPointF()
            self._look_at(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the frame."""
        if self._grip is not None:
            self._look_at(event.position() - self._grip)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        self._grip = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """The second press is like the first, not one on the canvas."""
        self.mousePressEvent(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom: the wheel over the small picture changes how much is seen."""
        factor = 1.15 if event.angleDelta().y() > 0 else 1 / 1.15
        self.canvas.sight.zoom(self.canvas.sight.camera.scale * factor)
        event.accept()

    def _look_at(self, point: QPointF) -> None:
        page, seen = self.to_page(point), self.canvas.sight.visible_page_rect()
        self.canvas.sight.move_camera(page.x() - seen.width / 2, page.y() - seen.height / 2)

    # Following the canvas

    def showEvent(self, event: QShowEvent) -> None:
        """Be up to date from now on."""
        super().showEvent(event)
        self._is_stale = True
        self.raise_()
        self._take_place()

    def _take_place(self) -> None:
        view = self.canvas.viewport().geometry()
        size = self.sizeHint().boundedTo(view.size() / 2)
        if size != self.size():
            self.resize(size)
            self._is_stale = True
        is_mirrored = self.canvas.look.measures.is_mirrored
        x = view.left() + MARGIN if is_mirrored else view.right() - MARGIN - size.width()
        self.move(x, view.bottom() - self.below - MARGIN - size.height())

    def _on_layout_changed(self) -> None:
        if self.isVisible() and not self._later.isActive():
            self._later.start()

    def _on_rested(self) -> None:
        self._is_stale = True
        self.update()

    def _on_view_changed(self) -> None:
        if self.isVisible():
            self.update()


# What an empty page says: what belongs there, and how one begins.

WIDEST_LINES = 22
"""How wide the words may be, in lines of text."""


class EmptyHint(QLabel):
    """Words in the middle of a page on which there is nothing yet; the mouse goes through."""

    def __init__(self, canvas: Canvas) -> None:
        super().__init__(canvas.viewport())
        self._canvas = canvas
        self.setWordWrap(True)
        self.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.setProperty("role", "hint")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        canvas.news.layout_changed.connect(self._show_or_hide)
        canvas.news.page_changed.connect(self.refresh)
        canvas.news.resized.connect(self._take_place)
        follow_words(self, self.refresh)

    def refresh(self) -> None:
        """Take the words for the page that is shown."""
        project, page = self._canvas.editor.project, self._canvas.page_layout.page
        belongs = {
            "robots": tr("Here you say which robots take part."),
            "nodes": tr("Here you say which nodes run. The program finds most by itself."),
        }
        first = belongs.get(project.kind_of_page(page), "")
        how = tr("Drag a block here, or press / and type what should happen.")
        self.setText(f"{first}\n{how}".strip())
        self._show_or_hide()

    def _show_or_hide(self) -> None:
        project, page = self._canvas.editor.project, self._canvas.page_layout.page
        has_notes = any(note.page == page for note in project.notes.values())
        is_empty = not project.pages.get(page) and not has_notes
        self.setVisible(is_empty)
        if is_empty:
            self._take_place()

    def _take_place(self) -> None:
        view: QWidget = self._canvas.viewport()
        wide = min(self.fontMetrics().height() * WIDEST_LINES, view.width() - 16)
        self.resize(wide, self.heightForWidth(wide))
        self.move((view.width() - wide) // 2, max(0, view.height() * 2 // 5 - self.height() // 2))
