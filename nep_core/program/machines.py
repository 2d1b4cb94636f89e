"""State machines: a program is in one state of each, does what belongs to it, and goes to another.

A state may have an activity, a function that begins when the state is entered and is ended when it
is left. A transition leads from a state to another one: when the person's state is so, when a
message is told, when a condition is true, when the activity is done, or when the state has lasted
for so long. Of those that could be taken, the one that was defined first is. What a transition does
is done between the two states, and is not interrupted. Where a machine stands is in David Harel's
words (Statecharts, 1987) a configuration of flat states: there are none inside of others; several
machines run side by side instead.
"""

from __future__ import annotations

import contextlib
import contextvars
import functools
import threading
from collections.abc import Callable
from dataclasses import dataclass, field

from nep_core.errors import NepError

from .tasks import CLOCK, POLL_S, Cancelled, Part, RuleStopped, Standing, Task, current_task

Action = Callable[[], object]
Condition = Callable[[], object]


class StateRefused(NepError, title="The program stopped with an error"):
    """A state that a machine does not have."""


@dataclass(frozen=True, eq=False)
class Transition:
    """From state ``source`` to ``target``, when one of the others says so.

    ``state`` is one of the person, ``message`` one that is told; ``is_done``: when the activity of
    the source has come to its end; ``after_s``: seconds since the source was entered.
    """

    source: str
    target: str
    action: Action | None = None
    state: str = ""
    message: str = ""
    condition: Condition | None = None
    is_done: bool = False
    after_s: float | None = None


Entered = Callable[[str], None]
"""Hears that a machine is in a state from now on."""

MachineEntered = Callable[[str, str], None]
"""Hears the name of the machine, too, before the state."""

Failed = Callable[[BaseException, str], None]
"""Hears that an activity, a transition or its condition has ended with an error, and which."""


@dataclass
class Machine:
    """The states of one machine, and where it stands; ``now`` is "" before it is begun."""

    activities: dict[str, Action | None] = field(default_factory=dict)
    transitions: list[Transition] = field(default_factory=list)
    first: str = ""
    now: str = ""

    def states(self) -> list[str]:
        """All states, in the order in which the program names them."""
        named = [s for one in self.transitions for s in (one.source, one.target)]
        return list(dict.fromkeys([*self.activities, *named]))


class Running:
    """A machine that runs: a thread of its own takes the transitions, one after the other."""

    def __init__(self, machine: Machine, entered: Entered, failed: Failed) -> None:
        self.machine = machine
        self._entered, self._failed = entered, failed
        self._news = threading.Condition()
        self._wanted = machine.first
        self._heard: list[Transition] = []
        """The transitions that something has set off since the state was entered."""
        self._broken: list[Transition] = []
        """Those whose condition has failed since then: they are asked no more."""
        self._stay: Stay | None = None

    @property
    def is_busy(self) -> bool:
        """Whether the activity of the present state is under way."""
        return self._stay is not None and self._stay.is_busy

    def go_to(self, state: str) -> None:
        """Leave the state that it is in, and enter this one, also if it is the same.

        What belongs to the state that is left ends, also the lines below the call.
        """
        with self._news:
            self._wanted = state
            is_own = self._stay is not None and _staying.get() is self._stay
            self._news.notify_all()
        if is_own:
            raise Cancelled

    def hear(self, state: str = "", message: str = "") -> None:
        """Take in what the person does, or what is told; it counts for the present state only."""
        with self._news:
            self._heard += (
                one
                for one in self._leading_out()
                if (state and one.state == state) or (message and one.message == message)
            )
            if self._heard:
                self._news.notify_all()

    def run(self) -> None:
        """Go from state to state until this part of the program is cancelled."""
        task = current_task()
        while True:
            target, action = self._next(task)
            if self._stay is not None:
                self._stay.end()
            task.check()
            if action is not None:
                self._do(action, f"{self.machine.now} - {target}", task)
            with self._news:
                target, self._wanted = self._wanted or target, ""
            self._enter(target, task)

    def _leading_out(self) -> list[Transition]:
        """The transitions out of the present state; none on the way to another one."""
        stay = self._stay
        if stay is None or stay.is_over:
            return []
        return [one for one in self.machine.transitions if one.source == self.machine.now]

    def _next(self, task: Task) -> tuple[str, Action | None]:
        """Wait for what leads out of this state; gives where to, and what is done before."""
        while True:
            with self._news:
                if self._wanted:
                    target, self._wanted = self._wanted, ""
                    return target, None
                heard, self._heard = self._heard, []
            for one in self._leading_out():
                if one in heard or self._is_due(one):
                    return one.target, one.action
            with self._news:
                if not self._wanted and not self._heard:
                    self._news.wait(POLL_S)  # conditions, times, and being cancelled
            task.check()

    def _is_due(self, one: Transition) -> bool:
        stay = self._stay
        if stay is None or one in self._broken:
            return False
        if one.is_done:
            return stay.is_done
        if one.after_s is not None:
            return CLOCK.now_s() - stay.since_s >= one.after_s
        if one.condition is None:
            return False
        try:
            return bool(one.condition())
        except Exception as error:
            self._broken.append(one)
            self._failed(error, f"{self.machine.now} - {one.target}")
            return False

    def _enter(self, state: str, task: Task) -> None:
        with self._news:
            self._heard, self._broken = [], []
            self.machine.now = state
            self._stay = Stay(state, self.machine.activities.get(state), self._wake)
        self._entered(state)
        self._stay.begin(task, self._failed)

    def _do(self, action: Action, what: str, task: Task) -> None:
        def act() -> None:
            current_task().standing = Standing(what)
            action()

        part = Part(act, f"nep-{what}", task).start()
        part.await_end()
        task.check()
        if part.error is not None and not isinstance(part.error, RuleStopped):
            self._failed(part.error, what)

    def _wake(self) -> None:
        with self._news:
            self._news.notify_all()


class Stay:
    """One stay in a state, from when it is entered to when it is left."""

    def __init__(self, state: str, activity: Action | None, wake: Callable[[], None]) -> None:
        self.since_s = CLOCK.now_s()
        self.is_done = activity is None
        """Whether its activity has come to its end, well."""
        self.is_over = False
        self._state, self._activity, self._wake = state, activity, wake
        self._part: Part | None = None

    @property
    def is_busy(self) -> bool:
        """Whether its activity is under way."""
        return self._part is not None and self._part.is_running

    def begin(self, task: Task, failed: Failed) -> None:
        """Begin the activity."""
        activity = self._activity
        if activity is None:
            return

        def act() -> None:
            _staying.set(self)
            current_task().standing = Standing(self._state)
            try:
                with contextlib.suppress(RuleStopped):
                    activity()
                self.is_done = True
            except Exception as error:
                failed(error, self._state)
                raise
            finally:
                self._wake()

        self._part = Part(act, f"nep-in-{self._state}", task).start()

    def end(self) -> None:
        """Leave the state: its activity ends, and what that has begun on robots."""
        self.is_over = True
        if self._part is not None:
            self._part.task.cancel()
            self._part.await_end()


_staying: contextvars.ContextVar[Stay | None] = contextvars.ContextVar("nep_stay", default=None)
"""The stay in a state of which this thread does a part."""


class Machines:
    """The state machines of a behaviour, by name; most have one, whose name is empty."""

    def __init__(self, entered: MachineEntered, failed: Failed) -> None:
        self._entered, self._failed = entered, failed
        self._machines: dict[str, Machine] = {}
        self._running: dict[str, Running] = {}

    def __bool__(self) -> bool:
        return bool(self._machines)

    @property
    def is_busy(self) -> bool:
        """Whether an activity of a state is under way."""
        return any(running.is_busy for running in self._running.values())

    @property
    def person_states(self) -> list[str]:
        """The states of the person that set transitions off."""
        return [one.state for m in self._machines.values() for one in m.transitions if one.state]

    def add_state(self, name: str, activity: Action, machine: str, *, first: bool) -> None:
        """Add a state with its activity; the machine begins with the first that says so."""
        found = self._machine(machine)
        if found.activities.get(name) is not None:
            raise StateRefused(
                "The state “{name}” is there twice.",
                checklist=("Give each state a name of its own.",),
                name=name,
            )
        found.activities[name] = activity
        if first:
            found.first = found.first or name

    def add_transition(self, transition: Transition, machine: str) -> None:
        """Add a transition; the ones before it are taken first."""
        self._machine(machine).transitions.append(transition)

    def begin(self, start: Callable[[Action, str], object]) -> None:
        """Let all machines run; ``start`` begins a part of the program with a name."""
        for name, machine in self._machines.items():
            entered = functools.partial(self._entered, name)
            self._running[name] = Running(machine, entered, self._failed)
            start(self._running[name].run, f"states-{name}".rstrip("-"))

    def go_to(self, state: str, machine: str = "") -> None:
        """Let a machine go to a state; raises StateRefused when it has none of that name."""
        running = self._running.get(machine)
        known = running.machine.states() if running is not None else []
        if running is None or state not in known:
            raise StateRefused(
                "There is no state “{state}”. There are: {states}.",
                checklist=("Choose one of these states.", "Or add a block for this state."),
                state=state,
                states=", ".join(known) or "-",
            )
        running.go_to(state)

    def now(self, machine: str = "") -> str:
        """The state in which a machine is, "" when it has not begun."""
        running = self._running.get(machine)
        return running.machine.now if running is not None else ""

    def hear(self, state: str = "", message: str = "") -> None:
        """Take in what the person does, or a message."""
        for running in self._running.values():
            running.hear(state, message)

    def _machine(self, name: str) -> Machine:
        return self._machines.setdefault(name, Machine())
