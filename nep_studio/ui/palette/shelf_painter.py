"""Paint the entries of the palette that are in view."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont, QPainter, QPen

from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.index import Rect
from nep_studio.ui.canvas.page import boxes_of
from nep_studio.ui.theme import Theme, paint_icon
from nep_studio.ui.words import tr

from .entries import Drawer, Entry
from .shelf_layout import ShelfLayout, Spot


class ShelfPainter:
    """Paints with the look of a canvas."""

    def __init__(self, canvas: Canvas, layout: ShelfLayout) -> None:
        self._theme: Theme = canvas.theme
        self._layout = layout
        self._font = QFont(canvas.block_font)
        self._font.setPointSizeF(self._font.pointSizeF() * layout.size)
        self._bold = QFont(self._font)
        self._bold.setBold(True)
        self._blocks = BlockPainter(
            canvas.theme, canvas.editor.language, layout.measures, canvas.block_font
        )

    def paint(self, painter: QPainter, spot: Spot) -> None:
        """Paint one entry; the painter counts from the top of the list."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        kind = spot.entry.kind
        if kind == "heading":
            self._heading(painter, spot)
        elif kind == "button":
            self._button(painter, spot)
        elif kind == "words":
            self._words(painter, spot)
        else:
            self._chains(painter, spot)

    def paint_mark(self, painter: QPainter, spot: Spot, *, is_current: bool) -> None:
        """Show where the mouse is, or the keyboard."""
        rect = self._layout.block_rect(spot).adjusted(-4, -3, 4, 3)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if is_current:
            painter.setPen(QPen(self._theme.colour("focus"), 2.5))
        else:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(self._theme.colour("hover"))
        painter.drawRoundedRect(rect, 8, 8)

    def paint_delete(self, painter: QPainter, rect: QRectF) -> None:
        """Show that blocks let go here are deleted: colour, sign and word."""
        panel = self._theme.colour("error_panel")
        panel.setAlphaF(0.94)
        painter.fillRect(rect, panel)
        line = self._layout.line
        colour = self._theme.colour("error")
        painter.setPen(QPen(colour, line / 6, Qt.PenStyle.DashLine))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(rect.adjusted(line / 2, line / 2, -line / 2, -line / 2), 10, 10)
        side = 2.4 * line  # at the top, as what is carried hides what is in the middle
        square = QRectF(rect.center().x() - side / 2, rect.top() + line, side, side)
        paint_icon(painter, square, "trash-2", colour)
        painter.setFont(self._bold)
        below = QRectF(rect.left(), square.bottom() + line / 3, rect.width(), 2 * line)
        painter.drawText(below, Qt.AlignmentFlag.AlignHCenter, tr("Delete"))

    def _heading(self, painter: QPainter, spot: Spot) -> None:
        line, rect = self._layout.line, self._layout.block_rect(spot)
        badge = self._at_start(rect, 1.35 * line)
        paint_badge(painter, badge, spot.entry.drawer, self._theme)
        painter.setFont(self._bold)
        painter.setPen(self._theme.colour("text"))
        self._text(painter, self._beside(rect, badge), spot.entry.text)

    def _button(self, painter: QPainter, spot: Spot) -> None:
        line, rect = self._layout.line, self._layout.block_rect(spot)
        painter.setPen(QPen(self._theme.colour("field_line"), 1.2))
        painter.setBrush(self._theme.colour("field"))
        painter.drawRoundedRect(rect, 8, 8)
        inner = rect.adjusted(line / 2, 0, -line / 2, 0)
        place = self._at_start(inner, line)
        paint_icon(painter, place, _button_icon(spot.entry), self._theme.colour("text"))
        painter.setFont(self._font)
        painter.setPen(self._theme.colour("text"))
        self._text(painter, self._beside(inner, place), spot.entry.text)

    def _words(self, painter: QPainter, spot: Spot) -> None:
        painter.setFont(self._font)
        painter.setPen(self._theme.colour("muted"))
        side = _side(self._layout.is_mirrored)
        flags = side | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
        rect = self._layout.block_rect(spot).adjusted(0, 0, 0, self._layout.line)
        painter.drawText(rect, int(flags), spot.entry.text)

    def _chains(self, painter: QPainter, spot: Spot) -> None:
        top = spot.y
        if spot.entry.kind == "snippet":
            line = self._layout.line
            row = QRectF(
                self._layout.margin, top, self._layout.width - 2 * self._layout.margin, line * 1.2
            )
            place = self._at_start(row, line)
            paint_icon(painter, place, spot.entry.drawer.icon, self._theme.colour("text"))
            painter.setFont(self._font)
            painter.setPen(self._theme.colour("text"))
            self._text(painter, self._beside(row, place), spot.entry.text)
            top += 1.4 * line
        painter.save()
        highest = self._layout.highest_snippet if spot.entry.kind == "snippet" else 1e6
        painter.translate(spot.x, top)
        painter.scale(spot.scale, spot.scale)
        if spot.entry.kind == "snippet":
            painter.setClipRect(QRectF(-1e5, -4, 2e5, highest + 8))
        shown = Rect(-1e5, -1.0, 2e5, highest)
        for chain in spot.chains:
            (spot.painter or self._blocks).paint(painter, boxes_of(chain, shown), spot.scale)
        painter.restore()

    def _at_start(self, rect: QRectF, side: float) -> QRectF:
        """A square where reading begins, in the middle of a row."""
        x = rect.right() - side if self._layout.is_mirrored else rect.left()
        return QRectF(x, rect.center().y() - side / 2, side, side)

    def _beside(self, rect: QRectF, square: QRectF) -> QRectF:
        gap = self._layout.line * 0.45
        if self._layout.is_mirrored:
            return QRectF(rect.left(), rect.top(), square.left() - gap - rect.left(), rect.height())
        left = square.right() + gap
        return QRectF(left, rect.top(), rect.right() - left, rect.height())

    def _text(self, painter: QPainter, rect: QRectF, text: str) -> None:
        side = _side(self._layout.is_mirrored)
        mode = Qt.TextElideMode.ElideRight
        shown = painter.fontMetrics().elidedText(text, mode, int(rect.width()))
        painter.drawText(rect, int(side | Qt.AlignmentFlag.AlignVCenter), shown)


def paint_badge(painter: QPainter, rect: QRectF, drawer: Drawer, theme: Theme) -> None:
    """The sign of a drawer: its icon on the colour of its blocks."""
    if not drawer.colour:
        paint_icon(painter, rect.adjusted(1, 1, -1, -1), drawer.icon, theme.colour("text"))
        return
    colours = theme.block(drawer.colour)
    painter.setPen(QPen(colours.line, 1.2))
    painter.setBrush(colours.fill)
    radius = rect.height() * 0.3
    painter.drawRoundedRect(rect, radius, radius)
    inner = rect.height() * 0.18
    icon_rect = rect.adjusted(inner, inner, -inner, -inner)
    paint_icon(painter, icon_rect, drawer.icon, colours.text)


def _button_icon(entry: Entry) -> str:
    return {"keep": "star", "import": "download"}.get(entry.action, "plus")


def _side(is_mirrored: bool) -> Qt.AlignmentFlag:
    """Where text begins; absolute, so that the direction of the application does not count."""
    side = Qt.AlignmentFlag.AlignRight if is_mirrored else Qt.AlignmentFlag.AlignLeft
    return side | Qt.AlignmentFlag.AlignAbsolute
