"""Publisher and Subscriber do the same over every transport."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from nep_core.errors import MasterNotFound, NetworkError
from nep_core.recordings.raw import RawSubscriber
from nep_core.wire import inbox
from nep_core.wire.messages import HUMAN_BEHAVIOR, HumanBehavior
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.worlds import EVERY, NAMED, World, a_world

only_named = pytest.mark.parametrize("world", NAMED, indirect=True)


@pytest.fixture(params=EVERY)
def world(request: pytest.FixtureRequest, free_port: int) -> Iterator[World]:
    with a_world(request.param, free_port) as world:
        yield world


def connect(world: World, topic: str, **settings: Any) -> tuple[Publisher, Subscriber[Any]]:
    """A publisher and a subscriber that hears it."""
    subscriber = Subscriber[Any](topic, network=world.join("hearer"))
    publisher = Publisher(topic, network=world.join("talker"), wait_for_subscribers=1, **settings)
    return publisher, subscriber


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 5
    while not condition():
        assert time.monotonic() < deadline
        threading.Event().wait(0.005)


def test_every_kind_of_message_arrives_as_it_was(world: World) -> None:
    publisher, subscriber = connect(world, "/x")
    messages = [{"a": [1, None, "ü"]}, ["list"], "text \0 with nul", "", b"\0bytes\xff", b""]

    for message in messages:
        publisher.send(message)
    publisher.send(HumanBehavior(human_state="hi", time=1.0))

    assert [subscriber.receive(5) for _ in messages] == messages
    assert subscriber.receive(5) == {"human_state": "hi", "time": 1.0}


def test_msgpack_arrives_as_it_was(world: World) -> None:
    publisher, subscriber = connect(world, "/x", encoding="msgpack")

    publisher.send({"raw": b"\0\1", "n": 1})

    assert subscriber.receive(5) == {"raw": b"\0\1", "n": 1}


def test_structs_are_read_into_their_kind(world: World) -> None:
    subscriber = Subscriber(HUMAN_BEHAVIOR, HumanBehavior, network=world.join("hearer"))
    publisher = Publisher(HUMAN_BEHAVIOR, network=world.join("talker"), wait_for_subscribers=1)

    publisher.send(HumanBehavior(human_state="happy"))

    message = subscriber.receive(5)
    assert message is not None
    assert message.human_state == "happy"


def test_messages_arrive_in_order_and_none_is_lost(world: World) -> None:
    publisher, subscriber = connect(world, "/count")

    for number in range(3000):
        publisher.send({"n": number})

    assert [subscriber.receive(5) for _ in range(3000)] == [{"n": n} for n in range(3000)]
    assert subscriber.lost == 0


def test_a_topic_gets_no_messages_of_longer_ones(world: World) -> None:
    publisher, subscriber = connect(world, "/gesture")
    for longer in ("/gesture_debug", "/gesture/left", "/gesture/"):
        Publisher(longer, network=publisher.network).send("not for you")

    publisher.send("for you")

    assert subscriber.receive(5) == "for you"


ODD_TOPICS = (
    "/ü/雪",
    "no slash",
    "//",
    "/a/",
    " ",
    "/a*b?c#d$e",
    "/%2A",
    "**",
    "/" + "x" * 300,
)


def test_odd_topics_are_topics_like_others(world: World) -> None:
    talker, hearer = world.join("talker"), world.join("hearer")
    subscribers = {topic: Subscriber[Any](topic, network=hearer) for topic in ODD_TOPICS}
    publishers = [Publisher(t, network=talker, wait_for_subscribers=1) for t in ODD_TOPICS]

    for publisher in publishers:
        publisher.send(publisher.topic)

    for topic, subscriber in subscribers.items():
        assert subscriber.receive(5) == topic
        assert subscriber.pending() == []


@pytest.mark.parametrize(
    "topic", ["/x\n", "/a\x1b[2J", "/a\0b", "/a\x85", "/a\u2028b", "", "\ud800"]
)
def test_what_a_terminal_would_obey_is_no_topic_anywhere(world: World, topic: str) -> None:
    network = world.join("talker")

    for at_this_end in (Publisher, Subscriber[Any], RawSubscriber):
        with pytest.raises(NetworkError, match=r"cannot be a topic.*no control") as refused:
            at_this_end(topic, network=network)
        assert not isinstance(refused.value, MasterNotFound)

    publisher, subscriber = connect(world, "/good")  # a refusal spoils nothing of what comes after
    publisher.send("still here")
    assert subscriber.receive(5) == "still here"


@only_named
def test_no_first_message_is_lost_whoever_comes_first(world: World) -> None:
    for trial in range(12):
        with world.join(f"a{trial}") as talker, world.join(f"b{trial}") as hearer:
            if trial % 2:
                subscriber = Subscriber[Any]("/x", network=hearer)
                publisher = Publisher("/x", network=talker)
            else:
                publisher = Publisher("/x", network=talker)
                subscriber = Subscriber[Any]("/x", network=hearer)

            publisher.send([trial])

            assert subscriber.receive(5) == [trial]


@only_named
def test_all_hear_all_with_several_at_both_ends(world: World) -> None:
    subscribers = [Subscriber[Any]("/x", network=world.join(f"hearer{n}")) for n in range(3)]
    subscribers.append(Subscriber[Any]("/x", network=subscribers[0].network))
    publishers = [Publisher("/x", network=world.join(f"talker{n}")) for n in range(2)]
    publishers.append(Publisher("/x", network=subscribers[0].network))

    for number, publisher in enumerate(publishers):
        publisher.send([number])

    for subscriber in subscribers:
        assert sorted(subscriber.receive(5)[0] for _ in publishers) == [0, 1, 2]


def test_a_late_joiner_gets_the_last_latched_message_before_newer_ones(world: World) -> None:
    publisher = Publisher("/state", network=world.join("talker"), latched=True)
    publisher.send({"n": 1})
    publisher.send({"n": 2})
    publisher.send({"n": 3}, latch=False)

    subscriber = Subscriber[Any]("/state", network=world.join("hearer"))
    assert publisher.wait_for_subscribers(1, 5)
    publisher.send({"n": 4})

    assert [subscriber.receive(5), subscriber.receive(5)] == [{"n": 2}, {"n": 4}]
    assert subscriber.lost == 0


def test_of_states_only_the_newest_is_kept_and_none_counts_as_lost(world: World) -> None:
    hearer = world.join("hearer")
    subscriber = Subscriber[Any]("/state", network=hearer, policy="state")
    last = Subscriber[Any]("/last", network=hearer)
    talker = world.join("talker")
    publisher = Publisher("/state", network=talker, wait_for_subscribers=1)

    for number in range(100):
        publisher.send({"n": number})
    Publisher("/last", network=talker, wait_for_subscribers=1).send("now")
    assert last.receive(5) == "now"

    until(lambda: subscriber.receive(5) == {"n": 99})
    assert subscriber.pending() == []
    assert subscriber.lost == 0


def test_who_cannot_keep_up_keeps_the_newest_and_knows_how_many_it_lost(
    world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inbox, "FRAMES", 10)
    publisher, subscriber = connect(world, "/n")

    for number in range(30):
        publisher.send(str(number))
    until(lambda: subscriber.lost == 20)

    assert subscriber.pending() == [str(number) for number in range(20, 30)]


def test_callbacks_get_each_message(world: World) -> None:
    heard: list[Any] = []
    done = threading.Event()

    def hear(message: dict[str, int]) -> None:
        heard.append(message["n"])
        if len(heard) == 3:
            done.set()

    Subscriber[Any]("/n", network=world.join("hearer"), callback=hear)
    publisher = Publisher("/n", network=world.join("talker"), wait_for_subscribers=1)
    for number in range(3):
        publisher.send({"n": number})

    assert done.wait(5)
    assert heard == [0, 1, 2]


def test_waiting_ends_in_time_and_when_the_subscriber_is_closed(world: World) -> None:
    subscriber = Subscriber[Any]("/silence", network=world.join("hearer"))
    assert subscriber.receive(0.01) is None
    received: list[Any] = []
    waiting = threading.Thread(target=lambda: received.append(subscriber.receive()))
    waiting.start()

    subscriber.close()
    waiting.join(5)

    assert received == [None]


def test_interrupting_a_network_ends_its_waits(world: World) -> None:
    hearer = world.join("hearer")
    subscriber = Subscriber[Any]("/silence", network=hearer)
    threading.Timer(0.02, hearer.interrupt).start()

    assert subscriber.receive() is None


def test_a_publisher_knows_who_hears_it(world: World) -> None:
    publisher = Publisher("/x", network=world.join("talker"))
    assert not publisher.wait_for_subscribers(1, 0.01)

    subscriber = Subscriber[Any]("/x", network=world.join("hearer"))
    assert publisher.wait_for_subscribers(1, 5)
    assert subscriber.wait_for_publishers(1, 5)
    subscriber.close()

    until(lambda: publisher.subscribers() == 0)


def test_after_a_restart_a_publisher_is_heard_again_and_nothing_counts_as_lost(
    world: World,
) -> None:
    subscriber = Subscriber[Any]("/x", network=world.join("hearer"))
    for life in range(2):
        with world.join("talker") as talker:
            publisher = Publisher("/x", network=talker, wait_for_subscribers=1)
            for number in range(5):
                publisher.send([life, number])

            assert [subscriber.receive(5) for _ in range(5)] == [[life, n] for n in range(5)]
    assert subscriber.lost == 0


def test_what_was_sent_before_leaving_arrives(world: World) -> None:
    subscriber = Subscriber[Any]("/x", network=world.join("hearer"))
    with world.join("talker") as talker:
        publisher = Publisher("/x", network=talker, wait_for_subscribers=1)
        for number in range(500):
            publisher.send([number])

    assert [subscriber.receive(5) for _ in range(500)] == [[n] for n in range(500)]


def test_large_messages_arrive_whole(world: World) -> None:
    publisher, subscriber = connect(world, "/image")
    image = bytes(range(256)) * 4096

    for _ in range(20):
        publisher.send(image)

    for _ in range(20):
        assert subscriber.receive(5) == image
    assert subscriber.lost == 0


def test_a_closed_network_says_so_to_whoever_uses_it(world: World) -> None:
    network = world.join("gone")
    publisher = Publisher("/x", network=network)
    network.close()

    for use in (
        lambda: Subscriber[Any]("/x", network=network),
        lambda: Publisher("/y", network=network).send("late"),
        lambda: publisher.send("late"),
    ):
        with pytest.raises(NetworkError, match="closed"):
            use()
