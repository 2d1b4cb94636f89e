"""The parts of a program that run side by side, and how they wait and are cancelled.

Cancelling is cooperative: a part ends at its next wait or robot call, by Cancelled, which
ordinary ``except`` clauses do not catch. One that only computes is interrupted after a while.
"""

from __future__ import annotations

import contextvars
import ctypes
import gc
import itertools
import math
import os
import sys
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from types import FrameType
from typing import Any, Literal, NamedTuple

from nep_core.errors import NepError

POLL_S = 0.05
"""How often a condition is looked at."""


class Cancelled(BaseException):
    """This part of the program has been asked to end."""


class RuleStopped(BaseException):
    """The rule in which this part runs is to end here, well."""


# The time of a program: what waits and limits are counted by.


class Clock:
    """Counts seconds, but none while the program is paused; no clock of the computer matters.

    Whoever pauses programs says so by ``is_pausable``; else a wait need not look for pauses.
    ``is_stepped`` tells whether the thread that asks runs a line of a paused program; ``hold``
    returns when a thread that waits may go on with that.
    """

    def __init__(self) -> None:
        self.is_pausable = False
        self.is_stepped: Callable[[], bool] = lambda: False
        self.hold: Callable[[], None] = lambda: None
        self._lost_s = 0.0
        self._paused_s = math.inf
        """Since when the program is paused, infinite when it is not."""
        self._lock = threading.Lock()

    def now_s(self) -> float:
        """Seconds of the program since some moment."""
        with self._lock:
            return min(time.monotonic(), self._paused_s) - self._lost_s

    def pause(self) -> None:
        """Stand still from now on."""
        with self._lock:
            self._paused_s = min(self._paused_s, time.monotonic())

    def resume(self) -> None:
        """Go on where it stopped."""
        with self._lock:
            now_s = time.monotonic()
            self._lost_s += max(0.0, now_s - self._paused_s)
            self._paused_s = math.inf


CLOCK = Clock()


class Countdown:
    """What is left of some seconds; of one thread, which may run while the others are paused.

    While the part that counts is held, nothing is counted.
    """

    def __init__(self, seconds: float) -> None:
        self._left_s = seconds
        self._task = current_task()
        self._looked_s = self._now_s()

    def skip(self) -> None:
        """Do not count the time since it was looked at last."""
        self._looked_s = self._now_s()

    def left_s(self) -> float:
        """How many seconds are left, 0 or less when they are over."""
        before, self._looked_s = self._looked_s, self._now_s()
        own, programs = (now - then for now, then in zip(self._looked_s, before, strict=True))
        self._left_s -= own if CLOCK.is_stepped() else programs
        return self._left_s

    def _now_s(self) -> tuple[float, float]:
        """The time of this thread alone, and that of the whole program."""
        held_s = self._task.held_s()
        return time.monotonic() - held_s, CLOCK.now_s() - held_s


LATER_S = 1.0
"""What came so much later was told later too, whatever a clock says that may have been set."""


class Stamp(NamedTuple):
    """When somebody told something: by their own clock, and when it came here (monotonic), in s."""

    told_s: float = -math.inf
    came_s: float = -math.inf

    def is_before(self, other: Stamp) -> bool:
        """Whether the other was told after this, by the same one."""
        return other.told_s >= self.told_s or other.came_s - self.came_s >= LATER_S


# How important what a program asks of robots is: of each run of a rule or goal.

Priority = Literal["low", "normal", "high"]
WhenDisplaced = Literal["resume", "give_up"]
PRIORITIES: dict[str, int] = {"low": -1, "normal": 0, "high": 1}
"""As robots are told of it."""


@dataclass
class Standing:
    """Who a rule or goal is to robots: its name, how important it is, and what if it must yield.

    ``displaced``: when something more important takes a limb from it, the step that needs the limb
    is done again afterwards ("resume"), or the rule or goal ends ("give_up").
    """

    name: str = ""
    priority: Priority = "normal"
    displaced: WhenDisplaced = "resume"
    goal: object = None
    """The goal that is pursued, if it is one."""


class RuleDisplaced(RuleStopped):
    """What the rule did has made way for something more important, and the rule gives up."""


def set_priority(priority: Priority, *, displaced: WhenDisplaced = "resume") -> None:
    """From here on, the rule that runs is so important: "low", "normal" or "high".

    What it asks of a robot takes the limbs that it needs from what is less important, and makes
    way for what is more important: then that step is done again afterwards, or the rule ends,
    where ``displaced`` is "give_up". It holds for this run of the rule. Raises NepError.
    """
    check_priority(priority)
    standing = current_task().standing
    standing.priority, standing.displaced = priority, displaced


def check_priority(priority: object) -> None:
    """Raise NepError for what is no priority."""
    if priority not in PRIORITIES:
        raise NepError(
            "There is no priority “{priority}”.",
            checklist=("Choose one of: {order}.",),
            priority=priority,
            order=", ".join(PRIORITIES),
        )


class Begun(NamedTuple):
    """What a part has begun and does not wait for: how it is ended, and begun again."""

    end: Callable[[], object]
    again: Callable[[], object] = lambda: None


class Task:
    """A part of a program; cancelling it cancels the parts that it started.

    While it is held, it and those that it started stand still at their next wait or robot call.
    """

    def __init__(self, parent: Task | None = None) -> None:
        self.cancelled = threading.Event()
        self.undo: dict[tuple[str, ...], Begun] = {}
        """What is still to be ended, by what it is, when this part is cancelled."""
        self.standing: Standing = parent.standing if parent is not None else Standing()
        self._parent = parent
        self._held_since_s = math.inf
        self._held_s = 0.0
        self.board: dict[str, Any] = parent.board if parent is not None else {}
        """The named values of the behaviour tree that this part belongs to."""
        self.in_step: bool = parent is not None and parent.in_step
        """Whether it belongs to a step of a behaviour tree."""
        self._children: list[Task] = []
        self._wakes: list[threading.Event] = []
        self._lock = threading.Lock()
        if parent is not None:
            parent._adopt(self)

    @property
    def is_held(self) -> bool:
        """Whether this part is to stand still, or one that has started it."""
        task: Task | None = self
        while task is not None:
            if task._held_since_s < math.inf:
                return True
            task = task._parent
        return False

    def held_s(self) -> float:
        """For how long it has been held, by the program's clock."""
        held_s, task = 0.0, self
        while True:
            with task._lock:
                held_s += task._held_s + max(0.0, CLOCK.now_s() - task._held_since_s)
            if task._parent is None:
                return held_s
            task = task._parent

    def hold(self) -> None:
        """Let this part stand still; what it had begun and not waited for is ended until then."""
        with self._lock:
            self._held_since_s = min(self._held_since_s, CLOCK.now_s())
        for begun in self._all_begun():
            begun.end()

    def go_on(self) -> None:
        """Let this part go on where it stands; what it had begun is begun again."""
        with self._lock:
            self._held_s += max(0.0, CLOCK.now_s() - self._held_since_s)
            self._held_since_s = math.inf
        for begun in self._all_begun():
            begun.again()

    def stand_still(self) -> None:
        """Return when this part is not held; raises Cancelled if it is asked to end."""
        while self.is_held:
            self.sleep(POLL_S)
        self.check()

    def _all_begun(self) -> list[Begun]:
        with self._lock:
            begun, children = list(self.undo.values()), list(self._children)
        return [*begun, *(one for child in children for one in child._all_begun())]

    def cancel(self) -> None:
        """Let this part and those that it started end at their next wait."""
        with self._lock:
            self.cancelled.set()
            children = list(self._children)
            wakes = list(self._wakes)
        for wake in wakes:
            wake.set()
        self.end_undone()
        for child in children:
            child.cancel()

    def end_undone(self) -> None:
        """End what this part and those that it has outlived began and did not wait for."""
        with self._lock:
            undo, self.undo = self.undo, {}
        for begun in undo.values():
            begun.end()

    def check(self) -> None:
        """Raise Cancelled if this part has been asked to end."""
        if self.cancelled.is_set():
            raise Cancelled

    def sleep(self, seconds: float) -> None:
        """Wait so long; raises Cancelled as soon as this part is asked to end."""
        if self.cancelled.wait(max(0.0, min(seconds, threading.TIMEOUT_MAX))):
            raise Cancelled

    def await_wake(self, wake: threading.Event) -> None:
        """Wait for an event; raises Cancelled as soon as this part is asked to end, which sets it.

        So the event is one of whoever waits alone.
        """
        with self._lock:
            self._wakes.append(wake)
        try:
            if not self.cancelled.is_set():
                wake.wait()
        finally:
            with self._lock:
                self._wakes.remove(wake)
        self.check()

    def _adopt(self, child: Task) -> None:
        with self._lock:
            self._children = [kept for kept in self._children if not kept.cancelled.is_set()]
            self._children.append(child)
            if self.cancelled.is_set():
                child.cancelled.set()

    def release(self, child: Task) -> None:
        """Forget a part that has ended; what it has not ended is left to this one."""
        with self._lock:
            self.undo |= child.undo
            if child in self._children:
                self._children.remove(child)


PROGRAM = Task()
"""The whole program; cancelling it ends the program."""

_current: contextvars.ContextVar[Task] = contextvars.ContextVar("nep_task", default=PROGRAM)


def current_task() -> Task:
    """The part of the program that this thread runs."""
    return _current.get()


_handled: contextvars.ContextVar[BaseException | None] = contextvars.ContextVar(
    "nep_handled", default=None
)
"""What went wrong where this part was begun."""


def handled_error() -> BaseException | None:
    """What went wrong, in what is done because of that, also in its parts; None elsewhere."""
    return sys.exception() or _handled.get()


_own_value: contextvars.ContextVar[object] = contextvars.ContextVar("nep_own_value", default=None)
"""The value for which this part is done, where it is one of ``for_each``."""


def own_value() -> object:
    """The value for which this is done, in a part of ``for_each`` and its parts; None elsewhere."""
    return _own_value.get()


def forget_origin() -> None:
    """Let nothing have gone wrong yet here, and be for no value: a rule begins that was told to."""
    _handled.set(None)
    _own_value.set(None)


_names: set[str] = set()
_names_lock = threading.Lock()


def _claim_name(wanted: str) -> str:
    """A name that no other running part has: the wanted one, or with a number behind it."""
    with _names_lock:
        numbers = (f"{wanted}-{number}" for number in itertools.count(2))
        name = next(name for name in itertools.chain([wanted], numbers) if name not in _names)
        _names.add(name)
        return name


PATIENCE_S = 1.0
"""A part that was asked to end, and has not waited for anything for so long, is interrupted."""
GIVEN_UP_S = 5.0
"""One that cannot be interrupted, as in a long call, is waited for no longer."""


class Part:
    """A function in a thread and task of its own; its error is kept for whoever joins it.

    The thread's name is ``name``, with a number while another part of that name runs. What was
    told to the rule that begins the part, and what went wrong there, is known in the part too.
    """

    def __init__(self, function: Callable[[], object], name: str, parent: Task) -> None:
        self.task = Task(parent)
        self.error: BaseException | None = None
        self._function = function
        self._parent = parent
        context = contextvars.copy_context()
        context.run(_handled.set, handled_error())
        self._thread = threading.Thread(
            target=context.run, args=(self._run,), name=name, daemon=True
        )

    def start(self) -> Part:
        """Begin."""
        self._thread.name = _claim_name(self._thread.name)
        self._thread.start()
        return self

    @property
    def is_running(self) -> bool:
        """Whether it has not ended yet."""
        return self._thread.is_alive()

    def join(self, timeout_s: float | None = None) -> None:
        """Wait for its end."""
        self._thread.join(timeout_s)

    def await_end(self, look: Callable[[], object] = lambda: False) -> None:
        """Wait for its end; ``look`` is called all the while, and ends the wait by being true.

        When it was asked to end, but only computes and so never notices, it is interrupted; it is
        not waited for any longer when that does not help either.
        """
        asked_s, interrupted_s = math.inf, -math.inf
        while self.is_running:
            self.join(POLL_S)
            if look():
                return
            now_s = time.monotonic()
            if not self.task.cancelled.is_set():
                continue
            asked_s = min(asked_s, now_s)
            if now_s - asked_s >= GIVEN_UP_S:
                return
            if now_s - asked_s >= PATIENCE_S and now_s - interrupted_s >= PATIENCE_S:
                interrupted_s = now_s if self.interrupt() else interrupted_s

    def interrupt(self) -> bool:
        """Raise Cancelled in the program's own lines, not where nep_core holds something; if so."""
        ident = self._thread.ident
        frame = frames_of_threads().get(ident) if ident is not None else None
        if ident is not None and frame is not None and _is_interruptible(frame):
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(ident), ctypes.py_object(Cancelled)
            )
            return True
        return False

    def _run(self) -> None:
        _current.set(self.task)
        try:
            self._function()
        except Cancelled:
            pass
        except BaseException as error:
            self.error = error
            self.task.cancel()  # what it has begun on a robot, such as a walk, ends with it
        finally:
            self._parent.release(self.task)
            with _names_lock:
                _names.discard(self._thread.name)


_one_look = threading.Lock()


def frames_of_threads() -> dict[int, FrameType]:
    """The innermost call of each thread, by its ident.

    WORKAROUND: Python 3.11 makes objects for it while it holds a lock that other threads need, and
    a garbage collection in between lets them wait for each other for ever; so there is none.
    https://github.com/python/cpython/issues/106883
    """
    with _one_look:
        collects = gc.isenabled()
        gc.disable()
        try:
            return sys._current_frames()
        finally:
            if collects:
                gc.enable()


def _is_interruptible(frame: FrameType) -> bool:
    """Whether a thread is in lines of a program, not in what nep_core does for it."""
    own = os.path.dirname(Part._run.__code__.co_filename)
    ours = os.path.dirname(own)
    at: FrameType | None = frame
    while at is not None and not at.f_code.co_filename.startswith(ours):
        at = at.f_back
    # behaviours and parts call the program's functions, everything else does something itself
    return at is not None and at is not frame and os.path.dirname(at.f_code.co_filename) == own


def wait(seconds: float) -> None:
    """Let this part of the program rest for so many seconds; pauses of it do not count."""
    task, countdown, left_s = current_task(), Countdown(seconds), seconds
    while left_s > 0:
        task.sleep(min(left_s, POLL_S) if CLOCK.is_pausable else left_s)
        task.stand_still()
        if (left_s := countdown.left_s()) > 0:
            CLOCK.hold()
            countdown.skip()
    task.check()


def wait_until(condition: Callable[[], object], at_most_s: float = math.inf) -> bool:
    """Let this part of the program rest until ``condition()`` is true, or the time is over.

    Gives whether the condition came true.
    """
    task, countdown = current_task(), Countdown(at_most_s)
    task.stand_still()
    while not condition():
        if (left_s := countdown.left_s()) <= 0:
            return False
        task.sleep(min(POLL_S, left_s))
        task.stand_still()
    return True


def together(*functions: Callable[[], object]) -> None:
    """Run the functions side by side and wait for all; an error ends the others and is raised."""
    task = current_task()
    name = threading.current_thread().name
    parts = [Part(f, f"{name}-part-{i}", task).start() for i, f in enumerate(functions, 1)]

    def look() -> None:
        if task.cancelled.is_set() or any(other.error for other in parts):
            for other in parts:
                other.task.cancel()

    for part in parts:
        part.await_end(look)
    task.check()
    for part in parts:
        if part.error is not None:
            raise part.error


def for_each(values: Iterable[object], function: Callable[[], object]) -> None:
    """Call the function once for each value, side by side, as ``together`` does."""

    def do(value: object) -> None:
        _own_value.set(value)  # of this part, and of those that it begins
        function()

    together(*(partial(do, value) for value in values))


def end_actions() -> None:
    """End what this part of the program has begun on robots and not waited for, such as a walk."""
    current_task().end_undone()


def stop_program() -> None:
    """End the whole program, well."""
    PROGRAM.cancel()
    raise Cancelled


def stop_rule() -> None:
    """End the rule that runs here, well; also out of its parts and own blocks."""
    raise RuleStopped


at_once = threading.RLock()
"""What is done ``with at_once:`` is done whole: nobody else who says so changes it meanwhile."""
