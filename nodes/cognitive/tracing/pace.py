"""How fast a program goes: breakpoints, pause, steps and slow motion, at each line of a thread."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from nep_core.messages import ProgramControl, ProgramEvent
from nep_core.tasks import POLL_S, PROGRAM, Cancelled
from nodes.cognitive.tracing.events import Lines
from nodes.cognitive.tracing.source import ProgramSource
from nodes.cognitive.tracing.threads import ProgramThread

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
                self._is_paused, self._is_first_pause_step = True, False
            elif order.command == "resume":
                self._is_paused = False
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
            self._is_over, self._is_paused, self._line_s = True, False, 0.0
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

    def _step(self, name: str) -> None:
        if self._is_paused:
            self._may_go |= {held for held in self._held if name in ("", held.name)}
        else:
            self._is_paused = self._is_first_pause_step = True

    def _hold(self, thread: ProgramThread, line: int) -> None:
        with self._changed:
            is_breakpoint = line in self._breakpoints
            is_step = thread.is_stepped or self._is_first_pause_step
            why = "breakpoint" if is_breakpoint else "step" if is_step else "pause"
            self._is_paused, thread.is_stepped = True, False
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
