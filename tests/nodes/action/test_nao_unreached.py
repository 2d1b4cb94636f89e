from __future__ import annotations

import queue
import socket
import threading
import time
from collections.abc import Iterator

import pytest

from nep_core.errors import ActionFailed, ParameterError
from nodes.action.naobody.actions import Turn
from nodes.action.naobody.unreached import (
    LONGEST_PAUSE_S,
    Address,
    UnreachedNao,
    answers,
    read_address,
)


@pytest.fixture
def listening_port() -> Iterator[int]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server.getsockname()[1]


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("192.168.1.10", ("192.168.1.10", 9559)),
        (" nao.local ", ("nao.local", 9559)),
        ("127.0.0.1:9600", ("127.0.0.1", 9600)),
    ],
)
def test_an_address_may_name_a_port(text: str, address: Address) -> None:
    assert read_address(text) == address


@pytest.mark.parametrize(
    "text", ["", " ", ":9559", "nao:", "nao:0", "nao:70000", "nao:x", "http://nao", "my nao", "a:²"]
)
def test_text_that_is_no_address_is_refused_with_what_to_do(text: str) -> None:
    with pytest.raises(ParameterError, match="is not the address of a robot") as told:
        read_address(text)

    assert "chest button" in told.value.checklist[0]


def test_a_listening_port_answers_and_a_closed_one_does_not(
    listening_port: int, free_port: int
) -> None:
    assert answers(("127.0.0.1", listening_port))
    assert not answers(("127.0.0.1", free_port))
    assert not answers(("a..b", 9559))


class Knocks:
    """Stands in for the network: each knock waits for the answer that the test gives it."""

    def __init__(self) -> None:
        self.knocked: queue.SimpleQueue[threading.Event] = queue.SimpleQueue()
        self.answer = False

    def __call__(self, address: Address) -> bool:
        may_answer = threading.Event()
        self.knocked.put(may_answer)
        may_answer.wait(5)
        return self.answer

    def end(self, robot: UnreachedNao, now_s: float) -> None:
        """Let the knock that is under way answer, and the robot hear it."""
        self.knocked.get(timeout=5).set()
        end_s = time.monotonic() + 5
        while robot._trying and time.monotonic() < end_s:
            robot.step(now_s)


def test_a_robot_that_does_not_answer_is_told_with_a_checklist_and_fails_every_action() -> None:
    knocks = Knocks()
    robot = UnreachedNao("NAO", "192.168.1.10", knocks)
    robot.connect()
    before = robot.connection
    knocks.end(robot, 0.0)

    sentence, *checklist = robot.connection.description.splitlines()
    assert before == ("connecting", "Looking for NAO at 192.168.1.10.")
    assert robot.connection.event == "connection_failed"
    assert sentence.startswith("NAO does not answer") and "192.168.1.10" in sentence
    assert len(checklist) == 4 and all(line.startswith("[ ] ") for line in checklist)
    with pytest.raises(ActionFailed) as told:
        robot.limbs(Turn(90.0))
    assert told.value.sentence == sentence
    assert robot.state() is None


def test_it_keeps_trying_after_longer_and_longer_pauses() -> None:
    knocks = Knocks()
    robot = UnreachedNao("NAO", "192.168.1.10", knocks)
    robot.connect()
    now_s, pauses_s = 0.0, []
    for _ in range(7):
        knocks.end(robot, now_s)
        failed_s = now_s
        while not robot._trying:
            now_s += 0.5
            robot.step(now_s)
        pauses_s.append(now_s - failed_s)

    assert pauses_s == [1, 2, 4, 8, 16, LONGEST_PAUSE_S, LONGEST_PAUSE_S]
    knocks.end(robot, now_s)


def test_when_something_answers_it_says_honestly_that_it_cannot_drive_it() -> None:
    knocks = Knocks()
    robot = UnreachedNao("NAO", "192.168.1.10", knocks)
    robot.connect()
    knocks.answer = True

    knocks.end(robot, 0.0)

    assert robot.connection.event == "connection_failed"
    assert "can drive the virtual NAO only" in robot.connection.description
