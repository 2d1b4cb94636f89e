"""A robot in the test's own process that answers when the test lets it, and notes what is asked."""

from __future__ import annotations

from typing import Any

from driver_held_nao import SERVICES, HeldNao

from robots.naoqi.server.server import Server
from robots.naoqi.wire.errors import CallFailed
from robots.naoqi.wire.promise import Promise
from robots.naoqi.wire.service import method

SCRIPTED = (*SERVICES, "ALAutonomousLife", "ALTracker")
LEGS = ["LHipPitch", "RHipPitch", "LKneePitch", "RKneePitch"]


class ScriptedNao(HeldNao):
    """All its services in one. What is in ``holds`` is answered when it is let ``go``."""

    def __init__(self) -> None:
        super().__init__()
        self.asked: list[tuple[Any, ...]] = []
        self.data: dict[str, str] = {}
        self.holds: set[str] = set()
        self.refuses: set[tuple[Any, ...]] = set()
        self.is_walking = False
        self.life = "disabled"
        self.celsius = 30.0
        self.tasks: list[list[Any]] = []
        self._held: list[tuple[str, Promise, Any]] = []
        self._server = Server({name: self for name in SCRIPTED}, port=0)
        self.address = f"127.0.0.1:{self._server.start()}"

    def close(self) -> None:
        self._server.stop()

    def times(self, *call: Any) -> int:
        """How often something was asked, of which this is the beginning."""
        return sum(one[: len(call)] == call for one in list(self.asked))

    def let_go(self, name: str) -> None:
        """Answer what was asked of this name, and hold it no more."""
        self.holds.discard(name)
        for held, promise, answer in list(self._held):
            if held == name:
                promise.set(answer() if callable(answer) else answer)
        self._held = [one for one in self._held if one[0] != name]

    def _asked(self, *call: Any, answer: Any = None) -> Any:
        self.asked.append(call)
        if call in self.refuses or call[:1] in self.refuses:
            raise CallFailed("No.")
        if call[0] in self.holds:
            promise = Promise()
            self._held.append((call[0], promise, answer))
            return promise.future
        return answer() if callable(answer) else answer

    @method("moveTo::b(fff)")
    def move_to(self, x: float, y: float, theta: float) -> Any:
        return self._asked("moveTo", x, y, theta, answer=True)

    @method("stopMove::v()")
    def stop_move(self) -> Any:
        return self._asked("stopMove")

    @method("moveIsActive::b()")
    def walks(self) -> Any:
        return self._asked("moveIsActive", answer=lambda: self.is_walking)

    @method("killTasksUsingResources::v([s])")
    def kill_tasks(self, names: list[str]) -> Any:
        return self._asked("kill", *names)

    @method("killTask::b(i)")
    def kill_task(self, number: int) -> Any:
        return self._asked("killTask", number, answer=True)

    @method("getTaskList::m()")
    def task_list(self) -> Any:
        return self._asked("getTaskList", answer=self.tasks)

    @method("angleInterpolationWithSpeed::v(mmf)")
    def go(self, names: Any, angles: Any, speed: float) -> Any:
        return self._asked("go", *names)

    @method("rest::v()")
    def rest(self) -> Any:
        def lie() -> None:
            self.awake = False

        return self._asked("rest", answer=lie)

    @method("wakeUp::v()")
    def wake_up(self) -> Any:
        def rise() -> None:
            self.awake = True

        return self._asked("wakeUp", answer=rise)

    @method("getState::s()")
    def life_state(self) -> Any:
        return self._asked("getState", answer=lambda: self.life)

    @method("setState::v(s)")
    def set_life(self, state: str) -> Any:
        def live() -> None:
            self.life = state

        return self._asked("setState", state, answer=live)

    @method("stopTracker::v()")
    def stop_tracker(self) -> Any:
        return self._asked("stopTracker")

    @method("getData::m(s)")
    def read(self, key: str) -> Any:
        if key not in self.data:
            raise CallFailed("no such key")
        return self._asked("read", key, answer=lambda: self.data[key])

    @method("insertData::v(sm)")
    def write(self, key: str, value: Any) -> Any:
        def keep() -> None:
            self.data[key] = value

        return self._asked("write", key, answer=keep)

    @method("getListData::m(m)")
    def values(self, keys: list[str]) -> list[Any]:
        return [self.celsius if "RKneePitch/Temperature" in key else None for key in keys]
