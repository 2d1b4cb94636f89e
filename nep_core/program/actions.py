"""Asking robots to act and waiting for their answers; one client a program.

The same request is sent again every second until it is done: a robot that knows it tells how it
is going, and one whose action node was started anew plays it again. So a lost message or a
crashed node costs a second, not the show.
"""

from __future__ import annotations

import contextlib
import threading
import time
import uuid
from dataclasses import dataclass, field
from typing import Any

import msgspec

from nep_core.errors import ActionFailed, NepError, RobotNotAnswering
from nep_core.networks.network import Network
from nep_core.networks.transports import default_network
from nep_core.wire.messages import (
    ACTION_REQUEST,
    ACTION_RESULT,
    DISPLACED,
    REST,
    ActionRequest,
    ActionResult,
)
from nep_core.wire.pubsub import Publisher, Subscriber

from .tasks import (
    POLL_S,
    PRIORITIES,
    Begun,
    Cancelled,
    RuleDisplaced,
    Stamp,
    Task,
    current_task,
)

ASK_AGAIN_S = 1.0
SILENCE_S = 5.0
"""A robot that says nothing about a request for so long does not answer."""
RENEWED_S = 0.3
"""So often is asked again for what ends unless it is; a robot stands when that is late by 0.7 s."""
UNLESS_ASKED_S = 1.0
"""What is renewed ends by itself when it was not asked for again for so long."""
UNANSWERED_S = 2.0
"""What a robot has said nothing about for so long is renewed no more: it has ended by itself, and
a robot whose action node was started anew meanwhile must not begin it again."""
HALTING_S = 0.5
"""A robot says within this time how far it came with what it has to stop."""
STOPPING_S = 0.1
"""Who stops robots stops the program next: so long it begins nothing after a cancelled action."""

_ENDS = ("done", "failed", "cancelled")


def _made_way(result: ActionResult) -> bool:
    """Whether an action has ended because the robot does something more important."""
    return result.state == "cancelled" and result.code == DISPLACED


def _request(robots: list[str], action: str, args: dict[str, Any], task: Task) -> ActionRequest:
    """A new request, as important as what asks for it."""
    return ActionRequest(
        id=uuid.uuid4().hex,
        robots=robots,
        action=action,
        args=args,
        priority=PRIORITIES[task.standing.priority],
        by=task.standing.name,
    )


@dataclass
class Call:
    """One request under way: what each robot said last, and when."""

    request: ActionRequest
    results: dict[str, ActionResult] = field(default_factory=dict)
    heard_s: dict[str, float] = field(default_factory=dict)
    ended: threading.Event = field(default_factory=threading.Event)
    begun_s: float = field(default_factory=time.monotonic)
    ask_s: float = 0.0
    """When it is asked for again."""
    redone: set[str] = field(default_factory=set)
    """The robots that are asked for it anew, by another request."""
    gives_up: bool = False
    """Whether it is not done again after it has made way for something more important."""

    def note(self, result: ActionResult) -> None:
        """Take in what a robot says; an end is not taken back."""
        known = self.results.get(result.robot)
        if result.robot not in self.request.robots or (known and known.state in _ENDS):
            return
        self.results[result.robot] = result
        self.heard_s[result.robot] = time.monotonic()
        states = [r.state for r in self.results.values()]
        if sum(state in _ENDS for state in states) == len(set(self.request.robots)):
            self.ended.set()

    def again(self) -> ActionRequest:
        """The request for those who may have been started anew since: they do not begin it then."""
        if len(self.results) < len(set(self.request.robots)):
            return self.request
        return msgspec.structs.replace(self.request, args={**self.request.args, "was_known": True})

    def displaced(self) -> list[str]:
        """The robots that have made way for something more important, and do not do it again."""
        results = self.results.copy().values()
        return [one.robot for one in results if _made_way(one) and one.robot not in self.redone]

    def rest(self, robot: str) -> dict[str, Any]:
        """The arguments for what a robot has not done of it."""
        result = self.results.get(robot)
        values = result.values if result is not None and isinstance(result.values, dict) else {}
        rest = {name: values.get(f"{REST}{name}") for name in self.request.args}
        known = {name: value for name, value in rest.items() if isinstance(value, int | float)}
        return {**self.request.args, **known}

    def silent(self, since_s: float) -> str:
        """A robot that has said nothing since then, or has never; "" when all talk."""
        for robot in self.request.robots:
            result = self.results.get(robot)
            has_ended = result is not None and result.state in _ENDS
            if not has_ended and self.heard_s.get(robot, since_s - 1) < since_s:
                return robot
        return ""


class ActionClient:
    """Sends requests and hands every result to the call that waits for it."""

    def __init__(self, network: Network) -> None:
        self.last_done: dict[str, Stamp] = {}
        """When each robot last told of an end that was waited for."""
        self._calls: dict[str, Call] = {}
        self._renewed: dict[str, Call] = {}
        self._renewing = threading.Lock()
        self._requests = Publisher(ACTION_REQUEST, network=network)
        self._results = Subscriber(
            ACTION_RESULT, ActionResult, network=network, callback=self._on_result
        )

    def perform(self, robots: list[str], action: str, args: dict[str, Any]) -> None:
        """Ask, and wait until all robots are done.

        What makes way for something more important is done again afterwards, a walk for the rest
        of its way; so it is when this part is held meanwhile. Raises RobotNotAnswering,
        ActionFailed, RuleDisplaced, or Cancelled after cancelling the action.
        """
        task = current_task()
        task.stand_still()
        calls = [self._call(robots, action, args, task)]
        try:
            self._await(calls, task)
        except (Cancelled, RuleDisplaced):
            for call in calls:
                if not call.ended.is_set():
                    self.send(call.request.robots, "stop", {"request": call.request.id})
            raise
        finally:
            for call in calls:
                del self._calls[call.request.id]
        results = [
            result
            for call in calls
            for result in call.results.values()
            if result.robot not in call.redone
        ]
        if any(result.state == "cancelled" for result in results):
            task.sleep(STOPPING_S)
        for result in results:
            if result.state == "failed":
                raise ActionFailed(
                    "{robot} could not do that: {description}",
                    checklist=result.fault.checklist
                    or (
                        "Change this block, or what comes before it.",
                        "Try the program on the virtual robot first.",
                    ),
                    robot=result.robot,
                    action=action,
                    code=result.fault.code,
                    description=result.fault.sentence,
                )

    def _call(self, robots: list[str], action: str, args: dict[str, Any], task: Task) -> Call:
        gives_up = task.standing.displaced == "give_up"
        call = Call(_request(robots, action, args, task), gives_up=gives_up)
        self._calls[call.request.id] = call
        return call

    def send(self, robots: list[str], action: str, args: dict[str, Any]) -> str:
        """Ask without waiting; the id of the request."""
        request = _request(robots, action, args, current_task())
        self._requests.send(request)
        return request.id

    def begin(self, robots: list[str], action: str, args: dict[str, Any]) -> None:
        """The same; the action is ended when the part that asks is cancelled or held."""
        request: list[str] = []

        def again() -> None:
            request[:] = [self.send(robots, action, args)]

        self._note_begun(
            (action, *robots),
            Begun(lambda: self.send(robots, "stop", {"request": request[0]}), again),
        )

    def begin_renewed(self, robots: list[str], action: str, args: dict[str, Any]) -> None:
        """The same, of an action that ends by itself soon after this program is gone.

        It is asked for again and again, until it has ended or this part is cancelled.
        """
        task, request = current_task(), list[str]()
        args = {**args, "unless_asked_s": UNLESS_ASKED_S}

        def again() -> None:
            request[:] = [self._begin_renewed(robots, action, args, task)]

        self._note_begun(
            (action, *robots), Begun(lambda: self._end_renewed(robots, request[0]), again)
        )

    def _note_begun(self, key: tuple[str, ...], begun: Begun) -> None:
        """Begin what this part does not wait for."""
        task = current_task()
        task.stand_still()
        begun.again()
        task.undo[key] = begun
        if task.is_held:  # since just now
            begun.end()

    def _begin_renewed(
        self, robots: list[str], action: str, args: dict[str, Any], task: Task
    ) -> str:
        call = self._call(robots, action, args, task)
        call.heard_s = dict.fromkeys(robots, time.monotonic())
        self._requests.send(call.request)
        with self._renewing:
            is_first = not self._renewed
            self._renewed[call.request.id] = call
        if is_first:
            threading.Thread(target=self._renew, name="nep-renewing", daemon=True).start()
        return call.request.id

    def _end_renewed(self, robots: list[str], request_id: str) -> None:
        with self._renewing:  # nothing asks for it again behind this
            call = self._renewed.pop(request_id, None)
            if call is not None:
                request_id = call.request.id
                del self._calls[request_id]
            self.send(robots, "stop", {"request": request_id})

    def _renew(self) -> None:
        """Ask again for all that is renewed, as long as there is something."""
        asked_s = time.monotonic()
        while True:
            time.sleep(RENEWED_S)
            now_s = time.monotonic()
            was_late, asked_s = now_s - asked_s > UNLESS_ASKED_S / 2.0, now_s
            with self._renewing:
                for request_id, call in [*self._renewed.items()]:
                    has_made_way = call.ended.is_set() and call.displaced() and not call.gives_up
                    if was_late or has_made_way:  # the robot may have ended it meanwhile
                        self._begin_anew(call)
                    if call.ended.is_set() or call.silent(now_s - UNANSWERED_S):
                        del self._renewed[request_id], self._calls[call.request.id]
                    else:
                        with contextlib.suppress(NepError):  # when it leaves the network just now
                            self._requests.send(call.again())
                if not self._renewed:
                    return

    def _begin_anew(self, call: Call) -> None:
        """Let the next request be another one, which a robot does not take for an ended one."""
        del self._calls[call.request.id]
        call.request = msgspec.structs.replace(call.request, id=uuid.uuid4().hex)
        self._calls[call.request.id] = call
        call.heard_s = dict.fromkeys(call.request.robots, time.monotonic())
        call.results.clear()
        call.ended.clear()

    def end(self, robots: list[str], action: str) -> None:
        """End an action that was begun in this part of the program."""
        if (begun := current_task().undo.pop((action, *robots), None)) is not None:
            begun.end()

    def _await(self, calls: list[Call], task: Task) -> None:
        """Wait until all calls have ended; what is to be done again becomes a further one."""
        while True:
            if task.is_held:
                self._stand_still(calls, task)
            under_way = [call for call in calls if not call.ended.is_set()]
            for call in [*calls]:
                for robot in call.displaced():
                    if call.gives_up:
                        raise RuleDisplaced
                    under_way.append(self._do_again(call, robot, calls, task))
            if not under_way:
                return
            task.check()
            for call in under_way:
                self._ask(call)
            under_way[0].ended.wait(POLL_S)

    def _ask(self, call: Call) -> None:
        """Ask for a call when it is time. Raises RobotNotAnswering."""
        now_s = time.monotonic()
        if now_s >= call.ask_s:
            self._requests.send(call.request)
            call.ask_s = now_s + ASK_AGAIN_S
        if now_s - call.begun_s > SILENCE_S and (robot := call.silent(now_s - SILENCE_S)):
            raise not_answering(robot)

    def _do_again(self, call: Call, robot: str, calls: list[Call], task: Task) -> Call:
        """Ask one robot once more, for what it has not done."""
        call.redone.add(robot)
        again = self._call([robot], call.request.action, call.rest(robot), task)
        calls.append(again)
        return again

    def _stand_still(self, calls: list[Call], task: Task) -> None:
        """End what was asked for while this part is held; afterwards it is to be done again."""
        halted = [call for call in calls if not call.ended.is_set()]
        for call in halted:
            self.send(call.request.robots, "stop", {"request": call.request.id})
        for call in halted:
            call.ended.wait(HALTING_S)
        task.stand_still()
        for call in halted:
            for robot in dict.fromkeys(call.request.robots):
                result = call.results.get(robot)
                has_ended = result is not None and result.state in ("done", "failed")
                if not has_ended and robot not in call.redone:
                    self._do_again(call, robot, calls, task)
            call.ended.set()

    def _on_result(self, result: ActionResult) -> None:
        if (call := self._calls.get(result.id)) is not None:
            if result.state in _ENDS:
                self.last_done[result.robot] = Stamp(result.time, time.monotonic())
            call.note(result)


def action_client(network: Network | None = None) -> ActionClient:
    """The client of this program's network."""
    return (network or default_network()).shared(ActionClient)


def not_answering(robot: str) -> RobotNotAnswering:
    """The error of a robot that says nothing."""
    return RobotNotAnswering(
        "{robot} does not answer: no running action node plays it.",
        checklist=(
            'Is there a robot with the name "{robot}" on the Robots page?',
            "Does its action node run? It is in the list of nodes.",
            "Is {robot} switched on and on the same network as this computer?",
            "Try the program on the virtual robot first.",
        ),
        robot=robot,
    )
