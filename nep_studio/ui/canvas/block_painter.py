"""Paint boxes: outline, words, fields, sockets and buttons, in the colours of the theme."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import Qt
from PySide6.QtGui import QBrush, QColor, QFont, QPainter, QPainterPath, QPen

from nep_studio.blocks.language import Language
from nep_studio.ui.theme import DISABLED, PLACEHOLDER, BlockColours, Theme

from .boxes import Box
from .geometry import Outlines
from .measures import Measures
from .page import Placed
from .piece_painter import PiecePainter

SMALLEST_TEXT_SCALE = 0.4
"""Below this zoom words cannot be read, and are not painted."""

SMALLEST_PIECE_SCALE = 0.2
"""Below this zoom fields are less than a few pixels, and are not painted either."""


class BlockPainter:
    """Paints blocks with one theme, one language and one font."""

    def __init__(self, theme: Theme, language: Language, measures: Measures, font: QFont) -> None:
        self.theme = theme
        self.outlines = Outlines(measures)
        self._language = language
        self._measures = measures
        self._pieces = PiecePainter(theme, self.outlines, measures)
        self._font = font
        self._looks: dict[tuple[str, bool], tuple[BlockColours, QBrush, QPen]] = {}

    def paint(self, painter: QPainter, boxes: Iterable[Placed], scale: float) -> None:
        """Paint boxes, each before those inside it; the painter counts in canvas units."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, True)
        painter.setFont(self._font)
        x = y = 0.0
        detail = 2 if scale >= SMALLEST_TEXT_SCALE else 1 if scale >= SMALLEST_PIECE_SCALE else 0
        for placed in boxes:
            painter.translate(placed.x - x, placed.y - y)
            x, y = placed.x, placed.y
            self._paint_box(painter, placed.box, detail)
        painter.translate(-x, -y)

    def colours(self, box: Box) -> BlockColours:
        """The colours of a block."""
        return self._look(box)[0]

    def _look(self, box: Box) -> tuple[BlockColours, QBrush, QPen]:
        key = (box.type, box.is_disabled)
        look = self._looks.get(key)
        if look is None:
            colours = self._colours_of(box)
            pen = QPen(colours.line, 1.2 * self._measures.unit)
            look = self._looks[key] = (colours, QBrush(colours.fill), pen)
        return look

    def _colours_of(self, box: Box) -> BlockColours:
        if box.is_disabled:
            return self.theme.block(DISABLED)
        definition = self._language.definitions.get(box.type)
        name = definition.category.colour if definition is not None else PLACEHOLDER
        return self.theme.block(name)

    def _paint_box(self, painter: QPainter, box: Box, detail: int) -> None:
        if box.outline == "gap":
            self._paint_gap(painter, box)
            return
        colours, brush, pen = self._look(box)
        path = self.outlines.of(box)
        painter.setPen(pen if detail else Qt.PenStyle.NoPen)
        painter.setBrush(brush)
        painter.drawPath(path)
        if box.is_disabled:
            _hatch(painter, path, colours.line)
        if detail == 0:
            return
        for piece in box.pieces:
            self._pieces.paint(painter, piece, colours, with_text=detail == 2)

    def _paint_gap(self, painter: QPainter, box: Box) -> None:
        colour = self.theme.colour("snap")
        colour.setAlphaF(0.28)
        painter.setPen(QPen(self.theme.colour("snap"), 2 * self._measures.unit))
        painter.setBrush(colour)
        painter.drawPath(self.outlines.of(box))


def _hatch(painter: QPainter, path: QPainterPath, colour: QColor) -> None:
    """Stripes: what is switched off shows it by more than its colour."""
    faint = QColor(colour)
    faint.setAlphaF(0.35)
    painter.fillPath(path, QBrush(faint, Qt.BrushStyle.BDiagPattern))
