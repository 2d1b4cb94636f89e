"""A virtual NAO on a fake clock: a test asks it to act, lets time pass, and reads what happened."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from nep_core.places import robot_folder
from robots.body.actor import FINAL, Actor
from robots.body.animations import load_animations
from robots.body.body import Angles, load_body
from robots.body.driver import ActionRequest, ActionResult
from robots.body.pose import VirtualRobot
from robots.body.speech import load_gesture_words
from robots.body.virtual import VirtualDriver

NAO = Path(__file__).resolve().parents[3] / "resources" / "robots" / "nao"
BODY = load_body(NAO)
ANIMATIONS = load_animations(NAO / "animations", BODY)
TICK_S, FAST_S = 0.01, 0.32


class Stage:
    """One actor; results are kept as text such as "1 started", angles and bases of every tick."""

    def __init__(self, posture: str = "Stand") -> None:
        words = load_gesture_words(NAO)
        self.robot = VirtualRobot(
            "NAO", BODY, ANIMATIONS, posture, words, files=robot_folder("NAO")
        )
        self.driver = VirtualDriver(self.robot)
        self.actor = Actor("NAO", self.driver)
        self.now_s = 0.0
        self.results: list[ActionResult] = []
        self.angles: list[Angles] = [self.robot.angles.copy()]
        self.bases: list[Angles] = [self.robot.base.copy()]

    @property
    def told(self) -> list[str]:
        return [f"{result.id} {result.state}" for result in self.results]

    def ask(self, id: str, action: str, priority: int = 0, *, by: str = "", **args: Any) -> None:
        request = ActionRequest(
            id=id, robots=["NAO"], action=action, args=args, priority=priority, by=by
        )
        self.results += self.actor.request(request)

    def pass_time(self, seconds: float) -> None:
        for _ in range(round(seconds / TICK_S)):
            self.now_s += TICK_S
            self.results += self.actor.step(self.now_s)
            self.angles.append(self.robot.angles.copy())
            self.bases.append(self.robot.base.copy())

    def finish(self, at_most_s: float = 300.0) -> float:
        """Let time pass until the robot rests; the seconds that took."""
        start_s = self.now_s
        self.pass_time(TICK_S)
        while self.driver.is_busy or self.actor.schedule.waiting:
            self.pass_time(TICK_S)
            assert self.now_s - start_s < at_most_s, "it never ends"
        return self.now_s - start_s

    def live_fast(self, action: str, **args: Any) -> ActionResult:
        """Ask, and live eight times as fast as real time; the angles of ticks are not kept."""
        self.ask("fast", action, **args)
        while self.results[-1].state not in FINAL:
            self.now_s += FAST_S
            self.results += self.actor.step(self.now_s)
        return self.results[-1]

    def do(self, action: str, **args: Any) -> ActionResult:
        """Ask, wait for the end, and return how it ended."""
        self.ask(str(len(self.results)), action, **args)
        if self.results[-1].state not in FINAL:
            self.finish()
        return next(result for result in reversed(self.results) if result.state in FINAL)

    @property
    def relative_speeds(self) -> Angles:
        """How fast each joint was between ticks, as a part of its top speed."""
        return np.abs(np.diff(np.array(self.angles), axis=0)) / TICK_S / BODY.max_speed
