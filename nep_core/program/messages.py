"""Messages: what a rule tells the other rules of its program, and the runs that begin by it."""

from __future__ import annotations

import contextvars
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Protocol

from nep_core.errors import NepError

from .human import note_answer
from .tasks import current_task, forget_origin
from .values import as_text


class MessageRefused(NepError, title="The program stopped with an error"):
    """A message that cannot be told and waited for."""


# The runs of rules: each knows what it was told, and whom it waits for.

_graph = threading.Lock()
"""Held while runs begin to wait for each other, so that no circle is closed unseen."""


class Run:
    """One run of a function of the program, which others may wait for.

    ``value`` is what it was told, ``after`` the run behind which it stands in a queue.
    """

    def __init__(self, action: Callable[[], object], value: object = "") -> None:
        self.action = action
        self.value = value
        self.after: Run | None = None
        self.awaited: list[Run] = []
        """The runs that parts of this one wait for."""
        self._has_ended = False
        self._wakes: list[threading.Event] = []
        self._lock = threading.Lock()

    def begin(self) -> None:
        """Let this be the run of the thread, and of the parts that it begins."""
        self.after = None  # else a rule that is always late would keep all its runs
        _own.set(self)
        forget_origin()
        note_answer("")

    def end(self) -> None:
        """Tell everybody who waits for it that it is over, however it has ended."""
        with self._lock:
            self._has_ended = True
            wakes, self._wakes = self._wakes, []
        for wake in wakes:
            wake.set()

    def await_end(self) -> None:
        """Wait until it is over; raises Cancelled as soon as who waits is asked to end."""
        wake = threading.Event()
        with self._lock:
            if self._has_ended:
                return
            self._wakes.append(wake)
        current_task().await_wake(wake)

    def waits_for(self, other: Run) -> bool:
        """Whether it ends only after another run, as far as runs wait for each other."""
        waiting, seen = [self], set[int]()
        while waiting:
            run = waiting.pop()
            if run is other:
                return True
            if id(run) not in seen:
                seen.add(id(run))
                waiting += [*run.awaited, *([run.after] if run.after is not None else [])]
        return False


_own: contextvars.ContextVar[Run | None] = contextvars.ContextVar("nep_run", default=None)


def own_run() -> Run | None:
    """The run of a rule in which this thread is, or a part of it; None elsewhere."""
    return _own.get()


def told_value() -> object:
    """What came with the message that this rule was told; an empty text in other rules."""
    run = _own.get()
    return "" if run is None else run.value


# Who hears: a behaviour that runs.


class Hearer(Protocol):
    """What has rules for messages."""

    def last_run(self, message: str) -> Iterator[tuple[str, Run | None]]:
        """For each rule for a message, what it does while it runs, and its run that ends last."""

    def hear(self, message: str, value: object) -> Iterator[Run]:
        """Start the rules for a message, in their order; gives the runs that begin by it."""


_hearers: list[Hearer] = []


@contextmanager
def heard_by(hearer: Hearer) -> Iterator[None]:
    """Let a behaviour hear the messages of this program."""
    _hearers.append(hearer)
    try:
        yield
    finally:
        _hearers.remove(hearer)


def tell(message: object, value: object = "", *, wait: bool = False) -> None:
    """Start each rule for a message, with a value for it; ``wait`` until all these have ended.

    A start that a rule ignores because it runs is not waited for. Raises MessageRefused where it
    would be waited for for ever: by the rule itself, or by one that waits for this one.
    """
    name, own = as_text(message), _own.get() if wait else None
    with _graph:
        if own is not None:
            _require_end(name, own)
        runs = [run for hearer in tuple(_hearers) for run in hearer.hear(name, value)]
        if own is not None:
            own.awaited += runs
    if wait:
        _await(runs, own)


def _await(runs: Sequence[Run], own: Run | None) -> None:
    try:
        for run in runs:
            run.await_end()
        current_task().check()  # what ended them may be that all is to end
    finally:
        if own is not None:
            with _graph:
                for run in runs:
                    own.awaited.remove(run)


def _require_end(message: str, own: Run) -> None:
    """Raise MessageRefused where a run would wait for itself."""
    for hearer in tuple(_hearers):
        for again, last in hearer.last_run(message):
            is_own = last is not None and last.action is own.action and again == "ignore"
            is_circle = again == "queue" and last is not None and last.waits_for(own)
            if is_own or is_circle:
                raise MessageRefused(
                    "Who tells “{message}” here waits for a rule that waits for this one: it "
                    "would never end.",
                    checklist=(
                        "Tell it without waiting.",
                        "Or use a loop where a rule should do the same again.",
                    ),
                    message=message,
                )
