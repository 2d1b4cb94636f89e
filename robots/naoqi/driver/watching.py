"""Looks at a robot again and again: one call for all joints and sensors, a few for how it is set.

Nothing waits: what was asked is taken in when the answer is there.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from robots.errors import ActionFailed
from robots.naoqi.wire.errors import NaoqiError
from robots.naoqi.wire.promise import Pending

from . import real
from .moving import RESTING
from .real import RealRobot

MOVING_PERIOD_S = 1.0 / 30.0
RESTING_PERIOD_S = 0.15
SLOW_PERIOD_S = 1.0
FROZEN_S = 2.0
"""Who has not told its joints for so long does not answer any more."""

FRAME_WORLD = 1
"""NAOqi's number for where the robot has started."""

TakeIn = Callable[[Any], None]


class Watching:
    """Keeps the picture of one robot true. ``is_frozen``: it has not answered for too long."""

    def __init__(self, robot: RealRobot) -> None:
        self._robot = robot
        body = robot.known.body
        self._quick, self._slow = real.quick_keys(body), real.slow_keys(body)
        self._asked: list[tuple[Pending, float, TakeIn]] = []
        self._next_quick_s = self._next_slow_s = 0.0
        self._heat: tuple[str, float] = ("", 0.0)
        self.has_met = False
        """Whether it has told once where its joints are and how it is set."""
        self._has_told_joints = False

    @property
    def hottest(self) -> tuple[str, float]:
        """The joint with the hottest motor, and its °C."""
        return self._heat

    @property
    def is_frozen(self) -> bool:
        """Whether an answer is too late."""
        limit_s = time.monotonic() - FROZEN_S
        return any(asked_s < limit_s for _, asked_s, _ in self._asked)

    def step(self, *, is_moving: bool) -> None:
        """Take in what was answered, and ask what is due."""
        self._take_in()
        self.has_met = self.has_met or (self._has_told_joints and not self._asked)
        now_s = time.monotonic()
        if self._asked:  # a slow robot is asked less often, not more at once
            return
        if now_s >= self._next_quick_s:
            self._next_quick_s = now_s + (MOVING_PERIOD_S if is_moving else RESTING_PERIOD_S)
            self._ask(self._on_quick, "ALMemory", "getListData", self._quick)
            if is_moving:
                self._ask_place()
        if now_s >= self._next_slow_s:
            self._next_slow_s = now_s + SLOW_PERIOD_S
            self._ask_slowly()

    def _ask_slowly(self) -> None:
        settings = self._robot.known.settings
        self._ask(self._on_slow, "ALMemory", "getListData", self._slow)
        self._ask_place()
        self._ask(self._on_posture, "ALRobotPosture", "getPosture")
        self._ask(self._setter("awake"), "ALMotion", "robotIsWakeUp")
        self._ask(self._setter("awareness"), "ALBasicAwareness", "isEnabled")
        self._ask(self._setter("awareness"), "ALBasicAwareness", "isAwarenessRunning")
        self._ask(self._setter("breathing"), "ALMotion", "getBreathEnabled", "Body")
        self._ask(
            lambda value: settings.update(volume=float(value)), "ALAudioDevice", "getOutputVolume"
        )
        self._ask(
            lambda value: settings.update(language=real.language_code(value)),
            "ALTextToSpeech",
            "getLanguage",
        )

    def _ask_place(self) -> None:
        self._ask(self._on_base, "ALMotion", "getRobotPosition", True)
        self._ask(self._on_torso, "ALMotion", "getPosition", "Torso", FRAME_WORLD, True)

    def _ask(self, take_in: TakeIn, service: str, method: str, *args: Any) -> None:
        if not self._robot.calls.has(service, method):
            return
        try:
            pending = self._robot.calls.begin(service, method, *args)
        except ActionFailed:
            return  # the link is just being lost; who keeps it says so
        self._asked.append((pending, time.monotonic(), take_in))

    def _take_in(self) -> None:
        waiting = []
        for pending, asked_s, take_in in self._asked:
            if not pending.done:
                waiting.append((pending, asked_s, take_in))
                continue
            try:
                take_in(pending.result(0.0))
            except (NaoqiError, TypeError, ValueError, IndexError):
                continue  # one robot may not know what another one tells
        self._asked = waiting

    def _setter(self, name: str) -> TakeIn:
        return lambda value: self._robot.known.settings.__setitem__(name, bool(value))

    def _on_quick(self, values: list[Any]) -> None:
        told = dict(zip(self._quick, values, strict=False))
        body = self._robot.known.body
        self._robot.take_in(real.joint_angles(body, told))
        self._robot.stand_as_told()
        self._robot.sensors |= real.sensors(body, told)
        self._has_told_joints = True

    def _on_slow(self, values: list[Any]) -> None:
        told = dict(zip(self._slow, values, strict=False))
        body, known = self._robot.known.body, self._robot.known
        self._robot.sensors |= real.sensors(body, told)
        loose = real.loose_parts(body, told)
        known.released = frozenset({part for part, is_loose in loose.items() if is_loose}) | (
            known.released - set(loose)
        )
        charge = real.battery(told)
        if charge is not None:
            self._robot.battery = charge
        self._heat = real.hottest(body, told)

    def _on_base(self, place: list[float]) -> None:
        self._robot.be_at(place)
        self._robot.stand_as_told()

    def _on_torso(self, place: list[float]) -> None:
        x, y, z, roll, pitch, yaw = (float(part) for part in place if math.isfinite(part))
        self._robot.torso = x, y, z, roll, pitch, yaw

    def _on_posture(self, name: Any) -> None:
        known = self._robot.known
        if name in known.body.postures:
            is_resting = known.posture == RESTING and name == "Crouch" and bool(known.released)
            known.posture = RESTING if is_resting else str(name)
            if known.family not in ("", "lying"):
                self._robot.has_fallen = False
