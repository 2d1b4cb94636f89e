"""Robots: what programs and networks ask of one on the screen, and what an odd one answers."""

from __future__ import annotations

import contextlib
import itertools
import random
import shutil
import socket
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fuzz.mutations import flipped, json_changed
from fuzz.target import Feed, Target

if TYPE_CHECKING:
    from robots.body.pose import VirtualRobot

HOST = "127.0.0.1"


def _virtual_nao(files: Path) -> tuple[VirtualRobot, Path]:
    """A NAO on the screen that keeps its files there, and its folder."""
    from nodes.resources import model_of, resource_folder
    from robots.body.animations import load_animations
    from robots.body.body import load_body
    from robots.body.pose import VirtualRobot
    from robots.body.speech import load_gesture_words

    nao = resource_folder() / "robots" / "nao"
    body = load_body(nao)
    return VirtualRobot(
        "NAO",
        body,
        load_animations(nao / "animations", body),
        gesture_words=load_gesture_words(nao),
        model=model_of(nao),
        files=files,
    ), nao


# NAOqi: frames of 28 bytes of header and values, to a virtual robot with all its services.


@contextmanager
def naoqi(folder: Path) -> Iterator[Feed]:
    """What a NAOqi program says to a virtual NAO: values read, and a connection of its own."""
    from robots.body.actor import Actor
    from robots.body.virtual import VirtualDriver
    from robots.naoqi.services.all import Offered
    from robots.naoqi.wire.codec import decode
    from robots.naoqi.wire.errors import NaoqiError
    from robots.naoqi.wire.line import FrameReader

    robot, nao = _virtual_nao(folder)
    driver = VirtualDriver(robot)
    actor = Actor("NAO", driver)
    driver.connect()
    offered = Offered(actor, robot, nao, 0)
    is_over = threading.Event()

    def live() -> None:
        start_s = time.monotonic()
        while not is_over.wait(0.02):
            with offered.lock:
                told = actor.step(time.monotonic() - start_s)
            offered.hear(told, [])

    life = threading.Thread(target=live, daemon=True)
    life.start()
    check = _naoqi_check()

    def feed(data: bytes) -> None:
        refused: Exception | None = None
        try:
            for frame in FrameReader().take(data):
                for kind in ("m", "(m)", "(IIL)", "{sm}", "[(sm)]"):
                    with contextlib.suppress(NaoqiError):
                        decode(kind, frame.payload)
        except NaoqiError as error:
            refused = error
        with socket.create_connection((HOST, offered.port), 5.0) as caller:
            with contextlib.suppress(OSError):
                caller.sendall(data)
                caller.shutdown(socket.SHUT_WR)
            caller.settimeout(0.15)  # nobody answers a program that has gone
            with contextlib.suppress(OSError):
                while caller.recv(65536):
                    pass
        check(offered.port)
        assert life.is_alive(), "the robot lives no more"
        if refused is not None:
            raise refused

    try:
        yield feed
    finally:
        is_over.set()
        life.join()
        offered.close()


def _naoqi_check() -> Callable[[int], None]:
    """Asks the directory for a service, as a program does, by a connection that stays."""
    from robots.naoqi.client.session import Session

    sessions: list[Session] = []

    def check(port: int) -> None:
        if not sessions:
            sessions.append(Session((HOST, port)))
            sessions[0].connect()
        name = sessions[0].service("ALRobotModel").call("getRobotType", timeout_s=5.0)
        assert name

    return check


_MAGIC = b"\x42\xde\xad\x42"


def _naoqi_changed(data: bytes, chance: random.Random, seeds: Sequence[bytes]) -> bytes:
    """Frames with other kinds, services, actions and values; their lengths made right mostly."""
    frames = data.split(_MAGIC)[1:]
    if not frames or chance.random() < 0.15:
        return flipped(data, chance, seeds)
    for _ in range(chance.choice((1, 1, 2, 4))):
        at = chance.randrange(len(frames))
        frame = bytearray(frames[at])
        match chance.randrange(6):
            case 0 if len(frames) > 2:
                del frames[at]
                continue
            case 1:
                frames[at:at] = chance.choice(seeds).split(_MAGIC)[1:][:3]
                continue
            case 2 if len(frame) >= 24:
                frame[12:24] = flipped(bytes(frame[12:24]), chance, [bytes(frame)])[:12].ljust(
                    12, b"\0"
                )
            case 3 if len(frame) >= 24:
                frame[20:24] = chance.choice((0, 1, 2, 100, 101, 102, 103, 120, 200)).to_bytes(
                    4, "little"
                )
            case _:
                frame[24:] = flipped(bytes(frame[24:]), chance, [bytes(frame[24:])])
        if chance.random() < 0.9 and len(frame) >= 24:
            frame[4:8] = (len(frame) - 24).to_bytes(4, "little")
        frames[at] = bytes(frame)
    return b"".join(_MAGIC + frame for frame in frames)


# The network: what any program of it may ask of a robot, and tell it of what is around.


@contextmanager
def requests(folder: Path) -> Iterator[Feed]:
    """A message to the node of a virtual NAO: it acts, feels and sees, and tells how it is."""
    import msgspec

    from faults import told
    from nep_core.wire.frames import CANNOT_DECODE
    from nep_core.wire.messages import ExpectedWords, described
    from robots.body.actor import Actor
    from robots.body.driver import ActionRequest, SenseRequest, Surroundings
    from robots.body.virtual import VirtualDriver

    robot, _ = _virtual_nao(folder)
    driver = VirtualDriver(robot)
    actor, numbers = Actor("NAO", driver), itertools.count()
    driver.connect()

    def feed(data: bytes) -> None:
        number, results = next(numbers), []
        for kind in (ActionRequest, SenseRequest, Surroundings, ExpectedWords):
            with contextlib.suppress(*CANNOT_DECODE):
                heard: Any = msgspec.json.decode(data, type=kind)
                if isinstance(heard, ActionRequest):
                    results += actor.request(heard)
                elif isinstance(heard, SenseRequest):
                    msgspec.json.encode(actor.sense(heard))
                elif isinstance(heard, Surroundings):
                    driver.surroundings(heard.things)
                else:
                    driver.expect(heard.words)
        for step in range(3):
            results += actor.step(number / 2 + step / 6)
        if number % 20 == 0:
            results += actor.stop()
        for result in results:
            told(result.fault.sentence).encode()
            msgspec.json.encode(described(result.fault))
        state = driver.state()
        assert state is not None and b"null" not in msgspec.json.encode(
            (state.joints, state.base, state.sensors, state.sees)
        ), "the robot is nowhere"
        shutil.rmtree(folder)  # pictures and videos
        folder.mkdir()

    yield feed


# The robot itself: a node connects to whatever answers at the address that a person wrote.


@contextmanager
def robot(folder: Path) -> Iterator[Feed]:
    """Frames that answer the calls of a client, one for each, while it connects and asks."""
    from robots.naoqi.client import session as client
    from robots.naoqi.wire.errors import BadFrame, Refused
    from robots.naoqi.wire.line import FrameReader, Kind

    reach, answers = client.reach, list[bytes]()

    def near(address: tuple[str, int], until_s: float) -> socket.socket:
        """A robot may send its clients to any other address: here, to none."""
        if address != (HOST, port):
            raise Refused("Not from here.")
        return reach(address, until_s)

    def serve() -> None:
        with contextlib.suppress(OSError):
            while True:
                # what is no robot is asked whether it encrypts, which is no frame either
                with door.accept()[0] as caller, contextlib.suppress(BadFrame):
                    _answer(caller, answers, FrameReader(), Kind.CALL)

    def feed(data: bytes) -> None:
        head, *frames = data.split(_MAGIC)
        answers[:] = [_MAGIC + frame for frame in frames] or [head]
        session = client.Session((HOST, port), tls=False, timeout_s=0.3)
        try:
            session.connect()
            memory = session.service("ALMemory")
            memory.call("getData", "key", timeout_s=0.3)
            session.services()
        finally:
            session.close()

    with socket.create_server((HOST, 0)) as door:
        port = int(door.getsockname()[1])
        client.reach = near
        threading.Thread(target=serve, daemon=True).start()
        try:
            yield feed
        finally:
            client.reach = reach


def _answer(caller: socket.socket, answers: Sequence[bytes], reader: Any, call: int) -> None:
    """Answer calls with frames that have their numbers; end with the last frame."""
    caller.settimeout(0.05)  # a client that waits for another answer waits no longer
    left = iter(tuple(answers))
    with contextlib.suppress(OSError):
        while data := caller.recv(65536):
            for frame in reader.take(data):
                if frame.kind != call:
                    continue
                if (answer := next(left, None)) is None:
                    return
                caller.sendall(answer[:4] + frame.number.to_bytes(4, "little") + answer[8:])


TARGETS = {
    one.name: one
    for one in (
        Target("naoqi", naoqi, _naoqi_changed),
        Target("requests", requests, json_changed),
        Target("robot", robot, _naoqi_changed),
    )
}
