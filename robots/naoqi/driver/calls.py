"""Calls of a robot's services that never wait: begun, looked at again, ended when stopped.

A task is a generator: it yields while it waits for the robot, returns what there is to say at its
end, and raises ActionFailed when the robot cannot do it. Closing it ends what it has begun.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Generator, Mapping, Sequence
from typing import Any

from robots.body.schedule import Task
from robots.errors import ActionFailed
from robots.naoqi.wire.errors import NaoqiError, NoConnection
from robots.naoqi.wire.promise import Pending
from robots.naoqi.wire.remote import RemoteObject

Calling = Generator[None, None, Any]

ANSWER_S = 2.5
"""What a robot does at once it has answered by then."""
STOPPED_S = 0.5
"""By then a robot has stopped."""

STOPS: dict[str, tuple[tuple[str, str], ...]] = {
    "ALTextToSpeech": (("ALTextToSpeech", "stopAll"),),
    "ALRobotPosture": (("ALRobotPosture", "stopMove"), ("ALMotion", "stopMove")),
    "ALAudioPlayer": (("ALAudioPlayer", "stopAll"),),
    "ALVideoRecorder": (("ALVideoRecorder", "stopRecording"),),
}
"""What ends a call of each service that has not ended by itself."""
WALKS = frozenset({"moveTo", "moveToward", "move"})
KILLS = frozenset({"wakeUp", "rest"})


class Calls:
    """The services of one robot; ``robot`` is its name for sentences."""

    def __init__(self, robot: str, services: Mapping[str, RemoteObject]) -> None:
        self.robot = robot
        self._services = services
        self._stops: list[Pending] = []

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
            return self._services[service].begin(method, *args)
        except NaoqiError as problem:
            raise ActionFailed(problem.sentence) from problem

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
                    raise ActionFailed(
                        "{robot} did not end in time what it was asked ({method}). Look whether "
                        "something holds it, and try again.",
                        robot=self.robot,
                        method=method,
                    )
                yield
        finally:
            if not pending.done:
                pending.cancel()
                self._end(service, method, uses)
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

    def stop(self, joints: Sequence[str]) -> None:
        """Let some joints stop at once, whoever moves them."""
        if self.has("ALMotion", "killTasksUsingResources"):
            self._stop("ALMotion", "killTasksUsingResources", list(joints))
        else:
            self._stop("ALMotion", "killAll")

    def stop_all(self) -> None:
        """Let motion, posture, speech and following stop at once."""
        self._stop("ALMotion", "stopMove")
        self._stop("ALMotion", "killAll")
        self._stop("ALRobotPosture", "stopMove")
        self._stop("ALTextToSpeech", "stopAll")
        self._stop("ALTracker", "stopTracker")

    def after_stops(self, task: Task) -> Task:
        """Run a task when what was stopped has stopped: robots may do calls in another order."""
        end_s = time.monotonic() + STOPPED_S
        while time.monotonic() < end_s and not all(pending.done for pending in self._stops):
            yield
        self._stops.clear()
        return (yield from task)

    def wait_for_stops(self) -> None:
        """Wait a moment until what was stopped has stopped: before the link is given up."""
        end_s = time.monotonic() + STOPPED_S
        while time.monotonic() < end_s and not all(pending.done for pending in self._stops):
            time.sleep(0.005)

    def _stop(self, service: str, method: str, *args: Any) -> None:
        if self.has(service, method):
            with contextlib.suppress(ActionFailed):
                self._stops.append(self.begin(service, method, *args))

    def _end(self, service: str, method: str, uses: object) -> None:
        if method in WALKS:
            self._stop("ALMotion", "stopMove")
        elif method in KILLS:
            self._stop("ALMotion", "killAll")
        elif isinstance(uses, Sequence) and uses:
            self.stop([str(joint) for joint in uses])
        for stopping in STOPS.get(service, ()):
            self._stop(*stopping)


def waited(seconds: float) -> Task:
    """Let some time pass."""
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        yield
    return ""
