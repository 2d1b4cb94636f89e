"""Where the boxes, words and lines of a diagram are."""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as some

from nep_studio.ui.plugins.diagrams.layout import (
    Drawing,
    Edge,
    Extent,
    Gaps,
    Point,
    as_tree,
    in_layers,
    in_order,
    mirrored,
)

GAPS = Gaps(10.0, 20.0)
BOX = Extent(40.0, 40.0, 30.0)
WORDS = (50.0, 12.0)

Rect = tuple[float, float, float, float]


def rects(drawing: Drawing, boxes: dict[str, Extent], edges: Iterable[Edge]) -> list[Rect]:
    """Left, top, right and bottom of all boxes and words."""
    found = []
    for name, extent in boxes.items():
        x, y = drawing.boxes[name]
        half = extent.height / 2
        found.append((x - extent.left, y - half, x + extent.right, y + half))
    for edge in edges:
        if edge.key in drawing.words:
            x, y = drawing.words[edge.key]
            wide, high = edge.width / 2, edge.height / 2
            found.append((x - wide, y - high, x + wide, y + high))
    return found


def overlapping(found: list[Rect]) -> list[tuple[Rect, Rect]]:
    return [
        (a, b)
        for a, b in itertools.combinations(found, 2)
        if a[0] < b[2] - 1e-6 and b[0] < a[2] - 1e-6 and a[1] < b[3] - 1e-6 and b[1] < a[3] - 1e-6
    ]


@some.composite
def graphs(draw) -> tuple[dict[str, Extent], list[Edge]]:
    names = [f"s{number}" for number in range(draw(some.integers(1, 12)))]
    sides = some.floats(5.0, 120.0)
    boxes = {name: Extent(draw(sides), draw(sides), draw(sides)) for name in names}
    ends = some.lists(some.tuples(some.sampled_from(names), some.sampled_from(names)), max_size=25)
    edges = [
        Edge(f"e{number}", start, end, draw(sides), draw(sides))
        for number, (start, end) in enumerate(draw(ends))
    ]
    return boxes, edges


@given(graphs())
def test_no_boxes_and_words_lie_on_each_other(graph) -> None:
    boxes, edges = graph

    drawing = in_layers(boxes, edges, ["s0"], GAPS)

    assert drawing.boxes.keys() == boxes.keys()
    assert drawing.ways.keys() == {edge.key for edge in edges if edge.start != edge.end}
    assert overlapping(rects(drawing, boxes, edges)) == []


@given(graphs())
def test_every_arrow_begins_and_ends_at_its_boxes(graph) -> None:
    boxes, edges = graph

    drawing = in_layers(boxes, edges, ["s0"], GAPS)

    for edge in edges:
        if edge.key not in drawing.ways:
            continue
        way = drawing.ways[edge.key]
        assert len(way) % 2 == 0
        for name, place in ((edge.start, way[0]), (edge.end, way[-1])):
            middle, extent = drawing.boxes[name], boxes[name]
            assert abs(abs(place.y - middle.y) - extent.height / 2) < 1e-6
            assert middle.x - extent.left <= place.x <= middle.x + extent.right


@given(graphs())
def test_the_same_graph_has_the_same_places(graph) -> None:
    assert in_layers(*graph, ["s0"], GAPS) == in_layers(*graph, ["s0"], GAPS)


def named(*names: str) -> dict[str, Extent]:
    return dict.fromkeys(names, BOX)


def test_where_it_begins_is_on_top_and_what_cannot_be_reached_is_below() -> None:
    edges = [Edge("a", "lost", "first"), Edge("b", "first", "next"), Edge("c", "next", "first")]

    drawing = in_layers(named("lost", "next", "first"), edges, ["first"], GAPS)

    heights = {name: place.y for name, place in drawing.boxes.items()}
    assert heights["first"] < heights["next"]
    assert heights["first"] < heights["lost"]


def test_several_arrows_between_the_same_two_go_beside_each_other() -> None:
    edges = [Edge(f"e{number}", "a", "b", *WORDS) for number in range(3)]
    edges.append(Edge("back", "b", "a", *WORDS))

    drawing = in_layers(named("a", "b"), edges, ["a"], GAPS)

    assert len({place.x for place in drawing.words.values()}) == 4
    assert drawing.ways["back"][0].y > drawing.ways["back"][-1].y


def test_arrows_do_not_cross_where_they_need_not() -> None:
    edges = [Edge("1", "top", "b"), Edge("2", "top", "a")]
    edges += [Edge("3", "a", "a2"), Edge("4", "b", "b2"), Edge("5", "a", "b2")]

    drawing = in_layers(named("top", "a", "b", "a2", "b2"), edges, ["top"], GAPS)

    x = {name: place.x for name, place in drawing.boxes.items()}
    assert (x["a"] < x["b"]) == (x["a2"] < x["b2"])


def test_a_long_arrow_goes_straight_past_the_boxes() -> None:
    names = [f"s{number}" for number in range(6)]
    chain = [Edge(f"e{a}", a, b) for a, b in itertools.pairwise(names)]

    drawing = in_layers(named(*names), [*chain, Edge("long", "s0", "s5")], ["s0"], GAPS)

    assert len({round(place.x, 3) for place in drawing.ways["long"][1:-1]}) == 1


def test_forty_states_are_laid_out_before_one_notices() -> None:
    names = [f"s{number}" for number in range(40)]
    edges = [
        Edge(f"{a} {factor}", names[a], names[(a * factor + 3) % 40], *WORDS)
        for a in range(40)
        for factor in (5, 7)
    ]

    begin = time.process_time()
    drawing = in_layers(named(*names), edges, ["s0"], GAPS)

    assert time.process_time() - begin < 1.0
    assert overlapping(rects(drawing, named(*names), edges)) == []


@pytest.mark.parametrize(
    ("wanted", "steps", "found"),
    [
        ([0.0, 100.0], [10.0], [0.0, 100.0]),
        ([0.0, 0.0], [10.0], [-5.0, 5.0]),
        ([9.0, 0.0, 50.0], [10.0, 10.0], [-0.5, 9.5, 50.0]),
    ],
)
def test_places_are_as_near_to_those_wanted_as_the_order_allows(wanted, steps, found) -> None:
    assert in_order(wanted, steps, [1.0] * len(wanted)) == pytest.approx(found)


# Trees


@some.composite
def trees(draw) -> tuple[dict[str, Extent], dict[str, list[str]]]:
    sides = some.floats(5.0, 120.0)
    boxes = {"t0": Extent(draw(sides), draw(sides), draw(sides))}
    children: dict[str, list[str]] = {}
    for number in range(1, draw(some.integers(1, 25))):
        parent = f"t{draw(some.integers(0, number - 1))}"
        children.setdefault(parent, []).append(f"t{number}")
        boxes[f"t{number}"] = Extent(draw(sides), draw(sides), draw(sides))
    return boxes, children


@given(trees())
def test_no_boxes_of_a_tree_lie_on_each_other_and_all_stand_as_they_are_done(tree) -> None:
    boxes, children = tree

    drawing = as_tree(boxes, children, "t0", GAPS)

    assert overlapping(rects(drawing, boxes, ())) == []
    for parent, below in children.items():
        places = [drawing.boxes[child] for child in below]
        assert places == sorted(places, key=lambda place: place.x)
        middle = (places[0].x + places[-1].x) / 2
        assert drawing.boxes[parent].x == pytest.approx(middle, abs=1e-6)
        assert all(place.y > drawing.boxes[parent].y for place in places)


@given(trees())
def test_the_lines_of_a_tree_join_its_boxes(tree) -> None:
    boxes, children = tree

    drawing = as_tree(boxes, children, "t0", GAPS)

    for parent, below in children.items():
        for child in below:
            start, end = drawing.ways[child]
            assert start.x == pytest.approx(drawing.boxes[parent].x)
            assert end == pytest.approx(
                Point(drawing.boxes[child].x, drawing.boxes[child].y - boxes[child].height / 2)
            )


def test_a_tree_that_is_very_deep_is_laid_out() -> None:
    names = [f"t{number}" for number in range(3000)]
    children = {a: [b] for a, b in itertools.pairwise(names)}

    drawing = as_tree(named(*names), children, "t0", GAPS)

    assert {place.x for place in drawing.boxes.values()} == {0.0}


def test_from_the_other_side_it_is_the_same_picture() -> None:
    edges = [Edge("1", "a", "b", *WORDS), Edge("2", "a", "c", *WORDS)]
    drawing = in_layers(named("a", "b", "c"), edges, ["a"], GAPS)

    turned = mirrored(drawing)

    assert turned.boxes["b"].x == -drawing.boxes["b"].x
    assert mirrored(turned) == drawing
