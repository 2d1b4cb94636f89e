"""The page Network in a real window: graph, list, messages of a topic, sending by hand."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from pytestqt.qtbot import QtBot

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire import messages as m
from nep_core.wire.pubsub import Publisher
from nep_studio.run.plan import PlannedNode
from nep_studio.ui.network_feed import Seen, TopicSeen
from nep_studio.ui.plugins.network.graph import Key
from nep_studio.ui.plugins.network.topics import SHOW_MS
from nep_studio.ui.running.runner import BATCHES_HZ
from tests.ui.panels.conftest import KARATE, WAIT_MS, WATCH, Bench

pytestmark = pytest.mark.long

Start = Callable[[PlannedNode], None]


def show(bench: Bench, qtbot: QtBot) -> None:
    bench.window.workbench.panels.show(bench.room)
    qtbot.waitUntil(bench.network.isVisible)


def wait_for(bench: Bench, key: Key, qtbot: QtBot) -> None:
    graph = bench.network.graph
    qtbot.waitUntil(lambda: key in graph.shapes.rects, timeout=WAIT_MS)


def test_an_empty_network_says_what_belongs_there_and_offers_to_run(
    bench: Bench, qtbot: QtBot
) -> None:
    show(bench, qtbot)

    assert bench.network.views.currentWidget() is bench.network.empty
    with qtbot.waitSignal(bench.runner.run_asked):
        qtbot.mouseClick(bench.network.empty.run_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bench.runner.state == "running", timeout=WAIT_MS)


def test_before_nodes_that_run_are_seen_nobody_says_that_there_are_none(
    bench: Bench, start: Start, qtbot: QtBot
) -> None:
    start(KARATE)
    qtbot.waitUntil(lambda: "karate" in bench.runner.board.nodes, timeout=WAIT_MS)

    show(bench, qtbot)
    bench.network._feed.changed.emit(Seen(is_up=True))  # as long as nobody has registered

    empty = bench.network.empty
    assert bench.network.views.currentWidget() is empty
    assert empty.words.text() == "Here you see which nodes run and what they tell each other."
    assert not empty.run_button.isVisible()


def test_real_nodes_and_their_rates_are_seen(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(KARATE)
    start(WATCH)

    wait_for(bench, ("topic", "/imu"), qtbot)

    feed = bench.network._feed
    qtbot.waitUntil(lambda: "/imu" in feed.seen.topics, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: feed.seen.topics["/imu"].rate_hz > 20, timeout=WAIT_MS)
    graph = bench.network.graph.shapes.rects
    assert graph["node", "virtual_watch"].left() < graph["topic", "/imu"].left()
    assert graph["topic", "/imu"].left() < graph["node", "karate"].left()
    assert ("node", "studio") not in graph
    assert ("topic", m.NODE_STATE) not in graph


def test_a_click_on_a_topic_shows_its_messages(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(WATCH)
    wait_for(bench, ("topic", "/imu"), qtbot)
    place = bench.network.graph.place_of(("topic", "/imu")).toPoint()

    qtbot.mouseClick(bench.network.graph, Qt.MouseButton.LeftButton, pos=place)

    pane = bench.network.pane
    qtbot.waitUntil(lambda: len(pane.heard.shown) > 3, timeout=WAIT_MS)
    assert pane.heard.shown[0].sender == "virtual_watch"
    assert '"rate_hz"' in pane.full.toPlainText()


def test_everything_is_shown_when_it_is_asked_for(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(KARATE)

    bench.network.whole_button.click()

    wait_for(bench, ("node", "studio"), qtbot)
    wait_for(bench, ("topic", m.NODE_STATE), qtbot)


def test_the_list_says_the_same_as_the_graph(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(WATCH)
    wait_for(bench, ("topic", "/imu"), qtbot)

    bench.network.list_button.click()

    view = bench.network.list
    assert bench.network.views.currentWidget() is view
    topics = {view.topics.child(row).text(0) for row in range(view.topics.childCount())}
    nodes = {view.nodes.child(row).text(0) for row in range(view.nodes.childCount())}
    assert "/imu" in topics
    assert nodes == {"virtual_watch"}
    with qtbot.waitSignal(view.topic_chosen):
        view.itemActivated.emit(view.topics.child(0), 0)


def test_a_message_is_sent_by_hand_and_arrives(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(KARATE)
    bench.network.open_topic(m.HUMAN_BEHAVIOR)
    pane = bench.network.pane
    pane.tabs.setCurrentWidget(pane.send_box)
    qtbot.waitUntil(lambda: pane.is_hearing)
    heard: list[m.HumanBehavior] = []
    bench.runner.arrived.connect(
        lambda batch: heard.extend(one for _, one in batch if isinstance(one, m.HumanBehavior))
    )

    pane.send_box.send_button.click()

    qtbot.waitUntil(lambda: bool(heard), timeout=WAIT_MS)
    assert heard[0].human_state == "gesture_karate"
    assert pane.send_box.note.text() == "Sent."
    assert pane.send_box.history.count() == 2


def test_a_wrong_message_is_not_sent_and_the_reason_is_told(
    bench: Bench, start: Start, qtbot: QtBot
) -> None:
    show(bench, qtbot)
    start(KARATE)
    bench.network.open_topic(m.HUMAN_BEHAVIOR)
    box = bench.network.pane.send_box
    box.text.setPlainText('{"certainty": 1.0}')

    box.send_now()

    assert "human_state" in box.note.text()
    assert box.history.count() == 1


def test_without_a_network_sending_says_what_to_do(bench: Bench, qtbot: QtBot) -> None:
    show(bench, qtbot)
    bench.network.open_topic(m.HUMAN_BEHAVIOR)
    box = bench.network.pane.send_box

    box.send_now()

    assert "press Run" in box.note.text()


def test_reading_a_message_stops_the_list(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(WATCH)
    bench.network.open_topic("/imu")
    pane = bench.network.pane
    qtbot.waitUntil(lambda: len(pane.heard.shown) > 5, timeout=WAIT_MS)

    place = pane.list.visualRect(pane.heard.index(1)).center()
    chosen = pane.heard.shown[1]
    qtbot.mouseClick(pane.list.viewport(), Qt.MouseButton.LeftButton, pos=place)
    pane.copy()

    assert pane.bar.pause_button.isChecked()
    before = list(pane.heard.shown)
    batches: list[object] = []
    pane._tap.arrived.connect(batches.append)
    qtbot.waitUntil(lambda: len(batches) > 2, timeout=WAIT_MS)
    assert list(pane.heard.shown) == before
    assert chosen.message.source in QGuiApplication.clipboard().text()


def test_only_messages_with_the_words_are_shown(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(KARATE)
    bench.network.open_topic(m.HUMAN_BEHAVIOR)
    pane = bench.network.pane
    for state in ("gesture_karate", "heard_hello"):
        bench.runner.send(m.HUMAN_BEHAVIOR, m.HumanBehavior(human_state=state))
    qtbot.waitUntil(lambda: len(pane.heard.shown) == 2, timeout=WAIT_MS)

    pane.bar.filter.setText("HELLO")

    assert [one.message.human_state for one in pane.heard.shown] == ["heard_hello"]


def test_a_number_of_a_message_can_be_plotted(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(WATCH)
    bench.network.open_topic("/imu")
    pane = bench.network.pane
    qtbot.waitUntil(lambda: bool(pane.heard.shown), timeout=WAIT_MS)

    pane._on_plot_menu()
    [action] = [one for one in pane.bar.plot_menu.actions() if one.text() == "acc"]
    with qtbot.waitSignal(bench.network.pane.plot_requested) as asked:
        action.trigger()

    assert asked.args == ["/imu", "acc"]


def test_hidden_it_costs_nothing(bench: Bench, start: Start, qtbot: QtBot) -> None:
    show(bench, qtbot)
    start(WATCH)
    bench.network.open_topic("/imu")
    assert bench.network.pane.is_hearing

    bench.window.workbench.rooms.show_canvas()
    bench.nodes.hide()

    assert not bench.network.pane.is_hearing
    qtbot.waitUntil(lambda: not bench.network._feed.is_watching)


def test_5000_messages_a_second_come_to_the_window_in_a_few_batches(
    bench: Bench, start: Start, qtbot: QtBot
) -> None:
    show(bench, qtbot)
    start(KARATE)
    bench.network.open_topic("/fast")
    batches: list[int] = []
    drawn: list[int] = []
    pane = bench.network.pane
    pane._tap.arrived.connect(lambda batch: batches.append(len(batch)))
    pane.heard.modelReset.connect(lambda: drawn.append(pane.heard.count))

    def flood(publisher: Publisher) -> None:
        begin_s = time.monotonic()
        for number in range(7_500):
            publisher.send({"number": number, "values": [1.0, 2.0, 3.0]})
            while number > 5000 * (time.monotonic() - begin_s):
                time.sleep(0.001)  # the rate that is played

    with PeerNetwork("fast", master=bench.runner.local.launcher.master) as network:
        publisher = Publisher("/fast", network=network)
        qtbot.waitUntil(lambda: "/fast" in bench.network._feed.seen.topics, timeout=WAIT_MS)
        qtbot.waitUntil(lambda: publisher.subscribers() > 1, timeout=WAIT_MS)  # pane and feed
        thread = threading.Thread(target=flood, args=[publisher])
        begin_s, worked_s = time.monotonic(), time.thread_time()
        thread.start()
        qtbot.waitUntil(lambda: not thread.is_alive(), timeout=WAIT_MS)
        took_s, worked_s = time.monotonic() - begin_s, time.thread_time() - worked_s

    assert pane.heard.count > 500
    assert len(batches) <= BATCHES_HZ * took_s + 2  # however many came, the window works so often
    assert len(drawn) <= took_s * 1000 / SHOW_MS + 2  # and draws them less often still
    assert worked_s < took_s / 2  # a fifth at most where this was written: a person may act


def test_a_topic_of_which_nothing_is_known_says_nothing_of_the_one_before(bench: Bench) -> None:
    pane = bench.network.pane
    pane.show_topic("/imu", TopicSeen("/imu", publishers=("watch",)))
    assert "watch" in pane.about.text()

    pane.show_topic("/other")
    pane._say()  # in another language

    assert pane.about.text() == ""
