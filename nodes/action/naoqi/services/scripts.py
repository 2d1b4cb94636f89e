"""Several actions one after the other, as one call of a program: it waits for the last one."""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any

from nep_core.messages import ActionResult
from nodes.action.naoqi.server import CallFailed, Promise
from nodes.action.naoqi.serving import ServedRobot


class Asked:
    """An action that the robot was asked to do, and how it has ended."""

    def __init__(self, robot: ServedRobot, action: str, **args: Any) -> None:
        self._robot = robot
        self._then: Callable[[], None] | None = None
        self.result: ActionResult | None = None
        self.id = robot.ask(action, self._end, **args)

    def then(self, call: Callable[[], None]) -> None:
        """Call something at the end, or now when it has ended."""
        with self._robot.lock:
            self._then = call
            has_ended = self.result is not None
        if has_ended:
            call()

    def stop(self) -> None:
        """End it, at once."""
        self._robot.stop_one(self.id)

    def _end(self, result: ActionResult) -> None:
        with self._robot.lock:
            self.result = result
            then = self._then
        if then is not None:
            then()


Begin = Callable[..., Asked]
"""Asks the robot for an action, as a part of the script: ``begin("say", text="Hello")``."""
Script = Generator[Asked, None, None]
"""Yields what has to end before it goes on; what it has begun and not awaited ends with it."""
Plot = Callable[[Begin], Script]


def play_script(robot: ServedRobot, plot: Plot, value: Any = None, stopped: Any = None) -> Any:
    """Play a script; the caller waits for its end, and gets a value then.

    It ends early when the robot fails at something, or when that is stopped.
    """
    promise = Promise()
    playing = _Playing(robot, plot, promise, value, stopped)
    promise.on_cancel = playing.give_up
    playing.go_on()
    return promise.future


class _Playing:
    """A script that is played."""

    def __init__(
        self, robot: ServedRobot, plot: Plot, promise: Promise, value: Any, stopped: Any
    ) -> None:
        self._robot = robot
        self._script = plot(self._begin)
        self._begun: list[Asked] = []
        self._promise = promise
        self._value = value
        self._stopped = stopped
        self._waits_for: Asked | None = None
        self._is_over = False

    def go_on(self) -> None:
        """Go on after what it waited for, if that was done; else end."""
        with self._robot.lock:
            if self._is_over:
                return
            result = self._waits_for.result if self._waits_for is not None else None
            is_right = result is None or result.state == "done"
            try:
                following = next(self._script, None) if is_right else None
            except CallFailed as problem:
                following, refused = None, problem.sentence
            else:
                refused = ""
            self._waits_for, self._is_over = following, following is None
        if following is not None:
            following.then(self.go_on)
            return
        self._stop_rest()
        if refused:
            self._promise.fail(refused)
        else:
            self._answer(result)

    def give_up(self) -> None:
        """Stop, because the caller does not want it any more."""
        with self._robot.lock:
            if self._is_over:
                return
            self._is_over = True
        self._stop_rest()
        self._promise.cancelled()

    def _begin(self, action: str, **args: Any) -> Asked:
        asked = Asked(self._robot, action, **args)
        self._begun.append(asked)
        return asked

    def _stop_rest(self) -> None:
        for asked in self._begun:
            if asked.result is None:
                asked.stop()

    def _answer(self, last: ActionResult | None) -> None:
        if last is None or last.state == "done":
            self._promise.set(self._value)
        elif last.state == "failed":
            self._promise.fail(last.description)
        else:
            self._promise.set(self._stopped)


def one_by_one(actions: list[tuple[str, dict[str, Any]]]) -> Plot:
    """Do some actions one after the other."""

    def play(begin: Begin) -> Script:
        for action, args in actions:
            yield begin(action, **args)

    return play
