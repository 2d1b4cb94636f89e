"""One robot that acts: takes requests, lets its driver play them, and tells how each one goes."""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Collection
from typing import Any

import numpy as np

from faults import Fault, Words, fault_of
from robots.errors import ActionFailed

from .actions import (
    Approach,
    LookAtSeen,
    SetAngles,
    Stop,
    StopMoving,
    Target,
    Turn,
    Walk,
    WalkFreely,
    read_action,
)
from .driver import NOTHING, ActionRequest, ActionResult, ActionState, Driver, SenseRequest
from .limbs import MOVING, Limb
from .schedule import Command, Schedule
from .tasks import moved_base

REMEMBERED_REQUESTS = 500
MOST_WAITING = 2000
"""A program that asks for more at once has lost its way, and would make all others wait."""
FULL = "{most} requests wait already: wait for the end of some of them, or stop them."
KEPT_S = 0.4
"""Between two steps of a rule passes less: until then a limb is kept from less important ones."""
DISPLACED = "displaced"
"""The code of what has made way for something more important."""
FOLLOWING = "following"
"""The command by which the head follows what it tracks; nobody has asked for it."""
APPROACHING = "approaching"
"""The commands by which limbs go where their joints were set to; nobody waits for them."""
FINAL: frozenset[ActionState] = frozenset({"done", "failed", "cancelled"})


MADE_WAY = "made way for something more important"
MADE_WAY_FOR = "made way for “{by}”, which is more important"

Base = tuple[float, float, float]
"""Where a robot is on the floor: x m, y m, theta rad."""
MOST_TURN_DEG = 180.0
"""How far a robot has turned cannot be seen from where it looks when it was to turn further."""


def rest_of_way(action: Walk | Turn | object, start: Base, here: Base) -> list[tuple[str, float]]:
    """The arguments for what is left of a walk or a turn; none where that is not known."""
    if isinstance(action, Turn) and abs(action.degrees) <= MOST_TURN_DEG:
        return [("degrees", _turn_deg(start[2] + math.radians(action.degrees) - here[2]))]
    if not isinstance(action, Walk) or abs(action.turn_deg) > MOST_TURN_DEG:
        return []
    way = np.array([action.forward_m, action.left_m, math.radians(action.turn_deg)])
    x, y, theta = moved_base(np.array(start), way) - np.array(here)
    cosine, sine = math.cos(here[2]), math.sin(here[2])
    return [
        ("forward_m", round(float(x * cosine + y * sine), 3)),
        ("left_m", round(float(y * cosine - x * sine), 3)),
        ("turn_deg", _turn_deg(float(theta))),
    ]


def _turn_deg(rad: float) -> float:
    return round(math.degrees(math.remainder(rad, math.tau)), 1)


class Actor:
    """Requests in, results out; every accepted request ends in one of done, failed, cancelled.

    ``pace``: how many seconds of the robot pass in one second of those who ask.
    """

    def __init__(self, robot: str, driver: Driver, *, pace: float = 1.0) -> None:
        self.robot = robot
        self.driver = driver
        self._pace = pace
        self.schedule = Schedule(KEPT_S * pace)
        self._open: dict[str, ActionResult] = {}
        self._over: OrderedDict[str, ActionResult] = OrderedDict()
        """The last results of those that have ended, the one that ended first before all others."""
        self._now_s = 0.0
        self._asked_s: dict[str, float] = {}
        """When each walk was asked for last that stops unless it is asked for again."""
        self._set_out: dict[str, Base] = {}
        """Where the robot was when each walk or turn began."""

    def is_asked(self, request: ActionRequest) -> bool:
        """Whether a request is for this robot: by its name, or for all robots."""
        return not request.robots or "all" in request.robots or self.robot in request.robots

    def request(self, request: ActionRequest) -> list[ActionResult]:
        """Take a request; one that is known already is not played again, only answered."""
        if known := self._open.get(request.id) or self._over.get(request.id):
            if request.id in self._asked_s:
                self._asked_s[request.id] = self._now_s
            return [self._result(request.id, known.state, known.fault)]
        try:
            action = read_action(request.action, request.args)
            if isinstance(action, Stop):
                return [*self.stop(action.request), self._result(request.id, "done")]
            if isinstance(action, StopMoving):
                moving = [command.id for command in self._commands() if command.limbs & MOVING]
                ended = self._end(moving, "cancelled", "stopped")
                return [*ended, self._result(request.id, "done")]
            limbs = self.driver.limbs(action)
        except ActionFailed as problem:
            return [self._result(request.id, "failed", problem.fault)]
        if isinstance(action, WalkFreely) and action.was_known:
            return [self._result(request.id, "cancelled", fault_of("stopped"))]
        if len(self.schedule.waiting) >= MOST_WAITING:
            full = fault_of(FULL, most=MOST_WAITING)
            return [ActionResult(id=request.id, robot=self.robot, state="failed", fault=full)]
        ended = self._end_free_walk(request.priority) if Limb.LEGS in limbs else []
        if isinstance(action, SetAngles):
            self._aim(action)
            return [*ended, self._result(request.id, "done")]
        self.schedule.add(Command(request.id, action, limbs, request.priority, request.by))
        if isinstance(action, WalkFreely) and action.unless_asked_s:
            self._asked_s[request.id] = self._now_s
        return [*ended, self._result(request.id, "accepted")]

    def _aim(self, action: SetAngles) -> None:
        """Change where joints go; limbs that are not on their way begin when it is their turn."""
        actions = [command.action for command in self._commands()]
        approaches = {one.limb: one for one in actions if isinstance(one, Approach)}
        for joint, angle in action.angles.items():
            (limb,) = self.driver.limbs(SetAngles({joint: angle}))
            if limb not in approaches:
                approach = approaches[limb] = Approach(limb, {})
                self.schedule.add(Command(f"{APPROACHING}_{limb}", approach, frozenset({limb})))
            approaches[limb].targets[joint] = Target(angle, action.speed)

    def is_meant(self, request: SenseRequest) -> bool:
        """Whether a robot is told to sense something: by its name, or all robots."""
        return request.robot in ("", "all", self.robot)

    def sense(self, request: SenseRequest) -> list[str]:
        """Let the robot sense something, and follow it if it tracks that; the human states."""
        states = self.driver.sense(request)
        state = self.driver.state()
        if state and request.value > 0 and state.settings.get("tracking") == request.sense:
            command = Command(FOLLOWING, LookAtSeen(request.sense), frozenset({Limb.HEAD}))
            if all(known.id != FOLLOWING for known in self.schedule.waiting):
                if any(known.id == FOLLOWING for known in self.schedule.running):
                    self.stop(FOLLOWING)
                self.schedule.add(command)
        return states

    def stop(self, only: str = "") -> list[ActionResult]:
        """End what is running and what waits, at once; or one request of these."""
        stopped = [command.id for command in self._commands() if only in ("", command.id)]
        results = self._end(stopped, "cancelled", "stopped")
        if not only:
            self.schedule.free()
            self.driver.halt()
        return results

    def stop_these(self, command_ids: Collection[str]) -> list[ActionResult]:
        """End some of what is running and what waits, all at once."""
        wanted = set(command_ids)
        stopped = [command.id for command in self._commands() if command.id in wanted]
        return self._end(stopped, "cancelled", "stopped")

    def noticed(self) -> list[str]:
        """Return the human states that the robot noticed by itself since the last call."""
        return self.driver.noticed()

    def _end_free_walk(self, priority: int) -> list[ActionResult]:
        """A walk without an end is over when the legs are asked for what is as important."""
        walks = [one for one in self._commands() if isinstance(one.action, WalkFreely)]
        free = [one.id for one in walks if one.priority == priority]
        return self._end(free, "done", "")

    def _end_forsaken(self) -> list[ActionResult]:
        """A walk that is not asked for any more stops: who drove the robot may be gone."""
        if not self._asked_s:
            return []
        walks = {one.id: one.action for one in self._commands()}
        self._asked_s = {id: s for id, s in self._asked_s.items() if id in walks}
        forsaken = [
            id
            for id, asked_s in self._asked_s.items()
            if isinstance(walk := walks[id], WalkFreely)
            and self._now_s - asked_s > walk.unless_asked_s * self._pace
        ]
        return self._end(forsaken, "cancelled", "nobody asked for it any more")

    def _commands(self) -> list[Command]:
        return [*self.schedule.running, *self.schedule.waiting]

    def _end(self, command_ids: list[str], state: ActionState, words: Words) -> list[ActionResult]:
        faults = {one: fault_of(words, **self._rest(one)) for one in command_ids}
        self.driver.stop(command_ids)
        self.schedule.end(*command_ids)
        return [self._result(one, state, fault) for one, fault in faults.items()]

    def _displace(self) -> list[ActionResult]:
        """End what is in the way of something more important; who asked for it is told why."""
        results = []
        for command_id, other in self.schedule.displaced().items():
            rest = self._rest(command_id)
            if other.by:
                fault = fault_of(MADE_WAY_FOR, code=DISPLACED, by=other.by, **rest)
            else:
                fault = fault_of(MADE_WAY, code=DISPLACED, **rest)
            self.driver.stop([command_id])
            self.schedule.end(command_id)
            results.append(self._result(command_id, "cancelled", fault))
        return results

    def _rest(self, command_id: str) -> dict[str, Any]:
        """The arguments for the rest of a walk or a turn, each with rest_ before its name."""
        here, start = self._place(), self._set_out.get(command_id)
        command = next((one for one in self.schedule.running if one.id == command_id), None)
        if command is None or start is None or here is None:
            return {}
        return {f"rest_{name}": value for name, value in rest_of_way(command.action, start, here)}

    def _place(self) -> Base | None:
        state = self.driver.state()
        return state.base if state is not None else None

    def step(self, now_s: float) -> list[ActionResult]:
        """Go on to a time, and return what was started and what ended on the way."""
        self._now_s = self.schedule.now_s = now_s
        results = [*self._end_forsaken(), *self._start_ready()]
        while ended := self.driver.step(now_s):
            for command_id, state, fault in ended:
                self.schedule.end(command_id)
                results.append(self._result(command_id, state, fault))
            results += self._start_ready()
        return results

    def _start_ready(self) -> list[ActionResult]:
        displaced = self._displace()
        ready = self.schedule.start_ready()
        for command in ready:
            if isinstance(command.action, Walk | Turn) and (place := self._place()) is not None:
                self._set_out[command.id] = place
            self.driver.start(command.id, command.action)
        return [*displaced, *(self._result(command.id, "started") for command in ready)]

    def _result(self, request_id: str, state: ActionState, fault: Fault = NOTHING) -> ActionResult:
        result = ActionResult(id=request_id, robot=self.robot, state=state, fault=fault)
        if state in FINAL:
            self._open.pop(request_id, None)
            self._set_out.pop(request_id, None)
            self._over[request_id] = result
            if len(self._over) > REMEMBERED_REQUESTS:
                self._over.popitem(last=False)
        else:
            self._open[request_id] = result
        return result
