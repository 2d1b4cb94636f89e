"""Watches a program by sys.monitoring, which costs nothing where nothing is asked."""

from __future__ import annotations

import contextlib
import sys

if sys.version_info >= (3, 12):
    from sys import monitoring
    from types import CodeType

    from nodes.cognitive.tracing.events import (
        Events,
        Lines,
        has_any,
        is_part_of_line,
        reporting_code,
    )
    from nodes.cognitive.tracing.threads import ProgramThreads

    _E = monitoring.events
    _CALLS = _E.PY_START | _E.PY_RESUME | _E.PY_RETURN | _E.PY_YIELD
    _NAME = "nep-studio"

    class MonitoringWatch:
        """Python calls it at the calls of the program's own code, and at lines only while asked."""

        def __init__(self, file: str, threads: ProgramThreads, events: Events) -> None:
            self._file = file
            self._threads = threads
            self._events = events
            self._code: dict[int, CodeType] = {}  # by id: to compare code takes long
            self._lines: Lines = frozenset()
            self._tool = free_tool() or 0

        def begin(self) -> None:
            """Watch this thread and those that begin from now on."""
            monitoring.use_tool_id(self._tool, _NAME)
            for event, callback in (
                (_E.PY_START, self._on_start),
                (_E.PY_RESUME, self._on_start),
                (_E.PY_RETURN, self._on_return),
                (_E.PY_YIELD, self._on_return),
                (_E.PY_UNWIND, self._on_unwind),
                (_E.LINE, self._on_line),
            ):
                monitoring.register_callback(self._tool, event, callback)
            for code in reporting_code():
                monitoring.set_local_events(self._tool, code, _E.PY_RETURN)
            monitoring.set_events(self._tool, _E.PY_START | _E.PY_UNWIND)

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
            for event in (_E.PY_START, _E.PY_RESUME, _E.PY_RETURN, _E.PY_YIELD, _E.PY_UNWIND):
                monitoring.register_callback(self._tool, event, None)
            monitoring.register_callback(self._tool, _E.LINE, None)
            monitoring.free_tool_id(self._tool)

        def _watch(self, code: CodeType) -> None:
            lines = _E.LINE if has_any(code, self._lines) else 0
            with contextlib.suppress(ValueError):  # another thread has ended the watch
                monitoring.set_local_events(self._tool, code, _CALLS | lines)

        def _is_ours(self, code: CodeType) -> bool:
            return code.co_filename == self._file and not is_part_of_line(code)

        def _on_start(self, code: CodeType, _offset: int) -> object:
            if not self._is_ours(code):
                return monitoring.DISABLE
            if id(code) not in self._code:
                self._code[id(code)] = code  # before: set_lines may look in between
                self._watch(code)
            self._events.enter(sys._getframe(1))
            return None

        def _on_return(self, code: CodeType, _offset: int, value: object) -> None:
            frame = sys._getframe(1)
            if code.co_filename == self._file:
                self._events.leave(frame)
            elif frame.f_back is not None and frame.f_back.f_code.co_filename == self._file:
                self._events.report(frame.f_back, value)

        def _on_unwind(self, code: CodeType, _offset: int, _error: BaseException) -> None:
            if self._is_ours(code):
                self._events.leave(sys._getframe(1))

        def _on_line(self, _code: CodeType, line: int) -> object:
            return monitoring.DISABLE if self._events.line(sys._getframe(1), line) else None

    def free_tool() -> int | None:
        """A number that no other tool uses, such as a debugger; None where there is none."""
        for tool in (4, 3, monitoring.PROFILER_ID, monitoring.DEBUGGER_ID):
            if monitoring.get_tool(tool) is None:
                return tool
        return None
