"""What a watch tells of a program: calls, lines, ends of calls, and what calls gave."""

from __future__ import annotations

import contextlib
import importlib
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from inspect import CO_GENERATOR, isfunction
from types import CodeType, FrameType
from typing import Any, Protocol

from .state import ProgramSource, ProgramThreads, is_part_of_line

WORDS_OF_ROBOTS = ("program.behavior", "program.human", "program.robot", "program.tasks")
"""Modules of nep_core whose functions programs call."""


class Events(Protocol):
    """What hears of a program; all are called in the program's own threads."""

    def begun(self, namespace: Mapping[str, object]) -> None:
        """Hear that the file runs, and where it keeps its names."""

    def ended(self, frame: FrameType) -> None:
        """Hear that a rule, or a part of one, has come to its end."""

    def line(self, frame: FrameType, line: int) -> bool:
        """Return when the line may run; whether it need not be told until the next refresh."""

    def report(self, caller: FrameType, value: object) -> None:
        """Hear what a call from the file into nep_core gave."""


Lines = frozenset[int] | None
"""Some lines of a file; None is all of them."""


class Watch(Protocol):
    """Tells Events of one file from begin to end."""

    def begin(self) -> None:
        """Watch this thread and those that begin from now on."""

    def set_lines(self, lines: Lines) -> None:
        """Tell of these lines from now on; the functions of the others cost little."""

    def refresh(self) -> None:
        """Tell again of every line."""

    def end(self) -> None:
        """Watch no more."""


def has_any(code: CodeType, lines: Lines) -> bool:
    """Whether code, without the functions in it, has any of the lines."""
    if not lines:
        return lines is None
    return any(line in lines for _, _, line in code.co_lines())


@cache
def reporting_code() -> frozenset[CodeType]:
    """The functions of nep_core that programs call for a value."""
    return frozenset(code for code in _public_code() if not code.co_flags & CO_GENERATOR)


def _public_code() -> Iterator[CodeType]:
    robot = importlib.import_module("nep_core.program.robot").Robot
    own = [kind for kind in robot.__mro__ if kind.__module__.startswith("nep_core.")]
    homes = [importlib.import_module(f"nep_core.{name}") for name in WORDS_OF_ROBOTS]
    for home in (*own, *homes):
        for name, function in vars(home).items():
            if isfunction(function) and not name.startswith("_"):
                yield function.__code__


# Watches a program by sys.monitoring, which costs nothing where nothing is asked.

if sys.version_info >= (3, 12):
    from sys import monitoring

    _E = monitoring.events
    _NAME = "nep-studio"

    class MonitoringWatch:
        """Python calls it when code begins for the first time, and at lines only while asked."""

        def __init__(
            self, file: str, source: ProgramSource, _threads: ProgramThreads, events: Events
        ) -> None:
            self._file = file
            self._source = source
            self._events = events
            self._code: dict[int, CodeType] = {}  # by id: to compare code takes long
            self._lines: Lines = frozenset()
            self._tool = free_tool() or 0

        def begin(self) -> None:
            """Watch this thread and those that begin from now on."""
            monitoring.use_tool_id(self._tool, _NAME)
            for event, callback in (
                (_E.PY_START, self._on_start),
                (_E.PY_RETURN, self._on_return),
                (_E.LINE, self._on_line),
            ):
                monitoring.register_callback(self._tool, event, callback)
            for code in reporting_code():
                monitoring.set_local_events(self._tool, code, _E.PY_RETURN)
            monitoring.set_events(self._tool, _E.PY_START)

        def set_lines(self, lines: Lines) -> None:
            """Tell of these lines from now on; the functions of the others cost less."""
            self._lines = lines
            for code in list(self._code.values()):
                self._watch(code)

        def refresh(self) -> None:
            """Tell again of every line."""
            monitoring.restart_events()

        def end(self) -> None:
            """Watch no more."""
            monitoring.set_events(self._tool, 0)
            for code in (*self._code.values(), *reporting_code()):
                monitoring.set_local_events(self._tool, code, 0)
            for event in (_E.PY_START, _E.PY_RETURN, _E.LINE):
                monitoring.register_callback(self._tool, event, None)
            monitoring.free_tool_id(self._tool)

        def _watch(self, code: CodeType) -> None:
            events = _E.LINE if has_any(code, self._lines) else 0
            if code.co_name in self._source.rules:
                events |= _E.PY_RETURN
            with contextlib.suppress(ValueError):  # another thread has ended the watch
                monitoring.set_local_events(self._tool, code, events)

        def _on_start(self, code: CodeType, _offset: int) -> object:
            if code.co_filename == self._file and not is_part_of_line(code):
                if not self._code:
                    self._events.begun(sys._getframe(1).f_globals)
                if id(code) not in self._code:
                    self._code[id(code)] = code  # before: set_lines may look in between
                    self._watch(code)
            return monitoring.DISABLE

        def _on_return(self, code: CodeType, _offset: int, value: object) -> None:
            if code.co_filename == self._file:
                self._events.ended(sys._getframe(1))
                return
            caller = sys._getframe(1).f_back
            if caller is not None and caller.f_code.co_filename == self._file:
                self._events.report(caller, value)

        def _on_line(self, _code: CodeType, line: int) -> object:
            return monitoring.DISABLE if self._events.line(sys._getframe(1), line) else None

    def free_tool() -> int | None:
        """A number that no other tool uses, such as a debugger; None where there is none."""
        tools = (4, 3, monitoring.PROFILER_ID, monitoring.DEBUGGER_ID)
        return next((tool for tool in tools if monitoring.get_tool(tool) is None), None)


# Watches a program by sys.settrace, for Pythons without sys.monitoring.

Trace = Callable[[FrameType, str, Any], Any]


class SettraceWatch:
    """Python calls it at every call in the program's threads, and at lines only while asked.

    At each call it looks up the name, and no more, where nothing is wanted of functions so called:
    that is what following a program costs.
    """

    def __init__(
        self, file: str, source: ProgramSource, threads: ProgramThreads, events: Events
    ) -> None:
        self._file = file
        self._source = source
        self._threads = threads
        self._events = events
        self._lines: Lines = frozenset()
        self._has_lines: dict[int, bool] = {}  # by id of code, for the lines that are wanted now
        self._api = {id(code): code for code in reporting_code()}
        names = (code.co_name for code in reporting_code())
        self._wanted: dict[str, Trace] = dict.fromkeys((*names, *source.rules), self._on_call)
        self._wanted["<module>"] = self._on_call
        self._has_begun = False

    def begin(self) -> None:
        """Watch this thread and those that begin from now on."""
        wanted = self._wanted.get

        def on_call(frame: FrameType, event: str, argument: object) -> Trace | None:
            look = wanted(frame.f_code.co_name)
            return None if look is None else look(frame, event, argument)

        threading.settrace(on_call)
        sys.settrace(on_call)

    def set_lines(self, lines: Lines) -> None:
        """Tell of these lines from now on; the functions of the others cost little."""
        if lines != self._lines:
            self._lines, self._has_lines = lines, {}
        if lines is None or lines:
            self._wanted.update(dict.fromkeys(self._source.functions, self._on_call))
        else:
            for name in self._source.functions - self._source.rules - self._api_names():
                self._wanted.pop(name, None)
        for frame in self._threads.frames():
            frame.f_trace_lines = has_any(frame.f_code, lines)
            if frame.f_trace_lines:
                frame.f_trace = self._on_event

    def refresh(self) -> None:
        """Tell again of every line: here no line is left out."""

    def end(self) -> None:
        """Watch no more; threads that still run are watched to their end."""
        sys.settrace(None)
        threading.settrace(None)

    def _api_names(self) -> frozenset[str]:
        return frozenset(code.co_name for code in self._api.values())

    def _on_call(self, frame: FrameType, event: str, argument: object) -> Trace | None:
        code = frame.f_code
        if code.co_filename != self._file:
            return self._on_api_call(frame)
        if not self._has_begun:
            self._has_begun = True
            self._events.begun(frame.f_globals)
        frame.f_trace_lines = self._wants(code)
        is_told = code.co_name in self._source.rules
        return self._on_event if is_told or frame.f_trace_lines else None

    def _on_api_call(self, frame: FrameType) -> Trace | None:
        caller = frame.f_back
        if id(frame.f_code) not in self._api or caller is None:
            return None
        if caller.f_code.co_filename != self._file:
            return None
        frame.f_trace_lines = False
        return self._on_report

    def _wants(self, code: CodeType) -> bool:
        wanted = self._has_lines.get(id(code))
        if wanted is None:
            known, lines = self._has_lines, self._lines
            wanted = known[id(code)] = has_any(code, lines)
        return wanted

    def _on_event(self, frame: FrameType, event: str, _argument: object) -> Trace:
        if event == "line":
            lines = self._lines
            if lines is None or frame.f_lineno in lines:
                self._events.line(frame, frame.f_lineno)
        elif event == "return" and frame.f_code.co_name in self._source.rules:
            self._events.ended(frame)
        return self._on_event

    def _on_report(self, frame: FrameType, event: str, value: object) -> Trace:
        if event == "return" and frame.f_back is not None:
            self._events.report(frame.f_back, value)
        return self._on_report
