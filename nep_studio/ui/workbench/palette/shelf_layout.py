"""Where the entries of the palette are: one below the other, blocks as narrow as the palette."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont, QPainter, QPen

from nep_studio.ui.canvas.host import CanvasHost
from nep_studio.ui.canvas.layout.boxes import Chain, Measures
from nep_studio.ui.canvas.layout.index import Rect
from nep_studio.ui.canvas.layout.layout import Layout
from nep_studio.ui.canvas.layout.page import boxes_of, paused_garbage_collection
from nep_studio.ui.canvas.painting.painter import BlockPainter
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import paint_icon
from nep_studio.ui.words import tr

from .entries import Drawer, Entry, Stock

SCALE = 0.8
"""How large blocks are in the palette beside those of the canvas at its usual size."""

NARROWEST = 160.0
HIGHEST_SNIPPET = 200.0
"""How much of a snippet is shown, in units of the measures."""
NOTE_LINES = 1.1
"""How high the words below a block are, in lines."""
ROUNDING = 1.0
"""A list that begins at a place may be scrolled so much less: to whole pixels."""


@dataclass(slots=True)
class Spot:
    """An entry with its place, in pixels from the top of the list; ``chain`` are its blocks.

    ``x`` is where its chain begins: its left, or its right in a mirrored palette.
    """

    entry: Entry
    y: float
    height: float
    x: float = 0.0
    chain: Chain | None = None
    painter: BlockPainter | None = None
    scale: float = SCALE
    width: float = 0.0

    @property
    def bottom(self) -> float:
        """Its lower side."""
        return self.y + self.height


class ShelfLayout:
    """The spots of a list of entries, for one width of the palette.

    ``size`` is how large the words of the palette are beside those of a canvas at scale 1.
    """

    def __init__(self, canvas: CanvasHost, width: float, size: float = 1.0) -> None:
        like = canvas.look.measures
        self.width, self.size, self.scale = width, size, SCALE * size
        self.is_mirrored = like.is_mirrored
        self.line = like.line * size
        self.margin = self.line * 0.6
        self.measures = Measures(like.line, like.text_width, is_mirrored=like.is_mirrored)
        room = (width - 2 * self.margin) / self.scale
        self.measures.widest = max(NARROWEST, room - 2 * self.measures.pad)
        self.highest_snippet = HIGHEST_SNIPPET * self.measures.unit
        self.spots: list[Spot] = []
        self.height = 0.0
        self.language = canvas.editor.language
        self._canvas = canvas
        self._tops: list[float] = []

    def fill(self, stock: Stock, entries: Sequence[Entry]) -> None:
        """Give every entry its place."""
        self.language = stock.language
        layout = Layout(stock.project, stock.language, self.measures)
        self.spots = []
        y = self.margin / 2
        with paused_garbage_collection():
            for entry in entries:
                spot = self._spot(entry, y, layout)
                self.spots.append(spot)
                y = spot.bottom + (self.margin / 4 if entry.kind == "heading" else self.margin)
        self.height = y + self.margin
        self._tops = [spot.y for spot in self.spots]

    def between(self, top: float, bottom: float) -> list[Spot]:
        """The spots that touch a part of the list."""
        first = max(0, bisect_right(self._tops, top) - 1)
        last = bisect_right(self._tops, bottom)
        return [spot for spot in self.spots[first:last] if spot.bottom >= top]

    def at(self, y: float) -> int:
        """The number of the spot at a height, or -1."""
        number = bisect_right(self._tops, y) - 1
        return number if number >= 0 and y <= self.spots[number].bottom else -1

    def first_of(self, drawer: str) -> Spot | None:
        """Where a drawer begins."""
        return next((spot for spot in self.spots if spot.entry.drawer.id == drawer), None)

    def drawer_at(self, y: float) -> Drawer | None:
        """The drawer at a height."""
        if not self.spots:
            return None
        number = max(0, bisect_right(self._tops, y) - 1)
        return self.spots[number].entry.drawer

    def lowest_top(self, view: float) -> int:
        """How far one can scroll: so far that the last drawer too can be at the top."""
        if self.height <= view or not self.spots:
            return 0
        last = self.first_of(self.spots[-1].entry.drawer.id)
        assert last is not None
        return round(max(self.height - view, last.y))

    def spot_and_way(self, y: float) -> tuple[int, float]:
        """A height as the number of the spot there, and the way from its top."""
        number = max(0, bisect_right(self._tops, y + ROUNDING) - 1)
        return (number, y - self._tops[number]) if self._tops else (0, y)

    def drawer_and_way(self, y: float) -> tuple[str, float]:
        """A height as a drawer, and the way from its beginning."""
        drawer = self.drawer_at(y + ROUNDING)
        first = self.first_of(drawer.id) if drawer is not None else None
        return (first.entry.drawer.id, y - first.y) if first is not None else ("", y)

    def place_of(self, drawer: str, way: float) -> float:
        """The height that ``drawer_and_way`` was told, where the drawer is now."""
        first = self.first_of(drawer)
        return (first.y if first is not None else 0.0) + way

    def block_rect(self, spot: Spot) -> QRectF:
        """The rectangle around the blocks of a spot, or around its words."""
        if spot.chain is None:
            return QRectF(self.margin, spot.y, self.width - 2 * self.margin, spot.height)
        left = spot.x - spot.width if self.is_mirrored else spot.x
        return QRectF(left, spot.y, spot.width, spot.height)

    def _spot(self, entry: Entry, y: float, layout: Layout) -> Spot:
        line = self.line
        if entry.kind == "block":
            spot = self._blocks(entry, y, layout.chain([entry.sample]))
            spot.height += NOTE_LINES * line if entry.note else 0.0
            return spot
        if entry.snippet is not None:
            project = entry.snippet.clip.project
            language = self._canvas.editor.language.of(project)
            chain = Layout(project, language, self.measures).chain(entry.snippet.clip.roots[0])
            spot = self._blocks(entry, y, chain)
            spot.painter = BlockPainter(
                self._canvas.look.theme, language, self.measures, self._canvas.look.block_font
            )
            spot.height += 1.4 * self.line
            return spot
        if entry.kind == "words":
            words = self.measures.text_width(entry.text) * self.size
            rows = words / max(self.width - 2 * self.margin, 1) + 1
            return Spot(entry, y, line * 1.3 * int(rows + 0.5))
        return Spot(entry, y, line * (2.0 if entry.kind == "button" else 1.9))

    def _blocks(self, entry: Entry, y: float, chain: Chain) -> Spot:
        scale = self.scale
        if chain.width * scale > self.width - 2 * self.margin:
            scale = max(0.3, (self.width - 2 * self.margin) / chain.width)
        height = chain.height if entry.kind == "block" else min(chain.height, self.highest_snippet)
        tab = self.measures.notch_depth
        x = self.width - self.margin if self.is_mirrored else self.margin
        spot = Spot(entry, y, (height + tab) * scale, x, chain, scale=scale)
        spot.width = chain.width * scale
        return spot


# Paint the entries of the palette that are in view.


class ShelfPainter:
    """Paints with the look of a canvas."""

    def __init__(self, canvas: CanvasHost, layout: ShelfLayout) -> None:
        self._theme: Theme = canvas.look.theme
        self._layout = layout
        self._font = QFont(canvas.look.block_font)
        self._font.setPointSizeF(self._font.pointSizeF() * layout.size)
        self._small = QFont(self._font)
        self._small.setPointSizeF(self._small.pointSizeF() * 0.85)
        self._bold = QFont(self._font)
        self._bold.setBold(True)
        self._blocks = BlockPainter(
            canvas.look.theme, layout.language, layout.measures, canvas.look.block_font
        )

    def paint(self, painter: QPainter, spot: Spot) -> None:
        """Paint one entry; the painter counts from the top of the list."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        kind = spot.entry.kind
        if kind == "heading":
            line, rect = self._layout.line, self._layout.block_rect(spot)
            badge = self._at_start(rect, 1.35 * line)
            paint_badge(painter, badge, spot.entry.drawer, self._theme)
            painter.setFont(self._bold)
            painter.setPen(self._theme.colour("text"))
            self._text(painter, self._beside(rect, badge), spot.entry.text)
        elif kind == "button":
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
        elif kind == "words":
            painter.setFont(self._font)
            painter.setPen(self._theme.colour("muted"))
            side = _side(self._layout.is_mirrored)
            flags = side | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap
            rect = self._layout.block_rect(spot).adjusted(0, 0, 0, self._layout.line)
            painter.drawText(rect, int(flags), spot.entry.text)
        elif spot.chain is not None:
            self._blocks_of(painter, spot, spot.chain)

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

    def _blocks_of(self, painter: QPainter, spot: Spot, chain: Chain) -> None:
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
        (spot.painter or self._blocks).paint(painter, boxes_of(chain, shown), spot.scale)
        painter.restore()
        if spot.entry.note:
            high, margin = NOTE_LINES * self._layout.line, self._layout.margin
            row = QRectF(margin, spot.bottom - high, self._layout.width - 2 * margin, high)
            painter.setFont(self._small)
            painter.setPen(self._theme.colour("muted"))
            self._text(painter, row, spot.entry.note)

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
