"""A virtual NAO that NAOqi programs reach, living in a thread of the test, as in its node."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from nep_core.places import robot_folder
from nodes.resources import model_of
from robots.body.actor import Actor
from robots.body.animations import Animations, load_animations
from robots.body.body import Body, load_body
from robots.body.driver import ActionRequest, ActionResult, RobotState, SenseRequest
from robots.body.pose import VirtualRobot
from robots.body.speech import load_gesture_words
from robots.body.virtual import VirtualDriver
from robots.naoqi.client.session import Session
from robots.naoqi.services.all import Offered
from robots.naoqi.wire.remote import RemoteObject

NAO = Path(__file__).resolve().parents[3] / "resources" / "robots" / "nao"


@cache
def known(folder: Path) -> tuple[Body, Animations]:
    """The body and the animations of a robot; reading them takes longer than most tests."""
    body = load_body(folder)
    return body, load_animations(folder / "animations", body)


BODY, ANIMATIONS = known(NAO)
LOOP_S = 0.005
WAIT_S = 20.0


class NaoqiTheatre:
    """The robot, its server at a free port, and one client; ``speed``: times real time."""

    def __init__(self, speed: float = 1.0, folder: Path = NAO) -> None:
        body, animations = known(folder)
        words = load_gesture_words(folder)
        self.robot = VirtualRobot(
            "NAO",
            body,
            animations,
            gesture_words=words,
            model=model_of(folder),
            files=robot_folder("NAO"),
        )
        self.driver = VirtualDriver(self.robot)
        self.actor = Actor("NAO", self.driver)
        self.driver.connect()
        self.offered = Offered(self.actor, self.robot, folder, 0)
        self.results: list[ActionResult] = []
        self._felt: list[SenseRequest] = []
        self._speed = speed
        self._is_over = threading.Event()
        self.offered.hear([], [])  # what changes from now on is news
        self._life = threading.Thread(target=self._live, daemon=True)
        self._life.start()
        self.session = Session(("127.0.0.1", self.offered.port))
        self.session.connect()

    def service(self, name: str) -> RemoteObject:
        return self.session.service(name)

    def call(self, service: str, method: str, *arguments: Any, timeout_s: float = WAIT_S) -> Any:
        return self.session.service(service).call(method, *arguments, timeout_s=timeout_s)

    def state(self) -> RobotState:
        return self.offered.robot.state()

    def joint(self, name: str) -> float:
        return self.state().joints[name]

    def feel(self, sense: str, value: float = 1.0, **of: Any) -> None:
        """Let the robot feel, see or hear something, as the studio's person does."""
        request = SenseRequest(robot="NAO", sense=sense, value=value, **of)
        with self.offered.lock:
            self.actor.sense(request)
            self._felt.append(request)

    def ask(self, id: str, action: str, **args: Any) -> None:
        """Let the network ask the robot to act, beside the NAOqi programs."""
        request = ActionRequest(id=id, robots=["NAO"], action=action, args=args)
        with self.offered.lock:
            told = self.actor.request(request)
        self.results += self.offered.hear(told, [])

    def until(self, condition: Callable[[], bool], timeout_s: float = WAIT_S) -> None:
        """Wait for something; fails when it does not come."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end_s, "it did not happen"
            time.sleep(LOOP_S)

    def close(self) -> None:
        self.session.close()
        self._is_over.set()
        self._life.join()
        self.offered.close()

    def _live(self) -> None:
        start_s = time.monotonic()
        while not self._is_over.wait(LOOP_S):
            with self.offered.lock:
                told = self.actor.step((time.monotonic() - start_s) * self._speed)
                felt, self._felt = self._felt, []
            self.results += self.offered.hear(told, felt)
