"""The speech bubbles beside the heads of robots that talk, all of each inside the picture."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QPolygonF

from nep_studio.ui.theme import Theme

MOST_LETTERS = 400
WIDEST_EM, NARROWEST_EM = 22.0, 10.0
EDGE, AIR, TAIL = 0.3, 0.45, 0.8
"""In lines: around bubbles, around words, and between a bubble and its head."""
HIGHEST_SHARE = 0.4
FLAGS = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap


@dataclass(frozen=True)
class Said:
    """What a robot says, and where the middle of its head is on the picture, and how large."""

    words: str
    head: QPointF
    half_px: float


@dataclass(frozen=True)
class Bubble:
    """Where the words are, and where the tail points to."""

    words: str
    box: QRectF
    tip: QPointF


def placed_bubbles(said: Iterable[Said], font: QFont, width: float, height: float) -> list[Bubble]:
    """Place bubbles above or beside heads, inside the picture and not over each other."""
    placed: list[Bubble] = []
    for one in sorted(said, key=lambda item: item.head.x()):
        bubble = _placed(one, QFontMetricsF(font), width, height)
        placed.append(_freed(bubble, placed, width))
    return placed


def _placed(said: Said, metrics: QFontMetricsF, width: float, height: float) -> Bubble:
    """Above the head if there is room, else beside it, else as much as goes above."""
    line, head, half = metrics.height(), said.head, said.half_px
    edge, air = line * EDGE, line * AIR
    widest = min(WIDEST_EM * metrics.averageCharWidth() * 1.6, width - 2 * edge)
    above = head.y() - half - line * TAIL - edge
    side = 1 if head.x() < width / 2 else -1
    beside = (width - head.x() if side > 0 else head.x()) - half * 1.15 - line * TAIL - edge
    words, size = _fitting(said.words, metrics, widest - 2 * air, HIGHEST_SHARE * height)
    box = QRectF(0, 0, size.width() + 2 * air, size.height() + 1.2 * air)
    if box.height() > above and beside > metrics.averageCharWidth() * NARROWEST_EM:
        words, size = _fitting(words, metrics, min(widest, beside) - 2 * air, height - 2 * edge)
        box = QRectF(0, 0, size.width() + 2 * air, size.height() + 1.2 * air)
        off = half * 1.15 + line * TAIL + box.width() / 2
        box.moveCenter(QPointF(head.x() + side * off, head.y() - half * 0.5))
        tip = QPointF(head.x() + side * half * 1.1, head.y())
    else:
        room = max(above, line * 1.6)
        words, size = _fitting(words, metrics, widest - 2 * air, room - 1.2 * air)
        box = QRectF(0, 0, size.width() + 2 * air, size.height() + 1.2 * air)
        box.moveCenter(QPointF(head.x() + half * 0.6, 0))
        box.moveBottom(head.y() - half - line * TAIL)
        tip = QPointF(head.x() + half * 0.25, head.y() - half)
    _keep_inside(box, width, height, edge)
    return Bubble(words, box, tip)


def _keep_inside(box: QRectF, width: float, height: float, edge: float) -> None:
    box.moveLeft(min(max(box.left(), edge), max(width - box.width() - edge, 0)))
    box.moveTop(min(max(box.top(), edge), max(height - box.height() - edge, 0)))


def _fitting(words: str, metrics: QFontMetricsF, width: float, height: float) -> tuple[str, QRectF]:
    """The words as far as there is room for them, and their size."""
    words = words if len(words) <= MOST_LETTERS else words[:MOST_LETTERS] + "…"
    endless = QRectF(0, 0, width, 1e5)
    size = metrics.boundingRect(endless, FLAGS.value, words)
    while size.height() > height and len(words) > 4:
        words = words[: len(words) * 9 // 10].rstrip(" …") + "…"
        size = metrics.boundingRect(endless, FLAGS.value, words)
    return words, size


def _freed(bubble: Bubble, others: Sequence[Bubble], width: float) -> Bubble:
    """The bubble moved off those that are there already."""
    box = QRectF(bubble.box)
    for other in others:
        if not box.intersects(other.box):
            continue
        if other.box.top() - box.height() - 6 >= 0:
            box.moveBottom(other.box.top() - 6)
        elif other.box.right() + 6 + box.width() <= width:
            box.moveLeft(other.box.right() + 6)
        else:
            box.moveTop(other.box.bottom() + 6)
    return Bubble(bubble.words, box, bubble.tip)


def paint_bubble(painter: QPainter, bubble: Bubble, theme: Theme, font: QFont) -> None:
    """Paint a bubble with its tail and words."""
    line = QFontMetricsF(font).height()
    painter.setPen(QPen(theme.colour("field_line"), max(1.2, line / 13)))
    painter.setBrush(theme.colour("field"))
    painter.drawPath(_outline(bubble, line))
    painter.setPen(theme.colour("field_text"))
    painter.setFont(font)
    painter.drawText(bubble.box, FLAGS, bubble.words)


def _outline(bubble: Bubble, line: float) -> QPainterPath:
    box, tip = bubble.box, bubble.tip
    body, tail = QPainterPath(), QPainterPath()
    body.addRoundedRect(box, line * 0.55, line * 0.55)
    foot = QPointF(
        min(max(tip.x(), box.left() + line), box.right() - line),
        min(max(tip.y(), box.top() + line * 0.7), box.bottom() - line * 0.7),
    )
    way = tip - foot
    far = max((way.x() ** 2 + way.y() ** 2) ** 0.5, 1.0)
    aside = QPointF(-way.y(), way.x()) * (line * 0.32 / far)
    short = foot + way * (1 - min(0.25, line * 0.35 / far))
    tail.addPolygon(QPolygonF([foot + aside, short, foot - aside]))
    tail.closeSubpath()
    return body.united(tail)
