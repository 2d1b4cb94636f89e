"""Follows a program while it runs, tells where it is and what it holds, and obeys orders."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Mapping
from functools import lru_cache
from itertools import islice
from pathlib import Path
from types import CodeType, FrameType

from nep_core.program.tasks import CLOCK, POLL_S, PROGRAM, Cancelled
from nep_core.wire.messages import ProgramControl, ProgramEvent, ProgramState

from .state import ProgramSource, ProgramThread, ProgramThreads, ProgramValues, read_source
from .watches import Events, Lines, Watch

# How fast a program goes: breakpoints, pause, steps and slow motion, at each line of a thread.

Tell = Callable[[ProgramEvent, str, int, str], None]
"""Called with "paused" or "resumed", the thread, its line, and why."""


class Pace:
    """Lets threads pass their lines, or holds them there.

    A breakpoint pauses the whole program: every thread at its next line. A step lets one of them,
    or each, run to its next line.
    """

    def __init__(self, source: ProgramSource, tell: Tell) -> None:
        self._source = source
        self._tell = tell
        self._changed = threading.Condition()
        self._is_paused = False
        self._is_first_pause_step = False
        self._breakpoints: frozenset[int] = frozenset()
        self._line_s = 0.0
        self._held: set[ProgramThread] = set()
        self._may_go: set[ProgramThread] = set()
        self._is_over = False

    @property
    def lines(self) -> Lines:
        """The lines at which threads must stop by now."""
        if self._is_over:
            return frozenset()
        if self._is_paused or self._line_s > 0 or PROGRAM.cancelled.is_set():
            return None
        return self._breakpoints

    def obey(self, order: ProgramControl) -> None:
        """Pause, resume, step, or go on as "set" says."""
        with self._changed:
            if order.command == "pause":
                self._pause()
                self._is_first_pause_step = False
            elif order.command == "resume":
                self._resume()
            elif order.command == "step":
                self._step(order.thread)
            elif order.command == "set":
                moved = self._source.moved
                self._breakpoints = frozenset(moved.get(at, at) for at in order.breakpoints)
                self._line_s = order.line_s if order.line_s > 0 else 0.0
            self._changed.notify_all()

    def end(self) -> None:
        """Hold nobody any more."""
        with self._changed:
            self._is_over, self._line_s = True, 0.0
            self._resume()
            self._changed.notify_all()

    def wake(self) -> None:
        """Let those who are held see at once that they have been cancelled."""
        with self._changed:
            self._changed.notify_all()

    def at_line(self, thread: ProgramThread, line: int) -> bool:
        """Return when ``thread`` may run ``line``; raises Cancelled when the program ends.

        Gives whether it may run this line without asking until the pace changes.
        """
        if self._is_over or thread.is_cancelled:
            return True
        if PROGRAM.cancelled.is_set():
            self._cancel(thread)
            return False
        is_step = line not in self._source.quiet_lines
        if line in self._breakpoints or (is_step and self._is_paused):
            self._hold(thread, line)
        elif is_step and self._line_s:
            self._linger(thread, line)
        else:
            return not (is_step and self._is_paused)  # perhaps since a moment ago
        return False

    def in_wait(self, thread: ProgramThread, line: int) -> None:
        """Return when a thread may go on with a wait; raises Cancelled when the program ends."""
        if self._is_paused and not thread.is_stepped and not thread.is_cancelled:
            self._hold(thread, line)

    def _pause(self) -> None:
        """Pause, the waits of the program too."""
        self._is_paused = True
        CLOCK.pause()

    def _resume(self) -> None:
        self._is_paused = False
        CLOCK.resume()

    def _step(self, name: str) -> None:
        if self._is_paused:
            may_go = {held for held in self._held if name in ("", held.name)}
            self._may_go |= may_go
            if not may_go:  # those that wait for something with a limit come to their next line
                CLOCK.resume()
        else:
            self._pause()
            self._is_first_pause_step = True

    def _hold(self, thread: ProgramThread, line: int) -> None:
        with self._changed:
            is_breakpoint = line in self._breakpoints
            is_step = thread.is_stepped or self._is_first_pause_step
            why = "breakpoint" if is_breakpoint else "step" if is_step else "pause"
            self._pause()
            thread.is_stepped = False
            self._held.add(thread)
            try:
                self._tell("paused", thread.name, line, why)
                while self._is_paused and thread not in self._may_go:
                    self._check(thread)
                    self._changed.wait(POLL_S)
                thread.is_stepped = self._is_paused
                self._tell("resumed", thread.name, line, "step" if self._is_paused else "")
            finally:
                self._held.discard(thread)
                self._may_go.discard(thread)

    def _linger(self, thread: ProgramThread, line: int) -> None:
        begun_s = time.monotonic()
        with self._changed:
            while (left_s := begun_s + self._line_s - time.monotonic()) > 0:
                self._check(thread)
                if self._is_paused:
                    self._hold(thread, line)
                    return
                self._changed.wait(min(left_s, POLL_S))

    def _check(self, thread: ProgramThread) -> None:
        """End a thread that is held, as a wait would, when its part of the program is cancelled."""
        if thread.task.cancelled.is_set() or PROGRAM.cancelled.is_set():
            self._cancel(thread)

    def _cancel(self, thread: ProgramThread) -> None:
        """Raise Cancelled, once: what the program does at its end is its own affair."""
        thread.is_cancelled = True
        raise Cancelled


PERIOD_S = 1 / 30
"""How often is looked, at most, and told what is new."""
LOOKING_SHARE = 0.1
"""Looking takes at most this share of the time, however much there is to see."""
REFRESHES = 2
"""After an order; a thread that was just let past a line takes in the first one too early."""

Send = Callable[[ProgramState], None]
WatchMaker = Callable[[str, ProgramSource, ProgramThreads, Events], Watch]


class Tracer:
    """Traces the program ``file`` between begin() and end(), which the same thread calls.

    ``send`` is called, from several threads, with each state; ``name`` is the program's;
    ``make_watch`` makes what follows the lines (None: as costs least).
    """

    def __init__(
        self, name: str, file: str, send: Send, make_watch: WatchMaker | None = None
    ) -> None:
        self._name = name
        self._send = send
        source = read_source(Path(file))
        self._threads = ProgramThreads(file)
        self._values = ProgramValues(source.variables, self._threads.frames)
        self._pace = Pace(source, self._tell)
        self._watch = (make_watch or cheapest_watch())(file, source, self._threads, self)
        self._lock = threading.Lock()
        self._sending = threading.Lock()
        self._refreshes = 0
        self._last_lines: dict[str, list[int]] = {}
        self._over = threading.Event()
        self._teller = threading.Thread(target=self._keep_telling, name="nep-trace", daemon=True)

    def begin(self) -> None:
        """Follow this thread and those that begin from now on."""
        CLOCK.is_pausable, CLOCK.is_stepped, CLOCK.hold = True, self._is_stepped, self._hold
        self._teller.start()
        self._set_lines()
        self._watch.begin()

    def end(self) -> None:
        """Follow no more; what is new is told first."""
        self._pace.end()
        CLOCK.is_pausable, CLOCK.is_stepped, CLOCK.hold = False, lambda: False, lambda: None
        self._over.set()
        with self._lock:
            self._watch.end()
        self._teller.join()
        self._tell_values()
        self._tell_lines({})

    def obey(self, order: ProgramControl) -> None:
        """Pause, resume, step or set; also before the program begins."""
        self._pace.obey(order)
        self._set_lines()

    def wake(self) -> None:
        """Let threads that are held see at once that the program is to end."""
        self._set_lines()
        self._pace.wake()

    def begun(self, namespace: Mapping[str, object]) -> None:
        """Note where the program keeps its names."""
        self._values.namespace = namespace

    def ended(self, frame: FrameType) -> None:
        """Note what a rule held that ends now."""
        self._values.end_of(frame)

    def line(self, _frame: FrameType, line: int) -> bool:
        """Hold this thread at a line for as long as the pace says."""
        return self._pace.at_line(self._threads.this(), line)

    def report(self, caller: FrameType, value: object) -> None:
        """Note what a call in the program's file gave."""
        if value is not None:
            self._values.report(place_of(caller.f_code, caller.f_lasti), value)

    def look(self) -> None:
        """Tell what is new; called 30 times a second, or less often where there is much."""
        if PROGRAM.cancelled.is_set():
            self._set_lines()
        with self._lock:
            if self._refreshes and not self._over.is_set():
                self._refreshes -= 1
                self._watch.refresh()
        with self._sending:
            self._tell_lines(self._threads.lines())
        self._tell_values()

    def _hold(self) -> None:
        """Hold a thread that waits while the program is paused, at the line in which it waits."""
        if line := self._threads.line_here():
            self._pace.in_wait(self._threads.this(), line)

    def _is_stepped(self) -> bool:
        """Whether the thread that asks runs a line of a program that is paused."""
        thread = self._threads.asked_before()
        return thread is not None and thread.is_stepped

    def _set_lines(self) -> None:
        with self._lock:
            if not self._over.is_set():
                self._watch.set_lines(self._pace.lines)
                self._refreshes = REFRESHES

    def _keep_telling(self) -> None:
        pause_s = PERIOD_S
        while not self._over.wait(pause_s):
            began_s = time.thread_time()
            self.look()
            pause_s = max(PERIOD_S, (time.thread_time() - began_s) / LOOKING_SHARE)

    def _tell_lines(self, lines: dict[str, list[int]]) -> None:
        if lines != self._last_lines:
            self._last_lines = lines
            self._send(ProgramState(program=self._name, event="line", lines=lines))

    def _tell_values(self) -> None:
        if values := self._values.changed():
            self._send(ProgramState(program=self._name, event="value", values=values))

    def _tell(self, event: ProgramEvent, thread: str, line: int, why: str) -> None:
        state = ProgramState(
            program=self._name, event=event, thread=thread, line=line, description=why
        )
        with self._sending:  # no line that was read before a pause is told after it
            self._send(state)
        if event == "paused":
            self._set_lines()  # a breakpoint of one thread pauses all


def cheapest_watch() -> WatchMaker:
    """How this Python watches a program at the least cost."""
    if sys.version_info >= (3, 12):
        from .watches import MonitoringWatch, free_tool

        if free_tool() is not None:
            return MonitoringWatch
    from .watches import SettraceWatch

    return SettraceWatch


@lru_cache(4096)
def place_of(code: CodeType, offset: int) -> str:
    """Where the call is that code has come to: "@12:4-20", its line and columns (bytes, from 0)."""
    line, _, begin, end = next(islice(code.co_positions(), offset // 2, None))
    return f"@{line}:{begin}-{end}"
