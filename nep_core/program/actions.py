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
from functools import partial
from typing import Any

import msgspec

from nep_core.errors import ActionFailed, NepError, RobotNotAnswering
from nep_core.networks.network import Network
from nep_core.networks.transports import default_network
from nep_core.wire.messages import ACTION_REQUEST, ACTION_RESULT, ActionRequest, ActionResult
from nep_core.wire.pubsub import Publisher, Subscriber

from .tasks import POLL_S, Cancelled, Stamp, current_task

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
STOPPING_S = 0.1
"""Who stops robots stops the program next: so long it begins nothing after a cancelled action."""

_ENDS = ("done", "failed", "cancelled")


@dataclass
class Call:
    """One request under way: what each robot said last, and when."""

    request: ActionRequest
    results: dict[str, ActionResult] = field(default_factory=dict)
    heard_s: dict[str, float] = field(default_factory=dict)
    ended: threading.Event = field(default_factory=threading.Event)

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

        Raises RobotNotAnswering, ActionFailed, or Cancelled after cancelling the action.
        """
        request = ActionRequest(id=uuid.uuid4().hex, robots=robots, action=action, args=args)
        call = self._calls[request.id] = Call(request)
        try:
            self._await(call)
        except Cancelled:
            self.send(robots, "stop", {"request": request.id})
            raise
        finally:
            del self._calls[request.id]
        if any(result.state == "cancelled" for result in call.results.values()):
            current_task().sleep(STOPPING_S)
        for result in call.results.values():
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

    def send(self, robots: list[str], action: str, args: dict[str, Any]) -> str:
        """Ask without waiting; the id of the request."""
        request = ActionRequest(id=uuid.uuid4().hex, robots=robots, action=action, args=args)
        self._requests.send(request)
        return request.id

    def begin(self, robots: list[str], action: str, args: dict[str, Any]) -> str:
        """The same; the action is ended when the part that asks is cancelled."""
        request = self.send(robots, action, args)
        stop = partial(self.send, robots, "stop", {"request": request})
        current_task().undo[action, *robots] = stop
        return request

    def begin_renewed(self, robots: list[str], action: str, args: dict[str, Any]) -> str:
        """The same, of an action that ends by itself soon after this program is gone.

        It is asked for again and again, until it has ended or this part is cancelled.
        """
        args = {**args, "unless_asked_s": UNLESS_ASKED_S}
        request = ActionRequest(id=uuid.uuid4().hex, robots=robots, action=action, args=args)
        call = self._calls[request.id] = Call(request)
        call.heard_s = dict.fromkeys(robots, time.monotonic())
        self._requests.send(request)
        with self._renewing:
            is_first = not self._renewed
            self._renewed[request.id] = call
        if is_first:
            threading.Thread(target=self._renew, name="nep-renewing", daemon=True).start()
        current_task().undo[action, *robots] = partial(self._end_renewed, robots, request.id)
        return request.id

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
                    if was_late:  # this program stood still: the robot may have ended it meanwhile
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

    def end(self, robots: list[str], action: str, request_id: str) -> None:
        """End an action that was begun in this part of the program."""
        current_task().undo.pop((action, *robots), None)
        self.send(robots, "stop", {"request": request_id})

    def _await(self, call: Call) -> None:
        task = current_task()
        asked_first_s = time.monotonic()
        ask_s = 0.0
        while not call.ended.is_set():
            task.check()
            now_s = time.monotonic()
            if now_s >= ask_s:
                self._requests.send(call.request)
                ask_s = now_s + ASK_AGAIN_S
            if now_s - asked_first_s > SILENCE_S and (robot := call.silent(now_s - SILENCE_S)):
                raise not_answering(robot)
            call.ended.wait(POLL_S)

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
