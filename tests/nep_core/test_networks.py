"""The networks: what cannot be joined is told, and nobody is lost or killed."""

from __future__ import annotations

import socket
from collections.abc import Callable
from contextlib import closing

import psutil
import pytest
import zmq

from nep_core.errors import MasterNotFound, NameTaken, NetworkError, PortTaken
from nep_core.networks.master import Master
from nep_core.networks.zmq_networks import DirectNetwork, PeerNetwork
from nep_core.wire.frames import subscription
from nep_core.wire.outbox import read_subscription
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.master_process import until

Join = Callable[[str], PeerNetwork]


def test_a_taken_port_is_told_in_a_sentence(free_port: int) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with DirectNetwork(endpoint) as first, DirectNetwork(endpoint) as second:
        Publisher("/x", network=first)

        with pytest.raises(PortTaken, match=str(free_port)):
            Publisher("/x", network=second)


@pytest.mark.parametrize("endpoint", ["", "127.0.0.1:7000", "tcp://127.0.0.1:99999", "tcp://a b:1"])
def test_what_is_no_endpoint_is_told(endpoint: str, free_port: int) -> None:
    with pytest.raises(NetworkError, match="not an endpoint"):
        DirectNetwork(endpoint)


def test_without_a_master_the_sentence_says_how_to_start_one(
    free_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.networks.master_client.ANSWER_S", 0.2)
    nobody = f"tcp://127.0.0.1:{free_port}"
    with PeerNetwork("lonely", master=nobody) as network, pytest.raises(MasterNotFound) as raised:
        Publisher("/x", network=network)

    assert any("nep master" in step for step in map(str, raised.value.checklist))


def test_a_second_node_of_the_same_name_is_refused_and_nobody_is_killed(join: Join) -> None:
    first, second = join("watch"), join("watch")
    first.join()

    with pytest.raises(NameTaken, match="watch"):
        second.join()

    Publisher("/x", network=first).send("the first goes on")


def test_what_the_master_cannot_use_is_told_with_its_own_sentence_and_at_once(join: Join) -> None:
    network = join("a\x1b[2Jb")

    with pytest.raises(NetworkError, match="without control characters") as raised:
        Publisher("/x", network=network)

    assert not isinstance(raised.value, MasterNotFound)
    Publisher("/x", network=join("another")).send("the others go on")


def has_ipv6() -> bool:
    try:
        with socket.create_server(("::1", 0), family=socket.AF_INET6):
            return True
    except OSError:
        return False


@pytest.mark.skipif(not has_ipv6(), reason="this computer has no IPv6")
def test_a_master_and_a_publisher_at_an_address_of_ipv6_are_reached(free_port: int) -> None:
    place = f"tcp://[::1]:{free_port}"
    with closing(Master("tcp://[::1]:*")) as master, DirectNetwork(place) as fixed:
        publisher = Publisher("/x", network=fixed)

        with PeerNetwork("watch", master=master.endpoint) as network:
            network.join()
        with DirectNetwork(place) as hearer:
            subscriber = Subscriber("/x", network=hearer)
            assert publisher.wait_for_subscribers(1, 2.0)
            publisher.send("hello")

            assert subscriber.receive(2.0) == "hello"


def test_the_private_subscription_is_sent_after_the_data_one(free_port: int) -> None:
    """ZeroMQ sends subscriptions in the order of their bytes, and the handshake rests on it."""
    with zmq.Context() as context, context.socket(zmq.XPUB) as publisher:
        publisher.linger = 0
        publisher.bind(f"tcp://127.0.0.1:{free_port}")
        with DirectNetwork(f"tcp://127.0.0.1:{free_port}") as hearer:
            Subscriber("/\U0010ffff", network=hearer)

            events = [publisher.recv(), publisher.recv()]

    assert events[0] == b"\x01" + subscription("/\U0010ffff")
    assert read_subscription(events[1]) is not None


def test_a_subscriber_of_a_closed_network_is_refused_and_nothing_hangs(join: Join) -> None:
    hearer = join("hearer")
    hearer.close()

    with pytest.raises(NetworkError, match="closed"):
        Subscriber("/x", network=hearer)


@pytest.mark.skipif(not hasattr(psutil.Process, "num_fds"), reason="Windows counts otherwise")
def test_subscribers_that_were_closed_take_no_files(join: Join) -> None:
    network, files = join("restless"), psutil.Process().num_fds
    before = files()

    for _ in range(20):
        Subscriber("/x", network=network).close()

    assert until(lambda: files() < before + 5)
