"""Draws the shapes of a diagram in the colours of the theme."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QPolygonF

from nep_studio.ui.running.stage import STATUSES
from nep_studio.ui.theme.colours import Theme
from nep_studio.ui.theme.icons import paint_icon

from .model import Item, Key
from .shapes import DOT, Arrow, Box, Measures, Shapes, Words

STATUS_ICONS = {"running": "circle-play", "succeeded": "circle-check", "failed": "octagon-x"}
FALLBACK = "?"
STATES, TREES, OWN = "states", "trees", "my_blocks"
"""The colours of the blocks."""


@dataclass(frozen=True)
class Marks:
    """What is chosen, pointed at and drawn by the person, and how the boxes are while it runs."""

    statuses: Mapping[str, str] = field(default_factory=dict)
    selected: Key | None = None
    hovered: Key | None = None
    has_focus: bool = False
    target: str | None = None
    """The box over which a new arrow is."""
    new_arrow: tuple[QPointF, QPointF] | None = None


class DiagramPainter:
    """Draws with one font and theme; the painter's camera is set already."""

    def __init__(self, painter: QPainter, theme: Theme, measures: Measures) -> None:
        self._painter, self._theme, self._measures = painter, theme, measures
        self._line = measures.line

    def draw(self, shapes: Shapes, marks: Marks, view: QRectF) -> None:
        """Draw what is in view: lines first, those of interest over the others."""
        chosen = {key[1] for key in (marks.selected, marks.hovered) if key and key[0] == "arrow"}
        for key, box in shapes.boxes.items():
            self._draw_status_ring(box, marks.statuses.get(key, ""))
        arrows = sorted(shapes.arrows.values(), key=lambda arrow: arrow.line.key in chosen)
        for arrow in arrows:
            self._draw_arrow(arrow, is_chosen=arrow.line.key in chosen)
        for middle, path, head in shapes.dots:
            self._draw_dot(middle, path, head)
        for arrow in arrows:
            if arrow.label.intersects(view):
                self._draw_label(arrow, marks)
        if marks.new_arrow is not None:
            self._painter.setPen(QPen(self._theme.colour("accent"), self._line * 0.14))
            self._painter.drawLine(*marks.new_arrow)
        for key, box in shapes.boxes.items():
            if box.whole.adjusted(-self._line, -self._line, self._line, self._line).intersects(
                view
            ):
                self._draw_box(key, box, marks)

    # Lines

    def _draw_arrow(self, arrow: Arrow, *, is_chosen: bool) -> None:
        colour = self._theme.colour("accent" if is_chosen else "field_line")
        pen = QPen(colour, self._line * (0.15 if is_chosen else 0.1))
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        if arrow.line.is_dashed:
            pen.setDashPattern([4.0, 3.0])
        self._painter.setBrush(Qt.BrushStyle.NoBrush)
        self._painter.setPen(pen)
        self._painter.drawPath(arrow.path)
        self._fill(arrow.head, colour)

    def _draw_dot(self, middle: QPointF, path: QPainterPath, head: QPolygonF) -> None:
        colour = self._theme.colour("text")
        self._painter.setPen(QPen(colour, self._line * 0.1))
        self._painter.drawPath(path)
        self._fill(head, colour)
        self._painter.drawEllipse(middle, self._line * DOT, self._line * DOT)

    def _fill(self, shape: QPolygonF, colour: QColor) -> None:
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(colour)
        self._painter.drawPolygon(shape)

    def _draw_label(self, arrow: Arrow, marks: Marks) -> None:
        key: Key = ("arrow", arrow.line.key)
        is_selected = key == marks.selected
        is_chosen = is_selected or key == marks.hovered
        theme, round_ = self._theme, self._line * 0.4
        line = theme.colour("accent")
        self._painter.setPen(QPen(line, self._line * 0.08) if is_chosen else Qt.PenStyle.NoPen)
        self._painter.setBrush(theme.colour("selection" if is_selected else "canvas"))
        self._painter.drawRoundedRect(arrow.label, round_, round_)
        colour = theme.colour("selection_text" if is_selected else "text")
        self._words(arrow.label, arrow.words, self._measures.small, colour)
        if is_selected and marks.has_focus:
            self._focus(arrow.label, round_)

    # Boxes

    def _draw_box(self, key: str, box: Box, marks: Marks) -> None:
        status = marks.statuses.get(key, "")
        is_chosen = ("box", key) in (marks.selected, marks.hovered) or marks.target == key
        fill, line, text = self._colours(box.item)
        if marks.target == key:
            line = self._theme.colour("accent")
        pen = QPen(line, self._line * (0.18 if is_chosen else 0.1))
        if not box.item.is_reached or box.item.shape == "any":
            pen.setDashPattern([3.0, 2.0])
        self._painter.setPen(pen)
        self._painter.setBrush(fill)
        self._painter.drawPath(self._outline(box.item, box.rect))
        if box.item.sign == "list-tree":
            inner = self._line * 0.22
            inside = box.rect.adjusted(inner, inner, -inner, -inner)
            self._painter.drawPath(self._outline(box.item, inside))
        self._draw_inside(box, text)
        if box.item.hidden:
            self._draw_hidden(box)
        self._draw_badge(box, status)
        if ("box", key) == marks.selected:
            self._focus(box.rect, self._line * 0.8, is_strong=marks.has_focus)

    def _colours(self, item: Item) -> tuple[QColor, QColor, QColor]:
        """What a box is filled with, its edge, and its words."""
        theme = self._theme
        colours = theme.block({"state": STATES, "step": OWN}.get(item.shape, TREES))
        if item.shape in ("state", "root", "sign", "diamond", "step") and not item.is_plain:
            return colours.fill, colours.line, colours.text
        if item.shape == "any":
            return theme.colour("panel_alt"), theme.colour("field_line"), theme.colour("text")
        return theme.colour("field"), colours.line, theme.colour("field_text")

    def _outline(self, item: Item, rect: QRectF) -> QPainterPath:
        path, unit = QPainterPath(), self._line
        if item.shape == "ellipse":
            path.addEllipse(rect)
        elif item.shape == "diamond":
            middle = rect.center()
            corners = [
                QPointF(middle.x(), rect.top()),
                QPointF(rect.right(), middle.y()),
                QPointF(middle.x(), rect.bottom()),
                QPointF(rect.left(), middle.y()),
            ]
            path.addPolygon(QPolygonF(corners))
            path.closeSubpath()
        else:
            usual = {"state": 0.7, "sign": 0.25, "leaf": 0.25, "step": 0.25}
            round_ = min(usual.get(item.shape, 9.0) * unit, rect.height() / 2)
            path.addRoundedRect(rect, round_, round_)
        return path

    def _draw_inside(self, box: Box, text: QColor) -> None:
        item, measures, unit = box.item, self._measures, self._line
        if item.shape == "sign":
            self._draw_sign(box.rect, item.sign, text)
        elif item.shape == "diamond":
            edge = box.rect.width() * 0.27
            paint_icon(self._painter, box.rect.adjusted(edge, edge, -edge, -edge), item.sign, text)
        else:
            rect, both = QRectF(box.rect), box.title.height + box.small.height
            rect.setTop(rect.center().y() - both / 2)
            rect.setHeight(box.title.height)
            if item.sign:
                side = unit * 1.1
                is_mirrored = self._painter.layoutDirection() == Qt.LayoutDirection.RightToLeft
                x = rect.right() - side - unit / 2 if is_mirrored else rect.left() + unit / 2
                square = QRectF(x, rect.center().y() - side / 2, side, side)
                paint_icon(self._painter, square, item.sign, text)
                rect.adjust(0 if is_mirrored else side, 0, -side if is_mirrored else 0, 0)
            self._words(rect, box.title, measures.bold, text)
            rect = QRectF(box.rect.left(), rect.bottom(), box.rect.width(), box.small.height)
            self._words(rect, box.small, measures.small, text)
            return
        beside = Qt.AlignmentFlag.AlignLeading
        colour = self._theme.colour("text")
        self._words(box.beside, box.small, measures.small, colour, beside)

    def _draw_sign(self, rect: QRectF, sign: str, colour: QColor) -> None:
        """An arrow, a question mark, or two arrows: the signs of the field."""
        if sign == "fallback":
            font = QFont(self._measures.bold)
            font.setPointSizeF(font.pointSizeF() * 1.4)
            self._painter.setFont(font)
            self._painter.setPen(colour)
            self._painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, FALLBACK)
            return
        unit, middle = self._line, rect.center()
        pen = QPen(colour, unit * 0.13)
        pen.setCapStyle(Qt.PenCapStyle.RoundCap)
        pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
        self._painter.setPen(pen)
        self._painter.setBrush(Qt.BrushStyle.NoBrush)
        is_mirrored = self._painter.layoutDirection() == Qt.LayoutDirection.RightToLeft
        side = -1.0 if is_mirrored else 1.0
        for down in (-0.36, 0.36) if sign == "parallel" else (0.0,):
            tip = middle + QPointF(side * unit * 0.6, down * unit)
            back = unit * (0.24 if sign == "parallel" else 0.34)
            self._painter.drawLine(middle + QPointF(-side * unit * 0.6, down * unit), tip)
            wings = [tip + QPointF(-side * back, way * back) for way in (-1, 1)]
            self._painter.drawPolyline(QPolygonF([wings[0], tip, wings[1]]))

    def _draw_hidden(self, box: Box) -> None:
        """How many parts are folded away, under the box."""
        words = f"+{box.item.hidden}"
        metrics = QFontMetricsF(self._measures.small)
        width = metrics.horizontalAdvance(words) + self._line * 0.7
        rect = QRectF(0, 0, width, metrics.height())
        rect.moveCenter(QPointF(box.rect.center().x(), box.rect.bottom() + rect.height() * 0.55))
        self._painter.setPen(QPen(self._theme.colour("field_line"), self._line * 0.08))
        self._painter.setBrush(self._theme.colour("menu"))
        self._painter.drawRoundedRect(rect, rect.height() / 2, rect.height() / 2)
        self._painter.setFont(self._measures.small)
        self._painter.setPen(self._theme.colour("text"))
        self._painter.drawText(rect, Qt.AlignmentFlag.AlignCenter, words)

    # What runs, and what is chosen

    def _draw_status_ring(self, box: Box, status: str) -> None:
        if not status:
            return
        edge = self._line * 0.3
        self._painter.setBrush(Qt.BrushStyle.NoBrush)
        self._painter.setPen(QPen(self._theme.colour(STATUSES[status]), self._line * 0.28))
        self._painter.drawPath(self._outline(box.item, box.rect.adjusted(-edge, -edge, edge, edge)))

    def _draw_badge(self, box: Box, status: str) -> None:
        """The icon of a status, or of a state that cannot be come to, at the corner."""
        icon, colour = STATUS_ICONS.get(status, ""), STATUSES.get(status, "")
        if not icon and not box.item.is_reached:
            icon, colour = "triangle-alert", "warning"
        if not icon:
            return
        side = self._line * 1.25
        is_mirrored = self._painter.layoutDirection() == Qt.LayoutDirection.RightToLeft
        square = QRectF(0, 0, side, side)
        square.moveCenter(box.rect.topLeft() if is_mirrored else box.rect.topRight())
        self._painter.setPen(Qt.PenStyle.NoPen)
        self._painter.setBrush(self._theme.colour("canvas"))
        self._painter.drawEllipse(square)
        edge = side * 0.1
        inside = square.adjusted(edge, edge, -edge, -edge)
        paint_icon(self._painter, inside, icon, self._theme.colour(colour))

    def _focus(self, rect: QRectF, round_: float, *, is_strong: bool = True) -> None:
        edge = self._line * 0.3
        pen = QPen(self._theme.colour("focus"), self._line * (0.16 if is_strong else 0.08))
        self._painter.setBrush(Qt.BrushStyle.NoBrush)
        self._painter.setPen(pen)
        self._painter.drawRoundedRect(rect.adjusted(-edge, -edge, edge, edge), round_, round_)

    def _words(
        self,
        rect: QRectF,
        words: Words,
        font: QFont,
        colour: QColor,
        alignment: Qt.AlignmentFlag = Qt.AlignmentFlag.AlignHCenter,
    ) -> None:
        self._painter.setFont(font)
        self._painter.setPen(colour)
        step = QFontMetricsF(font).height()
        top = rect.center().y() - step * len(words.lines) / 2
        flags = alignment | Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextDontClip
        for index, line in enumerate(words.lines):
            row = QRectF(rect.left(), top + index * step, rect.width(), step)
            self._painter.drawText(row, int(flags), line)
