"""The master and its registry: names, leases, who is at each topic."""

from __future__ import annotations

import socket
import subprocess
import sys
from collections.abc import Callable

import pytest
import zmq
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import NameTaken, PortTaken
from nep_core.networks import master_messages as says
from nep_core.networks.master import CHECK_S, Master, Processes
from nep_core.networks.master_messages import ask_master
from nep_core.networks.registry import LEASE_S, Registration, Registry
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.master_process import (
    TIMEOUT_S,
    RawProgram,
    nodes_of,
    registration,
    until,
)

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

    registry.confirm("i2", b"b", now_s=LEASE_S)

    assert registry.expired(now_s=LEASE_S + 0.1) == ["i1"]
    assert registry.remove("i1") == {"/imu"}
    assert registry.publishers("/imu") == []


def test_a_master_that_was_held_up_does_not_count_it_as_silence_of_others() -> None:
    registry = Registry()
    registry.register(told("watch", "i1", "/imu"), b"a", now_s=0.0)

    registry.lengthen_leases(10.0)

    assert registry.expired(now_s=10.0 + LEASE_S) == []
    assert registry.expired(now_s=10.1 + LEASE_S) == ["i1"]


def test_a_program_that_missed_news_or_comes_by_another_way_has_to_register_again() -> None:
    registry = Registry()
    registry.register(told("watch", "i"), b"a", 0.0)

    assert registry.confirm("i", b"a", 0.1)
    assert not registry.confirm("i", b"another connection", 0.1)
    registry.entries["i"].has_missed = True
    assert not registry.confirm("i", b"a", 0.1)
    assert not registry.confirm("nobody", b"a", 0.1)


PROGRAMS = st.sampled_from("abc")
TOPICS = st.sampled_from(["/x", "/y", "/z"])
STEPS = st.tuples(
    PROGRAMS,
    st.sampled_from(["node 1", "node 2"]),
    st.lists(TOPICS, max_size=3),
    st.dictionaries(st.sampled_from("123"), TOPICS),
    st.booleans(),
)


@given(steps=st.lists(STEPS, max_size=12))
def test_what_the_registry_finds_is_what_its_entries_say(steps: list[tuple]) -> None:
    registry = Registry()
    for instance, node, publishes, subscribes, leaves in steps:
        registration = told(f"{node} {instance}", instance, *publishes)
        registration.subscribes = {f"{instance}{i}": topic for i, topic in subscribes.items()}
        changed = registry.remove(instance) if leaves else None
        if changed is None:
            registry.register(registration, instance.encode(), 0.0)

        entries = registry.entries.values()
        for topic in ("/x", "/y", "/z"):
            here = {e.registration.instance for e in entries if topic in e.registration.publishes}
            hear = {i for e in entries for i, t in e.registration.subscribes.items() if t == topic}
            assert {one.instance for one in registry.publishers(topic)} == here
            assert sorted(registry.subscribers(topic)) == sorted(hear)
            assert {e.address.decode() for e in registry.listeners(topic)} == {i[0] for i in hear}
        assert {registry.holder(e.registration.node) is e for e in entries} <= {True}


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

    assert any("another port" in step for step in map(str, raised.value.checklist))


def test_a_port_of_a_stranger_is_not_called_a_master() -> None:
    with zmq.Context() as context, context.socket(zmq.PULL) as stranger:
        stranger.linger = 0
        stranger.bind("tcp://127.0.0.1:*")
        endpoint = stranger.getsockopt_string(zmq.LAST_ENDPOINT)

        with pytest.raises(PortTaken, match="cannot be used"):
            Master(endpoint)


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


def test_a_program_whose_process_cannot_be_seen_stays_until_its_lease_runs_out(
    master: Master,
) -> None:
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    in_a_container = registration("arm", pid=child.pid, host=socket.gethostname())

    def taking_part() -> set[str]:
        return nodes_of(master.endpoint, TIMEOUT_S)

    with RawProgram(master.endpoint) as program:
        program.ask(says.Register(version=1, registration=in_a_container))

        # an answer that comes late is no sign that the program has gone
        assert not until(lambda: taking_part() != {"arm"}, timeout_s=2 * CHECK_S)


@pytest.mark.parametrize(("key", "is_ours"), [("this computer's", True), ("the laptop's", False)])
def test_only_processes_of_this_computer_are_looked_for_whatever_another_is_called(
    key: str, is_ours: bool
) -> None:
    processes = Processes("this computer's")
    child = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    told = registration("arm", pid=child.pid, host=socket.gethostname(), key=key)
    processes.register(told)

    child.communicate()

    assert processes.has_ended(told) == is_ours


def test_a_subscriber_forgets_a_publisher_that_left(join: Join) -> None:
    subscriber = Subscriber[str]("/x", network=join("hearer"))
    with PeerNetwork("first") as first:
        Publisher("/x", network=first).send("one")
        assert subscriber.receive(5) == "one"

    with PeerNetwork("second") as second:
        Publisher("/x", network=second).send("two")
        assert subscriber.receive(5) == "two"
    assert subscriber.lost == 0
