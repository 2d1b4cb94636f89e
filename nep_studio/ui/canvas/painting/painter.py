"""Paint boxes: outline, words, fields, sockets and buttons, in the colours of the theme."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QFont, QPainter, QPen, qGray

from nep_studio.blocks.language import Language
from nep_studio.ui.canvas.layout.boxes import Box, Measures, Piece, Texts, TextWidths
from nep_studio.ui.canvas.layout.page import Placed
from nep_studio.ui.canvas.layout.pieces import HINT_SIZE
from nep_studio.ui.theme.colours import DISABLED, PLACEHOLDER, BlockColours, Theme, mixed

from .shapes import Outlines, paint_marks, paint_sign, round_pen, slot_path

# What is typed in is white, what is chosen has the colour of its block.

TINT = 0.24
"""How far the colour of a choice is from that of its block."""

DARKEST_TINTED = 0.02
"""Blocks that are darker have choices that are brighter than they are."""


LIGHTEST_TINT, DARKEST_WORDS = 219, 48
"""Greys. A choice that is lighter could be taken for a white field of text: it is darker than its
block then, where the words are so dark that they can be read on it."""


def choice_tint(colours: BlockColours) -> QColor:
    """What a choice is filled with: the block's colour, farther from that of its words."""
    away = QColor("black" if qGray(colours.text.rgb()) > 128 else "white")
    if colours.fill.lightnessF() < DARKEST_TINTED:
        return mixed(colours.fill, colours.line, TINT)  # there is hardly a darker colour
    tint = mixed(colours.fill, away, TINT)
    if qGray(tint.rgb()) > LIGHTEST_TINT and qGray(colours.text.rgb()) < DARKEST_WORDS:
        return mixed(colours.fill, QColor("black"), TINT)
    return tint


# Paint what is inside a block: words, fields, sockets and buttons.


class PiecePainter:
    """Paints the pieces of boxes."""

    def __init__(self, theme: Theme, measures: Measures) -> None:
        self._theme = theme
        self._measures = measures
        self._texts = Texts()
        self._hints = Texts()
        self._hint_font: QFont | None = None
        self._shades: dict[int, QColor] = {}
        self._tints: dict[tuple[int, int], QColor] = {}

    def paint(
        self, painter: QPainter, piece: Piece, colours: BlockColours, *, with_text: bool
    ) -> None:
        """Paint one piece; the painter's origin is the block's corner."""
        if piece.piece == "words":
            if with_text:
                painter.setPen(colours.text)
                painter.drawStaticText(QPointF(piece.x, piece.y), self._texts[piece.text])
        elif piece.piece == "field":
            self._field(painter, piece, colours, with_text)
        elif piece.piece == "socket":
            self._shape(painter, piece, self._darker(colours.fill), colours.line)
            if with_text and piece.hint:
                self._hint(painter, piece, colours.text, piece.x, piece.width)
        elif with_text:
            self._button(painter, piece, colours)

    def _shape(self, painter: QPainter, piece: Piece, fill: QColor, line: QColor) -> None:
        painter.setPen(QPen(line, self._measures.unit))
        painter.setBrush(fill)
        painter.translate(piece.x, piece.y)
        width, height = round(piece.width, 1), round(piece.height, 1)
        painter.drawPath(slot_path(piece.shape, width, height, self._measures.unit))
        painter.translate(-piece.x, -piece.y)

    def _field(
        self, painter: QPainter, piece: Piece, colours: BlockColours, with_text: bool
    ) -> None:
        if piece.kind == "parameter":
            # A parameter looks like the block that is dragged out of it
            self._shape(painter, piece, self._darker(colours.fill), colours.text)
            if with_text:
                painter.setPen(colours.text)
                self._centred(painter, piece, piece.x, piece.width)
            return
        fill, ink, line = self._inks(piece, colours)
        self._shape(painter, piece, fill, line)
        if not with_text:
            return
        lead = self._measures.line * 0.95 if piece.mark == "dial" else 0.0
        trail = self._measures.line * 0.75 if piece.opens else 0.0
        if piece.mark or piece.opens:
            paint_marks(painter, piece, ink, colours, self._measures)
        if piece.mark in ("swatch", "tick"):
            return
        left = piece.x + (trail if self._measures.is_mirrored else lead)
        room = piece.width - lead - trail
        if piece.text:
            painter.setPen(ink)
            self._centred(painter, piece, left, room)
        elif piece.hint:
            # The colour of a hint on a field
            faint = QColor(ink)
            faint.setAlphaF(0.66 if fill is colours.field else 0.85)
            self._hint(painter, piece, faint, left, room)

    def _inks(self, piece: Piece, colours: BlockColours) -> tuple[QColor, QColor, QColor]:
        """What a field is filled with, written and framed in: white says that one may type."""
        if piece.mark == "swatch" and piece.text:
            fill = QColor(piece.text)
            return fill, QColor("white" if qGray(fill.rgb()) < 128 else "black"), colours.field_line
        if piece.opens:
            return self._tint(colours), colours.text, colours.line
        return colours.field, colours.field_text, colours.field_line

    def _centred(self, painter: QPainter, piece: Piece, left: float, room: float) -> None:
        line = self._measures.line
        if "\n" not in piece.text:
            width = self._measures.text_width(piece.text)
            top = piece.y + (piece.height - line) / 2
            place = QPointF(left + (room - width) / 2, top)
            painter.drawStaticText(place, self._texts[piece.text])
            return
        rows, pad = piece.text.split("\n"), self._measures.field_pad
        top = piece.y + (piece.height - line * len(rows)) / 2
        for number, row in enumerate(rows):
            width = self._measures.text_width(row)
            x = left + room - pad - width if self._measures.is_mirrored else left + pad
            painter.drawStaticText(QPointF(x, top + number * line), self._texts[row])

    def _hint(
        self, painter: QPainter, piece: Piece, colour: QColor, left: float, room: float
    ) -> None:
        """Faint small words in an empty place."""
        usual = painter.font()
        if self._hint_font is None:
            self._hint_font = QFont(usual)
            self._hint_font.setPointSizeF(usual.pointSizeF() * HINT_SIZE)
        width = self._measures.text_width(piece.hint) * HINT_SIZE
        height = self._measures.line * HINT_SIZE
        painter.setFont(self._hint_font)
        painter.setPen(colour)
        place = QPointF(left + (room - width) / 2, piece.y + (piece.height - height) / 2)
        painter.drawStaticText(place, self._hints[piece.hint])
        painter.setFont(usual)

    def _button(self, painter: QPainter, piece: Piece, colours: BlockColours) -> None:
        """A round button with a sign, and a label beside it when it has one."""
        size, unit = piece.height, self._measures.unit
        x = piece.x + (piece.width - size if self._measures.is_mirrored else 0.0)
        circle = QRectF(x, piece.y, size, size).adjusted(unit, unit, -unit, -unit)
        painter.setPen(QPen(colours.text, 1.2 * unit))
        painter.setBrush(self._darker(colours.fill))
        painter.drawEllipse(circle)
        painter.setPen(round_pen(colours.text, 2 * unit))
        mirrored = self._measures.is_mirrored
        paint_sign(painter, piece.kind, circle.center(), size * 0.24, is_mirrored=mirrored)
        if piece.text:
            width = self._measures.text_width(piece.text)
            beside = piece.x if mirrored else piece.x + piece.width - width
            y = piece.y + (size - self._measures.line) / 2
            painter.drawStaticText(QPointF(beside, y), self._texts[piece.text])

    def _tint(self, colours: BlockColours) -> QColor:
        key = colours.fill.rgba(), colours.text.rgba()
        if key not in self._tints:
            self._tints[key] = choice_tint(colours)
        return self._tints[key]

    def _darker(self, colour: QColor) -> QColor:
        """A shade deeper than the block: a hole in it."""
        key = colour.rgba()
        shade = self._shades.get(key)
        if shade is None:
            is_black = colour.lightnessF() <= 0.12
            shade = colour.lighter(180) if is_black else colour.darker(128)
            self._shades[key] = shade
        return shade


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
        self._pieces = PiecePainter(theme, measures)
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
            box = placed.box
            if box.outline == "gap":
                colour = self.theme.colour("snap")
                colour.setAlphaF(0.28)
                painter.setPen(QPen(self.theme.colour("snap"), 2 * self._measures.unit))
                painter.setBrush(colour)
                painter.drawPath(self.outlines.of(box))
                continue
            look = self._looks.get((box.type, box.is_disabled))
            colours, brush, pen = look or self.look_of(box)
            path = self.outlines.of(box)
            painter.setPen(pen if detail else Qt.PenStyle.NoPen)
            painter.setBrush(brush)
            painter.drawPath(path)
            if box.is_disabled:
                # Stripes: what is switched off shows it by more than its colour
                faint = QColor(colours.line)
                faint.setAlphaF(0.35)
                painter.fillPath(path, QBrush(faint, Qt.BrushStyle.BDiagPattern))
            for piece in box.pieces if detail else ():
                self._pieces.paint(painter, piece, colours, with_text=detail == 2)
        painter.translate(-x, -y)

    def look_of(self, box: Box) -> tuple[BlockColours, QBrush, QPen]:
        """The colours of a block, what fills it, and its line."""
        look = self._looks.get((box.type, box.is_disabled))
        if look is None:
            definition = self._language.definitions.get(box.type)
            name = definition.category.colour if definition is not None else PLACEHOLDER
            colours = self.theme.block(DISABLED if box.is_disabled else name)
            pen = QPen(colours.line, 1.2 * self._measures.unit)
            look = self._looks[box.type, box.is_disabled] = (colours, QBrush(colours.fill), pen)
        return look


class Look:
    """How the blocks of a canvas look: in this theme, this font, and from this side."""

    def __init__(self, theme: Theme, font: QFont, language: Language, *, is_mirrored: bool) -> None:
        self.theme = theme
        self.block_font = QFont(font)
        self.block_font.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
        self.badge_font = QFont(self.block_font)
        self.badge_font.setBold(True)
        self.badge_font.setPointSizeF(max(1.0, self.block_font.pointSizeF() * 0.8))
        widths = TextWidths(self.block_font)
        self.measures = Measures(widths.line, widths.__getitem__, is_mirrored=is_mirrored)
        self.block_painter = BlockPainter(theme, language, self.measures, self.block_font)
