"""Behavior: rules that fire on what the person does, and what runs at the start."""

from __future__ import annotations

import logging
import math
import random
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from types import CodeType, FunctionType
from typing import Literal

from faults import Fault, Tr, fault_in, fault_of, plain
from faults import told as words_of
from nep_core.errors import NepError
from nep_core.networks.network import Network
from nep_core.networks.transports import default_network
from nep_core.wire.messages import (
    EXPECTED_WORDS,
    PROGRAM_STATE,
    ExpectedWords,
    HumanBehavior,
    PlannedStep,
    PlanTold,
    ProgramEvent,
    ProgramState,
    told,
)
from nep_core.wire.pubsub import Publisher
from nep_core.wire.states import state_of_thing, state_of_word, word_of_state

from .goals import Goal, GoalEvent, Goals, Interrupted
from .human import human_listener
from .kept import keep_now, take_troubles
from .machines import Machines, Transition
from .messages import Run, heard_by, own_run
from .plans import tell_by, tell_nobody
from .robot import Robot
from .tasks import (
    CLOCK,
    PROGRAM,
    Cancelled,
    Part,
    Priority,
    RuleStopped,
    Standing,
    current_task,
    handled_error,
)
from .tree import Plan, Status, do_tree, do_tree_again, plant
from .triggers import TELL_AGAIN_S, Days, Watch, each, each_day, each_time_true
from .values import speak

log = logging.getLogger(__name__)

Action = Callable[[], object]
Condition = Callable[[], object]
Decorator = Callable[[Action], Action]
Again = Literal["ignore", "restart", "queue"]
OnError = Literal["go_on", "end"]
TreeRuns = Literal["when_asked", "at_start", "always"]

MOST_QUEUED = 1000

# Who runs a program can say more about an error of it than that there was one.

Explain = Callable[[BaseException], tuple[Fault, int]]
"""The fault that a person reads of an error of the program, and its line of the file, 0: none."""


def _explain(error: BaseException) -> tuple[Fault, int]:
    return fault_in(error), 0


_explainers: list[Explain] = [_explain]


def explain_by(explain: Explain) -> None:
    """Let errors of rules be explained so from now on."""
    _explainers[:] = [explain]


_translators: list[Tr] = [plain]


def translate_by(tr: Tr) -> None:
    """Let what a program tells itself of its errors be in the words of ``tr`` from now on."""
    _translators[:] = [tr]


def what_went_wrong() -> str:
    """The sentence of the error because of which this is done; an empty text elsewhere."""
    error = handled_error()
    if error is None:
        return ""
    fault, _ = _explainers[0](error)
    return words_of(fault.sentence, _translators[0])


Sort = Literal["state", "message", "watch"]


@dataclass
class Rule:
    """When the person does this, do that; ``again``: what if it fires while it runs.

    ``source`` is who must tell of the state, "" for anybody. Of the other sorts, one fires each
    time that a message is told, which is its ``state`` then, or when its ``watch`` says so.
    """

    state: str
    action: Action
    again: Again = "ignore"
    source: str = ""
    sort: Sort = "state"
    watch: Watch | None = None
    running: Part | None = None
    run: Run | None = None
    """What is running."""
    ending: Part | None = None
    """What was stopped, and may not have ended yet."""
    queued: deque[Run] = field(default_factory=deque)
    dropped: int = 0
    """How many starts did not fit into the queue since that was last told."""
    lock: threading.Lock = field(default_factory=threading.Lock)


class StopRefused(NepError, title="The program stopped with an error"):
    """What is to be stopped is no rule."""


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
        self._starts: dict[Action, Part | None] = {}
        self._goals = Goals(self._tell, self._note_error)
        self._machines = Machines(self._entered, self._note_error)
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

        return self._watching("condition", self._each_time(condition), again)

    def when_idle(self, seconds: float) -> Decorator:
        """Run the decorated function each time that for so long no state came and no rule ran."""

        return self._watching("idle", self._each_time(lambda: self._idle_s() >= seconds))

    def when_told(self, message: str, *, again: Again = "ignore") -> Decorator:
        """Run the decorated function each time that the program tells itself ``message``."""
        return _decorator(
            lambda action: self._rules.append(Rule(message, action, again, sort="message"))
        )

    def every(self, seconds: float) -> Decorator:
        """Run the decorated function after so many seconds, and so on, but never twice at once.

        While the program is paused nothing is counted.
        """
        return self._watching("every", each(seconds))

    def at(self, time: str, *, days: Days = "every_day") -> Decorator:
        """Run the decorated function when the clock shows ``time``, such as "09:30".

        ``days`` are "every_day", "weekdays", "weekends", or a day such as "monday".
        """
        return self._watching(f"at {time}", each_day(time, days))

    def _watching(self, state: str, watch: Watch, again: Again = "ignore") -> Decorator:
        return _decorator(
            lambda action: self._rules.append(Rule(state, action, again, sort="watch", watch=watch))
        )

    def _each_time(self, condition: Condition) -> Watch:
        return each_time_true(condition, lambda error: self._note_error(error, "condition"))

    def goal(
        self,
        name: str,
        *,
        when: str | Condition = "",
        priority: Priority = "normal",
        stop: str = "",
        interrupted: Interrupted = "again",
        robot: Robot | None = None,
        at_most_s: float = math.inf,
    ) -> Decorator:
        """Pursue the decorated function as a goal each time the person's state is ``when``.

        Or each time that ``when()`` becomes true; without it, when ``pursue`` asks for it. A robot
        pursues one goal at a time: ``robot`` is whose goal it is (None: that of all robots). One
        of a higher priority interrupts it; then it begins "again" afterwards, goes on where it was
        ("resume"), or is "drop"ped. The state ``stop`` ends it. When it has run for ``at_most_s``
        seconds, it has failed.

        ``name`` is told to people; ``interrupted`` is "again", "resume" or "drop". Raises NepError.
        """

        def add(action: Action) -> None:
            robots = frozenset(robot.robots if robot is not None else ())
            goal = Goal(name, when, action, priority, stop, interrupted, robots, at_most_s)
            self._goals.add(goal)

        return _decorator(add)

    def when_goal(self, name: str, event: GoalEvent) -> Decorator:
        """Run the decorated function when a goal has "finished", "failed", or was "stopped".

        Or "interrupted", or, before it begins again or goes on, when it "returns".
        """

        return _decorator(lambda action: self._goals.hook(name, event, action))

    def pursue(self, name: str, value: object = "") -> None:
        """Let a goal begin when its turn comes; ``value`` is what it is given.

        Nothing happens if it is pursued already, or waits for its turn. Raises NepError.
        """
        self._goals.pursue(name, value)

    def pursues(self, name: str) -> bool:
        """Whether a goal runs, or waits: for its turn, or to return. Raises NepError."""
        return self._goals.is_pursued(name)

    def give_up(self, name: str) -> None:
        """Give a goal up that runs or waits; a goal that gives itself up ends here.

        Raises NepError.
        """
        self._goals.give_up(name)
        current_task().check()

    def state(self, name: str, *, first: bool = False, machine: str = "") -> Decorator:
        """Run the decorated function when the program's state ``name`` begins, until it ends.

        ``first``: the program begins in it. ``machine`` names one of several state machines.
        """
        return _decorator(
            lambda action: self._machines.add_state(name, action, machine, first=first)
        )

    def transition(
        self,
        source: str,
        target: str,
        *,
        when: str | Condition = "",
        told: str = "",
        after: float | None = None,
        done: bool = False,
        machine: str = "",
    ) -> Decorator:
        """Go from the state ``source`` to ``target``, and run the decorated function in between.

        ``when`` the person's state is so, or a condition true; when a message is ``told``;
        ``after`` so many seconds in the state; or when what is done in it is ``done``.
        ``machine`` names one of several state machines.
        """
        state, condition = (when, None) if isinstance(when, str) else ("", when)
        return _decorator(
            lambda action: self._machines.add_transition(
                Transition(source, target, action, state, told, condition, done, after), machine
            )
        )

    def go_to(self, state: str, machine: str = "") -> None:
        """Leave the state in which the program is, and enter another one."""
        self._machines.go_to(state, machine)

    def is_in(self, state: str, machine: str = "") -> bool:
        """Whether the program is in a state."""
        return self._machines.now(machine) == state

    def state_now(self, machine: str = "") -> str:
        """The state in which the program is, an empty text before the first."""
        return self._machines.now(machine)

    def when_started(self, action: Action) -> Action:
        """Run the decorated function when the program starts."""
        self._starts[action] = None
        return action

    def stop(self, rule: Action) -> None:
        """Stop what the rule of a function does, and what it was to do after that.

        Goes on when that has ended. The rule may fire again. In the rule itself, it ends there.
        """
        if rule not in self._starts and not any(one.action is rule for one in self._rules):
            raise StopRefused(
                "What is to be stopped here is no rule.",
                checklist=("Write the name of the function of a rule.",),
            )
        own = own_run()
        parts = [self._stop_rule(one) for one in self._rules if one.action is rule]
        if rule in self._starts:
            parts.append(self._starts[rule])
        if own is not None and own.action is rule:
            raise RuleStopped
        for part in parts:
            if part is not None:
                part.task.cancel()
                part.await_end(current_task().check)

    def _stop_rule(self, rule: Rule) -> Part | None:
        """Empty the queue of a rule, and let it fire afresh; gives what is to be ended."""
        with rule.lock:
            queued, rule.queued = rule.queued, deque()
            is_own = rule.run is not None and rule.run is own_run()
            stopped = rule.running
            if not is_own and stopped is not None:
                rule.ending, rule.running, rule.run = stopped, None, None
        for run in queued:
            run.end()
        return None if is_own else stopped

    def tree(self, name: str, *, runs: TreeRuns = "when_asked") -> Decorator:
        """Make the decorated function a behaviour tree, whose nodes it makes.

        ``runs``: "when_asked" by ``do_tree`` or by another tree, once "at_start" of the program,
        or "always", again and again from the start on.
        """

        def note(action: Action) -> None:
            tell, note_error = partial(self._tell_tree, name), partial(self._note_error, rule=name)
            plant(Plan(name, action, tell, note_error))
            if runs != "when_asked":
                do = do_tree if runs == "at_start" else do_tree_again
                self._starts[partial(do, name)] = None

        return _decorator(note)

    def run(self) -> None:
        """Run until the program is stopped or all is done; raises the first error of its parts."""
        network = self._network or default_network()
        self._states = Publisher(PROGRAM_STATE, network=network)
        words = Publisher(EXPECTED_WORDS, network=network)
        # What rules and goals wait for: real robots must know it before
        of_rules = (rule.state for rule in self._rules if rule.sort == "state")
        states = [*of_rules, *self._goals.states, *self._machines.person_states]
        expected = dict.fromkeys(filter(None, map(word_of_state, states)))
        words.send(ExpectedWords(words=list(expected)))
        listener = human_listener(network)
        listener.of_rules = frozenset(states)
        self._busy_s = CLOCK.now_s()
        tell_by(self._tell_plan)
        listener.listen(self._on_behavior)
        try:
            with heard_by(self):
                for rule in self._rules:
                    if rule.watch is not None:
                        fire = partial(self._fire, rule)
                        self._start(partial(rule.watch, fire), f"watch-{rule.state}")
                if self._goals:
                    self._start(self._goals.run, "goals")
                self._machines.begin(self._start)
                for action in self._starts:
                    self._starts[action] = self._start(partial(self._begin, action), "")
                self._supervise()
        finally:
            listener.unlisten(self._on_behavior)
            listener.of_rules = frozenset()
            for part in self._parts:
                part.task.cancel()
            for part in self._parts:
                part.join(1.0)
            PROGRAM.end_undone()
            keep_now()
            self._tell_troubles()
            tell_by(tell_nobody)
            self._states.close()
            words.close()
        if self._first_error is not None and not PROGRAM.cancelled.is_set():
            raise self._first_error

    def _begin(self, action: Action) -> None:
        """Do what is done when the program starts."""
        Run(action).begin()
        self._play(action, "")

    def _idle_s(self) -> float:
        """For how long nothing has happened."""
        now_s = CLOCK.now_s()
        is_busy = self._goals.is_busy or self._machines.is_busy
        if is_busy or any(rule.running for rule in self._rules):
            self._busy_s = now_s
        heard_s = human_listener(self._network).heard_s
        return now_s - max(self._busy_s, heard_s)

    def _supervise(self) -> None:
        # nobody else tells messages: where nothing runs, no rule for one will begin
        is_open = any(rule.sort != "message" for rule in self._rules)
        while is_open or self._parts:
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
        current_task().standing = Standing(rule)
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

    def _entered(self, machine: str, state: str) -> None:
        self._tell("state_entered", state, machine=machine)

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
            is_meant = rule.source in ("", behavior.source) and rule.sort == "state"
            if is_meant and rule.state == behavior.human_state:
                self._fire(rule)
        self._goals.hear(behavior.human_state)
        self._machines.hear(state=behavior.human_state)

    def last_run(self, message: str) -> Iterator[tuple[Again, Run | None]]:
        """For each rule for a message, what it does while it runs, and its run that ends last."""
        for rule in self._rules_for(message):
            with rule.lock:
                yield rule.again, rule.queued[-1] if rule.queued else rule.run

    def hear(self, message: str, value: object) -> Iterator[Run]:
        """Start the rules for a message, in their order; gives the runs that begin by it."""
        self._machines.hear(message=message)
        for rule in self._rules_for(message):
            if (run := self._fire(rule, value)) is not None:
                yield run

    def _rules_for(self, message: str) -> list[Rule]:
        return [rule for rule in self._rules if rule.sort == "message" and rule.state == message]

    def _fire(self, rule: Rule, value: object = "") -> Run | None:
        """Let a rule begin, or do what it does while it runs; gives the run that comes of it."""
        run = Run(rule.action, value)
        with rule.lock:
            if rule.running is None or not rule.running.is_running:
                self._begin_run(rule, run, rule.ending)
            elif rule.again == "queue":
                if len(rule.queued) >= MOST_QUEUED:
                    rule.dropped += 1
                    return None
                run.after = rule.queued[-1] if rule.queued else rule.run
                rule.queued.append(run)
            elif rule.again == "restart":
                rule.running.task.cancel()
                self._begin_run(rule, run, rule.running)
            else:
                return None
        return run

    def _begin_run(self, rule: Rule, run: Run, old: Part | None) -> None:
        """Start a run of a rule, which begins when an old one has ended."""
        rule.run, rule.ending = run, None
        rule.running = self._start(lambda: self._run_rule(rule, run, old), rule.state)

    def _run_rule(self, rule: Rule, run: Run, old: Part | None) -> None:
        following: Run | None = run
        try:
            if old is not None:
                old.await_end()
                current_task().check()  # a newer one may have taken its place meanwhile
            while following is not None:
                run = following
                run.begin()
                self._tell("rule_started", rule.state, _line_of(rule.action))
                self._play(rule.action, rule.state)
                self._busy_s = CLOCK.now_s()
                following = self._goes_on(rule)  # before it is told: who hears it may fire the rule
                run.end()
                self._tell("rule_finished", rule.state, _line_of(rule.action))
        finally:
            run.end()

    def _goes_on(self, rule: Rule) -> Run | None:
        """The next run that is queued; if there is none, the rule may fire afresh from now on."""
        with rule.lock:
            if rule.running is None or rule.running.task is not current_task():
                return None  # it was stopped, and may run anew already
            rule.run = rule.queued.popleft() if rule.queued else None
            if rule.run is None:
                rule.running = None
            return rule.run

    def _start(self, action: Action, state: str) -> Part:
        part = Part(action, f"nep-{state or 'start'}", PROGRAM)
        with self._parts_lock:  # a part that has not started yet must not count as ended
            self._parts.append(part)
            return part.start()

    def _tell_plan(
        self,
        event: PlanTold,
        goal: str,
        plan: Sequence[PlannedStep],
        step: int,
        fault: Fault | None,
    ) -> None:
        name = threading.current_thread().name
        self._states.send(
            ProgramState(
                program=self.name,
                event=event,
                rule=goal,
                thread=name,
                plan=list(plan),
                step=step,
                **told(fault),
            )
        )

    def _tell(
        self,
        event: ProgramEvent,
        rule: str,
        line: int = 0,
        fault: Fault | None = None,
        *,
        machine: str = "",
    ) -> None:
        self._states.send(
            ProgramState(
                program=self.name,
                event=event,
                rule=rule,
                machine=machine,
                thread=threading.current_thread().name,
                line=line,
                **told(fault),
            )
        )

    def _tell_tree(self, name: str, nodes: dict[int, Status]) -> None:
        told_nodes: dict[str, str] = {str(line): status for line, status in nodes.items()}
        self._states.send(
            ProgramState(program=self.name, event="tree", rule=name, nodes=told_nodes)
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
