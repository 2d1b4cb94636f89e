"""Behavior: rules that fire on what the person does, what runs at the start, and goals."""

from __future__ import annotations

import contextlib
import logging
import random
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from types import CodeType, FunctionType
from typing import Literal

from faults import Fault, fault_in, fault_of
from nep_core.errors import NepError
from nep_core.networks.network import Network
from nep_core.networks.transports import default_network
from nep_core.wire.messages import (
    EXPECTED_WORDS,
    PROGRAM_STATE,
    ExpectedWords,
    HumanBehavior,
    ProgramEvent,
    ProgramState,
    told,
)
from nep_core.wire.pubsub import Publisher
from nep_core.wire.states import state_of_thing, state_of_word, word_of_state

from .human import human_listener
from .kept import keep_now, take_troubles
from .tasks import CLOCK, POLL_S, PROGRAM, Cancelled, Part, RuleStopped, Task, current_task
from .values import speak

log = logging.getLogger(__name__)

Action = Callable[[], object]
Condition = Callable[[], object]
Decorator = Callable[[Action], Action]
Again = Literal["ignore", "restart", "queue"]
OnError = Literal["go_on", "end"]

MOST_QUEUED = 1000
TELL_AGAIN_S = 1.0
"""What happens over and over is told no more often than this, with how often it happened."""

# Who runs a program can say more about an error of it than that there was one.

Explain = Callable[[BaseException], tuple[Fault, int]]
"""The fault that a person reads of an error of the program, and its line of the file, 0: none."""


def _explain(error: BaseException) -> tuple[Fault, int]:
    return fault_in(error), 0


_explainers: list[Explain] = [_explain]


def explain_by(explain: Explain) -> None:
    """Let errors of rules be explained so from now on."""
    _explainers[:] = [explain]


@dataclass
class Rule:
    """When the person does this, do that; ``again``: what if it fires while it runs.

    ``source`` is who must tell of the state, "" for anybody. A rule with a ``condition`` fires
    each time that becomes true instead.
    """

    state: str
    action: Action
    again: Again = "ignore"
    source: str = ""
    condition: Condition | None = None
    running: Part | None = None
    queued: int = 0
    dropped: int = 0
    """How many starts did not fit into the queue since that was last told."""
    lock: threading.Lock = field(default_factory=threading.Lock)


class Behavior:
    """The rules of a program; ``run`` returns when the program ends.

    A behaviour without rules ends when all that was started at the start is done. An error in a
    rule, goal or start ends that one, and what it had begun on robots; ``on_error`` says whether
    the others "go_on", or whether the program shall "end" too. ``language`` is that in which
    values are told: the words for true, false and “and”, and the decimal mark.
    """

    def __init__(
        self,
        name: str = "behaviour",
        *,
        on_error: OnError = "go_on",
        language: str = "en",
        network: Network | None = None,
    ) -> None:
        speak(language)
        self.name = name
        self._ends_on_error = on_error == "end"
        self._network = network
        self._rules: list[Rule] = []
        self._starts: list[Action] = []
        self._goals = Goals(self._tell, self._note_error)
        self._busy_s = CLOCK.now_s()
        self._parts: list[Part] = []
        self._parts_lock = threading.Lock()
        self._first_error: BaseException | None = None
        self._told_drops_s = -TELL_AGAIN_S

    def when(self, state: str, *, again: Again = "ignore", source: str = "") -> Decorator:
        """Run the decorated function each time the person's state is ``state``.

        ``source``: only if this robot or node tells of it.

        When that happens while the function still runs: "ignore" it, "restart" the function, or
        "queue" another run.
        """

        return _decorator(lambda action: self._rules.append(Rule(state, action, again, source)))

    def when_heard(self, word: str, *, again: Again = "ignore") -> Decorator:
        """Run the decorated function each time that a word or sentence is heard."""
        return self.when(state_of_word(word), again=again)

    def when_noticed(
        self, thing: str, name: object = "", *, again: Again = "ignore", source: str = ""
    ) -> Decorator:
        """Run the decorated function each time that a robot begins to see or hear something.

        "face", "ball", "mark" or "sound"; ``name``: only this face, or the mark with this number.

        ``thing`` is which of these, ``source`` the robot that notices ("": any); ``again``:
        what to do when the rule still runs.
        """
        return self.when(state_of_thing(thing, name), again=again, source=source)

    def when_true(self, condition: Condition, *, again: Again = "ignore") -> Decorator:
        """Run the decorated function each time that ``condition()`` becomes true."""

        return _decorator(
            lambda action: self._rules.append(Rule("condition", action, again, condition=condition))
        )

    def when_idle(self, seconds: float) -> Decorator:
        """Run the decorated function each time that for so long no state came and no rule ran."""

        return _decorator(
            lambda action: self._rules.append(
                Rule("idle", action, condition=lambda: self._idle_s() >= seconds)
            )
        )

    def goal(
        self,
        name: str,
        *,
        when: str,
        priority: Priority = "normal",
        stop: str = "",
        interrupted: Interrupted = "again",
    ) -> Decorator:
        """Pursue the decorated function as a goal each time the person's state is ``when``.

        One goal runs at a time. One of a higher priority interrupts it; then it begins "again"
        afterwards, or is "drop"ped. The state ``stop`` ends it.

        ``name`` is told to people; ``interrupted`` is "again" or "drop".
        """

        return _decorator(
            lambda action: self._goals.add(Goal(name, when, action, priority, stop, interrupted))
        )

    def when_goal(self, name: str, event: GoalEvent) -> Decorator:
        """Run the decorated function when a goal has "finished", or was "stopped" or "interrupted".

        Or, before it begins again, when it "returns".
        """

        return _decorator(lambda action: self._goals.hook(name, event, action))

    def when_started(self, action: Action) -> Action:
        """Run the decorated function when the program starts."""
        self._starts.append(action)
        return action

    def run(self) -> None:
        """Run until the program is stopped or all is done; raises the first error of its parts."""
        network = self._network or default_network()
        self._states = Publisher(PROGRAM_STATE, network=network)
        words = Publisher(EXPECTED_WORDS, network=network)
        # What rules and goals wait for: real robots must know it before
        states = [*(rule.state for rule in self._rules), *self._goals.states]
        expected = dict.fromkeys(filter(None, map(word_of_state, states)))
        words.send(ExpectedWords(words=list(expected)))
        listener = human_listener(network)
        self._busy_s = CLOCK.now_s()
        listener.listen(self._on_behavior)
        try:
            for rule in self._rules:
                if rule.condition is not None:
                    self._start(partial(self._watch, rule), f"watch-{rule.state}")
            if self._goals:
                self._start(self._goals.run, "goals")
            for action in self._starts:
                self._start(partial(self._play, action, ""), "")
            self._supervise()
        finally:
            listener.unlisten(self._on_behavior)
            for part in self._parts:
                part.task.cancel()
            for part in self._parts:
                part.join(1.0)
            PROGRAM.end_undone()
            keep_now()
            self._tell_troubles()
            self._states.close()
            words.close()
        if self._first_error is not None and not PROGRAM.cancelled.is_set():
            raise self._first_error

    def _watch(self, rule: Rule) -> None:
        """Fire a rule each time that its condition becomes true."""
        was_true = False
        while rule.condition is not None:
            is_true = bool(rule.condition())
            if is_true and not was_true:
                self._fire(rule)
            was_true = is_true
            current_task().sleep(POLL_S)

    def _idle_s(self) -> float:
        """For how long nothing has happened."""
        now_s = CLOCK.now_s()
        if self._goals.is_busy or any(rule.running for rule in self._rules):
            self._busy_s = now_s
        heard_s = human_listener(self._network).heard_s
        return now_s - max(self._busy_s, heard_s)

    def _supervise(self) -> None:
        while self._rules or self._parts:
            if PROGRAM.cancelled.wait(0.02):
                return
            with self._parts_lock:
                ended = [part for part in self._parts if not part.is_running]
                self._parts = [part for part in self._parts if part not in ended]
            for part in ended:
                if part.error is not None:
                    self._note_error(part.error, "")
            if self._ends_on_error and self._first_error is not None:
                return
            if time.monotonic() - self._told_drops_s >= TELL_AGAIN_S:
                self._tell_troubles()

    def _play(self, action: Action, rule: str) -> None:
        """Do something; an error in it is told, and ends nothing else than the program says."""
        try:
            action()
        except RuleStopped:
            pass
        except Cancelled:
            raise
        except BaseException as error:
            current_task().end_undone()
            self._note_error(error, rule)

    def _note_error(self, error: BaseException, rule: str) -> None:
        """Tell that a rule has failed; whether others go on, ``_supervise`` sees to."""
        log.error("a rule failed", exc_info=error)
        fault, line = _explainers[0](error)
        self._tell("rule_failed", rule, line, fault)
        self._first_error = self._first_error or error

    def _tell_troubles(self) -> None:
        """Tell what a person should look at: what was left out, what could not be kept."""
        self._tell_drops()
        for fault in take_troubles():
            self._tell("warning", "", 0, fault)

    def _tell_drops(self) -> None:
        """Tell of the starts that did not fit into a queue since that was last told."""
        for rule in self._rules:
            with rule.lock:
                count, rule.dropped = rule.dropped, 0
            if count:
                self._told_drops_s = time.monotonic()
                fault = fault_of(
                    "“{rule}” happened more often than its rule could keep up with: {count} times "
                    "it was left out.",
                    code="queue_full",
                    checklist=(
                        "Make the rule shorter.",
                        "Let it wait for something that happens less often.",
                    ),
                    rule=rule.state.replace("_", " "),
                    count=count,
                )
                self._tell("warning", rule.state, _line_of(rule.action), fault)

    def _on_behavior(self, behavior: HumanBehavior) -> None:
        for rule in self._rules:
            is_meant = rule.source in ("", behavior.source) and rule.condition is None
            if is_meant and rule.state == behavior.human_state:
                self._fire(rule)
        self._goals.hear(behavior.human_state)

    def _fire(self, rule: Rule) -> None:
        with rule.lock:
            if rule.running is None or not rule.running.is_running:
                rule.running = self._start(lambda: self._run_rule(rule), rule.state)
            elif rule.again == "queue":
                rule.dropped += rule.queued >= MOST_QUEUED
                rule.queued = min(rule.queued + 1, MOST_QUEUED)
            elif rule.again == "restart":
                old = rule.running
                old.task.cancel()
                rule.running = self._start(lambda: self._restart_rule(rule, old), rule.state)

    def _restart_rule(self, rule: Rule, old: Part) -> None:
        old.await_end()
        current_task().check()  # a newer one may have taken its place meanwhile
        self._run_rule(rule)

    def _run_rule(self, rule: Rule) -> None:
        again = True
        while again:
            self._tell("rule_started", rule.state, _line_of(rule.action))
            self._play(rule.action, rule.state)
            self._busy_s = CLOCK.now_s()
            again = self._goes_on(rule)  # before it is told: who hears it may fire the rule
            self._tell("rule_finished", rule.state, _line_of(rule.action))

    def _goes_on(self, rule: Rule) -> bool:
        """Whether another run is queued; if not, the rule may fire afresh from now on."""
        with rule.lock:
            if rule.queued > 0:
                rule.queued -= 1
                return True
            if rule.running is not None and rule.running.task is current_task():
                rule.running = None
            return False

    def _start(self, action: Action, state: str) -> Part:
        part = Part(action, f"nep-{state or 'start'}", PROGRAM)
        with self._parts_lock:  # a part that has not started yet must not count as ended
            self._parts.append(part)
            return part.start()

    def _tell(
        self, event: ProgramEvent, rule: str, line: int = 0, fault: Fault | None = None
    ) -> None:
        name = threading.current_thread().name
        self._states.send(
            ProgramState(
                program=self.name, event=event, rule=rule, thread=name, line=line, **told(fault)
            )
        )


def _decorator(note: Callable[[Action], None]) -> Decorator:
    """What gives a function to ``note``, and leaves it as it is."""

    def decorate(action: Action) -> Action:
        note(action)
        return action

    return decorate


def _line_of(action: Action) -> int:
    """Where a function begins in its file, which tells rules for the same state apart."""
    code = getattr(action, "__code__", None)
    return code.co_firstlineno if code is not None else 0


# Which of several functions to run: one by chance, or the next in turn.

_turns: dict[CodeType, int] = {}
_lock = threading.Lock()


def one_of(*functions: FunctionType) -> None:
    """Run one of the functions, by chance."""
    random.choice(functions)()


def in_turn(*functions: FunctionType) -> None:
    """Run one of the functions: the first time the first, next time the next, and so on.

    The turn belongs to this place in the program, however often its functions are made anew.
    """
    with _lock:
        place = functions[0].__code__
        turn = _turns.get(place, 0)
        _turns[place] = turn + 1
    functions[turn % len(functions)]()


# Goals: longer tasks that run one at a time, of which the more important interrupt the others.

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

    def __init__(
        self,
        tell: Callable[[ProgramEvent, str], None],
        note_error: Callable[[BaseException, str], None],
    ) -> None:
        self._tell, self._note_error = tell, note_error
        self._goals: list[Goal] = []
        self._hooks: list[tuple[str, GoalEvent, Action]] = []
        self._waiting: list[Goal] = []
        self._given_up: list[Goal] = []
        """Those that had begun, and were stopped while another one ran."""
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
        return self._running is not None or bool(self._waiting or self._given_up)

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
            stopped = [goal for goal in self._waiting if goal.stop == state]
            self._given_up += (goal for goal in stopped if goal.returns)
            self._waiting = [goal for goal in self._waiting if goal not in stopped]
            if self._running and self._running.stop == state:
                self._cut_running("stopped")
            for goal in self._goals:
                if goal.state == state and goal not in (self._running, *self._waiting):
                    goal.returns = False
                    self._waiting.append(goal)
            running = self._running
            if running is not None and self._cut == "finished":
                order = ORDER[running.priority]
                if any(ORDER[goal.priority] > order for goal in self._waiting):
                    self._cut_running("interrupted")
            self._news.notify_all()

    def run(self) -> None:
        """Pursue goals one after the other until this part of the program is cancelled."""
        goals = {goal.name: goal for goal in self._goals}
        for name, event, action in self._hooks:
            if name in goals:
                goals[name].hooks.setdefault(event, []).append(action)
                continue
            unknown = NepError(
                "There is no goal with the name “{name}”.",
                checklist=("Write the name as the goal's own block has it.",),
                name=name,
            )
            self._note_error(unknown, name)
        task = current_task()
        while True:
            if (goal := self._next(task)) is not None:
                self._pursue(goal, task)
                continue
            self._tell_end(self._given_up[0], "stopped", task)
            with self._news:
                del self._given_up[0]

    def _next(self, task: Task) -> Goal | None:
        """Wait for a goal, and make it the running one; None when some were given up instead."""
        with self._news:
            while not self._waiting and not self._given_up:
                task.check()
                self._news.wait(POLL_S)
            if self._given_up:
                return None
            goal = max(self._waiting, key=lambda waiting: ORDER[waiting.priority])
            self._waiting.remove(goal)
            self._running, self._cut, self._task = goal, "finished", None
            self._has_ended = False
            return goal

    def _pursue(self, goal: Goal, task: Task) -> None:
        """Run a goal to its end, or until it is stopped or interrupted; then what follows that."""
        self._tell("goal_started", goal.name)
        if goal.returns:
            for action in goal.hooks.get("returns", ()):
                part = Part(action, f"nep-goal-{goal.name}-returns", task)
                self._wait_for(self._cuttable(part).start(), task, goal)
        part = self._cuttable(Part(lambda: self._play(goal), f"nep-goal-{goal.name}", task))
        self._wait_for(part.start(), task, goal)
        with self._news:
            end: End = "finished" if self._has_ended else self._cut
            if part.error is not None:
                end = "stopped"
            self._task = None
        self._tell_end(goal, end, task)
        # Let go of a goal that has ended; one that returns waits before those of its priority
        with self._news:
            self._running = None
            was_stopped = self._cut == "stopped"  # while its hooks ran
            if end == "interrupted" and goal.interrupted == "again" and not was_stopped:
                goal.returns = True
                self._waiting.insert(0, goal)

    def _tell_end(self, goal: Goal, end: End, task: Task) -> None:
        """Tell how a goal has ended, and do what follows that."""
        self._tell(TOLD[end], goal.name)
        for action in goal.hooks.get(end, ()):
            self._wait_for(Part(action, f"nep-goal-{goal.name}-{end}", task).start(), task, goal)

    def _cuttable(self, part: Part) -> Part:
        """Let a part end when the running goal is cut, which may have been before it begins."""
        with self._news:
            self._task = part.task
            if self._cut != "finished":
                part.task.cancel()
        return part

    def _play(self, goal: Goal) -> None:
        with contextlib.suppress(RuleStopped):
            goal.action()
        with self._news:
            self._has_ended = True

    def _cut_running(self, end: End) -> None:
        """End the running goal; being stopped outdoes being interrupted."""
        self._cut = end
        if self._task is not None:
            self._task.cancel()

    def _wait_for(self, part: Part, task: Task, goal: Goal) -> None:
        """Wait for the end of a part; its error is told, and it ends with ``task``."""
        part.await_end()
        task.check()
        if part.error is not None and not isinstance(part.error, RuleStopped):
            self._note_error(part.error, goal.name)
