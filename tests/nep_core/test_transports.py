"""A whole project is switched from one transport to another by one environment variable."""

from __future__ import annotations

import os
import queue
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from nep_core.cli import main
from nep_core.errors import BrokerNotFound, MasterNotFound, NameTaken, NetworkError, RouterNotFound
from nep_core.networks import transports
from nep_core.networks.registry import Registration
from nep_core.networks.transports import default_network, set_default_network
from nep_core.processes.launcher import Launcher
from nep_core.processes.node import Node
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.node_making import write_node
from tests.nep_core.worlds import NAMED, WITH_ZENOH, World, a_world

ECHO = """
hears = node.subscriber("/in")
says = node.publisher("/out")
node.ready()
for message in hears:
    says.send(message)
"""


@pytest.fixture(params=NAMED)
def world(
    request: pytest.FixtureRequest, free_port: int, monkeypatch: pytest.MonkeyPatch
) -> Iterator[World]:
    """A network which this test, and all that it starts, joins by the environment alone."""
    with a_world(request.param, free_port) as world:
        for variable, value in world.environment.items():
            monkeypatch.setenv(variable, value)
        yield world


def until(condition: Callable[[], bool]) -> None:
    deadline = time.monotonic() + 8
    while not condition():
        assert time.monotonic() < deadline
        threading.Event().wait(0.01)


def test_a_launched_node_talks_restarts_and_stops_over_every_transport(
    world: World, tmp_path: Path
) -> None:
    write_node(tmp_path, "echo", ECHO, type_="cognitive")
    with transports.network_for("test") as network, Launcher(folders=(tmp_path,)) as launcher:
        launcher.hear(network)
        states = Subscriber(NODE_STATE, NodeState, network=network)
        heard = Subscriber[Any]("/out", network=network)
        said = Publisher("/in", network=network)

        launched = launcher.start("cognitive/echo", "parrot")
        launched.wait_ready()
        said.send({"life": 1})
        assert heard.receive(5) == {"life": 1}
        os.kill(launched.pid, signal.SIGKILL)
        until(lambda: launched.restarts == 1)
        launched.wait_ready()
        said.send({"life": 2})
        assert heard.receive(5) == {"life": 2}
        assert {"parrot", "test"} <= {told.node for told in transports.registrations()}
        assert transports.ask_to_stop("parrot")
        assert launched.ended.wait(5)

        until(lambda: "parrot" not in {told.node for told in transports.registrations()})
        events = [state.event for state in states.pending() if state.node == "parrot"]
        assert [event for event in events if event != "alive"] == [
            *("starting", "ready", "crashed"),
            *("starting", "ready", "stopped"),
        ]


def test_a_name_is_used_once_and_free_again_afterwards(world: World) -> None:
    with Node("watch", "sensory"), pytest.raises(NameTaken, match="watch"):
        Node("watch", "sensory")

    with Node("watch", "sensory") as again:
        assert again.name == "watch"


def test_tools_see_who_is_there_and_follow_who_comes_and_goes(world: World) -> None:
    told: queue.Queue[list[Registration]] = queue.Queue()
    feed = transports.follow(told.put)
    network = world.join("watch")
    subscriber = Subscriber[Any]("/a*b", network=network)
    Publisher("/ü", network=network)

    def is_seen(there: list[Registration]) -> bool:
        return any(
            one.node == "watch"
            and one.publishes == ["/ü"]
            and [*one.subscribes.values()] == ["/a*b"]
            for one in there
        )

    until(lambda: is_seen(told.get(timeout=8)))
    assert is_seen(transports.registrations())
    [registration] = transports.registrations()
    assert registration.pid == os.getpid()
    subscriber.close()
    network.close()
    until(lambda: told.get(timeout=8) == [])
    assert feed.is_answered
    feed.close()
    assert not transports.ask_to_stop("nobody")


def test_the_command_line_works_over_every_transport(
    world: World, capsys: pytest.CaptureFixture[str]
) -> None:
    with Node("watch", "sensory") as node:
        node.ready()

        assert main(["nodes"]) == 0
        assert main(["echo", NODE_STATE, "--count", "1"]) == 0

    printed = capsys.readouterr().out
    assert "watch   sensory   ready" in printed
    assert '"event":"ready"' in printed


def test_programs_that_name_no_network_join_the_one_of_the_environment(world: World) -> None:
    set_default_network(None)
    hearer = world.join("hearer")
    subscriber = Subscriber[Any]("/x", network=hearer)

    Publisher("/x").send("hello")

    assert subscriber.receive(5) == "hello"
    assert type(default_network()) is type(hearer)
    default_network().close()


@pytest.mark.parametrize("world", ["broker", WITH_ZENOH], indirect=True)
def test_when_the_central_service_comes_back_all_goes_on(world: World) -> None:
    subscriber = Subscriber[Any]("/x", network=world.join("hearer"))
    talker = world.join("talker")
    publisher = Publisher("/x", network=talker, wait_for_subscribers=1)
    state = Publisher("/state", network=talker, latched=True)
    states = Subscriber[Any]("/state", network=subscriber.network)
    heard: list[str] = []

    def hear() -> int:
        heard.extend(subscriber.pending())
        return len(heard)

    world.end()
    publisher.send("perhaps to nobody")
    state.send("newest")
    world.begin()

    assert states.receive(8) == "newest"
    sent = 1
    while "again" not in heard:
        publisher.send("again")
        sent += 1
        heard.extend(filter(None, [subscriber.receive(0.02)]))
    until(lambda: hear() + subscriber.lost == sent)
    until(lambda: {"hearer", "talker"} == {one.node for one in transports.registrations()})
    with pytest.raises(NameTaken):
        Publisher("/x", network=world.join("talker"))
    late = Subscriber[Any]("/x", network=world.join("late"))
    publisher.send("to all")
    assert late.receive(5) == "to all"


def test_without_the_central_service_a_sentence_says_how_to_start_it(
    free_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("nep_core.networks.master_client.ANSWER_S", 0.1)
    monkeypatch.setattr("nep_core.networks.zenoh_session.CONNECT_MS", 100)
    monkeypatch.setenv("NEP_MASTER", f"tcp://127.0.0.1:{free_port}")
    monkeypatch.setenv("NEP_BROKER", f"tcp://127.0.0.1:{free_port}")
    monkeypatch.setenv("NEP_ZENOH", f"tcp/127.0.0.1:{free_port}")
    kinds = {
        "p2p": (MasterNotFound, "nep master"),
        "broker": (BrokerNotFound, "nep broker"),
        "zenoh": (RouterNotFound, "nep broker --zenoh"),
    }
    for kind, (error, command) in kinds.items():
        monkeypatch.setenv("NEP_NETWORK", kind)

        with pytest.raises(error) as raised:
            Node("lonely", "sensory")

        assert str(free_port) in str(raised.value.sentence)
        assert str(raised.value.checklist[0]).endswith(command)


def test_an_unknown_transport_is_told_with_those_that_there_are(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("NEP_NETWORK", "pigeons")

    with pytest.raises(NetworkError, match="pigeons") as raised:
        transports.network_for("x")

    assert "p2p, broker, zenoh" in str(raised.value.checklist[0])
    assert main(["nodes"]) == 1
    assert "pigeons" in capsys.readouterr().err


def test_without_the_zenoh_library_the_checklist_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("NEP_NETWORK", "zenoh")
    monkeypatch.setattr("nep_core.networks.zenoh_session.find_spec", lambda name: None)

    with pytest.raises(NetworkError, match="not installed") as raised:
        transports.network_for("x")

    assert 'pip install "nep-studio[zenoh]"' in str(raised.value.checklist[0])
