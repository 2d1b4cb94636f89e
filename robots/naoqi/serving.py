"""A virtual robot that other programs ask to act, from threads of their own, while its node runs.

The node's loop lets the robot live; everybody who touches it holds ``lock``. Nobody waits inside:
who asks for something is called back when it has ended.
"""

from __future__ import annotations

import contextlib
import itertools
import logging
import threading
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from robots.body.actor import FINAL, MOST_WAITING, Actor
from robots.body.driver import ActionRequest, ActionResult, RobotState
from robots.body.gait import comes_to_rest, is_stepping
from robots.body.limbs import Limb
from robots.body.pose import VirtualRobot
from robots.body.schedule import Command
from robots.naoqi.wire.errors import CallFailed

log = logging.getLogger(__name__)

OnEnd = Callable[[ActionResult], None]
Condition = Callable[[], bool]
Ending = tuple[OnEnd, ActionResult]


class ServedRobot:
    """One robot; ``ask`` and ``stop`` may be called by any thread."""

    def __init__(self, actor: Actor, robot: VirtualRobot) -> None:
        self.actor = actor
        self.robot = robot
        self.lock = threading.RLock()
        self._on_end: dict[str, OnEnd] = {}
        self._others: list[ActionResult] = []
        self._awaited: list[tuple[Condition, Callable[[], None]]] = []
        self._numbers = itertools.count(1)
        self._moment: RobotState | None = None

    @property
    def name(self) -> str:
        """The robot's name."""
        return self.robot.name

    def ask(self, action: str, on_end: OnEnd | None = None, **args: Any) -> str:
        """Let the robot do something; the request's id. ``on_end`` gets its last result.

        What the robot refuses ends as failed before this returns. Raises CallFailed when too many
        wait already.
        """
        with self.lock:
            _check_room(len(self.actor.schedule.waiting))
            request_id = f"naoqi {self.name} {next(self._numbers)}"
            self._on_end[request_id] = on_end or (lambda result: None)
            request = ActionRequest(id=request_id, robots=[self.name], action=action, args=args)
            endings = self._sort(self.actor.request(request))
        _tell(endings)
        return request_id

    def stop(self, which: Callable[[Command], bool]) -> None:
        """End what is done or waits, and is wanted by ``which``; at once."""
        with self.lock:
            wanted = [command.id for command in self.commands() if which(command)]
            endings = self._sort(self.actor.stop_these(wanted))
        _tell(endings)

    def kill(self, which: Callable[[Command], bool], *, legs: bool = False) -> None:
        """End what ``which`` wants, and care for nothing: who is in the middle of a step falls.

        ``legs``: also the step that ends a walk, which is no command any more.
        """
        with self.lock:
            walks = [one for one in self.actor.schedule.running if Limb.LEGS in one.limbs]
            is_tripped = self.is_stepping and (any(map(which, walks)) if walks else legs)
            self.stop(which)
            if is_tripped:
                self.robot.stance.trip()

    @property
    def is_stepping(self) -> bool:
        """Whether it walks, or ends the step with which a walk ends."""
        with self.lock:
            return is_stepping(self.robot) and self.state().moving

    @property
    def is_coming_to_rest(self) -> bool:
        """Whether both feet stand where they stay after a walk, and the weight goes back."""
        with self.lock:
            return comes_to_rest(self.robot) and self.state().moving

    def stop_one(self, request_id: str) -> None:
        """End one request, at once."""
        self.stop(lambda command: command.id == request_id)

    def commands(self) -> list[Command]:
        """Return what is done and what waits."""
        with self.lock:
            return [*self.actor.schedule.running, *self.actor.schedule.waiting]

    def is_asked_here(self, command: Command) -> bool:
        """Whether it was asked for here, not over the network of the studio."""
        return command.id in self._on_end

    def when(self, condition: Condition, call: Callable[[], None]) -> Callable[[], bool]:
        """Call something once, as soon as a condition holds; the return value ends the wait.

        That says whether it was still waiting. Raises CallFailed when too many wait already.
        """
        awaited = (condition, call)
        with self.lock:
            _check_room(len(self._awaited))
            self._awaited.append(awaited)

        def end() -> bool:
            with self.lock:
                was_waiting = awaited in self._awaited
                if was_waiting:
                    self._awaited.remove(awaited)
            return was_waiting

        return end

    def busy_limbs(self) -> frozenset[Limb]:
        """Return the limbs that are used, or waited for."""
        return frozenset(limb for command in self.commands() for limb in command.limbs)

    @contextlib.contextmanager
    def moment(self) -> Iterator[None]:
        """Let nothing change meanwhile: ``state`` is made once, however often it is asked."""
        with self.lock:
            self._moment = self.state()
            try:
                yield
            finally:
                self._moment = None

    def state(self) -> RobotState:
        """Return how the robot is now."""
        with self.lock:
            if self._moment is not None:
                return self._moment
            state = self.actor.driver.state()
        assert state is not None  # of a virtual robot it is always known
        return state

    def hear(self, told: Iterable[ActionResult]) -> list[ActionResult]:
        """Take in what the node's loop was told; return what concerns others, to be sent on."""
        with self.lock:
            endings = self._sort(told)
            others, self._others = self._others, []
            is_due = [condition() for condition, _ in self._awaited]
            calls = [call for (_, call), due in zip(self._awaited, is_due, strict=True) if due]
            self._awaited = [one for one, due in zip(self._awaited, is_due, strict=True) if not due]
        _tell(endings)
        for call in calls:
            try:
                call()
            except CallFailed as refused:  # nobody is there any more who could be told
                log.info("what was to follow could not begin: %s", refused)
        return others

    def _sort(self, told: Iterable[ActionResult]) -> list[Ending]:
        """Return the endings of requests that were asked here; keep what concerns others."""
        endings: list[Ending] = []
        for result in told:
            if result.id not in self._on_end:
                self._others.append(result)
            elif result.state in FINAL:
                endings.append((self._on_end.pop(result.id), result))
        return endings


def _check_room(waiting: int) -> None:
    if waiting >= MOST_WAITING:
        raise CallFailed(
            "{most} requests wait already. Wait for the end of some of them, or end all "
            "movements with ALMotion.killAll.",
            most=MOST_WAITING,
        )


def _tell(endings: list[Ending]) -> None:
    for on_end, result in endings:
        on_end(result)
