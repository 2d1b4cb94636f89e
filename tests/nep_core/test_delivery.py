"""What is promised of messages: none is lost after the handshake, and every loss is known."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack

import psutil
import pytest
import zmq

from nep_core.errors import NetworkError
from nep_core.networks.network import Network
from nep_core.networks.zmq_networks import Broker, BrokerNetwork, DirectNetwork, PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber

pytestmark = pytest.mark.long

Join = Callable[[str], PeerNetwork]
Numbered = dict[str, int]

MOST_WAITING_BYTES = 64_000_000
ALLOWANCE_BYTES = 30_000_000
"""What the allocator and ZeroMQ need beside the messages themselves."""

HEARER = """
import sys
from nep_core.networks.zmq_networks import BrokerNetwork
from nep_core.wire.pubsub import Subscriber
from nep_core.networks.zmq_networks import DirectNetwork

kind, endpoint = sys.argv[1:]
network = BrokerNetwork(endpoint) if kind == "broker" else DirectNetwork(endpoint)
subscriber = Subscriber("/flood", network=network)
received = 0
while True:
    while subscriber.receive(0.1) is not None:
        received += 1
    print(received, subscriber.lost, flush=True)
"""


@pytest.fixture
def talker(request: pytest.FixtureRequest, free_port: int) -> Iterator[tuple[Network, str]]:
    """A publisher's network of the kind that is asked for, and its endpoint."""
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with ExitStack() as stack:
        if request.param == "broker":
            broker = Broker(endpoint)
            stack.callback(broker.close)
            yield stack.enter_context(BrokerNetwork(endpoint)), endpoint
        else:
            yield stack.enter_context(DirectNetwork(endpoint)), endpoint


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="no program can be frozen here")
@pytest.mark.parametrize("talker", ["direct", "broker"], indirect=True)
def test_a_frozen_subscriber_costs_bounded_memory_and_its_neighbour_nothing_and_knows_its_loss(
    talker: tuple[Network, str],
) -> None:
    network, endpoint = talker
    kind = "broker" if isinstance(network, BrokerNetwork) else "direct"
    neighbour_network = (
        BrokerNetwork(endpoint, node="neighbour") if kind == "broker" else DirectNetwork(endpoint)
    )
    neighbour = Subscriber[object]("/flood", network=neighbour_network)
    publisher = Publisher("/flood", network=network)
    hearer = subprocess.Popen(
        [sys.executable, "-c", HEARER, kind, endpoint], stdout=subprocess.PIPE, text=True
    )
    try:
        assert publisher.wait_for_subscribers(2, 20)
        hearer.send_signal(signal.SIGSTOP)
        before_bytes = psutil.Process().memory_info().rss
        message, count = {"text": "x" * 1000}, 100_000
        for _ in range(count // 1000):
            for _ in range(1000):
                publisher.send(message)
            assert all(neighbour.receive(10) for _ in range(1000))
        grown_bytes = psutil.Process().memory_info().rss - before_bytes
        hearer.send_signal(signal.SIGCONT)

        assert hearer.stdout is not None
        received = lost = 0
        deadline_s = time.monotonic() + 20
        while received + lost < count and time.monotonic() < deadline_s:
            received, lost = (int(word) for word in hearer.stdout.readline().split())
    finally:
        hearer.kill()
        hearer.communicate()
        neighbour_network.close()

    assert grown_bytes < MOST_WAITING_BYTES + ALLOWANCE_BYTES
    assert lost > 0
    assert received + lost == count
    assert neighbour.lost == 0


def test_who_joins_in_a_flood_misses_nothing_from_then_on(master: object, join: Join) -> None:
    publisher = Publisher("/flood", network=join("talker"))
    stop = threading.Event()

    def flood() -> None:
        number = 0
        while not stop.wait(0.0001 if number % 50 == 0 else 0):
            publisher.send({"n": number})
            number += 1

    flooding = threading.Thread(target=flood)
    flooding.start()
    try:
        for trial in range(5):
            with PeerNetwork(f"hearer-{trial}") as hearer:
                subscriber = Subscriber[Numbered]("/flood", network=hearer)
                heard = [message["n"] for _ in range(500) if (message := subscriber.receive(5))]

                assert heard == list(range(heard[0], heard[0] + 500))
                assert subscriber.lost == 0
    finally:
        stop.set()
        flooding.join()


def test_who_joins_a_fast_latched_topic_hears_no_message_twice(master: object, join: Join) -> None:
    publisher = Publisher("/state", network=join("talker"), latched=True)
    stop = threading.Event()

    def talk() -> None:
        number = 0
        while not stop.wait(0.0002):
            publisher.send({"n": number})
            number += 1

    talking = threading.Thread(target=talk)
    talking.start()
    try:
        hearer = join("hearer")
        for _ in range(20):
            subscriber = Subscriber[Numbered]("/state", network=hearer)
            heard = [message["n"] for _ in range(20) if (message := subscriber.receive(5))]
            subscriber.close()

            assert heard == list(range(heard[0], heard[0] + 20))
            assert subscriber.lost == 0
    finally:
        stop.set()
        talking.join()


def test_the_first_message_of_a_publisher_that_starts_again_arrives(
    master: object, join: Join
) -> None:
    subscriber = Subscriber[Numbered]("/x", network=join("hearer"))
    for start in range(10):
        with PeerNetwork("talker") as talker:
            publisher = Publisher("/x", network=talker)
            for number in range(3):
                publisher.send({"n": 10 * start + number})

            heard = [subscriber.receive(5) for _ in range(3)]

        assert heard == [{"n": 10 * start + number} for number in range(3)]
    assert subscriber.lost == 0


def test_a_state_is_read_fresh_and_an_old_one_is_not_lost(free_port: int) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with DirectNetwork(endpoint) as talker, DirectNetwork(endpoint) as hearer:
        states = Subscriber[Numbered]("/state", network=hearer, policy="state")
        events = Subscriber[Numbered]("/state", network=hearer)
        publisher = Publisher("/state", network=talker, wait_for_subscribers=2)

        for number in range(1000):
            publisher.send({"n": number})
        while events.receive(5) != {"n": 999}:
            pass
        deadline_s = time.monotonic() + 5
        while (state := states.receive(0)) != {"n": 999}:
            assert time.monotonic() < deadline_s, state

        assert states.receive(0) is None
        assert states.lost == 0


def test_a_peer_that_sends_rubbish_ends_no_subscriber(free_port: int) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with (
        DirectNetwork(endpoint, binds="subscriber") as hearer,
        zmq.Context() as context,
        context.socket(zmq.XPUB) as peer,
    ):
        subscriber = Subscriber[str]("/x", network=hearer)
        peer.linger = 0
        peer.rcvtimeo = 10_000
        peer.connect(endpoint)
        private = [peer.recv(), peer.recv()][-1][1:]

        for parts in (
            [b"/x\0", b""],
            [b"/x\0", b"\xff", b"\xffs", private],
            [private],
            [private + b"\0\0"],
            [private + b"abc\0" + b"\0" * 9],
            [b"/x\0\0"],
            [b"/x\0[]\0{}"],
            [b'/x\0["n",1,2,"json","12345678"]\0{'],
            [b'/x\0["n",2,2,"text","12345678"]\0the end'],
        ):
            peer.send_multipart(parts)

        received: list[str] = []
        while "the end" not in received:
            message = subscriber.receive(5)
            assert message is not None
            received.append(message)


def test_waiting_for_publishers_ends_in_time_though_a_callback_is_listening(
    master: object, join: Join
) -> None:
    subscriber = Subscriber[Numbered]("/x", network=join("hearer"), callback=lambda _: None)

    assert not subscriber.wait_for_publishers(1, 0.1)
    Publisher("/x", network=join("talker"))
    assert subscriber.wait_for_publishers(1, 5)


def test_a_callback_may_close_its_subscriber_and_hears_no_more(master: object, join: Join) -> None:
    heard: list[int] = []
    closed = threading.Event()

    def hear(message: Numbered) -> None:
        heard.append(message["n"])
        subscriber.close()
        closed.set()

    subscriber = Subscriber[Numbered]("/x", network=join("hearer"), callback=hear)
    publisher = Publisher("/x", network=join("talker"))

    for number in range(100):
        publisher.send({"n": number})

    assert closed.wait(5)
    assert publisher.wait_for_subscribers(0, 5)
    assert heard == [0]


def test_an_interrupt_ends_receiving_though_messages_wait(master: object, join: Join) -> None:
    hearer = join("hearer")
    subscriber = Subscriber[Numbered]("/x", network=hearer)
    publisher = Publisher("/x", network=join("talker"))
    publisher.send({"n": 1})
    publisher.send({"n": 2})
    subscriber.receive(5)

    hearer.interrupt()

    assert subscriber.receive() is None


def test_whoever_sends_after_the_end_is_told(free_port: int) -> None:
    network = DirectNetwork(f"tcp://127.0.0.1:{free_port}")
    publisher = Publisher("/x", network=network)
    network.close()

    with pytest.raises(NetworkError, match="is closed"):
        publisher.send({"n": 1})
