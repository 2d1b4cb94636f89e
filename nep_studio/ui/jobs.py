"""Work in a thread of its own, whose news come to the window as calls in its own thread."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QObject, Signal

from .background import Background

log = logging.getLogger(__name__)

Tell = Callable[[object], None]
Work = Callable[[threading.Event, Tell], None]
"""Works until the event is set, and tells its news."""


class Job(QObject):
    """One thing at a time in a thread; a new one, or ``stop``, lets the old one end unheard.

    The libraries are loaded in the thread: the window must not wait for them.
    """

    ended = Signal(str)
    """The problem, in the words of the system; "" when there was none."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._background = Background(self)
        self._cancelled = threading.Event()
        self._thread: threading.Thread | None = None
        self.is_running = False
        """Whether it works."""

    def stop(self) -> None:
        """Let it end; nothing is told of it any more."""
        self._cancelled.set()
        self.is_running = False

    def _start(self, work: Work, tell: Tell) -> None:
        """Work in a thread; ``tell`` is called here for each of its news."""
        self.stop()
        cancelled = self._cancelled = threading.Event()
        self.is_running = True

        def tell_if_wanted(what: object) -> None:
            if not cancelled.is_set():
                tell(what)

        def end(problem: str) -> None:
            if not cancelled.is_set():
                self.stop()
                self.ended.emit(problem)

        def told(what: object) -> None:
            self._background.post(partial(tell_if_wanted, what))

        done = partial(_problem_of, work, cancelled, told)
        self._thread = self._background.start(done, end, name="search")


def _problem_of(work: Work, cancelled: threading.Event, tell: Tell) -> str:
    try:
        work(cancelled, tell)
    except OSError as error:
        return str(error)
    except Exception as error:  # the dialog must not wait for ever
        log.exception("work in the background")
        return str(error)
    return ""
