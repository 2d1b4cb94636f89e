"""Our driver and a robot that it drives: a virtual NAO behind NAOqi, in a process of its own."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec

from nodes.resources import model_folder, resource_folder
from robots.body.actor import FINAL, Actor
from robots.body.animations import load_animations
from robots.body.body import load_body
from robots.body.driver import ActionRequest, ActionResult, RobotState, SenseRequest
from robots.body.pose import VirtualRobot
from robots.naoqi.driver.driver import NaoqiDriver

NAO = resource_folder() / "robots" / "nao"
BODY = load_body(NAO)
ANIMATIONS = load_animations(NAO / "animations", BODY)
SERVER = Path(__file__).with_name("nao_in_a_process.py")
PATIENCE_S = 40.0


class ServedNao:
    """The robot at the other end: what it is told to sense, and how it really is."""

    def __init__(
        self, port: int = 0, speed: float = 20.0, password: str = "", model: str = "nao"
    ) -> None:
        command = [sys.executable, str(SERVER), str(port), str(speed), password, model]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        assert self.process.stdout is not None
        self.port = int(self.process.stdout.readline())

    @property
    def address(self) -> str:
        return f"127.0.0.1:{self.port}"

    def state(self) -> RobotState:
        return self._ask("state")

    def sense(self, what: str, value: float = 1.0, **more: Any) -> None:
        request = SenseRequest(robot="NAO", sense=what, value=value, **more)
        self._ask(f"sense {msgspec.json.encode(request).decode()}")

    def close(self) -> None:
        self.process.kill()
        self.process.wait(10)
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                pipe.close()

    def _ask(self, line: str) -> RobotState:
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return msgspec.json.decode(self.process.stdout.readline(), type=RobotState)


class DriverStage:
    """An actor with our driver; ``told`` are results as text such as "1 started"."""

    def __init__(self, address: str, model: str = "nao", *, takes_over: bool = False) -> None:
        folder = model_folder(model)
        body = load_body(folder)
        animations = load_animations(folder / "animations", body)
        known = VirtualRobot("NAO", body, animations)
        self.driver = NaoqiDriver(known, address, takes_over=takes_over)
        self.actor = Actor("NAO", self.driver)
        self.results: list[ActionResult] = []
        self.noticed: list[str] = []
        self.driver.connect()

    @property
    def told(self) -> list[str]:
        return [f"{result.id} {result.state}" for result in self.results]

    @property
    def event(self) -> str:
        return self.driver.connection.event

    def step(self) -> None:
        self.results += self.actor.step(time.monotonic())
        self.noticed += self.actor.noticed()
        time.sleep(0.002)

    def until(self, is_so: Callable[[], object], at_most_s: float = PATIENCE_S) -> float:
        """Go on until something is so; the seconds that took."""
        start_s = time.monotonic()
        while not is_so():
            passed_s = time.monotonic() - start_s
            assert passed_s < at_most_s, f"not in {at_most_s} s: {self.driver.connection}"
            self.step()
        return time.monotonic() - start_s

    def meet(self) -> None:
        """Go on until the robot is connected and its state is known."""
        self.until(lambda: self.event == "connected" and self.driver.state() is not None)

    def ask(self, id: str, action: str, **args: Any) -> None:
        request = ActionRequest(id=id, robots=["NAO"], action=action, args=args)
        self.results += self.actor.request(request)
        self.step()

    def end_of(self, id: str) -> ActionResult:
        def ended() -> list[ActionResult]:
            return [one for one in self.results if one.id == id and one.state in FINAL]

        self.until(ended)
        return ended()[0]

    def do(self, action: str, **args: Any) -> ActionResult:
        """Ask, wait for the end, and return how it ended."""
        id = f"{action} {len(self.results)}"
        self.ask(id, action, **args)
        return self.end_of(id)

    def close(self) -> None:
        self.driver.disconnect()
