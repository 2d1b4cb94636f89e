"""Connections that are slow, cut or given up by the master: nothing is lost uncounted."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable

import pytest
import zmq

from nep_core.cli import look
from nep_core.cli.look import states_of
from nep_core.networks.master_messages import ask_master
from nep_core.networks.zmq_networks import DirectNetwork, PeerNetwork
from nep_core.wire import inbox
from nep_core.wire.frames import Header, read_header
from nep_core.wire.inbox import Inbox
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.outbox import private_subscription
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.master_process import until

Join = Callable[[str], PeerNetwork]


def test_the_state_of_a_node_is_its_newest_whichever_comes_last(master: object, join: Join) -> None:
    """A launcher's word about a crash is latched, and may come after what the node says now."""
    for number in range(4):
        ways = [join(f"launcher{number}"), join(f"node{number}")]
        states = [("crashed", 100.0), ("ready", 200.0)]
        order = list(zip(ways, states, strict=True))
        for network, (event, time_s) in order if number % 2 else order[::-1]:
            told = NodeState(node=f"x{number}", type="sensory", event=event, time=time_s)  # type: ignore[arg-type]
            Publisher(NODE_STATE, network=network).send(told)

    found = states_of(join("looker"))

    assert {name: state.event for name, state in found.items()} == {
        f"x{number}": "ready" for number in range(4)
    }


def test_what_was_told_of_a_process_that_has_ended_says_nothing_of_this_one(
    master: object, join: Join
) -> None:
    """Also where a clock that was set back makes the older word look like the newer one."""
    watch = join("watch")
    watch.join()
    registered = ask_master(watch.master)
    assert registered is not None
    for event, pid, time_s in (("ready", os.getpid(), 100.0), ("crashed", 2**30, 101.0)):
        told = NodeState(node="watch", type="sensory", event=event, pid=pid, time=time_s)  # type: ignore[arg-type]
        Publisher(NODE_STATE, network=watch if event == "ready" else join("launcher")).send(told)

    found = states_of(join("looker"), registered.registrations)

    assert found["watch"].event == "ready"


def test_states_that_come_without_end_are_looked_at_for_a_while(
    master: object, join: Join, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(look, "MOST_STATES_S", 0.2, raising=False)
    told = Publisher(NODE_STATE, network=join("busy"))
    stop, came = threading.Event(), threading.Event()

    def tell() -> None:
        while not stop.wait(0.01):
            told.send(NodeState(node="busy", type="sensory", event="ready"))

    telling = threading.Thread(target=tell)
    telling.start()
    looker = join("looker")
    threading.Thread(target=lambda: (states_of(looker), came.set()), daemon=True).start()
    try:
        assert came.wait(5)
    finally:
        stop.set()
        telling.join()


def test_every_link_asks_for_heartbeats(master: object, join: Join) -> None:
    network = join("beating")
    subscriber = Subscriber[object]("/x", network=network)
    sockets = [network.outbox._socket, network._client._socket, subscriber._inbox._socket]  # type: ignore[attr-defined]
    sockets += [] if not hasattr(master, "_socket") else [master._socket]

    Publisher("/x", network=join("talker"))

    for socket in sockets:
        assert 0 < socket.getsockopt(zmq.HEARTBEAT_IVL) <= 1000
        assert 0 < socket.getsockopt(zmq.HEARTBEAT_TIMEOUT) <= 4000


def test_a_publisher_that_the_master_lost_sight_of_is_heard_while_it_talks(
    master: object, join: Join, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inbox, "LAST_WORDS_S", 0.3)
    talker, hearer = join("talker"), join("hearer")
    subscriber = Subscriber[dict[str, int]]("/x", network=hearer)
    publisher = Publisher("/x", network=talker)
    receiving = subscriber._inbox
    assert isinstance(receiving, Inbox)

    receiving.connect({}, set())  # as the master would tell it
    heard: list[int] = []
    for number in range(30):
        publisher.send({"n": number})
        message = subscriber.receive(1)
        heard += [message["n"]] if message else []
        time.sleep(0.05)

    assert heard == list(range(30))
    assert until(lambda: not talker.outbox.subscribers("/x"))  # it was silent for a while


def test_who_comes_later_than_it_was_awaited_counts_what_it_missed(
    free_port: int,
) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with (
        DirectNetwork(endpoint) as talker,
        zmq.Context() as context,
        context.socket(zmq.SUB) as late,
    ):
        late.linger, late.rcvtimeo = 0, 10_000
        publisher = Publisher("/x", network=talker)
        publisher.send({"n": 1})
        talker.outbox.expect("/x", {"late"})  # as the master's answer names it
        for number in (2, 3, 4):
            publisher.send({"n": number})

        late.subscribe(b"/x\0")
        late.subscribe(private_subscription("/x", "late"))
        late.connect(endpoint)
        backlog = inbox.Backlog("/x")
        headers: list[Header] = []
        for _ in range(2):
            notice = late.recv().partition(talker.instance.encode() + b"\0")[2]
            headers.append(read_header(notice.split(b"\0")[1]))
            backlog.put(notice)

    assert [header.sent for header in headers] == [1, 4]
    assert backlog.lost == 3
