"""The outlines of blocks as painter paths, kept by their form."""

from __future__ import annotations

import math
from functools import lru_cache

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QTransform

from nep_studio.ui.canvas.layout.boxes import Box, Measures, Piece
from nep_studio.ui.theme.colours import BlockColours


class Outlines:
    """Makes the path of a form once; all forms with the same measures share it."""

    def __init__(self, measures: Measures) -> None:
        self._measures = measures
        self._paths: dict[tuple[object, ...], QPainterPath] = {}

    def of(self, box: Box) -> QPainterPath:
        """The outline of a box, from (0, 0)."""
        if box.outline not in ("statement", "hat", "cap", "gap"):
            width, height = round(box.width, 1), round(box.height, 1)
            return slot_path(box.outline, width, height, self._measures.unit)
        form = (box.outline, box.width, box.segments, box.is_mirrored)
        path = self._paths.get(form)
        if path is None:
            path = statement_path(box, self._measures)
            if box.is_mirrored:
                path = QTransform(-1, 0, 0, 1, box.width, 0).map(path)
            if len(self._paths) > 20_000:
                self._paths.clear()
            self._paths[form] = path
        return path


def statement_path(box: Box, m: Measures) -> QPainterPath:
    """Rows and mouths in turns, with a notch at the top and a tab at the bottom."""
    path = QPainterPath()
    r, width, y = m.corner, box.width, 0.0
    _top(path, box, m)
    for number, height in enumerate(box.segments):
        if number % 2 == 0:
            y += height
            continue
        path.lineTo(width, y - r)
        path.quadTo(width, y, width - r, y)
        _tab(path, m.indent, y, m)
        path.lineTo(m.indent + r, y)
        path.quadTo(m.indent, y, m.indent, y + r)
        y += height
        path.lineTo(m.indent, y - r)
        path.quadTo(m.indent, y, m.indent + r, y)
        path.lineTo(width - r, y)
        path.quadTo(width, y, width, y + r)
    path.lineTo(width, y - r)
    path.quadTo(width, y, width - r, y)
    if box.outline != "cap":
        _tab(path, 0.0, y, m)
    path.lineTo(r, y)
    path.quadTo(0, y, 0, y - r)
    path.closeSubpath()
    return path


def _top(path: QPainterPath, box: Box, m: Measures) -> None:
    r, width = m.corner, box.width
    if box.outline == "hat":
        curve = min(110 * m.unit, width - r)
        path.moveTo(0, m.hat)
        path.cubicTo(curve * 0.25, -m.hat * 0.35, curve * 0.75, -m.hat * 0.35, curve, m.hat)
        path.lineTo(width - r, m.hat)
        path.quadTo(width, m.hat, width, m.hat + r)
        return
    path.moveTo(0, r)
    path.quadTo(0, 0, r, 0)
    # the dent, from left to right
    left, right, deep, soft = m.notch_x, m.notch_x + m.notch_width, m.notch_depth, m.unit
    path.lineTo(left, 0)
    path.cubicTo(left + 4 * soft, 0, left + 3 * soft, deep, left + 8 * soft, deep)
    path.lineTo(right - 8 * soft, deep)
    path.cubicTo(right - 3 * soft, deep, right - 4 * soft, 0, right, 0)
    path.lineTo(width - r, 0)
    path.quadTo(width, 0, width, r)


def _tab(path: QPainterPath, x: float, y: float, m: Measures) -> None:
    """What fits into a notch, drawn from right to left."""
    left, right, deep, soft = x + m.notch_x, x + m.notch_x + m.notch_width, m.notch_depth, m.unit
    path.lineTo(right, y)
    path.cubicTo(right - 4 * soft, y, right - 3 * soft, y + deep, right - 8 * soft, y + deep)
    path.lineTo(left + 8 * soft, y + deep)
    path.cubicTo(left + 3 * soft, y + deep, left + 4 * soft, y, left, y)


@lru_cache(maxsize=8192)
def slot_path(shape: str, width: float, height: float, unit: float) -> QPainterPath:
    """A rounded, pointed or cut rectangle: the shape says what may be in it."""
    path = QPainterPath()
    if shape == "hexagon":
        point = min(height / 2, 18 * unit)
        far, middle = width - point, height / 2
        upper = [(0, middle), (point, 0), (far, 0)]
        _polygon(path, [*upper, (width, middle), (far, height), (point, height)])
    elif shape == "bracket":
        cut = 6 * unit
        right, low = width - cut, height - cut
        corners = [(cut, 0), (right, 0), (width, cut), (width, low), (right, height)]
        _polygon(path, [*corners, (cut, height), (0, low), (0, cut)])
    else:
        radius = {"round": min(height / 2, 22 * unit), "square": 4 * unit}.get(shape, 9 * unit)
        path.addRoundedRect(QRectF(0, 0, width, height), radius, radius)
    return path


def _polygon(path: QPainterPath, points: list[tuple[float, float]]) -> None:
    path.moveTo(QPointF(*points[0]))
    for point in points[1:]:
        path.lineTo(QPointF(*point))
    path.closeSubpath()


# The little drawings inside fields and buttons: arrow, tick, dial, bar, plus, minus.


def paint_marks(
    painter: QPainter, piece: Piece, ink: QColor, colours: BlockColours, measures: Measures
) -> None:
    """Draw the marks of a field in its ink, each at the side where it belongs."""
    rect, unit = QRectF(piece.x, piece.y, piece.width, piece.height), measures.unit
    painter.setPen(round_pen(ink, 1.8 * unit))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    middle, inset = rect.center(), 12 * unit
    start, end = QPointF(rect.left() + inset, middle.y()), QPointF(rect.right() - inset, middle.y())
    if measures.is_mirrored:
        start, end = end, start
    if piece.opens:
        at = end if piece.mark != "swatch" or rect.width() >= 40 * unit else middle
        sides = (QPointF(-4, -2), QPointF(0, 2.5), QPointF(4, -2))
        painter.drawPolyline([at + side * unit for side in sides])
    if piece.mark == "tick" and piece.amount:
        half = 5 * unit
        painter.drawPolyline(
            [
                middle + QPointF(-half, 0),
                middle + QPointF(-half * 0.25, half * 0.75),
                middle + QPointF(half, -half * 0.75),
            ]
        )
    elif piece.mark == "dial":
        # A circle with a hand: 0 is up, positive to the left
        radius = 6 * unit
        angle = math.radians(piece.amount)
        painter.drawEllipse(start, radius, radius)
        tip = start + QPointF(-radius * 0.85 * math.sin(angle), -radius * 0.85 * math.cos(angle))
        painter.drawLine(start, tip)
    elif piece.mark == "bar":
        _bar(painter, rect, colours, measures, piece.amount)


def paint_sign(
    painter: QPainter, action: str, at: QPointF, half: float, *, is_mirrored: bool
) -> None:
    """Plus, minus, a triangle that points to what is folded, or lines of writing."""
    x, y = at.x(), at.y()
    if action in ("add", "remove"):
        painter.drawLine(QPointF(x - half, y), QPointF(x + half, y))
    if action == "add":
        painter.drawLine(QPointF(x, y - half), QPointF(x, y + half))
    if action == "expand":
        side = -half / 2 if is_mirrored else half / 2
        painter.drawPolyline(
            [QPointF(x - side, y - half), QPointF(x + side, y), QPointF(x - side, y + half)]
        )
    if action == "comment":
        for row in (-0.5, 0.5):
            painter.drawLine(QPointF(x - half, y + row * half), QPointF(x + half, y + row * half))


def round_pen(colour: QColor, width: float) -> QPen:
    """A pen with round ends."""
    return QPen(colour, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap)


def _bar(
    painter: QPainter, rect: QRectF, colours: BlockColours, measures: Measures, share: float
) -> None:
    """A thin line at the foot of a field, as long as the value is large."""
    unit, is_mirrored = measures.unit, measures.is_mirrored
    y = rect.bottom() - 3 * unit
    low, high = rect.left() + 9 * unit, rect.right() - 9 * unit
    faint = QColor(colours.field_line)
    faint.setAlphaF(0.3)
    painter.setPen(round_pen(faint, 2.4 * unit))
    painter.drawLine(QPointF(low, y), QPointF(high, y))
    if share <= 0:
        return
    length = (high - low) * share
    painter.setPen(round_pen(colours.field_line, 2.4 * unit))
    start = high if is_mirrored else low
    painter.drawLine(QPointF(start, y), QPointF(start + (-length if is_mirrored else length), y))
