"""Where the nodes and topics of a network stand: in layers, from sensing to acting."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

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
        layers.setdefault(_layer_of_topic(says, hears), []).append(("topic", topic))
    return layers


def _layer_of(name: str, type_: str, graph: Graph) -> int:
    """A node whose type is not known stands at the side on which it speaks or hears."""
    if type_ in LAYERS:
        return LAYERS[type_]
    does_say = any(node == name for node, _ in graph.says)
    does_hear = any(node == name for node, _ in graph.hears)
    return {(True, False): 0, (False, True): 6}.get((does_say, does_hear), 4)


def _layer_of_topic(says: Sequence[int], hears: Sequence[int]) -> int:
    """Right of who says it first; a topic that nobody says, left of who hears it first."""
    if says:
        return min(says) + 1
    return min(hears, default=0) - 1


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
    column = 0
    for number in numbers:
        for part in _columns(order[number]):
            middle = (len(part) - 1) / 2
            for index, key in enumerate(part):
                spots[key] = Spot(column, index - middle)
            column += 1
    return spots


def _columns(items: list[Key]) -> list[list[Key]]:
    """A layer in columns of about the same length, its order read down each column."""
    count = max(1, -(-len(items) // MOST_IN_COLUMN))
    length = -(-len(items) // count)
    return [items[start : start + length] for start in range(0, len(items), length)]
