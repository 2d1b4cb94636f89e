"""Robots that announce themselves are found; the way to one is tested step by step."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Iterator

import pytest
from driver_stage import ServedNao
from zeroconf import DNSOutgoing, DNSPointer, ServiceInfo, Zeroconf

from robots.naoqi.discovery import SERVICE, FoundRobot, find_robots
from robots.naoqi.probe import STEPS, Check, probe
from robots.naoqi.server.server import Server
from robots.naoqi.wire.line import Login
from robots.naoqi.wire.service import method

LOOPBACK = "127.0.0.1"
ANSWER, POINTER, INTERNET = 0x8400, 12, 1
"""As RFC 1035 and 6762 number them."""


@contextlib.contextmanager
def announced(name: str, port: int) -> Iterator[None]:
    """A robot that says on this computer where it is."""
    network = Zeroconf(interfaces=[LOOPBACK])
    info = ServiceInfo(
        SERVICE,
        f"{name}.{SERVICE}",
        port=port,
        addresses=[socket.inet_aton(LOOPBACK)],
        server=f"{name}.local.",
    )
    network.register_service(info)
    try:
        yield
    finally:
        network.close()


@contextlib.contextmanager
def something_odd() -> Iterator[None]:
    """Something that says that it is a robot, by the name of another thing."""
    network, is_over = Zeroconf(interfaces=[LOOPBACK]), threading.Event()
    odd = DNSOutgoing(ANSWER)
    odd.add_answer_at_time(DNSPointer(SERVICE, POINTER, INTERNET, 120, "odd._lamp._tcp.local."), 0)

    def say() -> None:
        while not is_over.wait(0.05):
            network.send(odd)

    saying = threading.Thread(target=say)
    saying.start()
    try:
        yield
    finally:
        is_over.set()
        saying.join()
        network.close()


def test_a_robot_that_announces_itself_is_found_beside_what_is_none() -> None:
    found: list[FoundRobot] = []
    cancelled = threading.Event()

    def note(robot: FoundRobot) -> None:
        found.append(robot)
        cancelled.set()

    with something_odd(), announced("nao-blue", 9559):
        robots = find_robots(note, cancelled, seconds=10, interfaces=[LOOPBACK])

    assert robots == found == [FoundRobot("nao-blue", LOOPBACK, 9559)]
    assert robots[0].address == LOOPBACK


def test_the_search_ends_as_soon_as_nobody_wants_it() -> None:
    cancelled = threading.Event()
    cancelled.set()
    start_s = time.monotonic()

    robots = find_robots(lambda robot: None, cancelled, seconds=30, interfaces=[LOOPBACK])

    assert robots == []
    assert time.monotonic() - start_s < 15


def steps(checks: list[Check]) -> list[tuple[str, bool]]:
    return [(check.step, check.is_ok) for check in checks]


@pytest.fixture
def robot() -> Iterator[ServedNao]:
    made = ServedNao(password="right")
    yield made
    made.close()


def test_every_step_to_a_robot_is_told_and_the_last_one_says_how_it_is(robot: ServedNao) -> None:
    checks = list(probe(robot.address, Login("nao", "right")))

    assert steps(checks) == [(step, True) for step in STEPS]
    about = checks[-1].about
    assert about is not None and about.name and 0 < about.battery <= 1
    assert about.version.startswith("2.")


def test_a_wrong_password_and_none_stop_at_the_login(robot: ServedNao) -> None:
    wrong = list(probe(robot.address, Login("nao", "wrong"), "Anna"))
    none = list(probe(robot.address, None))

    assert steps(wrong) == [(step, step != "login") for step in STEPS[:4]]
    assert str(wrong[-1].sentence).startswith("Anna at") and "password" in str(wrong[-1].sentence)
    assert wrong[-1].checklist
    assert steps(none)[-1] == ("login", False)


def test_a_closed_port_stops_at_the_port(free_port: int) -> None:
    checks = list(probe(f"{LOOPBACK}:{free_port}", None))

    assert steps(checks) == [("name", True), ("port", False)]
    assert "chest button" in str(checks[-1].checklist[0])


@pytest.mark.parametrize("address", ["no robot", "nao:70000", "", "a..b"])
def test_what_is_no_address_stops_at_once(address: str) -> None:
    start_s = time.monotonic()

    [check] = probe(address, None)

    assert (check.step, check.is_ok) == ("name", False)
    assert check.checklist
    assert time.monotonic() - start_s < 10


def test_another_program_is_told_apart_from_a_robot() -> None:
    with socket.create_server((LOOPBACK, 0)) as server:
        threading.Thread(target=say_hello, args=(server,), daemon=True).start()

        checks = list(probe(f"{LOOPBACK}:{server.getsockname()[1]}", None))

    assert steps(checks)[-1] == ("naoqi", False)
    assert "not a NAOqi robot" in str(checks[-1].sentence)


def say_hello(server: socket.socket) -> None:
    with contextlib.suppress(OSError):
        while True:
            one, _ = server.accept()
            one.sendall(b"220 mail.example.org ESMTP ready\r\n" * 3)
            one.close()


class Lamp:
    @method("shine::v()")
    def shine(self) -> None:
        return


def test_a_robot_without_what_moves_it_is_told_by_the_names() -> None:
    server = Server({"Lamp": Lamp()}, port=0)
    port = server.start()
    try:
        checks = list(probe(f"{LOOPBACK}:{port}", None))
    finally:
        server.stop()

    assert steps(checks)[-1] == ("services", False)
    assert "ALMotion" in str(checks[-1].sentence)
