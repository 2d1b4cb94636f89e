"""What all services of NAOqi have in common."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Generator
from typing import Any

from faults import Text
from robots.body.driver import ActionResult
from robots.naoqi.server.module import Module as NaoqiModule
from robots.naoqi.serving import ServedRobot
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.service import method


class Module(NaoqiModule):
    """One service of a robot; its class has the name of the service."""

    def __init__(self, robot: ServedRobot) -> None:
        self._robot = robot
        self._kept: dict[str, Any] = {}

    @property
    def name(self) -> str:
        """The service's name, such as ALMotion."""
        return type(self).__name__

    def _do(
        self,
        action: str,
        value: Any = None,
        *,
        stopped: Any = None,
        then: Callable[[], None] | None = None,
        **args: Any,
    ) -> Any:
        """Let the robot act; the caller waits for the end, and gets a value then.

        ``stopped`` is for an action that another call stopped. A caller that gives up stops it.
        ``then`` is called at the end, however it ends.
        """
        promise = Promise()
        asked: list[str] = []

        def end(result: ActionResult) -> None:
            if then is not None:
                then()
            if result.state == "failed":
                promise.fail(result.description)
            elif result.state == "done":
                promise.set(value)
            elif promise.is_cancelled:
                promise.cancelled()
            else:
                promise.set(stopped)

        asked.append(self._robot.ask(action, end, **args))
        promise.on_cancel = lambda: self._robot.stop_one(asked[0])
        return promise.future

    def _set(self, action: str, **args: Any) -> None:
        """Let the robot do what takes no time; nobody waits for it. Raises CallFailed."""
        told: list[ActionResult] = []
        self._robot.ask(action, told.append, **args)
        if told and told[0].state == "failed":
            raise CallFailed(told[0].description)


def kept(
    getter: str, default: Any, choices: Collection[Any] = (), *, setter: str = ""
) -> Callable[..., Any]:
    """Return a method for a value that the robot only remembers, to set it and to get it.

    It gets it by the signature ``getter``, such as ``getMode::s()``, until then ``default``; and
    sets it by ``setter``, if that is not as usual (``setMode::v(s)``), to one of the ``choices``
    where there are some.
    """
    name = getter.partition("::")[0]

    @method(setter or _setter_of(getter), getter)
    def keep(self: Module, *given: Any) -> Any:
        if not given:
            return self._kept.get(name, default)
        (value,) = given
        if choices and value not in choices:
            raise CallFailed(
                "{name}: there is no “{value}”. Possible: {possible}.",
                name=name,
                value=value,
                possible=", ".join(map(str, choices)),
            )
        self._kept[name] = value
        return None

    return keep


def kept_each(
    getter: str,
    default: Any,
    *,
    setter: str = "",
    of_all: str = "",
    known: Callable[[Any, str], object] = lambda self, name: None,
) -> Callable[..., Any]:
    """Return a method for values that the robot remembers by a name, as ``kept`` for one.

    ``getter``, ``default`` and ``setter`` are as there. What has no value has that of the name
    ``of_all``. ``known`` raises CallFailed for strange names.
    """
    what = getter.partition("::")[0]
    answer = True if "::b" in setter else None

    @method(setter or _setter_of(getter), getter)
    def keep(self: Module, name: str, *given: Any) -> Any:
        known(self, name)
        if not given:
            return self._kept.get(f"{what} {name}", self._kept.get(f"{what} {of_all}", default))
        self._kept[f"{what} {name}"] = given[0]
        return answer

    return keep


def _setter_of(getter: str) -> str:
    """The signature that sets what another one gets: isEnabled::b() has setEnabled::v(b)."""
    return re.sub(r"(?:get|is)(\w+)::(\w)\((s?)\)", r"set\1::v(\3\2)", getter)


def always(value: Any, *signatures: str) -> Callable[..., Any]:
    """Return a method that answers the same to every call."""

    @method(*signatures)
    def answer(self: Module, *given: Any) -> Any:
        return value

    return answer


# Several actions one after the other, as one call of a program: it waits for the last one.


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

    It ends early when the ``robot`` fails at something in its ``plot``, or when that is stopped:
    then the caller gets ``stopped``.
    """
    playing = _Playing(robot, plot, value, stopped)
    playing.go_on()
    return playing.promise.future


class _Playing:
    """A script that is played."""

    def __init__(self, robot: ServedRobot, plot: Plot, value: Any, stopped: Any) -> None:
        self.promise = Promise(self._give_up)
        self._robot = robot
        self._script = plot(self._begin)
        self._begun: list[Asked] = []
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
            refused: Text | None = None
            try:
                following = next(self._script, None) if is_right else None
            except CallFailed as problem:
                following, refused = None, problem.sentence
            self._waits_for, self._is_over = following, following is None
        if following is not None:
            following.then(self.go_on)
            return
        self._stop_rest()
        if refused:
            self.promise.fail(refused)
        elif result is None or result.state == "done":
            self.promise.set(self._value)
        elif result.state == "failed":
            self.promise.fail(result.description)
        else:
            self.promise.set(self._stopped)

    def _give_up(self) -> None:
        """Stop, because the caller does not want it any more."""
        with self._robot.lock:
            if self._is_over:
                return
            self._is_over = True
        self._stop_rest()
        self.promise.cancelled()

    def _begin(self, action: str, **args: Any) -> Asked:
        asked = Asked(self._robot, action, **args)
        self._begun.append(asked)
        return asked

    def _stop_rest(self) -> None:
        for asked in self._begun:
            if asked.result is None:
                asked.stop()


def one_by_one(actions: list[tuple[str, dict[str, Any]]]) -> Plot:
    """Do some actions one after the other."""

    def play(begin: Begin) -> Script:
        for action, args in actions:
            yield begin(action, **args)

    return play
