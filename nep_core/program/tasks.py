"""The parts of a program that run side by side, and how they wait and are cancelled.

Cancelling is cooperative: a part ends at its next wait or robot call, by Cancelled, which
ordinary ``except`` clauses do not catch.
"""

from __future__ import annotations

import contextvars
import itertools
import math
import threading
import time
from collections.abc import Callable

POLL_S = 0.05
"""How often a condition is looked at."""


class Cancelled(BaseException):
    """This part of the program has been asked to end."""


class Task:
    """A part of a program; cancelling it cancels the parts that it started."""

    def __init__(self, parent: Task | None = None) -> None:
        self.cancelled = threading.Event()
        self.undo: dict[tuple[str, ...], Callable[[], object]] = {}
        """What is still to be ended, by what it is, when this part is cancelled."""
        self._children: list[Task] = []
        self._lock = threading.Lock()
        if parent is not None:
            parent._adopt(self)

    def cancel(self) -> None:
        """Let this part and those that it started end at their next wait."""
        with self._lock:
            self.cancelled.set()
            children = list(self._children)
        self.end_undone()
        for child in children:
            child.cancel()

    def end_undone(self) -> None:
        """End what this part and those that it has outlived began and did not wait for."""
        with self._lock:
            undo, self.undo = self.undo, {}
        for end in undo.values():
            end()

    def check(self) -> None:
        """Raise Cancelled if this part has been asked to end."""
        if self.cancelled.is_set():
            raise Cancelled

    def sleep(self, seconds: float) -> None:
        """Wait so long; raises Cancelled as soon as this part is asked to end."""
        if self.cancelled.wait(max(0.0, min(seconds, threading.TIMEOUT_MAX))):
            raise Cancelled

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


_names: set[str] = set()
_names_lock = threading.Lock()


def _claim_name(wanted: str) -> str:
    """A name that no other running part has: the wanted one, or with a number behind it."""
    with _names_lock:
        numbers = (f"{wanted}-{number}" for number in itertools.count(2))
        name = next(name for name in itertools.chain([wanted], numbers) if name not in _names)
        _names.add(name)
        return name


class Part:
    """A function in a thread and task of its own; its error is kept for whoever joins it.

    The thread's name is ``name``, with a number while another part of that name runs.
    """

    def __init__(self, function: Callable[[], object], name: str, parent: Task) -> None:
        self.task = Task(parent)
        self.error: BaseException | None = None
        self._function = function
        self._parent = parent
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

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

    def _run(self) -> None:
        _current.set(self.task)
        try:
            self._function()
        except Cancelled:
            pass
        except BaseException as error:
            self.error = error
        finally:
            self._parent.release(self.task)
            with _names_lock:
                _names.discard(self._thread.name)


def wait(seconds: float) -> None:
    """Let this part of the program rest for so many seconds."""
    current_task().sleep(seconds)


def wait_until(condition: Callable[[], object], at_most_s: float = math.inf) -> bool:
    """Let this part of the program rest until ``condition()`` is true, or the time is over.

    Gives whether the condition came true.
    """
    task, end = current_task(), time.monotonic() + at_most_s
    while not condition():
        left = end - time.monotonic()
        if left <= 0:
            return False
        task.sleep(min(POLL_S, left))
    return True


def together(*functions: Callable[[], object]) -> None:
    """Run the functions side by side and wait for all; an error ends the others and is raised."""
    task = current_task()
    name = threading.current_thread().name
    parts = [Part(f, f"{name}-part-{i}", task).start() for i, f in enumerate(functions, 1)]
    for part in parts:
        while part.is_running:
            part.join(POLL_S)
            if task.cancelled.is_set() or any(other.error for other in parts):
                for other in parts:
                    other.task.cancel()
    task.check()
    for part in parts:
        if part.error is not None:
            raise part.error


def stop_program() -> None:
    """End the whole program, well."""
    PROGRAM.cancel()
    raise Cancelled
