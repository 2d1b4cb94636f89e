"""Goals: longer tasks, one at a time for each robot, of which the more important come first."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import Literal

from nep_core.errors import NepError
from nep_core.wire.messages import ProgramEvent

from .tasks import (
    POLL_S,
    PRIORITIES,
    Countdown,
    Part,
    Priority,
    RuleDisplaced,
    RuleStopped,
    Standing,
    Task,
    WhenDisplaced,
    check_priority,
    current_task,
)

Action = Callable[[], object]
Condition = Callable[[], object]
Interrupted = Literal["again", "resume", "drop"]
GoalEvent = Literal["finished", "failed", "stopped", "interrupted", "returns"]
End = Literal["finished", "failed", "stopped", "interrupted"]

TOLD: dict[End, ProgramEvent] = {
    "finished": "goal_finished",
    "failed": "goal_failed",
    "stopped": "goal_stopped",
    "interrupted": "goal_interrupted",
}


class GoalFailed(RuleStopped):
    """The goal that is pursued here cannot be reached."""


@dataclass(eq=False)
class Goal:
    """What to do when the person does ``when``, until it is done or they do ``stop``.

    ``when`` may be a condition, too, or "": only when it is asked for. ``interrupted``: whether it
    begins again after a more important goal, goes on where it was, or is dropped. ``robots`` are
    those whose goal it is; it is that of all when there are none. When it has run for
    ``at_most_s`` it has failed. ``hooks`` are what to do besides: when it has finished or failed,
    was stopped or interrupted, or returns.
    """

    name: str
    when: str | Condition
    action: Action
    priority: Priority = "normal"
    stop: str = ""
    interrupted: Interrupted = "again"
    robots: frozenset[str] = frozenset()
    at_most_s: float = math.inf
    hooks: dict[GoalEvent, list[Action]] = field(default_factory=dict)

    def excludes(self, other: Goal) -> bool:
        """Whether the two may not run at once: they are for one robot."""
        is_of_all = not self.robots or not other.robots
        return is_of_all or bool(self.robots & other.robots)

    @property
    def importance(self) -> int:
        """Its priority as a number, larger for what is more important."""
        return PRIORITIES[self.priority]


class Pursuit:
    """A goal that runs or waits, from when it is asked for until its end."""

    def __init__(self, goal: Goal, value: object) -> None:
        self.goal = goal
        self.value = value
        """What it was given."""
        self.returns = False
        """Whether it was interrupted before."""
        self.is_dropped = False
        self.part: Part | None = None
        """The goal's function while it runs, or stands still."""
        self.task: Task | None = None
        """What is to end when the goal is cut: its function, or what precedes that."""
        self.begin_anew()

    def begin_anew(self) -> None:
        """Forget how it went so far, but for a function that stands still."""
        self.cut: End | None = None
        """Why it is to end before its function does."""
        self.outcome: End | None = None
        """How its function has ended by itself, whatever cut it after that."""
        if self.part is None:
            drops = self.goal.interrupted == "drop"
            displaced: WhenDisplaced = "give_up" if drops else "resume"
            self.standing = Standing(self.goal.name, self.goal.priority, displaced, self)
            self.left = Countdown(self.goal.at_most_s)

    @property
    def is_held(self) -> bool:
        """Whether its function stands still, to go on later."""
        return self.part is not None and self.part.task.is_held and self.part.is_running

    def end(self, cut: End) -> None:
        """Let it end, or stand still; being stopped outdoes being interrupted."""
        self.cut = cut
        self.obey()

    def obey(self) -> None:
        """Cut what runs for it, if it is to end."""
        if self.task is None or self.cut is None:
            return
        is_function = self.part is not None and self.task is self.part.task
        if is_function and self.cut == "interrupted" and self.goal.interrupted == "resume":
            self.task.hold()
        else:
            self.task.cancel()


class Goals:
    """The goals of a behaviour: at most one a robot runs, the others wait by priority and time."""

    def __init__(
        self,
        tell: Callable[[ProgramEvent, str], None],
        note_error: Callable[[BaseException, str], None],
    ) -> None:
        self._tell, self._note_error = tell, note_error
        self._goals: dict[str, Goal] = {}
        self._hooks: list[tuple[str, GoalEvent, Action]] = []
        self._waiting: list[Pursuit] = []
        self._given_up: list[Pursuit] = []
        """Those that had begun, and were stopped while another one ran."""
        self._running: list[Pursuit] = []
        self._news = threading.Condition(threading.RLock())

    def __bool__(self) -> bool:
        return bool(self._goals or self._hooks)

    @property
    def states(self) -> list[str]:
        """The states that begin a goal or stop it."""
        goals = self._goals.values()
        return [one for goal in goals for one in (goal.when, goal.stop) if isinstance(one, str)]

    @property
    def is_busy(self) -> bool:
        """Whether a goal runs or waits."""
        return bool(self._running or self._waiting or self._given_up)

    def add(self, goal: Goal) -> None:
        """Add a goal; its name is its own. Raises NepError."""
        if goal.name in self._goals:
            raise NepError(
                "Two goals are called “{name}”.",
                checklist=("Give each goal a name of its own.",),
                name=goal.name,
            )
        check_priority(goal.priority)
        self._goals[goal.name] = goal

    def hook(self, name: str, event: GoalEvent, action: Action) -> None:
        """Do something besides when that happens to a goal, which may be added later."""
        self._hooks.append((name, event, action))

    # What begins goals and ends them

    def hear(self, state: str) -> None:
        """Take in what the person does: goals begin, stop and interrupt each other."""
        with self._news:
            for goal in self._goals.values():
                if goal.stop and goal.stop == state:
                    self._stop(goal)
            for goal in self._goals.values():
                if state and goal.when == state:
                    self._begin(goal, "")
            self._interrupt()
            self._news.notify_all()

    def pursue(self, name: str, value: object) -> None:
        """Let a goal begin when its turn comes, unless it runs or waits. Raises NepError."""
        goal = self._named(name)
        with self._news:
            self._begin(goal, value)
            self._interrupt()
            self._news.notify_all()

    def give_up(self, name: str) -> None:
        """Let a goal end that runs or waits. Raises NepError."""
        goal = self._named(name)
        with self._news:
            self._stop(goal)
            self._news.notify_all()

    def is_pursued(self, name: str) -> bool:
        """Whether a goal runs, or waits: for its turn, or to return. Raises NepError."""
        goal = self._named(name)
        with self._news:
            return any(one.goal is goal for one in (*self._running, *self._waiting))

    def _named(self, name: str) -> Goal:
        if name not in self._goals:
            raise _unknown(name, self._goals)
        return self._goals[name]

    def _begin(self, goal: Goal, value: object) -> None:
        if all(one.goal is not goal for one in (*self._running, *self._waiting)):
            self._waiting.append(Pursuit(goal, value))

    def _stop(self, goal: Goal) -> None:
        for pursuit in [one for one in self._waiting if one.goal is goal]:
            self._waiting.remove(pursuit)
            if pursuit.returns:
                self._given_up.append(pursuit)
        for pursuit in self._running:
            if pursuit.goal is goal:
                pursuit.end("stopped")

    def _interrupt(self) -> None:
        """Cut the running goals that are in the way of more important ones."""
        for pursuit in self._next():
            in_way = [one for one in self._running if one.goal.excludes(pursuit.goal)]
            if all(one.goal.importance < pursuit.goal.importance for one in in_way):
                for one in in_way:
                    if one.cut is None:
                        one.end("interrupted")

    def _next(self) -> Iterator[Pursuit]:
        """The waiting goals that no other waiting goal goes before, the most important first."""
        before: list[Goal] = []
        for pursuit in sorted(self._waiting, key=lambda waiting: -waiting.goal.importance):
            if not any(goal.excludes(pursuit.goal) for goal in before):
                yield pursuit
            before.append(pursuit.goal)

    # Pursuing them

    def run(self) -> None:
        """Pursue goals, each when its turn comes, until this part of the program is cancelled."""
        self._hang_hooks()
        task = current_task()
        for goal in self._goals.values():
            if callable(goal.when):
                Part(partial(self._watch, goal, goal.when), f"nep-watch-{goal.name}", task).start()
        while True:
            with self._news:
                while not (ready := self._ready()):
                    task.check()
                    self._news.wait(POLL_S)
                self._running += ready
            for pursuit in ready:
                go = partial(self._pursue, pursuit, task)
                Part(go, f"nep-goals-{pursuit.goal.name}", task).start()

    def _hang_hooks(self) -> None:
        for name, event, action in self._hooks:
            if name in self._goals:
                self._goals[name].hooks.setdefault(event, []).append(action)
            else:
                self._note_error(_unknown(name, self._goals), name)

    def _watch(self, goal: Goal, condition: Condition) -> None:
        """Begin a goal each time that its condition becomes true."""
        was_true = False
        try:
            while True:
                is_true = bool(condition())
                if is_true and not was_true:
                    self.pursue(goal.name, "")
                was_true = is_true
                current_task().sleep(POLL_S)
        except Exception as error:
            self._note_error(error, goal.name)

    def _ready(self) -> list[Pursuit]:
        """Take those whose turn it is out of what waits; what was given up is told first."""
        ready: list[Pursuit] = []
        for pursuit in [*self._given_up, *self._next()]:
            busy = [*self._running, *ready]
            if any(one.goal.excludes(pursuit.goal) for one in busy):
                continue
            ready.append(pursuit)
            if pursuit in self._waiting:
                self._waiting.remove(pursuit)
                pursuit.begin_anew()
            else:
                self._given_up.remove(pursuit)
                pursuit.cut = "stopped"
        return ready

    def _pursue(self, pursuit: Pursuit, task: Task) -> None:
        """Run a goal to its end, or until it is cut; then what follows that."""
        current_task().standing = pursuit.standing
        if pursuit.cut == "stopped" and pursuit.returns:
            self._drop(pursuit)
            end: End = "stopped"
        else:
            end = self._play_through(pursuit, task)
        self._tell(TOLD[end], pursuit.goal.name)
        self._play_hooks(pursuit, end)
        with self._news:
            self._running.remove(pursuit)
            was_stopped = pursuit.cut == "stopped"  # perhaps while its hooks ran
            is_dropped = pursuit.goal.interrupted == "drop" or pursuit.is_dropped
            if end == "interrupted" and not is_dropped and not was_stopped:
                # One that returns waits before those of its priority
                pursuit.returns = True
                self._waiting.insert(0, pursuit)
            else:
                self._drop(pursuit)
            self._interrupt()
            self._news.notify_all()

    def _play_through(self, pursuit: Pursuit, task: Task) -> End:
        """Begin a goal, or let it go on, and wait until it has ended or stands still."""
        self._tell("goal_started", pursuit.goal.name)
        if pursuit.returns:
            self._play_hooks(pursuit, "returns", is_cuttable=True)
        with self._news:
            part = pursuit.part
            if part is None:
                name = f"nep-goal-{pursuit.goal.name}"
                part = pursuit.part = Part(partial(self._play, pursuit), name, task).start()
            if pursuit.cut is None:
                part.task.go_on()
            pursuit.task = part.task
            pursuit.left.skip()
            pursuit.obey()
        part.await_end(lambda: self._look(pursuit))
        return self._note_end(pursuit, part)

    def _note_end(self, pursuit: Pursuit, part: Part) -> End:
        with self._news:
            pursuit.task = None
            current_task().check()
            if pursuit.is_held:
                return "interrupted"
            pursuit.part = None
            if part.error is not None:
                self._note_error(part.error, pursuit.goal.name)
                return "stopped"
            return pursuit.outcome or pursuit.cut or "stopped"

    def _look(self, pursuit: Pursuit) -> bool:
        """Let a goal fail whose time is over; whether it stands still."""
        with self._news:
            if pursuit.cut is None and pursuit.left.left_s() <= 0:
                pursuit.end("failed")
            return pursuit.is_held

    def _play(self, pursuit: Pursuit) -> None:
        """Do what the goal is, and note how it has ended."""
        current_task().standing = pursuit.standing
        outcome: End = "finished"
        try:
            pursuit.goal.action()
        except GoalFailed:
            outcome = "failed"
        except RuleDisplaced:
            outcome, pursuit.is_dropped = "interrupted", True
        except RuleStopped:
            pass
        with self._news:
            pursuit.outcome = outcome

    def _drop(self, pursuit: Pursuit) -> None:
        """End the function of a goal that does not return."""
        if (part := pursuit.part) is not None:
            pursuit.part = None
            part.task.cancel()

    def _play_hooks(self, pursuit: Pursuit, event: GoalEvent, *, is_cuttable: bool = False) -> None:
        """Do what follows an event; its errors are told, and end nothing else."""
        goal = pursuit.goal
        for action in goal.hooks.get(event, ()):
            part = Part(action, f"nep-goal-{goal.name}-{event}", current_task())
            with self._news:
                if is_cuttable:
                    pursuit.task = part.task
                    pursuit.obey()
            part.start().await_end()
            current_task().check()
            if part.error is not None and not isinstance(part.error, RuleStopped):
                self._note_error(part.error, goal.name)
        pursuit.task = None


def _unknown(name: str, goals: Iterable[str]) -> NepError:
    return NepError(
        "There is no goal with the name “{name}”.",
        checklist=("Write the name as the goal's own block has it.", "The goals are: {goals}."),
        name=name,
        goals=", ".join(goals),
    )


# What a goal may say of itself.


def goal_value() -> object:
    """What the goal that is pursued here was given; "" when nothing. Raises NepError."""
    return _here().value


def fail_goal() -> None:
    """End the goal that is pursued here: it cannot be reached. Raises NepError."""
    _here()
    raise GoalFailed


def _here() -> Pursuit:
    pursuit = current_task().standing.goal
    if not isinstance(pursuit, Pursuit):
        raise NepError(
            "No goal is pursued here.",
            checklist=("Put this block below the block of a goal.",),
        )
    return pursuit
