"""The watch over a real network: who is there, how much goes through, what it costs."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterator

import pytest
from pytestqt.qtbot import QtBot

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher
from nep_studio.ui.network_feed import Seen
from nep_studio.ui.network_watch import MOST_ROUTES, NetworkWatch, ProcessMeter, Traffic

Join = Callable[[str], PeerNetwork]


@pytest.fixture
def watch(join: Join) -> Iterator[NetworkWatch]:
    network = join("studio")
    made = NetworkWatch(lambda: network)
    made.start()
    yield made
    made.stop()


def wait_for(watch: NetworkWatch, condition: Callable[[Seen], object], qtbot: QtBot) -> Seen:
    qtbot.waitUntil(lambda: bool(condition(watch.latest)), timeout=10_000)
    return watch.latest


def counted(topic: str, least: int) -> Callable[[Seen], bool]:
    """Whether so many messages of a topic were counted; it may not be seen at all yet."""
    return lambda seen: topic in seen.topics and seen.topics[topic].count >= least


def test_nodes_topics_and_ends_are_seen(watch: NetworkWatch, join: Join, qtbot: QtBot) -> None:
    Publisher("/imu", network=join("sensor"))

    seen = wait_for(watch, lambda seen: "/imu" in seen.topics and "sensor" in seen.nodes, qtbot)

    assert seen.topics["/imu"].publishers == ("sensor",)
    assert seen.nodes["sensor"].publishes == ("/imu",)


def test_messages_are_counted_and_the_last_one_kept(
    watch: NetworkWatch, join: Join, qtbot: QtBot
) -> None:
    publisher = Publisher("/imu", network=join("sensor"))
    wait_for(watch, lambda _: publisher.subscribers() > 0, qtbot)

    for number in range(100):
        publisher.send({"number": number})

    seen = wait_for(watch, counted("/imu", 100), qtbot)
    assert seen.topics["/imu"].count == 100
    assert seen.topics["/imu"].last == {"number": 99}
    assert seen.topics["/imu"].lost == 0
    assert seen.flows["sensor", "/imu"].count == 100
    assert abs(seen.topics["/imu"].last_s - time.time()) < 10


def test_texts_are_counted_too(watch: NetworkWatch, join: Join, qtbot: QtBot) -> None:
    publisher = Publisher("/words", network=join("old"))
    wait_for(watch, lambda _: publisher.subscribers() > 0, qtbot)

    publisher.send("hello")

    seen = wait_for(watch, counted("/words", 1), qtbot)
    assert seen.topics["/words"].last == "hello"


def test_5000_messages_a_second_are_all_counted(
    watch: NetworkWatch, join: Join, qtbot: QtBot
) -> None:
    publisher = Publisher("/fast", network=join("fast"))
    wait_for(watch, lambda _: publisher.subscribers() > 0, qtbot)

    def flood() -> None:
        begin_s = time.monotonic()
        for number in range(5_000):
            publisher.send({"number": number})
            while number > 5000 * (time.monotonic() - begin_s):
                time.sleep(0.001)  # the rate that is played

    thread = threading.Thread(target=flood)
    thread.start()
    try:
        seen = wait_for(watch, counted("/fast", 5_000), qtbot)
    finally:
        thread.join()

    assert seen.topics["/fast"].count + seen.topics["/fast"].lost == 5_000
    assert seen.topics["/fast"].lost == 0


def test_a_node_that_leaves_is_seen_no_more(watch: NetworkWatch, join: Join, qtbot: QtBot) -> None:
    network = join("sensor")
    Publisher("/imu", network=network)
    wait_for(watch, lambda seen: "sensor" in seen.nodes, qtbot)

    network.close()

    wait_for(watch, lambda seen: "sensor" not in seen.nodes and "/imu" not in seen.topics, qtbot)


def test_a_closed_network_is_seen_as_gone(join: Join, qtbot: QtBot) -> None:
    network = join("studio")
    watch = NetworkWatch(lambda: network)
    watch.start()
    wait_for(watch, lambda seen: seen.is_up, qtbot)

    network.close()

    wait_for(watch, lambda seen: not seen.is_up, qtbot)
    watch.stop()


def test_a_process_is_measured_with_what_it_started() -> None:
    meter = ProcessMeter()

    first = meter.measure(os.getpid())
    busy_until_s = time.process_time() + 0.3
    while time.process_time() < busy_until_s:
        pass
    second = meter.measure(os.getpid())

    assert first is not None and first.memory_bytes > 1_000_000
    assert second is not None and second.cpu_percent > 0


def test_a_process_that_is_gone_is_not_measured() -> None:
    assert ProcessMeter().measure(2**22 + 12345) is None


def test_senders_of_ever_new_names_do_not_fill_the_memory() -> None:
    traffic = Traffic()
    traffic.begin("/imu", 0.0)

    for number in range(MOST_ROUTES + 500):
        traffic.note("/imu", {f"stranger {number}": 1}, 0.1)

    flows = traffic.flows(0.2)
    assert len(flows) == MOST_ROUTES
    assert (f"stranger {MOST_ROUTES + 499}", "/imu") in flows


def test_a_rate_is_that_of_the_last_two_seconds() -> None:
    traffic = Traffic()
    traffic.begin("/imu", 0.0)

    for tenth in range(1, 101):
        traffic.note("/imu", {"watch": 5}, tenth / 10)

    assert traffic.topics["/imu"].counter.rate_hz(10.0) == pytest.approx(50, rel=0.1)
    assert traffic.flows(10.0)["watch", "/imu"].rate_hz == pytest.approx(50, rel=0.1)
    assert traffic.topics["/imu"].counter.rate_hz(20.0) < 30
