"""What goes wrong between client and server: a sentence, in time, and nothing hangs."""

import contextlib
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator

import psutil
import pytest
from naoqi_lamp import CERTIFICATE, KEY, child, lamp_server, until

from robots.naoqi.client.session import Session, is_about_login
from robots.naoqi.server.server import Server
from robots.naoqi.wire.errors import (
    ConnectionLost,
    LoginRefused,
    NaoqiError,
    NeedsTls,
    NoAnswer,
    NoTls,
    NotNaoqi,
    Refused,
    StrangeCertificate,
)
from robots.naoqi.wire.line import HEADER, MAGIC, Frame, Kind, Login, TlsFiles
from robots.naoqi.wire.remote import RemoteObject

LOGIN = Login("nao", "secret")
FILES = TlsFiles(CERTIFICATE, KEY)
GIGABYTE = HEADER.pack(MAGIC, 1, 2**30, 0, Kind.REPLY, 0, 0, 0, 8)
HALF = Frame(Kind.REPLY, 1, 0, 0, 8, bytes(100)).encoded()[:60]
ENOUGH_S = 6.0
"""Half of that on a quiet computer."""
only_posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGSTOP")


@contextlib.contextmanager
def in_time() -> Iterator[None]:
    """Fail when what is within takes three seconds."""
    start_s = time.monotonic()
    yield
    assert time.monotonic() - start_s < ENOUGH_S


@contextlib.contextmanager
def answering(serve: Callable[[socket.socket], None]) -> Iterator[int]:
    """A server that does what it is told with each connection; its port."""
    listener = socket.create_server(("127.0.0.1", 0))
    open_ones: list[socket.socket] = []

    def accept() -> None:
        with contextlib.suppress(OSError):
            while True:
                connected, _ = listener.accept()
                open_ones.append(connected)
                serve(connected)

    thread = threading.Thread(target=accept)
    thread.start()
    try:
        yield listener.getsockname()[1]
    finally:
        with contextlib.suppress(OSError):
            listener.shutdown(socket.SHUT_RDWR)
        listener.close()
        thread.join()
        for one in open_ones:
            one.close()


def failure(port: int, **settings: object) -> NaoqiError:
    """Connect; return why that failed, after less than three seconds."""
    with in_time(), pytest.raises(NaoqiError) as caught:
        Session(("127.0.0.1", port), **settings).connect()  # type: ignore[arg-type]
    assert str(caught.value.sentence).endswith(".")
    assert caught.value.checklist
    return caught.value


def freeze(pid: int) -> None:
    """Stop a process where it is; it goes on with SIGCONT."""
    os.kill(pid, signal.SIGSTOP)
    until(lambda: psutil.Process(pid).status() == psutil.STATUS_STOPPED)


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", NotNaoqi),
        (b"SSH-2.0-OpenSSH_9.0\r\n", NotNaoqi),
        (bytes(200), NotNaoqi),
        (GIGABYTE, NotNaoqi),
        (HALF, NoAnswer),
        (b"", NoAnswer),
    ],
    ids=["HTTP", "SSH", "zeros", "a gigabyte", "half a frame", "silence"],
)
def test_what_does_not_answer_as_a_robot_is_named(data: bytes, expected: type) -> None:
    patience = {"timeout_s": 0.5} if expected is NoAnswer else {}
    with answering(lambda connected: connected.sendall(data)) as port:
        assert type(failure(port, **patience)) is expected


def test_what_hangs_up_is_not_a_robot() -> None:
    with answering(lambda connected: connected.close()) as port:
        assert isinstance(failure(port), NotNaoqi)


def test_a_wrong_port_is_named() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]

    problem = failure(port)

    assert isinstance(problem, Refused)
    assert str(problem.sentence) == f"Nothing listens at 127.0.0.1:{port}."


@pytest.mark.parametrize("tls_files", [None, FILES])
@pytest.mark.parametrize("login", [None, Login("nao", "wrong"), Login("other", "secret")])
def test_a_login_that_is_wrong_or_missing_is_refused(
    login: Login | None, tls_files: TlsFiles | None
) -> None:
    with lamp_server(login=LOGIN, tls_files=tls_files) as (_, server):
        problem = failure(server.port, login=login)

    assert isinstance(problem, LoginRefused)
    assert ("does not accept" in str(problem.sentence)) == (login is not None)


@pytest.mark.parametrize(
    ("said", "refuses"),
    [
        ("Authentication failed", True),
        ("Authentication failed: Invalid user or token. [1.0]", True),
        (
            "Expected authentication (service #0, type #1, action #8), received service #0, "
            "type #1, action #100",
            True,
        ),
        ("Can't find function id 8", False),
        ("", False),
    ],
)
def test_a_robot_that_refuses_the_login_is_told_from_one_that_knows_none(
    said: str, refuses: bool
) -> None:
    assert is_about_login(said) == refuses


def test_a_plain_client_is_told_to_encrypt() -> None:
    with lamp_server(tls_files=FILES) as (_, server):
        assert isinstance(failure(server.port, tls=False), NeedsTls)


def test_an_encrypting_client_is_told_that_the_port_is_plain() -> None:
    with lamp_server() as (_, server):
        assert isinstance(failure(server.port, tls=True), NoTls)


def test_another_certificate_than_the_trusted_one_is_refused_before_the_password_is_told() -> None:
    with lamp_server(login=LOGIN, tls_files=FILES) as (_, server):
        problem = failure(server.port, login=LOGIN, trusted="00:11")

    assert isinstance(problem, StrangeCertificate)


def test_a_password_is_not_written_where_a_login_is_shown() -> None:
    assert "secret" not in repr(LOGIN)


def test_a_server_killed_in_a_call_is_noticed_at_once() -> None:
    lost: list[str] = []
    with child("naoqi_lamp.py") as (process, port):
        session = Session(("127.0.0.1", port))
        session.on_lost = lost.append
        session.connect()
        lamp = session.service("Lamp")
        going = lamp.begin("goToPosture", "Sit", 0.5)

        process.kill()

        with in_time(), pytest.raises(ConnectionLost, match="has ended"):
            going.result(ENOUGH_S)
        until(lambda: lost == ["The connection to NAO has ended."])
        with pytest.raises(ConnectionLost):
            lamp.call("say", "a")


@only_posix
def test_a_frozen_server_is_told_in_time_and_used_again_when_it_goes_on() -> None:
    with child("naoqi_lamp.py") as (process, port):
        session = Session(("127.0.0.1", port))
        session.connect()
        lamp = session.service("Lamp")

        freeze(process.pid)  # the usual patience is waited for once, and again a short one
        with in_time(), pytest.raises(NoAnswer, match="NAO has not answered say"):
            lamp.call("say", "a")
        assert isinstance(failure(port, timeout_s=0.5), NoAnswer)
        os.kill(process.pid, signal.SIGCONT)

        assert lamp.call("say", "a") == "s a"
        session.close()


@only_posix
def test_sending_to_a_frozen_server_does_not_wait() -> None:
    with child("naoqi_lamp.py") as (process, port):
        session = Session(("127.0.0.1", port))
        session.connect()
        lamp = session.service("Lamp")
        freeze(process.pid)

        with in_time():
            going = [lamp.begin("raw", bytes(1_000_000)) for _ in range(20)]
        os.kill(process.pid, signal.SIGCONT)

        assert going[-1].result(20.0) == bytes(1_000_000)
        session.close()


@pytest.mark.parametrize(
    "data", [b"garbage", GIGABYTE, bytes(1000)], ids=["text", "a gigabyte", "zeros"]
)
def test_a_server_that_goes_mad_ends_the_connection_with_a_sentence(data: bytes) -> None:
    lost: list[str] = []
    with lamp_server() as (lamp, server):
        session = Session(("127.0.0.1", server.port))
        session.on_lost = lost.append
        session.connect()
        going = session.service("Lamp").begin("goToPosture", "Sit", 0.5)
        until(lambda: lamp.going)

        [peer] = server._peers
        peer.line._socket.send(data)

        with in_time(), pytest.raises(ConnectionLost):
            going.result(ENOUGH_S)
        until(lambda: lost)


@pytest.mark.parametrize(
    "data",
    [b"GET / HTTP/1.1\r\n\r\n", GIGABYTE, HALF, b"\x16\x03\x01\x02"],
    ids=["HTTP", "a gigabyte", "half a frame", "TLS"],
)
def test_a_mad_client_does_not_disturb_the_others(
    data: bytes, lamp_serving: tuple[object, Server], lamp_remote: RemoteObject
) -> None:
    with socket.create_connection(("127.0.0.1", lamp_serving[1].port)) as mad:
        mad.sendall(data)
        if data != HALF:
            mad.settimeout(ENOUGH_S)
            assert mad.recv(100) == b""

        assert lamp_remote.call("say", "a") == "s a"
    until(lambda: lamp_serving[1].clients == 1)


def test_a_client_that_does_not_read_its_events_does_not_hold_up_the_others(
    lamp_serving: tuple[object, Server], lamp_remote: RemoteObject
) -> None:
    got: list[object] = []
    lamp_remote.connect("touched", got.append)
    with socket.create_connection(("127.0.0.1", lamp_serving[1].port)) as deaf:
        uid = next(it.uid for it in lamp_remote._meta.signals.values() if it.name == "touched")
        link = (1).to_bytes(4, "little") + uid.to_bytes(4, "little") + (1).to_bytes(8, "little")
        deaf.sendall(Frame(Kind.CALL, 1, 2, 1, 0, link).encoded())
        assert deaf.recv(28)

        for _ in range(40):
            lamp_remote.call("raiseEvent", "big", "x" * 300_000)

        until(lambda: len(got) == 40)
