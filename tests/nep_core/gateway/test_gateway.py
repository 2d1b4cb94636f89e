"""The gateway between the original's programs and ours: who hears what, and what is left behind."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import psutil
import pytest
import zmq

from nep_core.errors import PortTaken
from nep_core.networks.gateway import lines
from nep_core.networks.gateway.doors import (
    LONGEST_NAME,
    MOST_WAITING_BYTES,
    Shape,
    Watch,
    WayOut,
)
from nep_core.networks.gateway.gateway import Gateway, Ports
from nep_core.networks.gateway.lines import Speaker
from nep_core.networks.master import Master
from nep_core.networks.master_messages import ask_master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.nep_core.gateway.raw_programs import RawPrograms, free_ports, is_free, until

Join = Callable[[str], PeerNetwork]


def test_each_message_comes_once_and_in_order_to_everybody(raw: RawPrograms, join: Join) -> None:
    ours = join("ours")
    new, old = raw.register("/t", "publisher"), raw.register("/t", "publisher", old=True)
    bare, prefixed = raw.reader(new + 1), raw.reader(old + 1, "/t")
    speaker = Publisher("/t", network=ours, wait_for_subscribers=1)
    listener: Subscriber[Any] = Subscriber("/t", network=ours)
    publishers = [raw.publisher(new), raw.publisher(old)]
    until(lambda: all_hear(publishers[0], b'["hello", 0]', bare, prefixed))
    until(lambda: listener.wait_for_publishers(2, 0.1))

    for number in range(300):
        publishers[0].send(json.dumps(["new", number]).encode())
        publishers[1].send(b"/t " + json.dumps(["old", number]).encode())
        speaker.send(["ours", number])

    from_bare = some_of(lambda: json.loads(bare.recv()))
    from_prefixed = some_of(lambda: json.loads(prefixed.recv()[3:]))
    at_ours = some_of(lambda: listener.receive(10.0))
    for heard in (from_bare, from_prefixed, at_ours):
        for name in ("new", "old", "ours"):
            numbers = [number for who, number in heard if who == name]
            assert numbers == list(range(300)), name
    assert not bare.poll(100) and not prefixed.poll(0) and listener.receive(0.0) is None


def test_one_of_the_original_s_own_frames_arrives_byte_for_byte(raw: RawPrograms) -> None:
    port = raw.register("/t", "publisher", msg_type="string")
    reader, publisher = raw.reader(port + 1), raw.publisher(port)
    frames = [b"/t with the topic", b"without", b"\xff no text"]
    until(lambda: all_hear(publisher, b"hello", reader))
    for frame in frames:
        publisher.send(frame)

    heard = [reader.recv()]
    while heard[-1] != frames[-1]:
        heard.append(reader.recv())
    assert [frame for frame in heard if frame != b"hello"] == frames


def test_readers_of_0_5_4_6_ask_like_later_ones_but_get_the_topic_in_front(
    raw: RawPrograms, join: Join
) -> None:
    reader = raw.reader(raw.register("/t", "subscriber") + 1, "/t")

    Publisher("/t", network=join("ours"), wait_for_subscribers=1).send({"x": 1})

    assert reader.recv() == b'/t {"x":1}'


def test_a_message_that_a_reader_cannot_take_is_left_out(raw: RawPrograms, join: Join) -> None:
    reader = raw.reader(raw.register("/t", "subscriber") + 1)
    speaker = Publisher("/t", network=join("ours"), wait_for_subscribers=1)

    speaker.send(b"bytes")
    speaker.send({"x": 1})

    assert reader.recv() == b'{"x":1}'


def test_a_program_that_does_not_read_costs_bounded_memory(ports: Ports) -> None:
    with zmq.Context() as context, context.socket(zmq.SUB) as frozen:
        watch = Watch()
        way = WayOut(context, watch, lambda: None, "t", Shape(False, "bytes"))
        way.bind(f"tcp://127.0.0.1:{ports.topics}")
        frozen.linger, frozen.rcvhwm = 0, 1
        frozen.subscribe(b"")
        frozen.connect(f"tcp://127.0.0.1:{ports.topics}")
        while not way.wanted:
            watch.once(0.1)
        before_bytes = psutil.Process().memory_info().rss

        for _ in range(300):
            way.send(b"x" * 1_000_000)
        grown_bytes = psutil.Process().memory_info().rss - before_bytes
        for _ in range(2000):
            way.send(b"small")
        way.close()

    assert grown_bytes < MOST_WAITING_BYTES + 30_000_000


def test_what_waits_for_our_network_is_bounded_in_bytes(master: Master) -> None:
    with PeerNetwork("gateway", master="tcp://127.0.0.1:9") as nobody:  # no master is there
        speaker = Speaker(nobody, "/large")
        for _ in range(1000):
            speaker.say("x", 1_000_000)
        waiting = speaker._waiting.qsize()
        speaker.close()

    assert waiting * 1_000_000 <= MOST_WAITING_BYTES


def test_second_programs_that_bind_get_a_port_of_their_own(raw: RawPrograms, join: Join) -> None:
    listener: Subscriber[Any] = Subscriber("/one", network=join("ours"))
    one = [raw.register("/one", "publisher", mode="one2many") for _ in range(2)]
    to = [raw.register("/to", "subscriber", mode="many2one", node="b") for _ in range(2)]

    publishers = [raw.publisher(port, binds=True) for port in one]
    readers = [raw.reader(port, binds=True) for port in to]
    connected = raw.publisher(raw.register("/to", "publisher", mode="many2one"))
    for publisher in publishers:
        publisher.send(b'{"x":1}')

    until(lambda: all_hear(connected, b'{"x":2}', *readers))
    assert [listener.receive(10.0) for _ in one] == [{"x": 1}, {"x": 1}]
    assert [reader.recv() for reader in readers] == [b'{"x":2}'] * 2


def test_the_paper_s_programs_do_not_say_who_they_are_and_are_found_out(
    raw: RawPrograms, join: Join
) -> None:
    ours = join("ours")
    listener: Subscriber[Any] = Subscriber("/says", network=ours)
    said, heard = (
        raw.ask(json.dumps({"node_name": "paper", "topic": topic}).encode(), old=True)["port"]
        for topic in ("/says", "/hears")
    )

    publisher = raw.publisher(said, binds=True)
    reader = raw.reader(heard, "/hears")
    publisher.send(b'/says {"human_action": "karate"}')
    Publisher("/hears", network=ours, wait_for_subscribers=1).send({"action": "say"})

    assert listener.receive(10.0) == {"human_action": "karate"}
    assert reader.recv() == b'/hears {"action":"say"}'


def test_ports_are_freed_when_a_program_ends_without_a_word(raw: RawPrograms) -> None:
    ends = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    stays = raw.register("/stays", "publisher")
    goes = raw.register("/goes", "publisher", pid=ends.pid)
    service = raw.register("service", "server", pid=ends.pid)
    registry = raw.reader(raw.ports.registry)

    ends.communicate(b"\n")

    until(lambda: set(json.loads(registry.recv())) == {"/stays"})
    until(lambda: all(is_free(port) for port in (goes, goes + 1, service)))
    assert not is_free(stays)


def test_ports_of_a_program_that_cannot_be_seen_are_freed_when_nobody_is_connected(
    raw: RawPrograms, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lines, "UNUSED_S", 0.3)
    port = raw.register("/t", "subscriber", pid="none")
    registry = raw.reader(raw.ports.registry)

    reader = raw.reader(port + 1)
    until(lambda: bool(registry.recv()))
    assert not registry.poll(700), "freed while somebody was connected"
    reader.close()

    assert json.loads(registry.recv()) == {}


def test_names_that_strangers_make_up_do_not_pile_up(
    raw: RawPrograms, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lines, "MOST_PROGRAMS", 5)
    registry = raw.reader(raw.ports.registry)

    for number in range(20):
        raw.register("/t", "publisher", node=f"{number} {'long' * 1000}", pid=number % 2)

    told: dict[str, Any] = {}
    until(lambda: told.update(json.loads(registry.recv())) or "19 long" in str(told))
    nodes = told["/t"]["nodes"]
    assert [name.split()[0] for name in nodes] == ["15", "16", "17", "18", "19"]
    assert {len(name) for name in nodes} == {LONGEST_NAME}


def test_both_generations_get_the_list_of_topics_at_one_port(raw: RawPrograms) -> None:
    old, new = raw.reader(raw.ports.registry, "master"), raw.reader(raw.ports.registry)
    first_of_old, first_of_new = old.recv(), new.recv()

    port = raw.register("/t", "publisher", node="a", pid="none")

    until(lambda: b"/t" in old.recv())
    while (listed := json.loads(new.recv())) == {}:
        pass
    nodes = {"a": {"socket": "publisher", "pid": "n.a.", "ip": "127.0.0.1"}}
    told = {"port": port, "socket": "publisher", "ip": "127.0.0.1", "mode": "many2many"}
    assert listed == {"/t": told | {"msg_type": "json", "nodes": nodes}}
    assert (first_of_old, first_of_new) == (b"master {}", b"{}")


def test_what_nobody_of_the_original_wants_costs_nothing(
    raw: RawPrograms, master: Master, join: Join
) -> None:
    unheard = Publisher("/unheard", network=join("ours"))
    before = ask_master(master.endpoint)

    listener = Subscriber("/t", network=unheard.network)
    publisher = raw.publisher(raw.register("/t", "publisher"))
    publisher.send(b"{}")

    assert before is not None
    assert [told.node for told in before.registrations] == ["ours"]
    assert listener.receive(10.0) == {}
    assert unheard.subscribers() == 0


def test_a_topic_that_the_original_s_last_program_left_is_left_by_the_gateway(
    raw: RawPrograms, join: Join
) -> None:
    speaker = Publisher("/t", network=join("ours"))
    reader = raw.reader(raw.register("/t", "subscriber") + 1)
    assert speaker.wait_for_subscribers(1, 10.0)

    reader.close()

    until(lambda: speaker.subscribers() == 0)


def test_the_original_s_programs_talk_while_our_master_is_away(ports: Ports) -> None:
    endpoint = f"tcp://127.0.0.1:{free_ports().old}"
    with closing(Gateway(endpoint, ports)), closing(RawPrograms(ports)) as raw:
        port = raw.register("/t", "publisher")
        reader, publisher = raw.reader(port + 1), raw.publisher(port)
        until(lambda: all_hear(publisher, b'{"x":1}', reader))
        with closing(Master(endpoint)), PeerNetwork("ours", master=endpoint) as ours:
            listener: Subscriber[Any] = Subscriber("/t", network=ours)
            until(
                lambda: (
                    all_hear(publisher, b'{"x":1}', reader) and listener.receive(0.05) == {"x": 1}
                )
            )


def test_ports_of_other_programs_are_told(gateway: Gateway, master: Master) -> None:
    taken, free = gateway.ports, free_ports()

    second = Gateway(master.endpoint, Ports(free.old, taken.new, taken.registry, free.topics))
    second.close()

    assert [f"port {taken.new}" in told for told in second.troubles] == [True, False]
    assert f"port {taken.registry} is used by another program" in second.troubles[1]
    with pytest.raises(PortTaken):
        Gateway(master.endpoint, taken)


def test_a_gateway_that_is_started_anew_serves_the_programs_of_the_one_before(
    master: Master, ports: Ports, join: Join, tmp_path: Path
) -> None:
    ends = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    listener: Subscriber[Any] = Subscriber("/one", network=join("ours"))
    memory = tmp_path / "new" / "memory.json"
    with closing(RawPrograms(ports)) as raw:
        with closing(Gateway(master.endpoint, ports, memory=memory)):
            port = raw.register("/t", "publisher")
            bound = raw.register("/one", "publisher", mode="one2many")
            reader, publishers = raw.reader(port + 1), [raw.publisher(port)]
            publishers.append(raw.publisher(bound, binds=True))
            gone = raw.register("/gone", "publisher", pid=ends.pid)
        ends.communicate(b"\n")

        def arrive() -> bool:
            for publisher in publishers:
                publisher.send(b'{"x":1}')
            return bool(reader.poll(20)) and listener.receive(0.02) == {"x": 1}

        with closing(Gateway(master.endpoint, ports, memory=memory)):
            until(arrive)

            assert is_free(gone)
            assert raw.register("/t", "subscriber", node="late") == port
            assert raw.register("/late", "subscriber") not in (port, bound)


@pytest.mark.parametrize("content", [b"", b"[", b'[{"port": "x"}]', b"[1]"])
def test_a_memory_that_cannot_be_read_is_no_trouble(
    master: Master, ports: Ports, tmp_path: Path, content: bytes
) -> None:
    memory = tmp_path / "memory.json"
    memory.write_bytes(content)

    gateway = Gateway(master.endpoint, ports, memory=memory)
    with closing(gateway), closing(RawPrograms(ports)) as raw:
        assert raw.register("/t", "publisher")


def all_hear(publisher: zmq.Socket[bytes], frame: bytes, *readers: zmq.Socket[bytes]) -> bool:
    """Whether a frame, sent once more, has come to all of them."""
    publisher.send(frame)
    return all(reader.poll(20) for reader in readers)


def some_of(receive: Callable[[], Any]) -> list[tuple[str, int]]:
    """The first 900 messages, but not those that only tried whether somebody hears."""
    heard: list[tuple[str, int]] = []
    while len(heard) < 900:
        who, number = receive()
        if who != "hello":
            heard.append((who, number))
    return heard
