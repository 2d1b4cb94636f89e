"""What strangers on the network say: frames, requests to masters and gateways, pairing."""

from __future__ import annotations

import contextlib
import itertools
import queue
import random
import socket
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import zmq

from fuzz.mutations import flipped, json_changed, lines_changed
from fuzz.target import Feed, Target

if TYPE_CHECKING:
    from nep_core.wire.pubsub import Subscriber

HOST = "127.0.0.1"
ANSWER_MS = 5000


def free_ports(count: int) -> list[int]:
    """Ports that nobody has."""
    with contextlib.ExitStack() as stack:
        doors = [stack.enter_context(socket.socket()) for _ in range(count)]
        for door in doors:
            door.bind((HOST, 0))
        return [int(door.getsockname()[1]) for door in doors]


# Frames: what a publisher sends, heard by all that read frames.


@contextmanager
def frames(folder: Path) -> Iterator[Feed]:
    """A frame of a topic, through a real socket to who subscribes, in every way to subscribe."""
    from nep_core.networks.zmq_networks import DirectNetwork
    from nep_core.recordings.raw import RawSubscriber
    from nep_core.wire.frames import NUL, join, subscription
    from nep_core.wire.messages import BY_TOPIC
    from nep_core.wire.pubsub import Subscriber

    context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
    speaker = context.socket(zmq.PUB)
    speaker.linger = 0
    port = speaker.bind_to_random_port(f"tcp://{HOST}")
    topics = ["/t", *sorted(BY_TOPIC)]
    numbers, called = itertools.count(1), queue.Queue[object]()

    with contextlib.ExitStack() as stack:
        stack.callback(context.destroy, linger=0)
        network = stack.enter_context(DirectNetwork(f"tcp://{HOST}:{port}", node="reader"))
        plain: Subscriber[Any] = Subscriber("/t", network=network)
        newest: Subscriber[Any] = Subscriber("/t", network=network, policy="state")
        raw = RawSubscriber("/t", network=network)
        kinds = {
            topic: Subscriber(topic, kind, network=network) for topic, kind in BY_TOPIC.items()
        }
        callbacks: list[Subscriber[Any]] = []

        def call() -> None:
            while callbacks:
                callbacks.pop().close()
            callbacks.append(Subscriber("/t", network=network, callback=called.put))

        def end() -> str:
            word = f"end {next(numbers)}"
            speaker.send(join(subscription("/t"), "n", 1, 0, "json", f'"{word}"'.encode()))
            return word

        def begin() -> None:
            """Send until all hear: a new subscriber of ZeroMQ is not there at once."""
            call()
            all_hear = (plain.receive, newest.receive, raw.receive, lambda _: _next(called))
            for hears in all_hear:
                _until(partial(_hears_after, end, hears))

        begin()

        def feed(data: bytes) -> None:
            rest = data.partition(NUL)[2]
            topic = topics[next(numbers) % len(topics)]
            for frame in (data, subscription("/t") + rest, subscription(topic) + rest):
                speaker.send(frame)
            word = end()
            for one in (plain, newest):
                _until(partial(_hears, one, word))
                _ = one.header
            _until(
                lambda: (heard := raw.receive(HEARD_S)) and heard.payload == f'"{word}"'.encode()
            )
            for heard in kinds[topic].pending() if topic in kinds else ():
                assert heard is not None
                _ = kinds[topic].header
            try:
                _until(lambda: _next(called) == word)
            except AssertionError:
                begin()
                raise AssertionError("a callback hears no more") from None

        yield feed


HEARD_S = 1.0


def _hears_after(send: Callable[[], object], hears: Callable[[float], object]) -> bool:
    send()
    return hears(0.1) is not None


def _hears(one: Subscriber[Any], word: str) -> bool:
    return bool(one.receive(HEARD_S) == word)


def _next(waiting: queue.Queue[object]) -> object:
    with contextlib.suppress(queue.Empty):
        return waiting.get(timeout=HEARD_S)
    return None


def _until(condition: Callable[[], object]) -> None:
    end_s = time.monotonic() + 3.0
    while not condition():
        assert time.monotonic() < end_s, "it did not come"


# The master: requests in JSON.


@contextmanager
def master(folder: Path) -> Iterator[Feed]:
    """A request to a running master, which must answer a sound one after it."""
    from nep_core.networks import master_messages as says
    from nep_core.networks.master import Master

    server = Master(f"tcp://{HOST}:*")
    context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
    callers: list[zmq.Socket[bytes]] = []
    topics = itertools.count()

    def caller() -> zmq.Socket[bytes]:
        one = context.socket(zmq.DEALER)
        one.linger = 0
        one.connect(server.endpoint)
        return one

    def feed(data: bytes) -> None:
        number = next(topics)
        if number % 200 == 0:
            while callers:
                callers.pop().close()
            callers.append(caller())
        asking, topic = callers[0], f"/asked_{number}"
        asking.send(data)
        if number % 7 == 0:
            asking.send_multipart([b"a", data, data])
        asking.send(says.encode(says.Find(topic=topic)))
        while True:
            assert asking.poll(ANSWER_MS), "the master does not answer"
            answer = says.decode_answer(asking.recv())
            if isinstance(answer, says.Found) and answer.topic == topic:
                break
            assert not (isinstance(answer, says.Mistake) and "could not answer" in answer.sentence)

    try:
        yield feed
    finally:
        context.destroy(linger=0)
        server.close()


# The gateway: programs of the original NEP.


@contextmanager
def gateway(folder: Path) -> Iterator[Feed]:
    """A request of the original's programs at both ports, and a frame of theirs of each kind."""
    from faults import FaultError
    from nep_core.networks.gateway import lines
    from nep_core.networks.gateway.doors import KINDS, read, read_request, write
    from nep_core.networks.gateway.gateway import Gateway, Ports
    from nep_core.networks.gateway.lines import recall
    from nep_core.networks.master import Master

    # A line has 80 kB of sockets: those of ten seconds are 30 MB, which would hide what is kept
    lines.UNUSED_S = 1.0
    server = Master(f"tcp://{HOST}:*")
    old, new, registry, topics = free_ports(4)
    topics = min(topics, 60000)
    ports = Ports(old=old, new=new, registry=registry, topics=topics)
    served = Gateway(server.endpoint, ports, host=HOST)
    context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
    kept, seen = folder / "kept.json", set[str]()

    def ask(port: int, data: bytes) -> None:
        asking = context.socket(zmq.REQ)
        asking.linger = 0
        try:
            asking.connect(f"tcp://{HOST}:{port}")
            asking.send(data)
            assert asking.poll(ANSWER_MS), "the gateway does not answer"
            asking.recv()
        finally:
            asking.close()

    def feed(data: bytes) -> None:
        refused = None
        for is_old, port in ((True, old), (False, new)):
            try:
                request = read_request(data, is_old)
            except FaultError as error:
                refused = error
            else:
                if len(seen) > 40 and request.topic not in seen:
                    continue  # each topic has sockets and threads, for as long as somebody is there
                seen.add(request.topic)
            ask(port, data)
        kept.write_bytes(data)
        recall(kept)
        for kind in ("json", *KINDS.values()):
            try:
                value = read(data, "/t", kind)
                write(value, "/t", kind, prefixed=True)
                write(value, "/t", "json", prefixed=False)
            except FaultError:
                continue
        if refused is not None:
            raise refused

    try:
        yield feed
    finally:
        context.destroy(linger=0)
        served.close()
        server.close()


# Pairing: the lines of both sides, and what both keep in a file.


@contextmanager
def pairing(folder: Path) -> Iterator[Feed]:
    """What a guest says at a real door, what a door says to a guest, and a key file."""
    from faults import FaultError
    from nep_core.networks.security.keys import KeyFile, new_keys, write_keys
    from nep_core.networks.security.pairing import Door, Offer, Proof, Welcome, _expect, decode

    path, own = folder / "keys.json", folder / "own.json"
    write_keys(own, new_keys("A network"))
    door = Door(KeyFile(own), (HOST, 0))

    def feed(data: bytes) -> None:
        if door.code is None:
            door.new_code()
        answer = b""
        with socket.create_connection((HOST, door.port), 5.0) as caller:
            with contextlib.suppress(OSError):
                caller.sendall(data if data.endswith(b"\n") else data + b"\n")
                caller.shutdown(socket.SHUT_WR)
            with contextlib.suppress(OSError):
                while part := caller.recv(65536):
                    answer += part
        assert len(KeyFile(own).keys.computers) < 100
        path.write_bytes(data)
        refused = None
        for line in (*data.split(b"\n")[:4], *answer.split(b"\n")):
            refused = _guest_hears(line, (Offer, Welcome, Proof), decode, _expect) or refused
        try:
            KeyFile(path)
        except FaultError as error:
            refused = error
        if refused is not None:
            raise refused

    try:
        yield feed
    finally:
        door.close()


def _guest_hears(
    line: bytes,
    kinds: Sequence[type[Any]],
    decode: Callable[[bytes], Any],
    expect: Callable[..., Any],
) -> Exception | None:
    """What a guest makes of a line; the sentence that it tells."""
    import msgspec

    from faults import FaultError

    try:
        message = decode(line)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError):
        return None  # what reads lines tells that the talk is broken
    for kind in kinds:
        try:
            expect(kind, message)
        except FaultError as error:
            return error
    return None


def _frame_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """A frame with its header or a payload changed as JSON."""
    parts = data.split(b"\0")
    at = chance.randrange(len(parts))
    parts[at] = (
        json_changed(parts[at], chance, [parts[at]]) if at else flipped(parts[at], chance, seeds)
    )
    if chance.random() < 0.2:
        parts[at:at] = [chance.choice(parts)]
    return b"\0".join(parts)


TARGETS = {
    one.name: one
    for one in (
        Target("frames", frames, _frame_changed),
        Target("master", master, json_changed),
        Target("gateway", gateway, json_changed),
        Target("pairing", pairing, lines_changed),
    )
}
