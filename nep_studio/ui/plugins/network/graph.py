"""Where the nodes and topics of a network stand: in layers, from sensing to acting."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QPainterPath, QPolygonF

from nep_core.wire.messages import NODE_STATE
from nep_studio.run.plan import STUDIO
from nep_studio.ui.network_feed import Seen

Kind = Literal["node", "topic"]
Key = tuple[Kind, str]
"""What a node or topic is called in the graph; a node and a topic may have the same name."""

LAYERS: Mapping[str, int] = {"sensory": 0, "perceptual": 2, "cognitive": 4, "action": 6}
"""Nodes stand in even layers by their type, the topics in the odd ones between."""

MOST_IN_COLUMN = 8
"""A layer with more items gets more columns: one long column cannot be read."""
SWEEPS = 4


@dataclass(frozen=True)
class Graph:
    """Nodes by name with their type ("" when not known), topics, and who is at their ends."""

    nodes: Mapping[str, str] = field(default_factory=dict)
    topics: tuple[str, ...] = ()
    says: tuple[tuple[str, str], ...] = ()
    """(node, topic) of all that is published."""
    hears: tuple[tuple[str, str], ...] = ()
    """(node, topic) of all that is heard."""

    @property
    def keys(self) -> list[Key]:
        """All items, nodes first."""
        return [*(("node", name) for name in self.nodes), *(("topic", one) for one in self.topics)]

    def neighbours(self) -> dict[Key, list[Key]]:
        """What each item is joined with."""
        found: dict[Key, list[Key]] = {key: [] for key in self.keys}
        for node, topic in (*self.says, *self.hears):
            one: Key = ("node", node)
            other: Key = ("topic", topic)
            found[one].append(other)
            found[other].append(one)
        return found


@dataclass(frozen=True)
class Spot:
    """A column, from 0, and a row, whose middle is 0; rows may be halves."""

    column: int
    row: float


def lay_out(graph: Graph) -> dict[Key, Spot]:
    """Give each item a place: neighbours near each other, few lines that cross."""
    layers = _layers(graph)
    neighbours = graph.neighbours()
    order = {number: sorted(items, key=lambda key: key[1]) for number, items in layers.items()}
    numbers = sorted(order)
    for sweep in range(SWEEPS):
        for number in numbers if sweep % 2 == 0 else reversed(numbers):
            _sort_by_neighbours(order, number, neighbours)
    return _spots(order, numbers)


def _layers(graph: Graph) -> dict[int, list[Key]]:
    of_node = {name: _layer_of(name, type_, graph) for name, type_ in graph.nodes.items()}
    layers: dict[int, list[Key]] = {}
    for name, layer in of_node.items():
        layers.setdefault(layer, []).append(("node", name))
    for topic in graph.topics:
        says = [of_node[node] for node, one in graph.says if one == topic and node in of_node]
        hears = [of_node[node] for node, one in graph.hears if one == topic and node in of_node]
        # Right of who says it first; a topic that nobody says, left of who hears it first
        layer = min(says) + 1 if says else min(hears, default=0) - 1
        layers.setdefault(layer, []).append(("topic", topic))
    return layers


def _layer_of(name: str, type_: str, graph: Graph) -> int:
    """A node whose type is not known stands at the side on which it speaks or hears."""
    if type_ in LAYERS:
        return LAYERS[type_]
    does_say = any(node == name for node, _ in graph.says)
    does_hear = any(node == name for node, _ in graph.hears)
    return {(True, False): 0, (False, True): 6}.get((does_say, does_hear), 4)


def _sort_by_neighbours(
    order: dict[int, list[Key]], number: int, neighbours: Mapping[Key, Iterable[Key]]
) -> None:
    """Sort a layer by the mean place of what each item is joined with."""
    place = {
        key: index - (len(items) - 1) / 2
        for items in order.values()
        for index, key in enumerate(items)
    }

    def mean(key: Key) -> tuple[float, str]:
        rows = [place[other] for other in neighbours[key] if other in place]
        return (sum(rows) / len(rows) if rows else place[key], key[1])

    order[number] = sorted(order[number], key=mean)


def _spots(order: Mapping[int, list[Key]], numbers: Iterable[int]) -> dict[Key, Spot]:
    spots: dict[Key, Spot] = {}
    for column, part in enumerate(part for number in numbers for part in _columns(order[number])):
        for index, key in enumerate(part):
            spots[key] = Spot(column, index - (len(part) - 1) / 2)
    return spots


def _columns(items: list[Key]) -> list[list[Key]]:
    """A layer in columns of about the same length, its order read down each column."""
    count = max(1, -(-len(items) // MOST_IN_COLUMN))
    length = -(-len(items) // count)
    return [items[start : start + length] for start in range(0, len(items), length)]


# The graph of what is seen of a network: which of it is shown, and of which type nodes are.


def graph_of(seen: Seen, types: Mapping[str, str], *, is_whole: bool = False) -> Graph:
    """The graph to show; ``types`` are those of the nodes that have said theirs.

    Unless it ``is_whole`` the studio itself is left out, and ``/node_state``, which every node
    publishes: lines to both would cover all others.
    """
    nodes = {name: types.get(name, "") for name in sorted(seen.nodes) if is_whole or name != STUDIO}
    names = [name for name in sorted(seen.topics) if is_whole or name != NODE_STATE]
    topics = {name: seen.topics[name] for name in names}
    says = tuple((n, name) for name, one in topics.items() for n in one.publishers if n in nodes)
    hears = tuple((n, name) for name, one in topics.items() for n in one.subscribers if n in nodes)
    used = {topic for _, topic in (*says, *hears)}
    shown = tuple(topic for topic in topics if is_whole or topic in used)
    return Graph(nodes, shown, says, hears)


# The graph as shapes: boxes for nodes, pills for topics, curves between them.

# All in lines of text.
WIDTH = 9.6
NODE_HEIGHT = 3.0
TOPIC_HEIGHT = 2.4
ROW = 3.7
GAP = 3.0
ARROW = 0.55


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
        _curve(a, b, rects, line, is_mirrored, spots[b].column <= spots[a].column) for a, b in found
    )
    return Shapes(rects, curves)


def _rect(key: Key, spot: Spot, line: float, is_mirrored: bool) -> QRectF:
    column = -spot.column if is_mirrored else spot.column
    height = NODE_HEIGHT if key[0] == "node" else TOPIC_HEIGHT
    x, y = column * (WIDTH + GAP) * line, spot.row * ROW * line
    return QRectF(x, y - height * line / 2, WIDTH * line, height * line)


def _curve(
    a: Key, b: Key, rects: Mapping[Key, QRectF], line: float, is_mirrored: bool, is_back: bool
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
