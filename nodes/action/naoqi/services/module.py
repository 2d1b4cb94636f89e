"""What all services of NAOqi have in common."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

from nep_core.messages import ActionResult
from nodes.action.naoqi.server import CallFailed, Promise, method
from nodes.action.naoqi.server import Module as NaoqiModule
from nodes.action.naoqi.serving import ServedRobot

Kept = tuple[Callable[..., None], Callable[..., Any]]


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


def kept(setter: str, getter: str, default: Any, choices: Collection[Any] = ()) -> Kept:
    """Return a pair of methods for a value that the robot only remembers."""
    name = getter.partition("::")[0]

    @method(setter)
    def change(self: Module, value: Any) -> None:
        if choices and value not in choices:
            possible = ", ".join(map(str, choices))
            raise CallFailed(f"{name}: there is no “{value}”. Possible: {possible}.")
        self._kept[name] = value

    @method(getter)
    def read(self: Module) -> Any:
        return self._kept.get(name, default)

    return change, read
