"""The graph of the network: fifty nodes, keys, moving and zooming."""

from __future__ import annotations

from PySide6.QtCore import QPoint, Qt
from pytestqt.qtbot import QtBot

from nep_studio.ui.network_feed import NodeSeen, Seen, TopicSeen
from nep_studio.ui.plugins.network.graph import Graph
from nep_studio.ui.plugins.network.graph_view import GraphView
from tests.ui.panels.conftest import Bench


def many_nodes() -> tuple[Graph, Seen]:
    names = [f"gesture_{number}" for number in range(50)]
    says = tuple((name, "/human_behavior") for name in names)
    graph = Graph(dict.fromkeys(names, "perceptual"), ("/human_behavior",), says)
    topic = TopicSeen("/human_behavior", tuple(names))
    seen = Seen(True, {name: NodeSeen(name) for name in names}, {topic.name: topic})
    return graph, seen


def test_fifty_nodes_can_still_be_read(bench: Bench, qtbot: QtBot) -> None:
    view = GraphView(bench.window.look)
    qtbot.addWidget(view)
    view.resize(1000, 500)
    view.show()

    view.show_graph(*many_nodes(), {})
    shown = view.grab()

    assert view.scale >= 0.6
    assert not shown.isNull()


def test_the_arrow_keys_go_through_the_graph_and_enter_opens(bench: Bench, qtbot: QtBot) -> None:
    view = GraphView(bench.window.look)
    qtbot.addWidget(view)
    view.resize(400, 300)
    view.show()
    view.show_graph(*many_nodes(), {})

    qtbot.keyClick(view, Qt.Key.Key_Down)
    first = view.selected
    qtbot.keyClick(view, Qt.Key.Key_Down)
    below = view.selected
    for _ in range(8):
        qtbot.keyClick(view, Qt.Key.Key_Right)

    assert first is not None and below is not None
    assert view.shapes.rects[below].top() > view.shapes.rects[first].top()
    assert view.selected == ("topic", "/human_behavior")
    with qtbot.waitSignal(view.topic_chosen):
        qtbot.keyClick(view, Qt.Key.Key_Return)


def test_the_graph_is_moved_and_zoomed(bench: Bench, qtbot: QtBot) -> None:
    view = GraphView(bench.window.look)
    qtbot.addWidget(view)
    view.resize(400, 300)
    view.show()
    view.show_graph(*many_nodes(), {})
    key = ("topic", "/human_behavior")
    before, scale = view.place_of(key), view.scale

    qtbot.mousePress(view, Qt.MouseButton.LeftButton, pos=QPoint(200, 150))
    qtbot.mouseMove(view, QPoint(220, 160))
    qtbot.mouseMove(view, QPoint(260, 190))
    qtbot.mouseRelease(view, Qt.MouseButton.LeftButton, pos=QPoint(260, 190))
    moved = view.place_of(key) - before
    qtbot.keyClick(view, Qt.Key.Key_Plus)

    assert (round(moved.x()), round(moved.y())) == (60, 40)
    assert view.scale > scale
    qtbot.keyClick(view, Qt.Key.Key_0)
    assert view.scale == scale
