"""Checks the program after each edit, when the person pauses, and never for longer than a frame."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Generic, TypeVar

from PySide6.QtCore import QObject, QTimer, Signal

from nep_studio.blocks.checks.problem import Problem
from nep_studio.blocks.editor import Editor
from nep_studio.blocks.language import Language
from nep_studio.blocks.program import Changes, Project
from nep_studio.run.installation import all_problems

log = logging.getLogger(__name__)


# Long work in short slices on the main thread: it rests whenever its slice is over.

Result = TypeVar("Result")
Key = TypeVar("Key")
Value = TypeVar("Value")


class Cancelled(Exception):
    """The work is not wanted any more."""


class SlicedCall(Generic[Result]):
    """A call that runs in a thread of its own, but only while ``run`` is waiting for it.

    So it never runs at the same time as the main thread, and may read what that changes between
    two calls of ``run``; the caller cancels it when something has changed. The work calls
    ``rest`` often; that returns at once until the slice is over.
    """

    def __init__(self, work: Callable[[Callable[[], None]], Result]) -> None:
        self._work = work
        self._may_work, self._rests = threading.Semaphore(0), threading.Semaphore(0)
        self._end_of_slice = 0.0
        self._is_cancelled = False
        self._result: list[Result] = []
        self._error: BaseException | None = None
        self.is_over = False
        self._thread = threading.Thread(target=self._main, name="slices", daemon=True)
        self._thread.start()

    def run(self, slice_s: float) -> bool:
        """Let it work for a slice; whether it is over."""
        if not self.is_over:
            self._end_of_slice = time.perf_counter() + slice_s
            self._may_work.release()
            self._rests.acquire()
        return self.is_over

    def result(self) -> Result:
        """What the call gave, or raised."""
        if self._error is not None:
            raise self._error
        return self._result[0]

    def cancel(self) -> None:
        """End the work where it rests."""
        self._is_cancelled = True
        if not self.is_over:
            self._may_work.release()
        self._thread.join()

    def rest(self) -> None:
        """Rest when the slice is over; raises Cancelled when the work is not wanted any more."""
        if time.perf_counter() >= self._end_of_slice:
            self._rests.release()
            self._may_work.acquire()
        if self._is_cancelled:
            raise Cancelled

    def _main(self) -> None:
        self._may_work.acquire()
        try:
            if not self._is_cancelled:
                self._result.append(self._work(self.rest))
        except Cancelled:
            pass
        except BaseException as error:
            self._error = error
        self.is_over = True
        self._rests.release()


class RestingMapping(Mapping[Key, Value]):
    """A mapping in which each look-up is a place to rest."""

    def __init__(self, values: Mapping[Key, Value], rest: Callable[[], None]) -> None:
        self._values, self._rest = values, rest

    def __getitem__(self, key: Key) -> Value:
        self._rest()
        return self._values[key]

    def __iter__(self) -> Iterator[Key]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)


PAUSE_MS = 150
SLICE_S = 0.006
"""How long a check may take of one frame of the screen."""

BETWEEN_SLICES_MS = 4

Check = SlicedCall[list[Problem]]


class LiveChecks(QObject):
    """Follows one editor at a time; ``found`` gives the problems, errors first."""

    found = Signal(list)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._editor: Editor | None = None
        self._folder: Callable[[], Path] = Path.cwd
        self._check: Check | None = None
        self._pause = QTimer(self, singleShot=True, interval=PAUSE_MS)
        self._pause.timeout.connect(self.start)
        self._next = QTimer(self, singleShot=True, interval=BETWEEN_SLICES_MS)
        self._next.timeout.connect(self._on_next_slice)
        self.problems: list[Problem] = []

    def follow(self, editor: Editor | None, folder: Callable[[], Path] = Path.cwd) -> None:
        """Check another project; None checks nothing."""
        self.cancel()
        if self._editor is not None:
            self._editor.history.unlisten(self._on_changes)
        self._editor, self._folder = editor, folder
        if editor is not None:
            editor.history.listen(self._on_changes)
            self._pause.start()
        else:
            self._tell([])

    def start(self) -> None:
        """Check now."""
        self.cancel()
        if self._editor is None:
            return
        self._check = _sliced_check(self._editor.project, self._editor.language, self._folder())
        self._on_next_slice()

    def cancel(self) -> None:
        """Give up the check that is under way."""
        self._pause.stop()
        self._next.stop()
        if self._check is not None:
            self._check.cancel()
            self._check = None

    def _on_changes(self, changes: Changes) -> None:
        self.cancel()
        self._pause.start()

    def _on_next_slice(self) -> None:
        check = self._check
        if check is None:
            return
        if not check.run(SLICE_S):
            self._next.start()
            return
        self._check = None
        self._tell(check.result())

    def _tell(self, problems: list[Problem]) -> None:
        self.problems = problems
        self.found.emit(problems)


class _RestingLanguage(Language):
    """The language of one project for one check; its definitions rest."""

    __slots__ = ()

    def of(self, project: Project) -> Language:
        """This one: it was made for the project."""
        return self


def _sliced_check(project: Project, language: Language, folder: Path) -> Check:
    """All checks look up the definition of each block that they read: there they can rest."""

    def work(rest: Callable[[], None]) -> list[Problem]:
        definitions = RestingMapping(language.definitions, rest)
        resting = _RestingLanguage(
            definitions,
            language.categories,
            language.choices,
            language.profiles,
            robots=language.robots,
        )
        return all_problems(project, resting, folder)

    return SlicedCall(work)
