"""A free walk on a clock that a test turns: our driver's task, ALMotion, and the line between them.

So how long a robot goes on is measured in its own time, however slow the computer is. Both ends are
the real ones; only the line is made of a list of what is on its way.
"""

from __future__ import annotations

import heapq
import itertools
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from driver_stage import ANIMATIONS, BODY, NAO

from robots.body.actions import WalkFreely
from robots.body.actor import Actor
from robots.body.pose import VirtualRobot
from robots.body.virtual import VirtualDriver
from robots.naoqi.driver import calls, stepping
from robots.naoqi.driver.calls import Calls
from robots.naoqi.driver.moving import walk_freely
from robots.naoqi.driver.real import RealRobot
from robots.naoqi.services import motion
from robots.naoqi.services.all import Services
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.promise import Pending

TICK_S, ROBOT_S, DRIVER_S = 0.002, 0.01, 0.005
"""So often anything changes, the robot goes on, and the driver does."""
STILL_S = 0.3
METHODS = {
    "moveTo": "move_to",
    "getNextRobotPosition": "next_robot_position",
    "stopMove": "stop_move",
    "moveIsActive": "move_is_active",
}


class Line:
    """ALMotion at the other end of a line that needs some time each way."""

    methods = METHODS

    def __init__(self, motion: Any, latency_s: Callable[[], float]) -> None:
        self.is_frozen = False
        self.now_s = 0.0
        self.asked_s: dict[str, list[float]] = {name: [] for name in METHODS}
        self._motion, self._latency_s = motion, latency_s
        self._number = itertools.count()
        self._due: list[tuple[float, int, Callable[[], None]]] = []
        self._last_s = [0.0, 0.0]

    def begin(self, method: str, *args: Any) -> Pending:
        answer = Pending()
        self._send(0, lambda: self._ask(method, args, answer))
        return answer

    def pass_on(self) -> None:
        """Let what is due arrive."""
        while not self.is_frozen and self._due and self._due[0][0] <= self.now_s:
            heapq.heappop(self._due)[2]()

    def _ask(self, method: str, args: tuple[Any, ...], answer: Pending) -> None:
        self.asked_s[method].append(self.now_s)
        found = getattr(self._motion, METHODS[method])(*args)
        if isinstance(found, Pending):
            found.when_done(lambda done: self._send(1, lambda: _settle(answer, done.value)))
        else:
            self._send(1, lambda: _settle(answer, found))

    def _send(self, way: int, what: Callable[[], None]) -> None:
        # In order, as over TCP
        self._last_s[way] = max(self.now_s + self._latency_s(), self._last_s[way])
        heapq.heappush(self._due, (self._last_s[way], next(self._number), what))


def _settle(answer: Pending, value: Any) -> None:
    answer.settle([float(np.float32(one)) for one in value] if isinstance(value, list) else value)


class ClockedWalk:
    """A robot that walks freely; ``now_s`` is the time of both ends."""

    def __init__(
        self, monkeypatch: pytest.MonkeyPatch, latency_s: float = 0.0, seed: int = 0
    ) -> None:
        self.now_s, self.chance = 0.0, random.Random(seed)
        for module in (calls, stepping, motion):
            monkeypatch.setattr(module, "time", self)
        self.robot = VirtualRobot("NAO", BODY, ANIMATIONS, "StandInit")
        self._driver = VirtualDriver(self.robot)
        self._actor = Actor("NAO", self._driver)
        self._served = ServedRobot(self._actor, self.robot)
        self.motion = Services(self._served, Path(NAO)).by_name["ALMotion"]
        self.line = Line(self.motion, lambda: latency_s * self.chance.uniform(0.8, 1.2))
        self._known = VirtualRobot("NAO", BODY, ANIMATIONS, "StandInit")
        self.calls = Calls("NAO", {"ALMotion": self.line}, BODY.names)  # type: ignore[dict-item]
        self._task: Any = None
        self._driver_s = self._robot_s = 0.0

    def monotonic(self) -> float:
        """The time, for who asks the module for it."""
        return self.now_s

    @property
    def base(self) -> tuple[float, ...]:
        return tuple(np.round(self.robot.base, 5).tolist())

    def begin(self, **speeds: float) -> None:
        self._task = walk_freely(RealRobot(self._known, self.calls), WalkFreely(**speeds))

    def end_driver(self) -> None:
        """Let the driver be gone, which says nothing to a frozen line."""
        self._task.close()
        self._task = None

    def hold_up_driver(self, until_s: float) -> None:
        """Let the driver stand still, as on a busy computer."""
        self._driver_s = until_s

    def until(self, is_so: Callable[[], bool], at_most_s: float = 60.0) -> float:
        """Let time pass until something is so; how long that took."""
        begun_s = self.now_s
        while not is_so():
            assert self.now_s < begun_s + at_most_s, "it does not come to that"
            self._pass_tick()
        return self.now_s - begun_s

    def pass_time(self, seconds: float) -> None:
        end_s = self.now_s + seconds
        self.until(lambda: self.now_s >= end_s)

    def rests_after(self) -> tuple[float, float, float]:
        """How long it walks on as it says, how long it gets on, and how long its joints move."""
        begun_s, moved_s, place = self.now_s, self.now_s, self.base
        active_s = turned_s = begun_s
        while self.now_s < max(active_s, moved_s, turned_s) + STILL_S:
            self._pass_tick()
            if self._robot_s < self.now_s + ROBOT_S - TICK_S / 2.0:
                continue  # nothing has changed since
            if self.motion.move_is_active():
                active_s = self.now_s
            if self._driver.moves_joints:
                turned_s = self.now_s
            if self.base != place:
                place, moved_s = self.base, self.now_s
        return active_s - begun_s, moved_s - begun_s, turned_s - begun_s

    def _pass_tick(self) -> None:
        self.now_s += TICK_S
        self.line.now_s = self.now_s
        if self.now_s >= self._robot_s:
            self._robot_s = self.now_s + ROBOT_S
            with self._served.lock:
                told = self._actor.step(self.now_s)
            self._served.hear(told)
        self.line.pass_on()
        if self.now_s >= self._driver_s:
            self._driver_s = self.now_s + DRIVER_S * self.chance.uniform(0.5, 1.5)
            self.calls.step()
            if self._task is not None:
                next(self._task)
