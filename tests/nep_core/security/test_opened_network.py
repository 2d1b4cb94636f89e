"""An opened network: who has its keys talks, all others are refused, which everybody sees."""

import select
import socket
import time
from contextlib import closing

import msgspec
import pytest
import zmq

from nep_core.errors import NetworkError, NotLetIn, PortTaken
from nep_core.networks import master_client
from nep_core.networks import master_messages as says
from nep_core.networks.master import Master
from nep_core.networks.master_client import MasterFeed
from nep_core.networks.master_messages import MasterProbe, ask_master
from nep_core.networks.security.curve import Refusals
from nep_core.networks.security.keys import KeyFile
from nep_core.networks.zmq_networks import Broker, BrokerNetwork, DirectNetwork, PeerNetwork
from nep_core.processes.node import Node
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.security.conftest import Opened, wait_until

REFUSED = "showed no key of this network and was refused."


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(master_client, "ANSWER_S", 0.3)


def test_programs_of_two_computers_that_were_let_in_talk(opened: Opened) -> None:
    heard = Subscriber("/imu", network=opened.join("ears", opened.file.path))
    publisher = Publisher("/imu", network=opened.join("watch", opened.guest("laptop")))

    publisher.send({"x": 1})

    assert heard.receive(5.0) == {"x": 1}
    assert opened.master.take_warning() is None


def test_a_computer_that_is_let_in_later_talks_with_programs_that_run(opened: Opened) -> None:
    first = opened.join("first", opened.guest("laptop"))  # its key file knows the owner only
    heard = Subscriber("/imu", network=first)
    late = opened.join("late", opened.guest("tablet"))

    Publisher("/imu", network=late).send({"x": 2})
    Publisher("/answer", network=first)
    answers = Subscriber("/answer", network=late)

    assert heard.receive(5.0) == {"x": 2}
    assert answers.wait_for_publishers(1, 5.0)
    assert first.take_warning() is late.take_warning() is None


def test_the_tools_see_an_opened_network_with_its_keys_only(opened: Opened) -> None:
    opened.join("watch", opened.file.path).join()

    with MasterFeed(opened.master.endpoint, lambda told: None) as feed:
        assert wait_until(lambda: [told.node for told in feed.registrations] == ["watch"])
    listing = ask_master(opened.master.endpoint)
    opened.use(None)

    assert listing is not None
    assert listing.registrations[0].key == opened.file.keys.public
    assert ask_master(opened.master.endpoint, timeout_s=0.3) is None


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("who", ["plain", "stranger"])
def test_a_program_without_a_key_of_the_network_is_refused_and_the_master_tells(
    opened: Opened, who: str
) -> None:
    network = opened.join("spy", opened.guest("stranger", let_in=False) if who != "plain" else None)
    reason = "only to programs that have its keys" if who == "plain" else "does not take the keys"

    with pytest.raises(NotLetIn, match=reason) as error:
        network.join()

    assert any("nep pair" in step or "Pair it" in step for step in map(str, error.value.checklist))
    assert wait_until(lambda: _is_about_refusal(opened.master.take_warning()))
    assert ask_names(opened) == []


def test_a_program_that_was_killed_while_it_came_is_no_stranger(opened: Opened) -> None:
    with socket.create_connection(
        ("127.0.0.1", int(opened.master.endpoint.rpartition(":")[2]))
    ) as killed:
        wait_until(lambda: select.select([killed], [], [], 0)[0])  # and nobody reads it

    assert not wait_until(opened.master.take_warning, seconds=0.3)


def test_a_node_warns_when_a_program_without_keys_wants_to_hear_it(opened: Opened) -> None:
    seen = Subscriber(NODE_STATE, NodeState, network=opened.join("eyes", opened.file.path))
    node = Node("arm", "action", network=opened.join("arm", opened.file.path))
    context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
    spy = context.socket(zmq.SUB)
    spy.subscribe(b"")

    told = ask_master(opened.master.endpoint)
    assert told is not None
    spy.connect(next(one.endpoint for one in told.registrations if one.node == "arm"))
    warnings = [state for state in _states_for(seen, 4.0) if state.event == "warning"]
    context.destroy(linger=0)
    node.close()

    assert warnings
    assert warnings[0].node == "arm"
    assert _is_about_refusal(warnings[0].description)


def test_a_computer_that_is_forgotten_cannot_come_back(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    laptop = opened.guest("laptop")
    network = opened.join("watch", laptop)
    network.join()
    monkeypatch.setattr(master_client, "ANSWER_S", 0.3)

    opened.file.forget("laptop")

    assert wait_until(lambda: ask_names(opened) == [])
    with pytest.raises(NotLetIn):
        opened.join("watch2", laptop).join()


def test_a_computer_that_is_forgotten_is_not_heard_over_old_connections_either(
    opened: Opened,
) -> None:
    opened.use(opened.guest("laptop"))
    with closing(MasterProbe(opened.master.endpoint)) as probe:
        assert probe.ask(says.List(), says.Listing) is not None

        opened.file.forget("laptop")

        assert probe.ask(says.List(), says.Listing, timeout_s=0.3) is None


@pytest.mark.usefixtures("impatient")
def test_a_program_with_keys_does_not_join_a_plain_master_but_says_so(opened: Opened) -> None:
    opened.use(None)
    plain = Master("tcp://127.0.0.1:*")
    opened.use(opened.file.path)

    with (
        PeerNetwork("careful", master=plain.endpoint) as network,
        pytest.raises(NotLetIn, match="has no keys, but this program was started with"),
    ):
        network.join()
    plain.close()


def test_direct_networks_use_the_keys_too(opened: Opened, free_port: int) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with DirectNetwork(endpoint, node="watch") as watch, DirectNetwork(endpoint) as ears:
        publisher = Publisher("/imu", network=watch)
        heard = Subscriber("/imu", network=ears)
        publisher.wait_for_subscribers(1, 5.0)
        publisher.send({"x": 3})
        assert heard.receive(5.0) == {"x": 3}

        opened.use(None)
        with DirectNetwork(endpoint) as spy:
            unheard = Subscriber("/imu", network=spy)
            assert wait_until(lambda: _is_about_refusal(watch.take_warning()))
            publisher.send({"x": 4})
            assert unheard.receive(0) is None


def test_a_program_with_keys_says_when_it_meets_one_without(opened: Opened, free_port: int) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    opened.use(None)
    with DirectNetwork(endpoint, node="plain") as plain:
        Publisher("/imu", network=plain)
        opened.use(opened.file.path)
        with DirectNetwork(endpoint) as careful:
            Subscriber("/imu", network=careful)
            told = wait_until(lambda: f"at {endpoint} does not have" in str(careful.take_warning()))

    assert told


def test_the_same_refusal_is_told_once_in_a_while_and_many_places_in_one_sentence() -> None:
    refusals = Refusals("my.keys")
    for number in range(200):
        refusals.refuse(f"198.51.100.{number}")

    told = refusals.take()
    refusals.refuse("198.51.100.7")
    other = refusals.take()
    refusals.refuse("198.51.100.7")

    assert str(told).startswith(
        "A program at 198.51.100.0, 198.51.100.1, 198.51.100.10 and 17 more showed"
    )
    assert "at 198.51.100.7 showed" in str(other)
    assert refusals.take() is None


def test_a_broker_uses_the_keys_too(opened: Opened, free_port: int) -> None:
    broker = Broker(f"tcp://127.0.0.1:{free_port}")
    with BrokerNetwork(broker.endpoint, node="a") as one, BrokerNetwork(broker.endpoint) as two:
        heard = Subscriber("/imu", network=one)
        Publisher("/imu", network=two).send({"x": 5})

        assert heard.receive(5.0) == {"x": 5}
    broker.close()


@pytest.mark.parametrize(
    "endpoint", ["tcp://0.0.0.0:7999", "tcp://198.51.100.1:7999", "tcp://[::]:7"]
)
def test_without_keys_nothing_that_other_computers_reach_is_bound(endpoint: str) -> None:
    with pytest.raises(NetworkError, match="this network has no keys") as error:
        Master(endpoint)
    with DirectNetwork(endpoint) as network, pytest.raises(NetworkError, match="has no keys"):
        Publisher("/imu", network=network)
    with pytest.raises(NetworkError, match="has no keys"):
        Broker(endpoint)

    assert any("nep open" in step for step in map(str, error.value.checklist))


def test_an_address_that_is_not_this_computers_is_told(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NEP_HOST", "198.51.100.1")

    with pytest.raises(PortTaken, match=r"198\.51\.100\.1"):
        PeerNetwork("lost", master=opened.master.endpoint)


def ask_names(opened: Opened) -> list[str]:
    opened.use(opened.file.path)
    listing = ask_master(opened.master.endpoint)
    assert listing is not None
    return [told.node for told in listing.registrations]


def _is_about_refusal(warning: object) -> bool:
    return REFUSED in str(warning)


def _states_for(seen: Subscriber[NodeState], seconds: float) -> list[NodeState]:
    states: list[NodeState] = []
    until_s = time.monotonic() + seconds
    while time.monotonic() < until_s and not any(one.event == "warning" for one in states):
        if (state := seen.receive(0.2)) is not None:
            states.append(state)
    return states


def test_the_key_files_master_is_where_programs_look(
    opened: Opened, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("NEP_MASTER")
    path = opened.guest("laptop")
    master = opened.master.endpoint
    KeyFile(path).change(lambda keys: msgspec.structs.replace(keys, master=master))
    opened.use(path)

    with PeerNetwork("watch") as network:
        network.join()

    assert network.master == opened.master.endpoint
