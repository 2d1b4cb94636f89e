"""Where the entries of the palette are: one below the other, blocks as narrow as the palette."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field

from PySide6.QtCore import QRectF

from nep_studio.ui.canvas.block_painter import BlockPainter
from nep_studio.ui.canvas.boxes import Chain
from nep_studio.ui.canvas.canvas import Canvas
from nep_studio.ui.canvas.garbage import paused_garbage_collection
from nep_studio.ui.canvas.layout import Layout
from nep_studio.ui.canvas.measures import Measures

from .entries import Drawer, Entry
from .stock import Stock

SCALE = 0.8
"""How large blocks are in the palette beside those of the canvas at its usual size."""

NARROWEST = 160.0
HIGHEST_SNIPPET = 200.0
"""How much of a snippet is shown, in units of the measures."""


@dataclass(slots=True)
class Spot:
    """An entry with its place, in pixels from the top of the list; ``chains`` are its blocks.

    ``x`` is where its chains begin: their left, or their right in a mirrored palette.
    """

    entry: Entry
    y: float
    height: float
    x: float = 0.0
    chains: list[Chain] = field(default_factory=list)
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

    def __init__(self, canvas: Canvas, width: float, size: float = 1.0) -> None:
        like = canvas.measures
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
        self._canvas = canvas
        self._tops: list[float] = []

    def fill(self, stock: Stock, entries: Sequence[Entry]) -> None:
        """Give every entry its place."""
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
        number = max(0, bisect_right(self._tops, y) - 1)
        return (number, y - self._tops[number]) if self._tops else (0, y)

    def drawer_and_way(self, y: float) -> tuple[str, float]:
        """A height as a drawer, and the way from its beginning."""
        drawer = self.drawer_at(y)
        first = self.first_of(drawer.id) if drawer is not None else None
        return (first.entry.drawer.id, y - first.y) if first is not None else ("", y)

    def place_of(self, drawer: str, way: float) -> float:
        """The height that ``drawer_and_way`` was told, where the drawer is now."""
        first = self.first_of(drawer)
        return (first.y if first is not None else 0.0) + way

    def block_rect(self, spot: Spot) -> QRectF:
        """The rectangle around the blocks of a spot, or around its words."""
        if not spot.chains:
            return QRectF(self.margin, spot.y, self.width - 2 * self.margin, spot.height)
        left = spot.x - spot.width if self.is_mirrored else spot.x
        return QRectF(left, spot.y, spot.width, spot.height)

    def _spot(self, entry: Entry, y: float, layout: Layout) -> Spot:
        line = self.line
        if entry.kind == "block":
            return self._blocks(entry, y, [layout.chain([entry.sample])])
        if entry.snippet is not None:
            return self._snippet(entry, y)
        if entry.kind == "words":
            words = self.measures.text_width(entry.text) * self.size
            rows = words / max(self.width - 2 * self.margin, 1) + 1
            return Spot(entry, y, line * 1.3 * int(rows + 0.5))
        return Spot(entry, y, line * (2.0 if entry.kind == "button" else 1.9))

    def _snippet(self, entry: Entry, y: float) -> Spot:
        assert entry.snippet is not None
        project = entry.snippet.clip.project
        language = self._canvas.editor.language.of(project)
        layout = Layout(project, language, self.measures)
        chains = [layout.chain(stack.body) for stack in entry.snippet.clip.stacks[:1]]
        spot = self._blocks(entry, y, chains)
        spot.painter = BlockPainter(
            self._canvas.theme, language, self.measures, self._canvas.block_font
        )
        spot.height += 1.4 * self.line
        return spot

    def _blocks(self, entry: Entry, y: float, chains: list[Chain]) -> Spot:
        chain = chains[0]
        scale = self.scale
        if chain.width * scale > self.width - 2 * self.margin:
            scale = max(0.3, (self.width - 2 * self.margin) / chain.width)
        height = chain.height if entry.kind == "block" else min(chain.height, self.highest_snippet)
        tab = self.measures.notch_depth
        x = self.width - self.margin if self.is_mirrored else self.margin
        spot = Spot(entry, y, (height + tab) * scale, x, chains, scale=scale)
        spot.width = chain.width * scale
        return spot
