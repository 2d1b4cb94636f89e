"""A robot in a process of its own hears an answer that its question does not know."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator

import pytest

from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import tasks
from nep_core.program.human import heard_answer, human_listener
from nep_core.program.robot import Robot
from nep_core.program.tasks import wait, wait_until
from nep_core.wire.messages import ROBOT_STATE, SENSE_REQUEST, RobotState, SenseRequest
from nep_core.wire.pubsub import Publisher, Subscriber
from tests.node_running import NodeRunner

pytestmark = pytest.mark.long


class Questions(NodeRunner):
    """A robot, on the screen or over NAOqi, and a person who answers as soon as it listens."""

    def __init__(self, network: PeerNetwork, outside: PeerNetwork, driver: str) -> None:
        super().__init__(network)
        tasks.PROGRAM.cancelled.clear()
        human_listener(network)
        self._ears = "NAO" if driver == "virtual" else "Served"
        self._senses = Publisher(SENSE_REQUEST, network=outside)
        self._states: dict[str, RobotState] = {}
        Subscriber(ROBOT_STATE, RobotState, network=outside, callback=self._on_state)
        if driver == "virtual":
            self.start_node("action/nao", "NAO", robot="NAO")
        else:
            with socket.socket() as chosen:
                chosen.bind(("127.0.0.1", 0))
                port = chosen.getsockname()[1]
            self.start_node("action/nao", "Served", robot="Served", naoqi_port=port)
            self.state("ready", node="Served")
            address = f"127.0.0.1:{port}"
            self.start_node("action/nao", "NAO", robot="NAO", driver="naoqi", address=address)
        self.state("ready", node="NAO")
        self.robot = Robot("NAO")
        self.robot._state()

    def asked(self, answer: str) -> tuple[str, float]:
        """What the robot takes a word for, and after how many seconds."""
        wait_until(lambda: not self._listens())  # to the question before
        answering = threading.Thread(target=self._answer, args=(answer,))
        answering.start()
        begun_s = time.monotonic()
        word = self.robot.ask("Hm?", ["Yes", "No"], seconds=60)
        answering.join()
        return word, time.monotonic() - begun_s

    def _answer(self, answer: str) -> None:
        wait_until(self._listens)
        wait(1.0)  # nobody is quicker, and until then a robot may hear itself
        self._senses.send(SenseRequest(robot=self._ears, sense="word", name=answer))

    def _listens(self) -> bool:
        return all(self._states[name].listening for name in ("NAO", self._ears))

    def _on_state(self, state: RobotState) -> None:
        self._states[state.robot] = state


@pytest.fixture(params=["virtual", "naoqi"])
def questions(
    request: pytest.FixtureRequest, network: PeerNetwork, join: Callable[[str], PeerNetwork]
) -> Iterator[Questions]:
    made = Questions(network, join("outside"), request.param)
    yield made
    made.close()


def test_a_right_answer_is_taken_and_another_one_ends_the_question(questions: Questions) -> None:
    right, _ = questions.asked("yes")
    other, seconds = questions.asked("elephant")

    is_real = questions._ears == "Served"
    assert right == "Yes" and other == heard_answer() == ("" if is_real else "elephant")
    assert seconds < 30
