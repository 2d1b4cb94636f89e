"""Bytes at random and real messages with mistakes in them: both sides live on."""

import contextlib
import random
import socket
import threading
from collections.abc import Callable, Iterator

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from naoqi_lamp import lamp_server

from robots.naoqi.client.session import Session
from robots.naoqi.server.server import Server
from robots.naoqi.wire.codec import encode
from robots.naoqi.wire.errors import NaoqiError
from robots.naoqi.wire.line import Frame, Kind
from robots.naoqi.wire.remote import RemoteObject

pytestmark = pytest.mark.long

BOUNDED = settings(
    max_examples=20,  # each of some seconds of waiting for answers that do not come
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
LAMP = 2
REAL = [
    Frame(Kind.CALL, 1, 0, 0, 8, encode("{sm}", {"MessageFlags": True})),
    Frame(Kind.CALL, 2, 1, 1, 2, encode("(I)", (1,))),
    Frame(Kind.CALL, 3, 1, 1, 100, encode("(s)", ("Lamp",))),
    Frame(Kind.CALL, 4, 1, 1, 102, encode("((sIsI[s]ss))", (("New", 0, "", 1, [], "", ""),))),
    Frame(Kind.CALL, 5, 1, 1, 104, encode("(I)", (3,))),
    Frame(Kind.CALL, 6, LAMP, 1, 0, encode("(IIL)", (1, 130, 1))),
    Frame(Kind.CALL, 7, LAMP, 1, 5, encode("(m)", ("level",))),
    Frame(Kind.CALL, 8, LAMP, 1, 6, encode("(mm)", ("level", 0.5))),
    *(Frame(Kind.CALL, 9, LAMP, 1, uid, encode("(m)", ([1, "a"],))) for uid in range(100, 135)),
    Frame(Kind.CALL, 10, LAMP, 1, 120, encode("m", ("a", 1)), 1),
    Frame(Kind.POST, 11, LAMP, 1, 120, encode("(s)", ("a",))),
    Frame(Kind.CANCEL, 12, LAMP, 1, 0, encode("I", 9)),
    Frame(Kind.CAPABILITY, 13, 0, 0, 0, encode("{sm}", {"a": 1})),
]


def mutated(data: bytes, chance: random.Random) -> bytes:
    """Return bytes with a few mistakes; the first sixteen of each frame mostly stay as they are."""
    changed = bytearray(data)
    for _ in range(chance.randint(1, 6)):
        at = chance.randrange(len(changed)) if chance.random() < 0.2 else _behind(changed, chance)
        match chance.randrange(4):
            case 0:
                changed[at] = chance.randrange(256)
            case 1:
                changed[at] ^= 1 << chance.randrange(8)
            case 2:
                changed[at : at + 4] = b"\xff\xff\xff\x7f"
            case _:
                del changed[at : at + chance.randint(1, 8)]
        if not changed:
            return b""
    return bytes(changed)


def _behind(data: bytearray, chance: random.Random) -> int:
    return chance.randrange(min(16, len(data) - 1), len(data))


def conversation(number: int) -> bytes:
    """Return what a client says that makes mistakes, or never knew better."""
    chance = random.Random(number)
    frames = b"".join(
        frame.encoded() if chance.random() < 0.5 else mutated(frame.encoded(), chance)
        for frame in chance.sample(REAL, 8)
    )
    return frames if chance.random() < 0.9 else chance.randbytes(200)


@BOUNDED
@given(number=st.integers(0, 2**32))
def test_a_server_lives_on_whatever_a_client_says(
    number: int, lamp_serving: tuple[object, Server], lamp_remote: RemoteObject
) -> None:
    with socket.create_connection(("127.0.0.1", lamp_serving[1].port)) as mad:
        mad.sendall(conversation(number))
        mad.shutdown(socket.SHUT_WR)
        mad.settimeout(3.0)
        try:
            while mad.recv(65536):
                pass
        except ConnectionResetError:
            pass

    assert lamp_remote.call("say", "a") == "s a"


class Between:
    """Stands between a client and a server and changes what the server says."""

    def __init__(self, port: int, change: Callable[[bytes], bytes]) -> None:
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._server_port = port
        self._change = change
        self._sockets: list[socket.socket] = []
        self._threads = [threading.Thread(target=self._accept)]
        self._threads[0].start()

    def close(self) -> None:
        for one in (self._listener, *self._sockets):
            with contextlib.suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
        for thread in self._threads:
            thread.join()
        for one in (self._listener, *self._sockets):
            one.close()

    def _accept(self) -> None:
        try:
            while True:
                near, _ = self._listener.accept()
                far = socket.create_connection(("127.0.0.1", self._server_port))
                self._sockets += [near, far]
                for source, goal, change in ((near, far, bytes), (far, near, self._change)):
                    thread = threading.Thread(target=self._pass, args=(source, goal, change))
                    self._threads.append(thread)
                    thread.start()
        except OSError:
            pass

    def _pass(
        self, source: socket.socket, goal: socket.socket, change: Callable[[bytes], bytes]
    ) -> None:
        try:
            while data := source.recv(65536):
                goal.sendall(change(data))
            goal.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    with lamp_server() as (_, server):
        yield server.port


@BOUNDED
@given(number=st.integers(0, 2**32))
def test_a_client_lives_on_whatever_a_server_says(number: int, port: int) -> None:
    chance = random.Random(number)
    between = Between(port, lambda data: mutated(data, chance) if chance.random() < 0.4 else data)
    session = Session(("127.0.0.1", between.port), timeout_s=0.1, tls=False)
    try:
        session.connect()
        lamp = session.service("Lamp")
        lamp.connect("touched", lambda *_: None)
        for call in (("say", "a"), ("raiseEvent", "k", 1), ("echo", [1]), ("subscriber", "k")):
            with contextlib.suppress(NaoqiError):
                lamp.call(*call, timeout_s=0.1)
    except NaoqiError:
        pass
    finally:
        session.close()
        between.close()
