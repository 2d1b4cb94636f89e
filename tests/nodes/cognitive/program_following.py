"""Runs a program under a tracer in this process, and hears what is told of it."""

from __future__ import annotations

import runpy
import threading
from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from typing import Any

from nep_core.program.tasks import PROGRAM, Cancelled
from nep_core.wire.messages import ProgramControl, ProgramState
from nodes.cognitive.tracing.tracer import Tracer, WatchMaker

WAIT_S = 20.0
Wanted = Callable[[ProgramState], bool]


class Heard:
    """The states that have been told, in their order; each is waited for only once."""

    def __init__(self) -> None:
        self.states: list[ProgramState] = []
        self._next = 0
        self._came = threading.Condition()

    def __call__(self, state: ProgramState) -> None:
        with self._came:
            self.states.append(state)
            self._came.notify_all()

    def until(self, wanted: Wanted) -> ProgramState:
        with self._came:
            assert self._came.wait_for(lambda: self._found(wanted), WAIT_S), self.states[-9:]
            return self.states[self._next - 1]

    def paused(self, thread: str = "") -> tuple[int, str]:
        """The line of the next pause, of this thread or of any, and why it is."""
        state = self.until(lambda s: s.event == "paused" and thread in s.thread)
        return state.line, state.description

    def lines(self, wanted: Callable[[dict[str, list[int]]], bool]) -> dict[str, list[int]]:
        return self.until(lambda s: s.event == "line" and wanted(s.lines)).lines

    def value(self, name: str, told: str) -> None:
        self.until(lambda s: s.values.get(name) == told)

    def _found(self, wanted: Wanted) -> bool:
        for number in range(self._next, len(self.states)):
            if wanted(self.states[number]):
                self._next = number + 1
                return True
        return False


class Followed:
    """A program that runs in a thread of its own, "program", and is traced."""

    def __init__(self, file: Path, source: str, make_watch: WatchMaker) -> None:
        file.write_text(dedent(source).lstrip(), encoding="utf-8")
        self.heard = Heard()
        self.error: BaseException | None = None
        self.tracer = Tracer("program", str(file), self.heard, make_watch)
        self._file = file
        self._thread = threading.Thread(target=self._run, name="program")

    def start(self) -> Heard:
        self._thread.start()
        return self.heard

    def order(self, command: Any, **settings: Any) -> None:
        self.tracer.obey(ProgramControl(command=command, **settings))

    def join(self) -> None:
        self._thread.join(WAIT_S)
        assert not self._thread.is_alive()

    def stop(self) -> None:
        PROGRAM.cancel()
        self.tracer.wake()
        if self._thread.ident is not None:
            self.join()

    def _run(self) -> None:
        self.tracer.begin()
        try:
            runpy.run_path(str(self._file), run_name="__main__")
        except Cancelled:
            self.error = None
        except BaseException as error:
            self.error = error
        finally:
            self.tracer.end()
