"""Where nodes and topics stand in the graph."""

from __future__ import annotations

import math

from hypothesis import given
from hypothesis import strategies as some

from nep_studio.ui.plugins.network.graph import MOST_IN_COLUMN, Graph, lay_out, shapes_of

KARATE = Graph(
    {"watch": "sensory", "karate": "perceptual", "program": "cognitive", "NAO": "action"},
    ("/imu", "/human_behavior", "/action_request", "/action_result"),
    (
        ("watch", "/imu"),
        ("karate", "/human_behavior"),
        ("program", "/action_request"),
        ("NAO", "/action_result"),
    ),
    (
        ("karate", "/imu"),
        ("program", "/human_behavior"),
        ("NAO", "/action_request"),
        ("program", "/action_result"),
    ),
)

TYPES = some.sampled_from(["sensory", "perceptual", "cognitive", "action", ""])


@some.composite
def graphs(draw) -> Graph:
    nodes = draw(some.dictionaries(some.sampled_from([f"n{i}" for i in range(30)]), TYPES))
    topics = draw(some.lists(some.sampled_from([f"/t{i}" for i in range(20)]), unique=True))
    if not nodes or not topics:
        return Graph(nodes, tuple(topics))
    pairs = some.tuples(some.sampled_from(sorted(nodes)), some.sampled_from(topics))
    ends = some.lists(pairs, max_size=60, unique=True).map(tuple)
    return Graph(nodes, tuple(topics), draw(ends), draw(ends))


def test_a_gesture_goes_from_left_to_right_until_the_robot_moves() -> None:
    spots = lay_out(KARATE)

    way = [
        spots[key].column
        for key in (
            ("node", "watch"),
            ("topic", "/imu"),
            ("node", "karate"),
            ("topic", "/human_behavior"),
            ("node", "program"),
            ("topic", "/action_request"),
            ("node", "NAO"),
        )
    ]
    assert way == sorted(set(way))


def test_a_program_whose_type_nobody_knows_stands_where_it_speaks() -> None:
    graph = Graph({"sensor": "", "NAO": "action"}, ("/imu",), (("sensor", "/imu"),))

    spots = lay_out(graph)

    assert spots["node", "sensor"].column < spots["topic", "/imu"].column


def test_a_long_layer_becomes_several_columns() -> None:
    nodes = {f"gesture_{number}": "perceptual" for number in range(50)}
    says = tuple((name, "/human_behavior") for name in nodes)

    spots = lay_out(Graph(nodes, ("/human_behavior",), says))

    rows = {spot.row for spot in spots.values()}
    assert len(rows) <= 2 * MOST_IN_COLUMN
    assert max(abs(row) for row in rows) <= MOST_IN_COLUMN / 2


@given(graphs())
def test_everything_has_a_place_of_its_own(graph: Graph) -> None:
    spots = lay_out(graph)

    assert set(spots) == set(graph.keys)
    assert len(set(spots.values())) == len(spots)


@given(graphs())
def test_the_same_network_always_looks_the_same(graph: Graph) -> None:
    assert lay_out(graph) == lay_out(graph)


@given(graphs())
def test_boxes_never_lie_on_each_other(graph: Graph) -> None:
    rects = list(shapes_of(graph, 20.0).rects.values())

    for place, rect in enumerate(rects):
        assert not any(rect.intersects(other) for other in rects[place + 1 :])


def test_a_mirrored_graph_runs_from_right_to_left() -> None:
    rects = shapes_of(KARATE, 20.0, is_mirrored=True).rects

    assert rects["node", "watch"].left() > rects["node", "NAO"].left()


def test_every_line_ends_at_the_edge_of_its_box() -> None:
    shapes = shapes_of(KARATE, 20.0)

    for curve in shapes.curves:
        tip, rect = curve.arrow.first(), shapes.rects[curve.end]
        distance = math.hypot(
            max(rect.left() - tip.x(), 0, tip.x() - rect.right()),
            max(rect.top() - tip.y(), 0, tip.y() - rect.bottom()),
        )
        assert distance < 1
