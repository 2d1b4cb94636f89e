"""Where the boxes and lines of a diagram are: graphs in layers, and trees. Knows no Qt.

A graph is drawn as Sugiyama, Tagawa and Toda do it ("Methods for visual understanding of
hierarchical system structures", 1981): arrows that close a circle are turned round meanwhile, each
box is one layer below the last that leads to it, each layer is sorted by the mean place of its
neighbours, and where that is done the boxes go as near to their neighbours as the order allows.
Each arrow gets a place of its own in each layer that it goes through, and in the layers between
those of the boxes one for its words: so no two words, and no words and box, lie on each other. A
tree is drawn as Reingold and Tilford do it ("Tidier drawings of trees", 1981).

Lengths are pixels at scale 1, y goes down. The same graph always has the same places.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

SWEEPS = 12
"""How often the layers are sorted, down and up; the best order that was met is taken."""
PULLS = 24
"""How often the boxes are pulled to their neighbours."""
STRAIGHTENED = 3
"""How often each long arrow is straightened: where it goes others may have made room."""
STRAIGHT = 6.0
"""How much more a long arrow pulls at its own places than at boxes: it shall not have bends."""


class Point(NamedTuple):
    """A place."""

    x: float
    y: float


@dataclass(frozen=True)
class Extent:
    """How far a box reaches from its middle to the left and to the right, and how high it is."""

    left: float
    right: float
    height: float


@dataclass(frozen=True)
class Edge:
    """An arrow between two boxes, and the room that its words need."""

    key: str
    start: str
    end: str
    width: float = 0.0
    height: float = 0.0


@dataclass(frozen=True)
class Gaps:
    """What is left free beside boxes and words, and between the layers."""

    beside: float
    between: float


@dataclass(frozen=True)
class Drawing:
    """The middles of boxes and of words, and the points that each arrow goes through.

    Between the points 2n and 2n + 1 of an arrow there is a bend, between the others it is straight
    and upright.
    """

    boxes: Mapping[str, Point] = field(default_factory=dict)
    words: Mapping[str, Point] = field(default_factory=dict)
    ways: Mapping[str, tuple[Point, ...]] = field(default_factory=dict)


# Graphs


def in_layers(
    boxes: Mapping[str, Extent], edges: Sequence[Edge], first: Iterable[str], gaps: Gaps
) -> Drawing:
    """Lay a graph out from above to below; what cannot be reached from ``first`` is lowest.

    Arrows from a box to itself are not laid out.
    """
    if not boxes:
        return Drawing()
    real = [edge for edge in edges if edge.start != edge.end]
    graph = _Layered(boxes, real, [name for name in first if name in boxes])
    graph.sort()
    graph.place(gaps)
    return graph.drawing()


@dataclass
class _Spot:
    """A box in its layer, or the place of an arrow in a layer that it goes through."""

    extent: Extent
    layer: int
    box: str | None = None
    x: float = 0.0


class _Layered:
    """A graph on its way to a drawing; spots are known by their numbers."""

    def __init__(
        self, boxes: Mapping[str, Extent], edges: Sequence[Edge], first: Sequence[str]
    ) -> None:
        self._turned = _turned(boxes, edges, first)
        layers = _layers(boxes, edges, self._turned)
        self.spots = [_Spot(extent, layers[name], name) for name, extent in boxes.items()]
        number_of = {name: number for number, name in enumerate(boxes)}
        self.chains: dict[str, list[int]] = {}
        """The spots of each arrow, from above to below."""
        self._with_words: dict[str, int] = {}
        self.above: list[list[int]] = [[] for _ in self.spots]
        self.below: list[list[int]] = [[] for _ in self.spots]
        for edge in edges:
            self._add(edge, number_of)
        self.edges = {edge.key: edge for edge in edges}
        self.layers: list[list[int]] = [[] for _ in range(1 + max(s.layer for s in self.spots))]
        for number, spot in enumerate(self.spots):
            self.layers[spot.layer].append(number)

    def _add(self, edge: Edge, number_of: Mapping[str, int]) -> None:
        """Give an arrow its spots; its words stand near the box that it comes from."""
        is_turned = edge.key in self._turned
        top, bottom = (edge.end, edge.start) if is_turned else (edge.start, edge.end)
        upper, lower = number_of[top], number_of[bottom]
        inner = range(self.spots[upper].layer + 1, self.spots[lower].layer)
        chain = [upper]
        for layer in inner:
            is_for_words = layer == (inner[-1] if is_turned else inner[0])
            half = edge.width / 2 if is_for_words else 0.0
            extent = Extent(half, half, edge.height if is_for_words else 0.0)
            if is_for_words:
                self._with_words[edge.key] = len(self.spots)
            chain.append(len(self.spots))
            self.spots.append(_Spot(extent, layer))
            self.above.append([])
            self.below.append([])
        chain.append(lower)
        for one, other in itertools.pairwise(chain):
            self.below[one].append(other)
            self.above[other].append(one)
        self.chains[edge.key] = chain

    # The order in each layer

    def sort(self) -> None:
        """Sort the layers so that few arrows cross."""
        best, fewest = [list(layer) for layer in self.layers], self._crossings()
        for sweep in range(SWEEPS):
            is_down = sweep % 2 == 0
            numbers = range(1, len(self.layers))
            for number in numbers if is_down else reversed(range(len(self.layers) - 1)):
                near = self.above if is_down else self.below
                self._sort_layer(number, near, turns_ties=sweep // 2 % 2 == 1)
            count = self._crossings()
            if count < fewest:
                best, fewest = [list(layer) for layer in self.layers], count
        self.layers = best

    def _sort_layer(
        self, number: int, neighbours: Sequence[Sequence[int]], *, turns_ties: bool
    ) -> None:
        """Sort by the neighbours; those that are equal stay, or change places to get unstuck."""
        place = {spot: index for layer in self.layers for index, spot in enumerate(layer)}

        def mean(spot: int) -> float:
            near = [place[other] for other in neighbours[spot]]
            return sum(near) / len(near) if near else float(place[spot])

        if turns_ties:
            self.layers[number].reverse()
        self.layers[number].sort(key=mean)

    def _crossings(self) -> int:
        """How often arrows cross."""
        return sum(self._crossings_below(layer) for layer in self.layers)

    def _crossings_below(self, layer: Sequence[int]) -> int:
        place: dict[int, int] = {}
        for spot in layer:
            for other in self.below[spot]:
                place.setdefault(other, 0)
        if not place:
            return 0
        following = self.layers[self.spots[next(iter(place))].layer]
        place = {spot: index for index, spot in enumerate(following)}
        ends = [e for spot in layer for e in sorted(place[o] for o in self.below[spot])]
        return sum(
            1 for index, end in enumerate(ends) for later in ends[index + 1 :] if later < end
        )

    # Where in its layer each spot is

    def place(self, gaps: Gaps) -> None:
        """Put the spots as near to their neighbours as their order allows."""
        for layer in self.layers:
            self._pull(layer, gaps, lambda spot: [])
        for pull in range(PULLS):
            is_down = pull % 2 == 0
            near = self.above if is_down else self.below
            for layer in self.layers if is_down else reversed(self.layers):
                self._pull(layer, gaps, near.__getitem__)
        for layer in self.layers:
            self._pull(layer, gaps, lambda spot: [*self.above[spot], *self.below[spot]])
        for _ in range(STRAIGHTENED):
            for chain in self.chains.values():
                self._straighten(chain[1:-1], gaps)
        heights = [max(self.spots[s].extent.height for s in layer) for layer in self.layers]
        self._middles, y = list[float](), 0.0
        for height in heights:
            self._middles.append(y + height / 2)
            y += height + gaps.between
        self._heights = heights

    def _pull(
        self, layer: Sequence[int], gaps: Gaps, neighbours: Callable[[int], Sequence[int]]
    ) -> None:
        wanted, weights = list[float](), list[float]()
        for spot in layer:
            near = [(self.spots[other].x, self._weight(spot, other)) for other in neighbours(spot)]
            weight = sum(weight for _, weight in near)
            mean = sum(x * weight for x, weight in near) / weight if near else self.spots[spot].x
            wanted.append(mean)
            weights.append(weight or 0.1)
        extents = [self.spots[spot].extent for spot in layer]
        steps = [a.right + gaps.beside + b.left for a, b in itertools.pairwise(extents)]
        for spot, x in zip(layer, in_order(wanted, steps, weights), strict=True):
            self.spots[spot].x = x

    def _straighten(self, spots: Sequence[int], gaps: Gaps) -> None:
        """Let an arrow go straight through as many layers as it has room to."""
        run, low, high = list[int](), -math.inf, math.inf
        for spot in spots:
            left, right = self._room(spot, gaps)
            if run and max(low, left) > min(high, right):
                self._align(run, low, high)
                run, low, high = [], -math.inf, math.inf
            run.append(spot)
            low, high = max(low, left), min(high, right)
        self._align(run, low, high)

    def _align(self, run: Sequence[int], low: float, high: float) -> None:
        if run:
            mean = sum(self.spots[spot].x for spot in run) / len(run)
            for spot in run:
                self.spots[spot].x = min(max(mean, low), high)

    def _room(self, number: int, gaps: Gaps) -> tuple[float, float]:
        """How far a spot can go to both sides before it meets the next one."""
        spot = self.spots[number]
        layer = self.layers[spot.layer]
        index = layer.index(number)
        low, high = -math.inf, math.inf
        if index > 0:
            other = self.spots[layer[index - 1]]
            low = other.x + other.extent.right + gaps.beside + spot.extent.left
        if index + 1 < len(layer):
            other = self.spots[layer[index + 1]]
            high = other.x - other.extent.left - gaps.beside - spot.extent.right
        return min(low, spot.x), max(high, spot.x)  # where it is there is room for it

    def _weight(self, one: int, other: int) -> float:
        ends = (self.spots[one].box, self.spots[other].box)
        return STRAIGHT if ends == (None, None) else 1.0

    # The drawing

    def drawing(self) -> Drawing:
        """What has become of it."""
        boxes = {s.box: Point(s.x, self._middles[s.layer]) for s in self.spots if s.box is not None}
        words = {key: self._middle(number) for key, number in self._with_words.items()}
        down, up = self._doors(self.below, 1), self._doors(self.above, -1)
        ways = {}
        for key, chain in self.chains.items():
            way = [down[chain[0], chain[1], key]]
            for spot in chain[1:-1]:
                x, middle = self._middle(spot)
                half = self._heights[self.spots[spot].layer] / 2
                way += (Point(x, middle - half), Point(x, middle + half))
            way.append(up[chain[-1], chain[-2], key])
            ways[key] = tuple(reversed(way)) if key in self._turned else tuple(way)
        return Drawing(boxes, words, ways)

    def _middle(self, spot: int) -> Point:
        return Point(self.spots[spot].x, self._middles[self.spots[spot].layer])

    def _doors(
        self, neighbours: Sequence[Sequence[int]], side: int
    ) -> dict[tuple[int, int, str], Point]:
        """Where arrows leave the boxes: beside each other, in the order of where they go."""
        leaving: dict[int, list[tuple[float, int, str]]] = {}
        for key, chain in self.chains.items():
            spot, following = (chain[0], chain[1]) if side > 0 else (chain[-1], chain[-2])
            leaving.setdefault(spot, []).append((self.spots[following].x, following, key))
        doors = {}
        for spot, ways in leaving.items():
            extent, (x, y) = self.spots[spot].extent, self._middle(spot)
            narrow = min(extent.left, extent.right)
            step = min(2 * narrow * 0.7 / len(ways), narrow * 0.5)
            for index, (_, following, key) in enumerate(sorted(ways)):
                aside = (index - (len(ways) - 1) / 2) * step
                door = Point(x + aside, y + side * extent.height / 2)
                doors[spot, following, key] = door
        return doors


def _turned(
    boxes: Mapping[str, Extent], edges: Sequence[Edge], first: Sequence[str]
) -> frozenset[str]:
    """The arrows that lead back: on a walk from the first boxes, to one that was come from."""
    leaving: dict[str, list[Edge]] = {name: [] for name in boxes}
    for edge in edges:
        leaving[edge.start].append(edge)
    turned, done, on_way = set[str](), set[str](), set[str]()
    parts: dict[str, int] = {}
    for part, root in enumerate((*first, *boxes)):
        waiting = [(root, iter(leaving[root]))] if root not in done else []
        on_way.update([root] if waiting else [])
        is_reached = part < len(first)
        while waiting:
            name, ways = waiting[-1]
            parts.setdefault(name, 0 if is_reached else 1)
            way = next(ways, None)
            if way is None:
                waiting.pop()
                on_way.discard(name)
                done.add(name)
            elif way.end in on_way or (parts.get(way.end) == 0 and not is_reached):
                turned.add(way.key)  # also one from what cannot be reached: that is below
            elif way.end not in done:
                on_way.add(way.end)
                waiting.append((way.end, iter(leaving[way.end])))
    return frozenset(turned)


def _layers(
    boxes: Mapping[str, Extent], edges: Sequence[Edge], turned: frozenset[str]
) -> dict[str, int]:
    """The layer of each box: an even one, below all that lead to it."""
    leaving: dict[str, list[str]] = {name: [] for name in boxes}
    waits = dict.fromkeys(boxes, 0)
    for edge in edges:
        ends = (edge.end, edge.start) if edge.key in turned else (edge.start, edge.end)
        leaving[ends[0]].append(ends[1])
        waits[ends[1]] += 1
    layers = dict.fromkeys(boxes, 0)
    ready = [name for name, count in waits.items() if count == 0]
    while ready:
        name = ready.pop()
        for other in leaving[name]:
            layers[other] = max(layers[other], layers[name] + 2)
            waits[other] -= 1
            if waits[other] == 0:
                ready.append(other)
    return layers


def in_order(
    wanted: Sequence[float], steps: Sequence[float], weights: Sequence[float]
) -> list[float]:
    """The places nearest to those wanted, each at least a step behind the one before.

    The least sum of squares, by pooling neighbours that are too near to each other (isotonic
    regression; Ayer and others, 1955). There is one step less than places.
    """
    shifts = [0.0]
    for step in steps:
        shifts.append(shifts[-1] + step)
    pools: list[tuple[float, float, int]] = []  # mean, weight, how many
    for place, shift, weight in zip(wanted, shifts, weights, strict=False):
        pool = (place - shift, weight, 1)
        while pools and pools[-1][0] > pool[0]:
            mean, heavy, count = pools.pop()
            total = heavy + pool[1]
            pool = ((mean * heavy + pool[0] * pool[1]) / total, total, count + pool[2])
        pools.append(pool)
    means = [mean for mean, _, count in pools for _ in range(count)]
    return [mean + shift for mean, shift in zip(means, shifts, strict=False)]


# Trees


def as_tree(
    boxes: Mapping[str, Extent], children: Mapping[str, Sequence[str]], root: str, gaps: Gaps
) -> Drawing:
    """Lay a tree out: each box over the middle of those below it, these from left to right."""
    order, depth = [root], {root: 0}
    for name in order:
        for child in children.get(name, ()):
            depth[child] = depth[name] + 1
            order.append(child)
    shifts: dict[str, float] = {}
    outlines: dict[str, list[tuple[float, float]]] = {}
    for name in reversed(order):
        outlines[name] = _over(name, boxes[name], children.get(name, ()), outlines, shifts, gaps)
    tops = _tops(boxes, depth, gaps)
    middles = {root: Point(0.0, tops[0] + boxes[root].height / 2)}
    for name in order[1:]:
        middles[name] = Point(shifts[name], tops[depth[name]] + boxes[name].height / 2)
    ways = {}
    for name in order:
        x, y = middles[name]
        for child in children.get(name, ()):
            moved = middles[child]._replace(x=x + middles[child].x)
            middles[child] = moved
            foot = Point(x, y + boxes[name].height / 2)
            ways[child] = (foot, moved._replace(y=moved.y - boxes[child].height / 2))
    return Drawing(middles, {}, ways)


def _over(
    name: str,
    box: Extent,
    children: Sequence[str],
    outlines: dict[str, list[tuple[float, float]]],
    shifts: dict[str, float],
    gaps: Gaps,
) -> list[tuple[float, float]]:
    """Put branches beside each other, as near as they can be, under the middle of a box.

    ``outlines`` are how far a branch reaches to both sides in each row, from the middle of its
    first box; ``shifts`` where that is under the box above. Gives the outline of the whole.
    """
    whole: list[tuple[float, float]] = []
    for child in children:
        branch = outlines.pop(child)
        near = (a[1] - b[0] for a, b in zip(whole, branch, strict=False)) if whole else ()
        shift = max(near, default=0.0) + (gaps.beside if whole else 0.0)
        shifts[child] = shift
        moved = [(left + shift, right + shift) for left, right in branch]
        shared = [(a[0], b[1]) for a, b in zip(whole, moved, strict=False)]
        rest = whole[len(moved) :] if len(whole) > len(moved) else moved[len(whole) :]
        whole = shared + rest
    middle = (shifts[children[0]] + shifts[children[-1]]) / 2 if children else 0.0
    for child in children:
        shifts[child] -= middle
    return [(-box.left, box.right), *((a - middle, b - middle) for a, b in whole)]


def _tops(boxes: Mapping[str, Extent], depth: Mapping[str, int], gaps: Gaps) -> list[float]:
    """Where each row begins."""
    heights = [0.0] * (1 + max(depth.values()))
    for name, row in depth.items():
        heights[row] = max(heights[row], boxes[name].height)
    tops = [0.0]
    for height in heights[:-1]:
        tops.append(tops[-1] + height + gaps.between)
    return tops


def mirrored(drawing: Drawing) -> Drawing:
    """The same from the other side."""

    def turn(place: Point) -> Point:
        return place._replace(x=-place.x)

    return replace(
        drawing,
        boxes={key: turn(place) for key, place in drawing.boxes.items()},
        words={key: turn(place) for key, place in drawing.words.items()},
        ways={key: tuple(map(turn, way)) for key, way in drawing.ways.items()},
    )
