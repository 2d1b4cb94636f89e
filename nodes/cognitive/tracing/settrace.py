"""Watches a program by sys.settrace, for Pythons without sys.monitoring."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from types import CodeType, FrameType
from typing import Any

from nodes.cognitive.tracing.events import (
    Events,
    Lines,
    has_any,
    is_part_of_line,
    reporting_code,
    reporting_files,
)
from nodes.cognitive.tracing.threads import ProgramThreads

Trace = Callable[[FrameType, str, Any], Any]


class SettraceWatch:
    """Python calls it at every call in the program's threads, and at lines only while asked."""

    def __init__(self, file: str, threads: ProgramThreads, events: Events) -> None:
        self._file = file
        self._threads = threads
        self._events = events
        self._lines: Lines = frozenset()
        self._has_lines: dict[int, bool] = {}  # by id of code, for the lines that are wanted now
        self._api_files, self._api = reporting_files(), reporting_code()

    def begin(self) -> None:
        """Watch this thread and those that begin from now on."""
        threading.settrace(self._on_call)
        sys.settrace(self._on_call)

    def set_lines(self, lines: Lines) -> None:
        """Tell of these lines from now on; the functions of the others cost less."""
        if lines != self._lines:
            self._lines, self._has_lines = lines, {}
        for frame in self._threads.frames():
            frame.f_trace_lines = has_any(frame.f_code, lines)

    def refresh(self) -> None:
        """Tell again of every line: here no line is left out."""

    def end(self) -> None:
        """Watch no more; threads that still run are watched to their end."""
        sys.settrace(None)
        threading.settrace(None)

    def _on_call(self, frame: FrameType, _event: str, _argument: object) -> Trace | None:
        code = frame.f_code
        if code.co_filename == self._file:
            if is_part_of_line(code):
                return None
            self._events.enter(frame)
            frame.f_trace_lines = self._wants(code)  # after enter: set_lines may look in between
            return self._on_event
        if code.co_filename in self._api_files and code in self._api:
            caller = frame.f_back
            if caller is not None and caller.f_code.co_filename == self._file:
                frame.f_trace_lines = False
                return self._on_report
        return None

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
        elif event == "return":
            self._events.leave(frame)
        return self._on_event

    def _on_report(self, frame: FrameType, event: str, value: object) -> Trace:
        if event == "return" and frame.f_back is not None:
            self._events.report(frame.f_back, value)
        return self._on_report
