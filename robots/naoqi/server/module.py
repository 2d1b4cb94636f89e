"""What every module of NAOqi can do beside its own: the methods 100 to 112 of ALModule."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Sequence
from typing import Any

from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.metaobject import MetaObject
from robots.naoqi.wire.promise import Pending, Promise
from robots.naoqi.wire.service import FIRST_UID, Bound, description_of, method

VERSION = "2.8.7.4"
_tasks = itertools.count(1)


class Module:
    """A service with the methods that old NAOqi programs expect of every module."""

    @method("exit::v()", uid=100)
    def exit(self) -> None:
        """Refuse to end, as modules of a robot do."""
        raise CallFailed("This module stays as long as the robot is on.")

    @method("__pCall::i(I[m])", uid=101)
    def call_number(self, uid: int, values: list[Any]) -> int:
        """Begin a method by its number; return a task."""
        return self._begin(uid, values)

    @method("pCall::m(m)", uid=102)
    def call_name(self, call: Any) -> int:
        """Begin a method by its name; return a task."""
        if not isinstance(call, Sequence) or not call or not isinstance(call[0], str):
            raise CallFailed("pCall needs the name of a method and its values.")
        name, *values = call
        return self._begin(self._meta.overload(name, tuple(values)).uid, values)

    version = method("version::s()", uid=103)(lambda self: VERSION)
    ping = method("ping::b()", uid=104)(lambda self: True)

    @method("getMethodList::[s]()", uid=105)
    def method_names(self) -> list[str]:
        """Return the names of all methods."""
        return [name for name, all_of in self._meta.by_name.items() if all_of[0].uid >= FIRST_UID]

    @method("getMethodHelp::m(s)", uid=106)
    def method_help(self, name: str) -> list[Any]:
        """Return what is known of a method."""
        overloads = self._meta.by_name.get(name)
        if not overloads:
            raise CallFailed("There is no method {name}.", name=name)
        first = overloads[0]
        return [name, first.description, [str(one) for one in overloads], first.returns, ""]

    module_help = method("getModuleHelp::m()", uid=107)(lambda self: [self._meta.description, []])

    @method("wait::b(ii)", uid=108)
    def wait(self, task: int, timeout_ms: int) -> Any:
        """False when the task has ended, True when it still runs then, as NAOqi has it."""
        pending = self._tasks.get(task)
        if pending is None or pending.done:
            return False
        promise = Promise()
        timer = threading.Timer(max(0, timeout_ms) / 1000.0, promise.set, (True,))
        timer.daemon = True
        if timeout_ms > 0:
            timer.start()

        def end(_: Pending) -> None:
            timer.cancel()
            promise.set(False)

        pending.when_done(end)
        return promise.future

    @method("isRunning::b(i)", uid=109)
    def is_running(self, task: int) -> bool:
        """Whether a task is under way."""
        pending = self._tasks.get(task)
        return pending is not None and not pending.done

    @method("stop::v(i)", uid=110)
    def stop(self, task: int) -> None:
        """Give a task up."""
        pending = self._tasks.get(task)
        if pending is not None:
            pending.cancel()

    broker_name = method("getBrokerName::s()", uid=111)(lambda self: "MainBroker")

    @method("getUsage::s(s)", uid=112)
    def usage(self, name: str) -> str:
        """Return the signatures of a method."""
        return "\n".join(str(one) for one in self._meta.by_name.get(name, []))

    @property
    def _meta(self) -> MetaObject:
        return description_of(type(self)).meta

    @property
    def _tasks(self) -> dict[int, Pending]:
        tasks: dict[int, Pending] = vars(self).setdefault("_module_tasks", {})
        return tasks

    def _begin(self, uid: int, values: Sequence[Any]) -> int:
        """Begin a method as a task; return the task's number."""
        pending = Bound(self, 0).begin(uid, tuple(values))
        number = next(_tasks)
        self._tasks[number] = pending

        def forget(_: Pending) -> None:
            self._tasks.pop(number, None)

        pending.when_done(forget)
        return number
