"""One robot that acts: takes requests, lets its driver play them, and tells how each one goes."""

from __future__ import annotations

from nep_core.errors import ActionFailed
from nep_core.messages import ActionRequest, ActionResult, ActionState
from nodes.action.naobody.actions import Stop, read_action
from nodes.action.naobody.driver import Driver
from nodes.action.naobody.schedule import Command, Schedule

REMEMBERED_REQUESTS = 500
FINAL: frozenset[ActionState] = frozenset({"done", "failed", "cancelled"})


class Actor:
    """Requests in, results out; every accepted request ends in one of done, failed, cancelled."""

    def __init__(self, robot: str, driver: Driver) -> None:
        self.robot = robot
        self.driver = driver
        self.schedule = Schedule()
        self._last_result: dict[str, ActionResult] = {}

    def is_asked(self, request: ActionRequest) -> bool:
        """Whether a request is for this robot: by its name, or for all robots."""
        return not request.robots or "all" in request.robots or self.robot in request.robots

    def request(self, request: ActionRequest) -> list[ActionResult]:
        """Take a request; one that is known already is not played again, only answered."""
        if known := self._last_result.get(request.id):
            return [self._result(request.id, known.state, known.description)]
        try:
            action = read_action(request.action, request.args)
            if isinstance(action, Stop):
                return [*self.stop(action.request), self._result(request.id, "done")]
            limbs = self.driver.limbs(action)
        except ActionFailed as problem:
            return [self._result(request.id, "failed", problem.sentence)]
        self.schedule.add(Command(request.id, action, limbs, request.priority))
        return [self._result(request.id, "accepted")]

    def stop(self, only: str = "") -> list[ActionResult]:
        """End what is running and what waits, at once; or one request of these."""
        commands = [*self.schedule.running, *self.schedule.waiting]
        stopped = [command.id for command in commands if only in ("", command.id)]
        self.driver.stop(stopped)
        for command_id in stopped:
            self.schedule.end(command_id)
        return [self._result(command_id, "cancelled", "stopped") for command_id in stopped]

    def step(self, now_s: float) -> list[ActionResult]:
        """Go on to a time, and return what was started and what ended on the way."""
        results = self._start_ready()
        while ended := self.driver.step(now_s):
            for command_id, state, description in ended:
                self.schedule.end(command_id)
                results.append(self._result(command_id, state, description))
            results += self._start_ready()
        return results

    def _start_ready(self) -> list[ActionResult]:
        ready = self.schedule.start_ready()
        for command in ready:
            self.driver.start(command.id, command.action)
        return [self._result(command.id, "started") for command in ready]

    def _result(self, request_id: str, state: ActionState, description: str = "") -> ActionResult:
        result = ActionResult(id=request_id, robot=self.robot, state=state, description=description)
        self._last_result[request_id] = result
        self._forget_oldest()
        return result

    def _forget_oldest(self) -> None:
        surplus = len(self._last_result) - REMEMBERED_REQUESTS
        if surplus > 0:
            ended = (id for id, result in self._last_result.items() if result.state in FINAL)
            for request_id in [id for id, _ in zip(ended, range(surplus), strict=False)]:
                del self._last_result[request_id]
