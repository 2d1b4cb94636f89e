"""One bad input ends nothing but itself: what cannot be read is passed over, and all goes on."""

from __future__ import annotations

import contextlib
import json
import queue
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest
import zmq

from nep_core.cli.console import value_of
from nep_core.errors import BadMessage, PairingError
from nep_core.networks import discovery
from nep_core.networks.gateway.doors import refused
from nep_core.networks.gateway.gateway import Gateway, Ports
from nep_core.networks.master import Master
from nep_core.networks.master_client import MasterFeed
from nep_core.networks.master_messages import List, Listing, ask_master, decode_request, encode
from nep_core.networks.security.pairing import (
    _DOOR,
    _GUEST,
    DoorTalk,
    Guest,
    GuestTalk,
    Welcome,
    _mac,
)
from nep_core.networks.zenoh_session import registrations_of
from nep_core.networks.zmq_networks import DirectNetwork, PeerNetwork
from nep_core.processes import node as node_module
from nep_core.processes.handover import take
from nep_core.processes.node import Node
from nep_core.recordings.raw import RawMessage, RawSubscriber
from nep_core.recordings.recorder import Recorder
from nep_core.wire.frames import CANNOT_DECODE, read_header
from nep_core.wire.messages import NODE_STATE, NodeState
from nep_core.wire.pubsub import Publisher, Subscriber
from nep_studio.ui.node_style import as_json, pretty
from tests.nep_core.master_process import until

Join = Callable[[str], PeerNetwork]

DEEP = b"[" * 1200 + b"]" * 1200
HEADS = {
    "not UTF-8": b'["\xff\xfe",1,2,"json","12345678"]',
    "deep": b'["n",1,2,"json","12345678",1,' + DEEP + b"]",
    "digits": b'["n",' + b"9" * 5000 + b',2,"json","12345678"]',
    "encoding not UTF-8": b'["n",1,2,"\xff","12345678"]',
}
HEAD = b'["n",%d,2,"%s","12345678"]'
PAYLOADS = {
    "deep": (b"json", DEEP),
    "deep in a key that nobody asked for": (b"json", b'{"x":' + DEEP + b"}"),
    "not UTF-8": (b"json", b'{"a":"\xff"}'),
    "surrogate": (b"json", b'"\\ud800"'),
    "two, one deep": (b"json", DEEP + b"\0" + DEEP),
    "deep msgpack": (b"msgpack", b"\x91" * 1200 + b"\x01"),
    "long msgpack": (b"msgpack", b"\xdd\xff\xff\xff\xff"),
    "text": (b"text", b"\xff"),
}
BAD = [b"/x\0" + head + b"\0{}" for head in HEADS.values()] + [
    b"/x\0" + HEAD % (number, encoding) + b"\0" + payload
    for number, (encoding, payload) in enumerate(PAYLOADS.values(), 1)
]
GOOD = b"/x\0" + HEAD % (100, b"text") + b"\0the end"

Peer = zmq.Socket[bytes]


@pytest.fixture
def wire(free_port: int) -> Iterator[tuple[DirectNetwork, Peer]]:
    """A network that hears, and a peer that may send it anything."""
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with (
        DirectNetwork(endpoint, binds="subscriber") as network,
        zmq.Context() as context,
        context.socket(zmq.XPUB) as peer,
    ):
        peer.linger = 0
        peer.rcvtimeo = 10_000
        peer.connect(endpoint)
        yield network, peer


def send_all(peer: Peer, *frames: bytes) -> None:
    """Send once the subscriber is there, which says two subscriptions."""
    assert [peer.recv(), peer.recv()]
    for frame in frames:
        peer.send(frame)


@pytest.mark.parametrize("head", HEADS.values(), ids=HEADS)
def test_a_header_that_cannot_be_read_is_a_bad_message(head: bytes) -> None:
    with pytest.raises(BadMessage):
        read_header(head)


def test_no_frame_ends_receiving_or_its_header(wire: tuple[DirectNetwork, Peer]) -> None:
    network, peer = wire
    subscriber = Subscriber[Any]("/x", network=network)
    send_all(peer, *BAD, GOOD)

    received: list[object] = []
    while "the end" not in received:
        received.append(subscriber.receive(5))
        assert received[-1] is not None
        assert subscriber.header is not None or received[-1] != "the end"


def test_no_frame_ends_a_callback(wire: tuple[DirectNetwork, Peer]) -> None:
    network, peer = wire
    heard: queue.Queue[object] = queue.Queue()
    Subscriber[Any]("/x", network=network, callback=heard.put)
    send_all(peer, *BAD, GOOD)

    while heard.get(timeout=10) != "the end":
        pass


def test_a_flood_of_bad_frames_does_not_keep_receive_from_coming_back(
    wire: tuple[DirectNetwork, Peer],
) -> None:
    network, peer = wire
    subscriber = Subscriber[Any]("/x", network=network)
    stop = threading.Event()
    send_all(peer)

    def flood() -> None:
        while not stop.wait(0.001):
            peer.send(BAD[0])

    flooding = threading.Thread(target=flood)
    flooding.start()
    came = threading.Event()
    threading.Thread(target=lambda: (subscriber.receive(0.1), came.set()), daemon=True).start()
    try:
        assert came.wait(10)
    finally:
        stop.set()
        flooding.join()


@pytest.mark.parametrize("kind", [Subscriber, RawSubscriber])
def test_a_frame_of_millions_of_messages_is_one_bad_message(
    wire: tuple[DirectNetwork, Peer], kind: type[Subscriber[Any]] | type[RawSubscriber]
) -> None:
    network, peer = wire
    subscriber = kind("/x", network=network)
    send_all(peer, b"/x\0" + HEAD % (1, b"json") + b"\0" * 300_000, GOOD)

    message = subscriber.receive(5)

    assert getattr(message, "payload", message) in ("the end", b"the end")
    assert (trouble := network.take_warning()) and trouble.sentence.values["count"] == 1


FLOOD = """
import sys, zmq
with zmq.Context() as context, context.socket(zmq.XPUB) as peer:
    peer.linger = 0
    peer.connect(sys.argv[1])
    assert peer.recv() and peer.recv()
    many = b'/x\\0["n",1,2,"json","12345678"]\\0' + b"\\0".join([b"1"] * 19_000)
    while True:
        peer.send(many)
"""


def test_a_flood_does_not_keep_pending_from_coming_back(free_port: int) -> None:
    endpoint = f"tcp://127.0.0.1:{free_port}"
    with DirectNetwork(endpoint, binds="subscriber") as network:
        subscriber = Subscriber[int]("/x", network=network)
        flooding = subprocess.Popen([sys.executable, "-c", FLOOD, endpoint])
        came = threading.Event()
        try:
            assert subscriber.receive(20) == 1
            threading.Thread(target=lambda: (subscriber.pending(), came.set()), daemon=True).start()
            assert came.wait(5)
        finally:
            subscriber.close()  # ends it, also where it goes on for ever
            flooding.kill()
            flooding.wait()


def test_no_frame_ends_a_recording(wire: tuple[DirectNetwork, Peer], tmp_path: Path) -> None:
    network, peer = wire
    recorder = Recorder(tmp_path / "a.mcap", network=network)
    recorder.add(["/x"])
    send_all(peer, *BAD, GOOD)

    assert until(lambda: recorder.totals.messages == len(PAYLOADS) + 2)  # one is two; and the end
    recorder.close()

    assert recorder.failure is None


class _Ended(BaseException):
    """What a program may end a rule with."""


@pytest.mark.parametrize("kind", [ValueError, RecursionError, _Ended])
def test_an_error_in_a_callback_is_told_and_the_callback_goes_on(
    master: Master, join: Join, monkeypatch: pytest.MonkeyPatch, kind: type[BaseException]
) -> None:
    monkeypatch.setattr(node_module, "HEARTBEAT_S", 0.2)
    states = Subscriber(NODE_STATE, NodeState, network=join("watcher"))
    heard: queue.Queue[int] = queue.Queue()

    def hear(message: dict[str, int]) -> None:
        if message["n"] < 500:
            raise kind("a slip of {mine}")
        heard.put(message["n"])

    with Node("fragile", "perceptual", network=join("fragile")) as node:
        node.subscriber("/x", dict[str, int], callback=hear)
        publisher = Publisher("/x", network=join("talker"), wait_for_subscribers=1)
        for number in range(501):
            publisher.send({"n": number})
        assert heard.get(timeout=10) == 500
        told: list[NodeState] = []
        while "callback_failed" not in [state.code for state in told]:
            state = states.receive(10)
            assert state is not None
            told.append(state)

    warning = told[-1]
    assert warning.event == "warning"
    assert warning.values["topic"] == "/x"
    assert 0 < warning.values["count"] <= 500
    assert "a slip of {mine}" in warning.values["error"]
    assert "a slip of {mine}" in str(warning.fault)
    assert len(told) < 30  # heartbeats, and not a warning for each message


def test_messages_that_cannot_be_read_are_told_by_the_node(
    master: Master, join: Join, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(node_module, "HEARTBEAT_S", 0.1)
    states = Subscriber(NODE_STATE, NodeState, network=join("watcher"))

    with Node("reader", "perceptual", network=join("reader")) as node:
        samples = node.subscriber("/x", dict[str, int])
        publisher = Publisher("/x", network=join("talker"), wait_for_subscribers=1)
        for _ in range(3):
            publisher.send({"n": "three"})
        publisher.send({"n": 4})
        assert samples.receive(5) == {"n": 4}
        while (state := states.receive(10)) and state.code != "messages_unreadable":
            pass

    assert state is not None
    assert state.event == "warning"
    assert (state.values["topic"], state.values["count"]) == ("/x", 3)


@contextlib.contextmanager
def a_false_master(*answers: bytes) -> Iterator[str]:
    """Answers each request by all of these."""
    with zmq.Context() as context, context.socket(zmq.ROUTER) as router:
        router.linger = 0
        port = router.bind_to_random_port("tcp://127.0.0.1")
        stop = threading.Event()

        def serve() -> None:
            while not stop.is_set():
                if router.poll(20):
                    address = router.recv_multipart()[0]
                    for answer in answers:
                        router.send_multipart([address, answer])

        serving = threading.Thread(target=serve)
        serving.start()
        try:
            yield f"tcp://127.0.0.1:{port}"
        finally:
            stop.set()
            serving.join()


RUBBISH = (
    b'{"do":"listing","epoch":"\xff","pid":1,"registrations":[]}',
    b'{"do":"refused","version":1,"sentence":"","checklist":[],"fault":' + DEEP + b"}",
)


def test_a_master_that_answers_rubbish_is_no_master() -> None:
    for rubbish in RUBBISH:
        with a_false_master(rubbish) as endpoint:
            assert ask_master(endpoint) is None


def test_rubbish_of_a_master_ends_no_feed() -> None:
    listing = encode(Listing(epoch="e", pid=1, registrations=[], number=1))
    told = threading.Event()
    with (
        a_false_master(*RUBBISH, listing) as endpoint,
        MasterFeed(endpoint, lambda _: told.set()),
    ):
        assert told.wait(10)


@pytest.mark.parametrize("request_", [b'{"do":"list","x":' + DEEP + b"}", b'{"do":"\xff"}', b""])
def test_the_master_answers_any_request(master: Master, request_: bytes) -> None:
    with zmq.Context() as context, context.socket(zmq.DEALER) as socket:
        socket.linger, socket.rcvtimeo = 0, 10_000
        socket.connect(master.endpoint)
        for said in (request_, encode(List())):
            socket.send(said)

        answers = [json.loads(socket.recv())["do"] for _ in range(2)]

    assert answers[0] in ("error", "listing")
    assert answers[1] == "listing"
    with contextlib.suppress(ValueError, RecursionError):
        decode_request(request_)


def test_the_gateway_answers_any_request_and_the_next_one(master: Master, free_port: int) -> None:
    ports = Ports(free_port, free_port + 1, free_port + 2, 19_400)
    gateway = Gateway(master.endpoint, ports)
    deep = b'{"topic":' + b"[" * 900 + b"]" * 900 + b"}"
    try:
        with zmq.Context() as context, context.socket(zmq.REQ) as socket:
            socket.linger, socket.rcvtimeo = 0, 10_000
            socket.connect(f"tcp://127.0.0.1:{ports.new}")
            for request in (deep, DEEP, b"\xff", b'{"topic":"a\xff"}', b'{"topic":"\\ud800"}'):
                socket.send(request)
                assert json.loads(socket.recv())["state"] == "failure"
            socket.send(json.dumps({"node": "n", "topic": "t", "socket": "publisher"}).encode())
            assert json.loads(socket.recv())["state"] == "success"
    finally:
        gateway.close()
    assert json.loads(refused(deep, "no", ""))["topic"] == ""


@pytest.mark.parametrize("told", [DEEP.decode(), '{"name":1}'])
def test_who_is_paired_may_tell_rubbish(told: str) -> None:
    guest_talk = GuestTalk("123 456", Guest(name="me", key="k" * 40))
    door_talk = DoorTalk("123 456")
    proof = guest_talk.prove(door_talk.offer(guest_talk.hello()))
    secret = guest_talk._secret
    welcome = Welcome(told=told, mac=_mac(secret, _DOOR, guest_talk._guest, told))
    proof.told, proof.mac = told, _mac(secret, _GUEST, told)

    with pytest.raises(PairingError):
        guest_talk.read(welcome)
    with pytest.raises(PairingError):
        door_talk.read(proof)


def test_a_zenoh_token_with_a_pid_that_is_none_is_passed_over() -> None:
    tokens = [
        f"nep/alive/node/bad/i1/{'9' * 5000}/host",
        f"nep/alive/node/other/i2/{2**40}/host",
        "nep/alive/node/good/i3/12/host",
    ]

    assert [told.node for told in registrations_of(tokens, "")] == ["good"]


@pytest.mark.parametrize(
    "properties",
    [
        {b"title": b"\xff"},
        {b"title": b"t", b"computer": b"c", b"network": b"n", b"door": b"9" * 5000},
        {b"title": b"t", b"computer": b"c", b"network": b"n", b"door": b"99999"},
        {b"title": None},
        {},
    ],
)
def test_a_beacon_that_cannot_be_read_is_no_network(properties: dict[bytes, Any]) -> None:
    info = SimpleNamespace(
        properties=properties, port=1, parsed_scoped_addresses=lambda: ["127.0.0.1"]
    )

    assert discovery._found_of(info) is None  # type: ignore[arg-type]


@pytest.mark.parametrize(("encoding", "payload"), PAYLOADS.values(), ids=PAYLOADS)
def test_what_nep_cannot_read_it_says(encoding: bytes, payload: bytes) -> None:
    message = RawMessage("/x", "n", 1, 0, 0, encoding.decode(), payload)  # type: ignore[arg-type]

    with contextlib.suppress(*CANNOT_DECODE):
        value_of(message)


def test_what_a_program_leaves_may_be_rubbish(tmp_path: Path) -> None:
    for rubbish in (DEEP, b'{"code":"\xff"}', b'{"sentence":' + DEEP + b"}"):
        path = tmp_path / "fault"
        path.write_bytes(rubbish)

        assert take(path) is None


def test_the_studio_shows_any_message() -> None:
    deep = msgspec.json.decode(b"[" * 600 + b"]" * 600)

    for odd in (deep, {"x": msgspec.msgpack.Ext(5, b"a")}, {(1, 2): 3}, float("nan"), 2**70):
        assert as_json(odd)
        assert pretty(odd)
