"""The little drawings inside fields and buttons: arrow, tick, dial, file, bar, plus, minus."""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, qGray

from nep_studio.ui.theme import BlockColours


def paint_mark(
    painter: QPainter,
    mark: str,
    rect: QRectF,
    fill: QColor,
    colours: BlockColours,
    unit: float,
    *,
    is_mirrored: bool,
    amount: float = 0.0,
) -> None:
    """Draw a mark in the rectangle of its field, at the side where it belongs."""
    is_dark = fill is not colours.field and qGray(fill.rgb()) < 128
    is_plain = fill is colours.field
    ink = colours.field_text if is_plain else QColor("white" if is_dark else "black")
    painter.setPen(round_pen(ink, 1.8 * unit))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    inset = 12 * unit
    start = QPointF(rect.right() - inset if is_mirrored else rect.left() + inset, rect.center().y())
    end = QPointF(rect.left() + inset if is_mirrored else rect.right() - inset, rect.center().y())
    if mark == "arrow":
        _arrow(painter, rect.center() if not is_plain and rect.width() < 40 * unit else end, unit)
    elif mark == "checkbox" and amount:
        _tick(painter, rect.center(), 5 * unit)
    elif mark == "angle":
        _dial(painter, start, 6 * unit, amount)
    elif mark == "file":
        _sheet(painter, start, unit)
    elif mark == "slider":
        _bar(painter, rect, colours, unit, amount, is_mirrored=is_mirrored)


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


def _arrow(painter: QPainter, at: QPointF, unit: float) -> None:
    x, y = at.x(), at.y()
    painter.drawPolyline(
        [
            QPointF(x - 4 * unit, y - 2 * unit),
            QPointF(x, y + 2.5 * unit),
            QPointF(x + 4 * unit, y - 2 * unit),
        ]
    )


def _tick(painter: QPainter, at: QPointF, half: float) -> None:
    painter.drawPolyline(
        [
            at + QPointF(-half, 0),
            at + QPointF(-half * 0.25, half * 0.75),
            at + QPointF(half, -half * 0.75),
        ]
    )


def _dial(painter: QPainter, at: QPointF, radius: float, degrees: float) -> None:
    """A circle with a hand: 0 is up, positive to the left."""
    angle = math.radians(degrees)
    painter.drawEllipse(at, radius, radius)
    tip = at + QPointF(-radius * 0.85 * math.sin(angle), -radius * 0.85 * math.cos(angle))
    painter.drawLine(at, tip)


def _sheet(painter: QPainter, at: QPointF, unit: float) -> None:
    """A sheet of paper with a bent corner."""
    x, y = at.x(), at.y()
    wide, high, bend = 4.5 * unit, 6 * unit, 3.5 * unit
    painter.drawPolygon(
        [
            QPointF(x - wide, y - high),
            QPointF(x + wide - bend, y - high),
            QPointF(x + wide, y - high + bend),
            QPointF(x + wide, y + high),
            QPointF(x - wide, y + high),
        ]
    )


def _bar(
    painter: QPainter,
    rect: QRectF,
    colours: BlockColours,
    unit: float,
    share: float,
    *,
    is_mirrored: bool,
) -> None:
    """A thin line at the foot of a field, as long as the value is large."""
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
