"""Follows a program while it runs, tells where it is and what it holds, and obeys orders."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from functools import lru_cache
from itertools import islice
from pathlib import Path
from types import CodeType, FrameType

from nep_core.messages import ProgramControl, ProgramEvent, ProgramState
from nep_core.tasks import PROGRAM
from nodes.cognitive.tracing.events import Events, Watch
from nodes.cognitive.tracing.pace import Pace
from nodes.cognitive.tracing.source import read_source
from nodes.cognitive.tracing.threads import ProgramThreads
from nodes.cognitive.tracing.values import ProgramValues

PERIOD_S = 1 / 30
"""How often is looked, at most, and told what is new."""
LOOKING_SHARE = 0.1
"""Looking takes at most this share of the time, however much there is to see."""
REFRESHES = 2
"""After an order; a thread that was just let past a line takes in the first one too early."""

Send = Callable[[ProgramState], None]
WatchMaker = Callable[[str, ProgramThreads, Events], Watch]


class Tracer:
    """Traces the program ``file`` between begin() and end(), which the same thread calls.

    ``send`` is called, from several threads, with each state; ``name`` is the program's.
    """

    def __init__(
        self, name: str, file: str, send: Send, make_watch: WatchMaker | None = None
    ) -> None:
        self._name = name
        self._send = send
        source = read_source(Path(file))
        self._threads = ProgramThreads()
        self._values = ProgramValues(source.variables)
        self._pace = Pace(source, self._tell)
        self._watch = (make_watch or cheapest_watch())(file, self._threads, self)
        self._lock = threading.Lock()
        self._telling = threading.Lock()
        self._refreshes = 0
        self._told: dict[str, list[int]] = {}
        self._over = threading.Event()
        self._teller = threading.Thread(target=self._keep_telling, name="nep-trace", daemon=True)

    def begin(self) -> None:
        """Follow this thread and those that begin from now on."""
        self._teller.start()
        self._set_lines()
        self._watch.begin()

    def end(self) -> None:
        """Follow no more; what is new is told first."""
        self._pace.end()
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

    def enter(self, frame: FrameType) -> None:
        """Note a call in the program's file."""
        if frame.f_code.co_name == "<module>":
            self._values.namespace = frame.f_globals
        self._threads.enter(frame)

    def leave(self, frame: FrameType) -> None:
        """Note the end of a call."""
        self._threads.leave(frame)

    def line(self, _frame: FrameType, line: int) -> bool:
        """Hold this thread at a line for as long as the pace says."""
        thread = self._threads.this()
        if thread is None:
            return False
        try:
            return self._pace.at_line(thread, line)
        except BaseException:
            self._threads.forget()  # settrace tells no more of a thread in which it has failed
            raise

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
        with self._telling:
            self._tell_lines(self._threads.lines())
        self._tell_values()

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
        if lines != self._told:
            self._told = lines
            self._send(ProgramState(program=self._name, event="line", lines=lines))

    def _tell_values(self) -> None:
        if values := self._values.changed():
            self._send(ProgramState(program=self._name, event="value", values=values))

    def _tell(self, event: ProgramEvent, thread: str, line: int, why: str) -> None:
        state = ProgramState(
            program=self._name, event=event, thread=thread, line=line, description=why
        )
        with self._telling:  # no line that was read before a pause is told after it
            self._send(state)
        if event == "paused":
            self._set_lines()  # a breakpoint of one thread pauses all


def cheapest_watch() -> WatchMaker:
    """How this Python watches a program at the least cost."""
    if sys.version_info >= (3, 12):
        from nodes.cognitive.tracing.monitoring import MonitoringWatch, free_tool

        if free_tool() is not None:
            return MonitoringWatch
    from nodes.cognitive.tracing.settrace import SettraceWatch

    return SettraceWatch


@lru_cache(4096)
def place_of(code: CodeType, offset: int) -> str:
    """Where the call is that code has come to: "@12:4-20", its line and columns (bytes, from 0)."""
    line, _, begin, end = next(islice(code.co_positions(), offset // 2, None))
    return f"@{line}:{begin}-{end}"
