"""Publisher and Subscriber over real sockets; test_every_transport.py has what all carry."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable

import pytest

from nep_core.errors import NetworkError
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.messages import HUMAN_BEHAVIOR, HumanBehavior
from nep_core.wire.pubsub import Publisher, Subscriber

Join = Callable[[str], PeerNetwork]


@pytest.fixture(autouse=True)
def _a_master(master: Master) -> None:
    """For all that join."""


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
