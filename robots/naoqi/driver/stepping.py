"""How a real robot walks on and on: by one step at a time, each asked for in the step before.

Without this driver it soon stands: in the worst case the link is gone just after a step was asked
for. Then the robot makes the rest of the step under way, the one granted, and the one that puts its
feet side by side. So the next one is asked for late in each step, when few of its steps are left.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Sequence

from robots.body.gait import STEP_S
from robots.body.schedule import Task
from robots.naoqi.wire.errors import NaoqiError
from robots.naoqi.wire.promise import Pending

from .calls import LOOKING_S, Calls
from .real import RealRobot

INTO_STEP_S = 0.2
"""So late in a step the next one is asked for: 0.22 + 0.42 + 0.3 s later both feet stand for good.
Later would be shorter still, but who misses the end of the step (0.42 s) lets the robot stand."""
SPARE_S = 0.04
"""So long before the end of a step is the last moment to ask: what comes later, while the robot
brings its feet together, begins a walk anew. If nobody drives it by then, that is a second more."""
RENEWED_S = 0.4
"""So often is asked a robot that does not tell of its steps."""
AGAIN_S = 0.05
"""One that stands is asked so soon after it has said so."""
MOST_BEGUN = 20
"""Robots may answer all of these when they stand, and keep a thread for each until then."""
LEG_S = 10.0
ELSEWHERE = 1e-5
"""Places (m, m, rad) that differ by less are the same one."""
VAIN = 2
"""A robot that stood so often after its first step is asked by the clock instead."""


def step_on(robot: RealRobot, leg: list[float]) -> Task:
    """Ask for the next leg before the last one has ended: NAOqi goes over to it in its steps.

    Its documentation has this as an example: a second moveTo is seen from where the steps end that
    cannot be changed any more, and takes the place of the others.
    """
    begun: list[Pending] = []
    beat = _Beat(robot.calls)
    asked_s = -math.inf
    try:
        while True:
            for pending in [one for one in begun if one.done]:
                begun.remove(pending)
                yield from robot.calls.answer_of(pending)
                if not begun:
                    beat.stood()
            beat.look()
            is_due = beat.is_due(asked_s) if begun else time.monotonic() >= asked_s + AGAIN_S
            if is_due and len(begun) < MOST_BEGUN:
                asked_s = time.monotonic()
                begun.append(robot.calls.begin("ALMotion", "moveTo", *leg))
                beat.next()
            if time.monotonic() > asked_s + LEG_S:
                raise robot.calls.late("moveTo")
            yield
    finally:
        if begun:
            robot.calls.stop_walking()


class _Beat:
    """The beat of a robot's steps, as far as it tells of it.

    NAOqi says where the robot will be after the steps that it cannot change any more: that is
    another place as soon as there is one more of these.
    """

    def __init__(self, calls: Calls) -> None:
        self._calls = calls
        self._is_told = calls.has("ALMotion", "getNextRobotPosition")
        self._asked: deque[tuple[float, Pending]] = deque()
        self._asked_s = self._heard_s = -math.inf
        self._place: Sequence[float] | None = None
        self._step_s: tuple[float, float] | None = None
        """When the step under way began, at the earliest and at the latest."""
        self._steps = self._in_vain = 0

    def next(self) -> None:
        """Wait for the step that was asked for just now."""
        self._step_s = None

    def stood(self) -> None:
        """Take in that the robot stands: it was asked too late, or its beat is another one."""
        self._in_vain = self._in_vain + 2 - self._steps if self._steps < 2 else 0
        self._is_told = self._is_told and self._in_vain < VAIN
        self._steps = 0

    def is_due(self, asked_s: float) -> bool:
        """Whether a robot that walks is to be asked again, who was asked at ``asked_s``."""
        now_s = time.monotonic()
        if not self._is_told:
            return now_s >= asked_s + RENEWED_S
        if self._step_s is None:
            return False
        earliest_s, latest_s = self._step_s
        # Later than that it comes to rest: it is asked when it has
        return now_s >= latest_s + INTO_STEP_S and now_s < earliest_s + STEP_S - SPARE_S

    def look(self) -> None:
        """Ask where the robot will be, and hear of it."""
        while self._asked and self._asked[0][1].done:
            self._hear(*self._asked.popleft())
        is_wanted = self._is_told and len(self._asked) < MOST_BEGUN
        if is_wanted and time.monotonic() >= self._asked_s + LOOKING_S:
            self._asked_s = time.monotonic()
            place = self._calls.begin("ALMotion", "getNextRobotPosition")
            self._asked.append((self._asked_s, place))

    def _hear(self, asked_s: float, asked: Pending) -> None:
        try:
            place = [float(number) for number in asked.result(0.0)]
        except (NaoqiError, TypeError, ValueError):
            self._is_told = False
            return
        before, self._place = self._place, place
        if self._step_s is None and before is not None and _is_elsewhere(before, place):
            # Since it was asked before: how long the answer was on its way is of no matter
            self._step_s = self._heard_s, asked_s
            self._steps += 1
        self._heard_s = asked_s


def _is_elsewhere(one: Sequence[float], other: Sequence[float]) -> bool:
    return any(abs(a - b) > ELSEWHERE for a, b in zip(one, other, strict=False))
