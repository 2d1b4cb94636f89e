"""Publisher and Subscriber on all three networks, over real sockets."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest

from nep_core import inbox
from nep_core.broker import Broker
from nep_core.errors import NetworkError
from nep_core.messages import HUMAN_BEHAVIOR, HumanBehavior
from nep_core.network import BrokerNetwork, DirectNetwork, Network
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Publisher, Subscriber

Join = Callable[[str], PeerNetwork]
NetworkPair = tuple[Network, Network]


@pytest.fixture(params=["p2p", "broker", "direct one to many", "direct many to one"])
def pair(request: pytest.FixtureRequest, free_port: int) -> Iterator[NetworkPair]:
    """A publisher's and a subscriber's network of each kind."""
    with ExitStack() as stack:
        endpoint = f"tcp://127.0.0.1:{free_port}"
        match request.param:
            case "p2p":
                join: Join = request.getfixturevalue("join")
                yield join("talker"), join("hearer")
                return
            case "broker":
                broker = Broker(endpoint)
                stack.callback(broker.close)
                talker: Network = BrokerNetwork(endpoint, node="talker")
                hearer: Network = BrokerNetwork(endpoint, node="hearer")
            case "direct one to many":
                talker = DirectNetwork(endpoint, node="talker")
                hearer = DirectNetwork(endpoint, node="hearer")
            case _:
                talker = DirectNetwork(endpoint, binds="subscriber", node="talker")
                hearer = DirectNetwork(endpoint, binds="subscriber", node="hearer")
        stack.enter_context(talker)
        stack.enter_context(hearer)
        yield talker, hearer


def test_messages_arrive_in_order_on_every_network(pair: NetworkPair) -> None:
    talker, hearer = pair
    subscriber = Subscriber[dict[str, int]]("/count", network=hearer)
    publisher = Publisher("/count", network=talker, wait_for_subscribers=1)

    for number in range(1000):
        publisher.send({"n": number})

    received = [subscriber.receive(5) for _ in range(1000)]
    assert received == [{"n": number} for number in range(1000)]
    assert subscriber.lost == 0


def test_every_encoding_arrives_on_every_network(pair: NetworkPair) -> None:
    talker, hearer = pair
    subscriber = Subscriber[object]("/x", network=hearer)
    publisher = Publisher("/x", network=talker, wait_for_subscribers=1)

    for message in (
        {"a": 1},
        "text \0 with nul",
        b"\0bytes",
        HumanBehavior(human_state="hi", time=1.0),
    ):
        publisher.send(message)

    received = [subscriber.receive(5) for _ in range(4)]
    assert received[:3] == [{"a": 1}, "text \0 with nul", b"\0bytes"]
    assert received[3] == {"human_state": "hi", "time": 1.0}


def test_a_late_joiner_gets_the_last_latched_message(pair: NetworkPair) -> None:
    talker, hearer = pair
    publisher = Publisher("/state", network=talker, latched=True)
    publisher.send({"n": 1})
    publisher.send({"n": 2})
    publisher.send({"n": 3}, latch=False)

    subscriber = Subscriber[dict[str, int]]("/state", network=hearer)

    assert subscriber.receive(5) == {"n": 2}


def test_a_topic_does_not_get_the_messages_of_a_longer_one(join: Join) -> None:
    talker, hearer = join("talker"), join("hearer")
    subscriber = Subscriber[str]("/gesture", network=hearer)
    longer = Publisher("/gesture_debug", network=talker)
    publisher = Publisher("/gesture", network=talker)

    longer.send("not for you")
    publisher.send("for you")

    assert subscriber.receive(5) == "for you"


def test_no_first_message_is_lost_whoever_comes_first(join: Join) -> None:
    for trial in range(20):
        with PeerNetwork(f"a{trial}") as talker, PeerNetwork(f"b{trial}") as hearer:
            if trial % 2:
                subscriber = Subscriber[int]("/x", network=hearer)
                publisher = Publisher("/x", network=talker)
            else:
                publisher = Publisher("/x", network=talker)
                subscriber = Subscriber[int]("/x", network=hearer)

            publisher.send([trial])

            assert subscriber.receive(5) == [trial]


@pytest.fixture(autouse=True)
def _a_master(request: pytest.FixtureRequest) -> None:
    if "pair" not in request.fixturenames and "free_port" not in request.fixturenames:
        request.getfixturevalue("master")


def test_receive_comes_back_when_nothing_comes(join: Join) -> None:
    subscriber = Subscriber[str]("/silence", network=join("hearer"))
    started_s = time.monotonic()

    assert subscriber.receive(0.05) is None
    assert subscriber.pending() == []
    assert time.monotonic() - started_s >= 0.05


def test_closing_a_subscriber_ends_a_wait_in_another_thread(join: Join) -> None:
    subscriber = Subscriber[str]("/silence", network=join("hearer"))
    received: list[object] = ["nothing yet"]
    waiting = threading.Thread(target=lambda: received.append(subscriber.receive()))
    waiting.start()

    subscriber.close()
    waiting.join(5)

    assert received == ["nothing yet", None]


def test_callbacks_get_each_message_and_survive_their_own_errors(
    join: Join, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[int] = []
    done = threading.Event()

    def hear(message: dict[str, int]) -> None:
        if message["n"] == 1:
            raise ValueError("a mistake in the callback")
        heard.append(message["n"])
        if message["n"] == 3:
            done.set()

    Subscriber[dict[str, int]]("/n", network=join("hearer"), callback=hear)
    publisher = Publisher("/n", network=join("talker"))
    with caplog.at_level(logging.ERROR):
        for number in range(4):
            publisher.send({"n": number})
        assert done.wait(5)

    assert heard == [0, 2, 3]
    assert "the callback failed" in caplog.text


def test_a_wrong_message_is_skipped_and_its_key_is_named(
    join: Join, caplog: pytest.LogCaptureFixture
) -> None:
    subscriber = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=join("hearer"))
    publisher = Publisher(HUMAN_BEHAVIOR, network=join("talker"))
    with caplog.at_level(logging.WARNING):
        publisher.send({"certainty": 1.0})
        publisher.send({"human_state": 5})
        publisher.send("only text")
        publisher.send({"human_state": "happy", "unknown": "kept out"})
        message = subscriber.receive(5)

    assert message is not None
    assert message.human_state == "happy"
    assert "human_state" in caplog.text
    assert "is not JSON" in caplog.text


def test_a_slow_subscriber_keeps_the_newest_and_knows_how_many_it_lost(
    join: Join, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inbox, "BACKLOG", 10)
    subscriber = Subscriber[dict[str, int]]("/n", network=join("hearer"))
    publisher = Publisher("/n", network=join("talker"))
    publisher.send({"n": -1})
    assert subscriber.receive(5) == {"n": -1}
    taken_in = threading.Event()
    original = subscriber._inbox.tend

    for number in range(30):
        publisher.send({"n": number})
        while not taken_in.is_set() and not subscriber._inbox._backlog:
            original()
    while subscriber._inbox._backlog and subscriber._inbox._backlog[-1][-9:] != b'{"n": 29}'[-9:]:
        original()
        if b'"n":29' in subscriber._inbox._backlog[-1]:
            break

    received = [message["n"] for message in subscriber.pending()]
    assert received[-1] == 29
    assert len(received) + subscriber.lost == 30
    assert subscriber.lost > 0


def test_a_flood_arrives_whole_and_in_order(join: Join) -> None:
    subscriber = Subscriber[dict[str, int]]("/flood", network=join("hearer"))
    publisher = Publisher("/flood", network=join("talker"))

    for number in range(20_000):
        publisher.send({"n": number})

    for number in range(20_000):
        assert subscriber.receive(5) == {"n": number}
    assert subscriber.lost == 0


def test_the_header_tells_who_sent_a_message(join: Join) -> None:
    subscriber = Subscriber[str]("/x", network=join("hearer"))
    Publisher("/x", network=join("talker")).send("hello")

    subscriber.receive(5)

    assert subscriber.header is not None
    assert subscriber.header.node == "talker"


def test_two_publishers_of_a_topic_must_agree_on_the_encoding(join: Join) -> None:
    talker = join("talker")
    Publisher("/x", network=talker, encoding="msgpack")

    with pytest.raises(NetworkError, match="msgpack"):
        Publisher("/x", network=talker, encoding="json")
