"""The graph as shapes: boxes for nodes, pills for topics, curves between them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainterPath, QPolygonF

from .graph_layout import Graph, Key, Spot, lay_out

# All in lines of text.
WIDTH = 9.6
NODE_HEIGHT = 3.0
TOPIC_HEIGHT = 2.4
ROW = 3.7
GAP = 3.0
ARROW = 0.55
MARGIN = 1.2


@dataclass(frozen=True)
class Curve:
    """A line from who says to what is said, or from that to who hears it."""

    start: Key
    end: Key
    path: QPainterPath
    arrow: QPolygonF
    label: QPointF

    @property
    def is_saying(self) -> bool:
        """Whether it comes from a node."""
        return self.start[0] == "node"


@dataclass(frozen=True)
class Shapes:
    """Where everything is, in pixels at scale 1."""

    rects: Mapping[Key, QRectF] = field(default_factory=dict)
    curves: tuple[Curve, ...] = ()

    @property
    def bounds(self) -> QRectF:
        """What holds all of it."""
        found = QRectF()
        for rect in self.rects.values():
            found = found.united(rect)
        for curve in self.curves:
            found = found.united(curve.path.boundingRect())
        return found

    def at(self, place: QPointF) -> Key | None:
        """What is at a place."""
        return next((key for key, rect in self.rects.items() if rect.contains(place)), None)

    def next_to(self, key: Key, dx: int, dy: int) -> Key | None:
        """The nearest item in a direction: what an arrow key goes to."""
        start = self.rects[key].center()
        best: tuple[float, Key] | None = None
        for other, rect in self.rects.items():
            way = rect.center() - start
            ahead = way.x() * dx + way.y() * dy
            aside = abs(way.x() * dy) + abs(way.y() * dx)
            if other != key and ahead > 1:
                best = min(filter(None, (best, (ahead + 2 * aside, other))))
        return best[1] if best else None


def shapes_of(graph: Graph, line: float, *, is_mirrored: bool = False) -> Shapes:
    """Lay a graph out; ``line`` is the height of a line of text in pixels."""
    spots = lay_out(graph)
    rects = {key: _rect(key, spot, line, is_mirrored) for key, spot in spots.items()}
    ways: Iterable[tuple[Key, Key]] = [
        *((("node", node), ("topic", topic)) for node, topic in graph.says),
        *((("topic", topic), ("node", node)) for node, topic in graph.hears),
    ]
    found = [(a, b) for a, b in ways if a in rects and b in rects]
    curves = tuple(
        _curve(a, b, rects, line, is_mirrored, _backward(spots[a], spots[b])) for a, b in found
    )
    return Shapes(rects, curves)


def _rect(key: Key, spot: Spot, line: float, is_mirrored: bool) -> QRectF:
    column = -spot.column if is_mirrored else spot.column
    height = NODE_HEIGHT if key[0] == "node" else TOPIC_HEIGHT
    x, y = column * (WIDTH + GAP) * line, spot.row * ROW * line
    return QRectF(x, y - height * line / 2, WIDTH * line, height * line)


def _backward(start: Spot, end: Spot) -> bool:
    return end.column <= start.column


def _curve(
    a: Key,
    b: Key,
    rects: Mapping[Key, QRectF],
    line: float,
    is_mirrored: bool,
    is_back: bool,
) -> Curve:
    if is_back:
        return _back_curve(a, b, rects, line)
    side = -1.0 if is_mirrored else 1.0
    start = QPointF(_edge_x(rects[a], side), rects[a].center().y())
    end = QPointF(_edge_x(rects[b], -side), rects[b].center().y())
    tip = end - QPointF(side * ARROW * line, 0)
    bend = max(abs(tip.x() - start.x()) * 0.5, GAP * line * 0.5) * side
    path = QPainterPath(start)
    path.cubicTo(start + QPointF(bend, 0), tip - QPointF(bend, 0), tip)
    half = QPointF(0, ARROW * line * 0.55)
    return Curve(a, b, path, QPolygonF([end, tip + half, tip - half]), _label_place(path, line))


def _label_place(path: QPainterPath, line: float) -> QPointF:
    """Where the rate stands: near the beginning, so that on a long line it is at its box."""
    near = min(0.5, GAP * line * 0.5 / max(path.length(), 1.0))
    return path.pointAtPercent(near)


def _edge_x(rect: QRectF, side: float) -> float:
    return rect.right() if side > 0 else rect.left()


def _back_curve(a: Key, b: Key, rects: Mapping[Key, QRectF], line: float) -> Curve:
    """A line against the stream: it goes below, from bottom to bottom."""
    start = QPointF(rects[a].center().x(), rects[a].bottom())
    end = QPointF(rects[b].center().x(), rects[b].bottom())
    tip = end + QPointF(0, ARROW * line)
    deep = max(start.y(), end.y()) + (1.2 + abs(start.x() - end.x()) / (14 * line)) * line
    path = QPainterPath(start)
    path.cubicTo(QPointF(start.x(), deep), QPointF(end.x(), deep), tip)
    half = QPointF(ARROW * line * 0.55, 0)
    return Curve(a, b, path, QPolygonF([end, tip + half, tip - half]), _label_place(path, line))
