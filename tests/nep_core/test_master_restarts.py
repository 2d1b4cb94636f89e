"""Masters that are killed and started again, and what tools see of the programs meanwhile."""

from __future__ import annotations

import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator

import pytest

from nep_core.networks.master import Master
from nep_core.networks.master_client import MasterFeed
from nep_core.networks.master_messages import ask_to_stop
from nep_core.networks.registry import Registration
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.master_process import TIMEOUT_S, MasterProcess, nodes_of, until

pytestmark = pytest.mark.long

Join = Callable[[str], PeerNetwork]

TALKER = """
import sys, time
from nep_core import PeerNetwork, Publisher
publisher = Publisher("/x", network=PeerNetwork("talker", master=sys.argv[1]))
print("there", flush=True)
for number in range(1, 10_000):
    publisher.send({"number": number})
    time.sleep(0.01)
"""


@pytest.fixture
def masters() -> Iterator[MasterProcess]:
    with MasterProcess() as process:
        yield process


@pytest.fixture
def talker(masters: MasterProcess) -> Iterator[subprocess.Popen[bytes]]:
    """A program of its own that counts on /x, a hundred numbers a second."""
    command = [sys.executable, "-c", TALKER, masters.endpoint]
    child = subprocess.Popen(command, stdout=subprocess.PIPE)
    assert child.stdout is not None
    child.stdout.readline()
    yield child
    child.kill()
    child.communicate()


def test_a_new_master_knows_all_programs_within_two_seconds_and_they_talk_meanwhile(
    masters: MasterProcess, talker: subprocess.Popen[bytes]
) -> None:
    names = {f"node-{i}" for i in range(10)}
    networks = [PeerNetwork(name, master=masters.endpoint) for name in names]
    try:
        for network in networks:
            network.join()
        subscriber = Subscriber[dict]("/x", network=networks[0])
        first = subscriber.receive(TIMEOUT_S)
        masters.kill()
        heard_without_master = [subscriber.receive(TIMEOUT_S) for _ in range(20)]
        masters.start()

        came_back = until(lambda: names | {"talker"} <= masters.nodes(), timeout_s=2.0)
        heard_after = [subscriber.receive(TIMEOUT_S) for _ in range(20)]
    finally:
        for network in networks:
            network.close()

    assert came_back
    numbers = [m["number"] for m in (first, *heard_without_master, *heard_after) if m]
    assert numbers == list(range(numbers[0], numbers[0] + 41))


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="only POSIX can freeze a program")
def test_who_comes_back_late_to_a_new_master_was_heard_all_the_time(
    masters: MasterProcess, talker: subprocess.Popen[bytes]
) -> None:
    with PeerNetwork("hearer", master=masters.endpoint) as network:
        subscriber = Subscriber[dict]("/x", network=network)
        subscriber.receive(TIMEOUT_S)
        talker.send_signal(signal.SIGSTOP)
        masters.kill()
        masters.start()
        assert until(lambda: "hearer" in masters.nodes())
        # Longer than a subscriber hears a publisher that has left.
        assert not until(lambda: "talker" in masters.nodes(), timeout_s=1.3)

        talker.send_signal(signal.SIGCONT)
        assert until(lambda: "talker" in masters.nodes())

        for _ in range(20):
            assert subscriber.receive(TIMEOUT_S) is not None
        assert subscriber.lost == 0


def test_programs_of_a_master_that_ended_meet_newcomers_at_the_next(master: Master) -> None:
    with (
        PeerNetwork("talker", master=master.endpoint) as talker,
        PeerNetwork("hearer", master=master.endpoint) as hearer,
    ):
        publisher = Publisher("/x", network=talker)
        subscriber = Subscriber[str]("/x", network=hearer)
        master.close()

        publisher.send("without a master")
        assert subscriber.receive(5) == "without a master"

        next_master = Master(master.endpoint)
        try:
            assert until(lambda: {"talker", "hearer"} <= nodes_of(next_master.endpoint))
            with PeerNetwork("newcomer", master=master.endpoint) as newcomer:
                late = Subscriber[str]("/x", network=newcomer)
                publisher.send("with the next one")
                assert late.receive(5) == "with the next one"
        finally:
            next_master.close()


def test_publishers_made_at_the_same_time_each_wait_for_their_subscribers(join: Join) -> None:
    talker, hearer = join("talker"), join("hearer")
    topics = [f"/x{i}" for i in range(8)]
    subscribers = [Subscriber[str](topic, network=hearer) for topic in topics]

    threads = [
        threading.Thread(target=lambda topic=topic: Publisher(topic, network=talker).send(topic))
        for topic in topics
    ]
    for thread in threads:
        thread.start()

    assert [subscriber.receive(TIMEOUT_S) for subscriber in subscribers] == topics
    for thread in threads:
        thread.join()


def test_what_comes_and_goes_one_by_one_is_listed_whole(master: Master, join: Join) -> None:
    network = join("node")
    publishers = [Publisher(f"/p{i}", network=network) for i in range(3)]
    subscribers = [Subscriber(f"/s{i}", network=network) for i in range(3)]
    publishers.append(Publisher("/p0", network=network))

    publishers[0].close()
    publishers[1].close()
    subscribers[1].close()

    with Followed(master.endpoint) as followed:
        assert followed.has(
            lambda told: (
                len(told) == 1
                and told[0].publishes == ["/p0", "/p2"]
                and sorted(told[0].subscribes.values()) == ["/s0", "/s2"]
            )
        )


def test_a_feed_tells_who_comes_changes_and_goes(master: Master, join: Join) -> None:
    with Followed(master.endpoint) as followed:
        assert followed.has(lambda told: told == [])

        network = join("node")
        network.join()
        assert followed.has(lambda told: [one.node for one in told] == ["node"])

        Publisher("/x", network=network)
        assert followed.has(lambda told: [one.publishes for one in told] == [["/x"]])

        network.close()
        assert followed.has(lambda told: told == [])


def test_a_feed_goes_on_with_the_next_master(masters: MasterProcess) -> None:
    with (
        PeerNetwork("node", master=masters.endpoint) as network,
        Followed(masters.endpoint) as followed,
    ):
        network.join()
        assert followed.has(lambda told: len(told) == 1)
        masters.kill()
        masters.start()

        Publisher("/x", network=network)

        assert followed.has(lambda told: [one.publishes for one in told] == [["/x"]])


def test_a_feed_says_that_no_master_answers_and_keeps_what_was_told(master: Master) -> None:
    with PeerNetwork("node", master=master.endpoint) as network:
        network.join()
        with Followed(master.endpoint) as followed:
            assert followed.has(lambda told: len(told) == 1)
            master.close()

            assert followed.has(lambda told: len(told) == 1 and not followed.feed.is_answered)


def test_a_program_is_asked_to_stop_by_its_name(master: Master, join: Join) -> None:
    network, asked = join("node"), threading.Event()
    network.on_stop = asked.set
    network.join()

    is_known = ask_to_stop(master.endpoint, "node")

    assert is_known
    assert asked.wait(TIMEOUT_S)


def test_stopping_a_node_that_is_not_there_is_told(master: Master, free_port: int) -> None:
    assert ask_to_stop(master.endpoint, "nobody") is False
    assert ask_to_stop(f"tcp://127.0.0.1:{free_port}", "node", timeout_s=0.1) is None


class Followed:
    """A feed, and all that it told."""

    def __init__(self, endpoint: str) -> None:
        self._told: queue.Queue[list[Registration]] = queue.Queue()
        self.feed = MasterFeed(endpoint, self._told.put)

    def has(self, wanted: Callable[[list[Registration]], bool]) -> bool:
        """Whether the feed tells, now or soon, what is wanted."""
        deadline = time.monotonic() + TIMEOUT_S
        while time.monotonic() < deadline:
            try:
                if wanted(self._told.get(timeout=TIMEOUT_S)):
                    return True
            except queue.Empty:
                return False
        return False

    def __enter__(self) -> Followed:
        return self

    def __exit__(self, *_error: object) -> None:
        self.feed.close()
