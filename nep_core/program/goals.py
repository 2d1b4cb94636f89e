"""Goals: longer tasks that run one at a time, of which the more important interrupt the others."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

from nep_core.errors import NepError
from nep_core.wire.messages import ProgramEvent

from .tasks import POLL_S, Part, Task, current_task

Priority = Literal["low", "normal", "high"]
Interrupted = Literal["again", "drop"]
GoalEvent = Literal["finished", "stopped", "interrupted", "returns"]
End = Literal["finished", "stopped", "interrupted"]

ORDER: dict[str, int] = {"low": 0, "normal": 1, "high": 2}
TOLD: dict[End, ProgramEvent] = {
    "finished": "goal_finished",
    "stopped": "goal_stopped",
    "interrupted": "goal_interrupted",
}


@dataclass(eq=False)
class Goal:
    """What to do when the person does ``state``, until it is done or they do ``stop``.

    ``interrupted``: whether it begins again after a more important goal, or is dropped.
    ``hooks`` are what to do besides: when it has finished, was stopped or interrupted, or returns.
    """

    name: str
    state: str
    action: Action
    priority: Priority = "normal"
    stop: str = ""
    interrupted: Interrupted = "again"
    hooks: dict[GoalEvent, list[Action]] = field(default_factory=dict)
    returns: bool = False


class Goals:
    """The goals of a behaviour: at most one runs, the others wait by priority, then by time."""

    def __init__(self, tell: Callable[[ProgramEvent, str], None]) -> None:
        self._tell = tell
        self._goals: list[Goal] = []
        self._hooks: list[tuple[str, GoalEvent, Action]] = []
        self._waiting: list[Goal] = []
        self._running: Goal | None = None
        self._task: Task | None = None
        self._cut: End = "finished"
        self._has_ended = False
        """Whether the running goal came to its end by itself, whatever cut it after that."""
        self._news = threading.Condition()

    def __bool__(self) -> bool:
        return bool(self._goals or self._hooks)

    @property
    def states(self) -> list[str]:
        """The states that begin a goal or stop it."""
        return [state for goal in self._goals for state in (goal.state, goal.stop)]

    @property
    def is_busy(self) -> bool:
        """Whether a goal runs or waits."""
        return self._running is not None or bool(self._waiting)

    def add(self, goal: Goal) -> None:
        """Add a goal; its name is its own."""
        if any(known.name == goal.name for known in self._goals):
            raise NepError(
                "Two goals are called “{name}”.",
                checklist=("Give each goal a name of its own.",),
                name=goal.name,
            )
        if goal.priority not in ORDER:
            raise NepError(
                "A goal cannot have the priority “{priority}”.",
                checklist=("Choose one of: {order}.",),
                priority=goal.priority,
                order=", ".join(ORDER),
            )
        self._goals.append(goal)

    def hook(self, name: str, event: GoalEvent, action: Action) -> None:
        """Do something besides when that happens to a goal, which may be added later."""
        self._hooks.append((name, event, action))

    def hear(self, state: str) -> None:
        """Take in what the person does: goals begin, stop and interrupt each other."""
        with self._news:
            self._waiting = [goal for goal in self._waiting if goal.stop != state]
            if self._running and self._running.stop == state:
                self._cut_running("stopped")
            for goal in self._goals:
                if goal.state == state and goal not in (self._running, *self._waiting):
                    goal.returns = False
                    self._waiting.append(goal)
            self._interrupt()
            self._news.notify_all()

    def run(self) -> None:
        """Pursue goals one after the other until this part of the program is cancelled."""
        self._give_hooks()
        task = current_task()
        while True:
            self._pursue(self._next(task), task)

    def _give_hooks(self) -> None:
        goals = {goal.name: goal for goal in self._goals}
        for name, event, action in self._hooks:
            if name not in goals:
                raise NepError(
                    "There is no goal with the name “{name}”.",
                    checklist=("Write the name as the goal's own block has it.",),
                    name=name,
                )
            goals[name].hooks.setdefault(event, []).append(action)

    def _next(self, task: Task) -> Goal:
        """Wait for a goal, and make it the running one."""
        with self._news:
            while not self._waiting:
                task.check()
                self._news.wait(POLL_S)
            goal = max(self._waiting, key=lambda waiting: ORDER[waiting.priority])
            self._waiting.remove(goal)
            self._running, self._cut, self._task = goal, "finished", None
            self._has_ended = False
            return goal

    def _pursue(self, goal: Goal, task: Task) -> None:
        """Run a goal to its end, or until it is stopped or interrupted; then what follows that."""
        part = Part(lambda: self._play(goal), f"nep-goal-{goal.name}", task)
        with self._news:
            self._task = part.task
            if self._cut != "finished":  # cut before it could begin
                part.task.cancel()
        self._tell("goal_started", goal.name)
        _wait_for(part.start(), task)
        with self._news:
            end: End = "finished" if self._has_ended else self._cut
            self._task = None
        self._tell(TOLD[end], goal.name)
        for action in goal.hooks.get(end, ()):
            _wait_for(Part(action, f"nep-goal-{goal.name}-{end}", task).start(), task)
        self._release(goal, end)

    def _release(self, goal: Goal, end: End) -> None:
        """Let go of a goal that has ended; one that returns waits before those of its priority."""
        with self._news:
            self._running = None
            was_stopped = self._cut == "stopped"  # while its hooks ran
            if end == "interrupted" and goal.interrupted == "again" and not was_stopped:
                goal.returns = True
                self._waiting.insert(0, goal)

    def _play(self, goal: Goal) -> None:
        if goal.returns:
            for returning in goal.hooks.get("returns", ()):
                returning()
        goal.action()
        with self._news:
            self._has_ended = True

    def _interrupt(self) -> None:
        running = self._running
        if running is None or self._cut != "finished":
            return
        if any(ORDER[goal.priority] > ORDER[running.priority] for goal in self._waiting):
            self._cut_running("interrupted")

    def _cut_running(self, end: End) -> None:
        """End the running goal; being stopped outdoes being interrupted."""
        self._cut = end
        if self._task is not None:
            self._task.cancel()


def _wait_for(part: Part, task: Task) -> None:
    """Wait for the end of a part; its error is raised here, and it ends with ``task``."""
    while part.is_running:
        part.join(POLL_S)
    task.check()
    if part.error is not None:
        raise part.error
