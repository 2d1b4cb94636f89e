"""Calls of a robot's services that never wait: begun, looked at again, ended when stopped.

A task is a generator: it yields while it waits for the robot, returns what there is to say at its
end, and raises ActionFailed when the robot cannot do it. Closing it ends what it has begun: what
is said at once, a walk at the end of its step, and only then what moves arms and head. NAOqi says
of a walk that is killed that the robot may fall.
"""

from __future__ import annotations

import contextlib
import logging
import time
from collections.abc import Callable, Collection, Generator, Mapping
from typing import Any

from robots.body.schedule import Task, is_over
from robots.errors import ActionFailed
from robots.naoqi.wire.errors import NaoqiError, NoConnection
from robots.naoqi.wire.promise import Pending
from robots.naoqi.wire.remote import RemoteObject

log = logging.getLogger(__name__)

Calling = Generator[None, None, Any]

ANSWER_S = 2.5
"""What a robot does at once it has answered by then."""
STOPPED_S = 0.5
"""By then a robot has stopped."""

STANDING_S = 2.0
"""By then a robot that was told to stop walking stands."""
LOOKING_S = 0.03
"""So often it is asked whether it stands."""
STOP_AGAIN_S = 0.6
"""One that still walks by then may have been told to walk and to stop in another order."""

STOPS: dict[str, tuple[tuple[str, str], ...]] = {
    "ALTextToSpeech": (("ALTextToSpeech", "stopAll"),),
    "ALAudioPlayer": (("ALAudioPlayer", "stopAll"),),
    "ALVideoRecorder": (("ALVideoRecorder", "stopRecording"),),
}
"""What ends a call of each service that has not ended by itself."""
WALKS = frozenset({"moveTo", "moveToward", "move"})
STANDS = ("stopMove", "stopWalk")
"""What lets a robot that walks stand, in NAOqi's newer and older words."""
FINISHED = frozenset({"wakeUp", "rest"})
"""What is not left half way: a robot that stands up or goes down would fall over."""
ACTIVE = ("moveIsActive", "walkIsActive")
"""What tells whether the robot walks, in NAOqi's newer and older words."""


class Calls:
    """The services of one robot; ``robot`` is its name for sentences.

    ``joints`` are all of its joints, ``legs`` those that it stands and walks on.
    """

    def __init__(
        self,
        robot: str,
        services: Mapping[str, RemoteObject],
        joints: Collection[str] = (),
        legs: Collection[str] = (),
    ) -> None:
        self.robot = robot
        self._services = services
        self._joints, self._legs = frozenset(joints), frozenset(legs)
        self._stops: list[Pending] = []
        self._halting: Task | None = None
        self._to_kill: set[str] = set()
        self._ends_posture = False
        self._stand_until_s = 0.0
        self._is_let_go = False
        self._finishing: list[Task] = []
        self._walking: list[Pending] = []

    def has(self, service: str, method: str = "") -> bool:
        """Whether the robot has a service, with a method of that name."""
        remote = self._services.get(service)
        return remote is not None and (not method or method in remote.methods)

    def begin(self, service: str, method: str, *args: Any) -> Pending:
        """Begin a call. Raises ActionFailed when the robot has no such thing."""
        if not self.has(service, method):
            raise ActionFailed(
                "{robot} cannot do this: it has no {service}.{method}.",
                robot=self.robot,
                service=service,
                method=method,
            )
        try:
            pending = self._services[service].begin(method, *args)
        except NaoqiError as problem:
            raise ActionFailed(problem.sentence) from problem
        if method in WALKS:
            self._walking = [one for one in self._walking if not one.done] + [pending]
        return pending

    def tell(self, service: str, method: str, *args: Any) -> None:
        """Begin a call whose answer nobody wants, if the robot has such a thing."""
        if self.has(service, method):
            with contextlib.suppress(ActionFailed):
                self.begin(service, method, *args)

    def call(
        self, service: str, method: str, *args: Any, limit_s: float = ANSWER_S, uses: object = ()
    ) -> Calling:
        """Call, and return the robot's answer; ``uses`` are the joints that a movement moves.

        Raises ActionFailed: the robot's own words, or that it took longer than ``limit_s``.

        ``service`` and ``method`` are by name.
        """
        pending = self.begin(service, method, *args)
        end_s = time.monotonic() + limit_s
        try:
            while not pending.done:
                if time.monotonic() > end_s:
                    raise self.late(method)
                yield
        finally:
            if not pending.done and method not in FINISHED:
                self._end(pending, service, method, uses)
        return (yield from self.answer_of(pending))

    def late(self, method: str) -> ActionFailed:
        """What is told of a robot that does not end a call in time."""
        return ActionFailed(
            "{robot} did not end in time what it was asked ({method}). Look whether something "
            "holds it, and try again.",
            robot=self.robot,
            method=method,
        )

    def answer_of(self, pending: Pending) -> Calling:
        """Return the answer to a call that has ended. Raises ActionFailed: the robot's words."""
        lost_s = time.monotonic() + STOPPED_S
        while isinstance(pending.failure, NoConnection) and time.monotonic() < lost_s:
            yield  # who keeps the link hears of it too, and says it better
        try:
            return pending.result(0.0)
        except NaoqiError as problem:
            raise ActionFailed(
                "{robot} could not do that. It says: {sentence}",
                robot=self.robot,
                sentence=problem.sentence,
            ) from problem

    def stop(self, joints: Collection[str]) -> None:
        """Let some joints stop, whoever moves them: at once, or when a walk that stops stands."""
        self._to_kill |= set(joints)
        self._halting = self._halting or self._halt()

    def stop_walking(self) -> None:
        """Let the robot stop at the end of its step."""
        self._stand()
        self._stand_until_s = time.monotonic() + STANDING_S
        self._halting = self._halting or self._halt()

    def stop_all(self, *, kills: bool = True) -> None:
        """Let speech, following and walking stop at once, all other movement when it stands.

        A robot that goes to rest, or wakes up, finishes that; without ``kills`` also one that does
        so for somebody else.
        """
        self._stop("ALTextToSpeech", "stopAll")
        self._stop("ALTracker", "stopTracker")
        if not self._finishing:
            self.stop_walking()
            if kills:
                self._ends_posture = True
                self.stop(self._joints)

    def let_go(self) -> None:
        """Somebody else drives the robot now: kill nothing any more, it may be theirs."""
        self._is_let_go = True

    def finished(self, task: Task) -> Task:
        """Run a task that goes on to its end also when it is stopped meanwhile."""
        try:
            while True:
                try:
                    next(task)
                except StopIteration as end:
                    words: str = end.value
                    return words
                yield
        except GeneratorExit:
            self._finishing.append(task)
            raise

    @property
    def is_finishing(self) -> bool:
        """Whether the robot finishes something that was stopped: to rest, or to wake up."""
        return bool(self._finishing)

    @property
    def is_stopping(self) -> bool:
        """Whether something that was stopped still moves the robot."""
        return bool(self._halting or self._finishing)

    def step(self) -> None:
        """Go on with what was stopped and has not ended."""
        self._finishing = [task for task in self._finishing if not _is_over(task)]
        if self._halting is not None and _is_over(self._halting):
            self._halting = None

    def after_stops(self, task: Task, *, moves: bool) -> Task:
        """Run a task when what was stopped has stopped: robots may do calls in another order.

        One that ``moves`` the robot waits until it stands, too.
        """
        end_s = time.monotonic() + STOPPED_S
        while time.monotonic() < end_s and not all(pending.done for pending in self._stops):
            yield
        while moves and self.is_stopping:
            yield
        self._stops = [pending for pending in self._stops if not pending.done]
        return (yield from task)

    def wait_for(self, task: Task, limit_s: float) -> None:
        """Do a task to its end, at most so long, waiting: before the link is given up."""
        end_s = time.monotonic() + limit_s
        while time.monotonic() < end_s and not _is_over(task):
            self.step()
            time.sleep(0.005)
        task.close()

    def wait_for_stops(self, limit_s: float, meanwhile: Callable[[], object]) -> None:
        """Wait a while until what was stopped has stopped: before the link is given up.

        ``meanwhile`` is done again and again.
        """
        end_s = time.monotonic() + limit_s
        while time.monotonic() < end_s and self.is_stopping:
            self.step()
            meanwhile()
            time.sleep(0.005)
        end_s = min(end_s, time.monotonic() + STOPPED_S)
        while time.monotonic() < end_s and not all(pending.done for pending in self._stops):
            time.sleep(0.005)

    def _halt(self) -> Task:
        """Wait until the robot stands if its walk was stopped, then end what else moves it."""
        told_s = time.monotonic()
        while self._to_kill or time.monotonic() < self._stand_until_s:
            walks = yield from self._walks()
            if self._is_let_go:
                self._to_kill.clear()
                return ""
            if walks and time.monotonic() < self._stand_until_s:
                if time.monotonic() > told_s + STOP_AGAIN_S:
                    told_s = time.monotonic()
                    self._stand()
                yield from waited(LOOKING_S)
                continue
            self._stand_until_s = 0.0
            joints, self._to_kill = self._to_kill, set()
            if self._ends_posture:
                self._ends_posture = False
                self._stop("ALRobotPosture", "stopMove")
            if joints:
                yield from self._kill(joints, walks=walks)
        return ""

    def _walks(self) -> Generator[None, None, bool]:
        """Ask whether the robot walks; one that does not say is taken for walking.

        So is one that has not answered yet to be told to walk: it may be about to begin.
        """
        method = next((one for one in ACTIVE if self.has("ALMotion", one)), "")
        if not method:
            return self.has("ALMotion", "moveTo")
        try:
            walks = bool((yield from self.call("ALMotion", method, limit_s=STANDING_S)))
        except ActionFailed:
            return True
        return walks or not all(pending.done for pending in self._walking)

    def _kill(self, joints: set[str], *, walks: bool) -> Task:
        """End what moves some joints; while the robot walks or rises, only what moves no leg."""
        if walks or self._finishing:
            yield from self._kill_tasks(joints - self._legs)
        elif self.has("ALMotion", "killTasksUsingResources"):
            self._stop("ALMotion", "killTasksUsingResources", sorted(joints))
        else:
            self._stop("ALMotion", "killAll")
        return ""

    def _kill_tasks(self, joints: set[str]) -> Task:
        """End one by one the tasks that move some joints, and nothing that the robot walks by."""
        if not joints or not self.has("ALMotion", "getTaskList"):
            return ""
        try:
            tasks = yield from self.call("ALMotion", "getTaskList")
            for _, number, _, _, resources in tasks:
                used = {str(name) for name in resources}
                if used & joints and used <= self._joints - self._legs:
                    self._stop("ALMotion", "killTask", int(number))
        except (ActionFailed, TypeError, ValueError) as problem:
            log.info("what moves the arms could not be ended: %s", problem)
        return ""

    def _stand(self) -> None:
        self._stop("ALMotion", next((one for one in STANDS if self.has("ALMotion", one)), ""))

    def _stop(self, service: str, method: str, *args: Any) -> None:
        if self.has(service, method):
            with contextlib.suppress(ActionFailed):
                self._stops.append(self.begin(service, method, *args))

    def _end(self, pending: Pending, service: str, method: str, uses: object) -> None:
        """End a call that has not ended by itself."""
        if method in WALKS:  # which ends by itself when the robot stands
            self.stop_walking()
            return
        pending.cancel()
        self._ends_posture = self._ends_posture or service == "ALRobotPosture"
        if isinstance(uses, Collection) and uses:
            self.stop([str(joint) for joint in uses])
        for stopping in STOPS.get(service, ()):
            self._stop(*stopping)


def _is_over(task: Task) -> bool:
    """Let a task that nobody waits for go on by one step; whether that was its end."""
    try:
        return is_over(task)
    except ActionFailed as problem:
        log.info("what was stopped did not end as it should: %s", problem)
    except (TypeError, ValueError, LookupError, ArithmeticError):
        log.exception("what the robot answered to what was stopped")
    return True


def waited(seconds: float) -> Task:
    """Let some time pass."""
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        yield
    return ""
