"""The master: names only, leases, restarts, and requests of any kind."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable

import pytest
import zmq
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from nep_core.errors import NameTaken, PortTaken
from nep_core.master import Master
from nep_core.master_probe import ask_master
from nep_core.p2p import PeerNetwork
from nep_core.pubsub import Publisher, Subscriber
from nep_core.registry import LEASE_S, Registration, Registry

Join = Callable[[str], PeerNetwork]


def told(node: str, instance: str, *topics: str) -> Registration:
    return Registration(
        instance=instance,
        node=node,
        pid=1,
        host="here",
        endpoint="tcp://127.0.0.1:1",
        publishes=list(topics),
    )


def test_a_lease_that_is_not_renewed_runs_out() -> None:
    registry = Registry()
    registry.register(told("watch", "i1", "/imu"), b"a", now_s=0.0)
    registry.register(told("robot", "i2", "/robot_state"), b"b", now_s=0.0)

    registry.confirm("i2", now_s=LEASE_S)

    assert registry.expired(now_s=LEASE_S + 0.1) == ["i1"]
    assert registry.remove("i1") == {"/imu"}
    assert registry.publishers("/imu") == []


def test_registering_tells_which_topics_changed() -> None:
    registry = Registry()

    assert registry.register(told("a", "i", "/x", "/y"), b"a", 0.0) == {"/x", "/y"}
    assert registry.register(told("a", "i", "/y", "/z"), b"a", 0.0) == {"/x", "/z"}


def test_a_name_belongs_to_one_program() -> None:
    registry = Registry()
    registry.register(told("watch", "first"), b"a", 0.0)

    with pytest.raises(NameTaken, match='"watch" is already running'):
        registry.register(told("watch", "second"), b"b", 0.0)


def test_two_masters_on_one_port_is_told_in_a_sentence(master: Master) -> None:
    with pytest.raises(PortTaken, match="Another NEP master is already running") as raised:
        Master(master.endpoint)

    assert any("another port" in step for step in raised.value.checklist)


def test_a_port_of_a_stranger_is_not_called_a_master() -> None:
    with zmq.Context() as context, context.socket(zmq.PULL) as stranger:
        stranger.linger = 0
        stranger.bind("tcp://127.0.0.1:*")
        endpoint = stranger.getsockopt_string(zmq.LAST_ENDPOINT)

        with pytest.raises(PortTaken, match="cannot be used"):
            Master(endpoint)


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(request=st.lists(st.binary(max_size=200), min_size=1, max_size=3))
def test_any_request_gets_an_answer_and_the_master_goes_on(
    master: Master, request: list[bytes]
) -> None:
    with zmq.Context() as context, context.socket(zmq.DEALER) as stranger:
        stranger.linger = 0
        stranger.connect(master.endpoint)
        stranger.send_multipart(request)

        assert stranger.poll(2000)
        assert b'"error"' in stranger.recv()
    assert ask_master(master.endpoint) is not None


@pytest.mark.parametrize(
    "request_",
    [
        b"",
        b"null",
        b'{"do":"register"}',
        b'{"do":"register","version":1,"registration":{"node":5}}',
        b'{"do":"register","version":1,"registration":{"instance":"i","node":"n","pid":-1,'
        b'"host":"h","endpoint":"e"}}',
        b"[" * 5000,
        b'{"node":"a","topic":"/t1","mode":"many2many"}',
    ],
)
def test_a_wrong_request_is_answered_with_its_mistake(master: Master, request_: bytes) -> None:
    with zmq.Context() as context, context.socket(zmq.DEALER) as stranger:
        stranger.linger = 0
        stranger.connect(master.endpoint)
        stranger.send(request_)

        assert stranger.poll(2000)
        assert b"cannot be read" in stranger.recv()


def test_programs_go_on_without_the_master_and_register_again_with_the_next(
    master: Master,
) -> None:
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
            wait_for_nodes(next_master.endpoint, {"talker", "hearer"})
            with PeerNetwork("newcomer", master=master.endpoint) as newcomer:
                late = Subscriber[str]("/x", network=newcomer)
                publisher.send("with the next one")
                assert late.receive(5) == "with the next one"
        finally:
            next_master.close()


def test_a_killed_program_frees_its_name_at_once(master: Master, join: Join) -> None:
    code = "from nep_core import Publisher, PeerNetwork; import time\n"
    code += "Publisher('/x', network=PeerNetwork('watch')); print('there', flush=True)\n"
    code += "time.sleep(60)"
    child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert child.stdout is not None
    child.stdout.readline()
    child.kill()
    child.communicate()

    join("watch").join()

    listing = ask_master(master.endpoint)
    assert listing is not None
    assert [r.node for r in listing.registrations] == ["watch"]


def test_a_subscriber_forgets_a_publisher_that_left(join: Join) -> None:
    subscriber = Subscriber[str]("/x", network=join("hearer"))
    with PeerNetwork("first") as first:
        Publisher("/x", network=first).send("one")
        assert subscriber.receive(5) == "one"

    with PeerNetwork("second") as second:
        Publisher("/x", network=second).send("two")
        assert subscriber.receive(5) == "two"
    assert subscriber.lost == 0


def wait_for_nodes(endpoint: str, names: set[str], timeout_s: float = 5.0) -> None:
    deadline = time.monotonic() + timeout_s
    while time.monotonic() < deadline:
        listing = ask_master(endpoint, timeout_s=0.2)
        if listing and names <= {r.node for r in listing.registrations}:
            return
    raise AssertionError(f"{names} did not register")
