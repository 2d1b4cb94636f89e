"""Work in the background whose results come back to the thread of Qt."""

from __future__ import annotations

import contextlib
import logging
import threading
from collections.abc import Callable
from functools import cache, partial
from typing import TypeVar

from PySide6.QtCore import QCoreApplication, QObject, Qt, Signal

Result = TypeVar("Result")


class Background(QObject):
    """Does what takes a while in threads of their own; what comes of it is told in this one's.

    Nothing is told any more once its parent has gone.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._post = _post()
        self._gone = threading.Event()
        self.destroyed.connect(self._gone.set)

    def post(self, do: Callable[[], object]) -> None:
        """Do this in the thread of Qt, soon and in order; from any thread."""
        with contextlib.suppress(RuntimeError):  # the program ends
            self._post.asked.emit(do, self._gone)

    def start(
        self, work: Callable[[], Result], then: Callable[[Result], object], *, name: str
    ) -> threading.Thread:
        """Do ``work`` beside everything else, and ``then`` tell what it gave."""

        def run() -> None:
            result = work()
            self.post(lambda: then(result))

        thread = threading.Thread(target=run, name=f"nep-studio-{name}", daemon=True)
        thread.start()
        return thread


class _Post(QObject):
    """Lives as long as the program: a thread may use it while a dialog is being thrown away."""

    asked = Signal(object, object)

    def __init__(self) -> None:
        super().__init__(QCoreApplication.instance())
        self.asked.connect(self._on_asked, Qt.ConnectionType.QueuedConnection)

    def _on_asked(self, do: Callable[[], None], gone: threading.Event) -> None:
        if not gone.is_set():
            do()


@cache
def _post() -> _Post:
    """Made by the first who asks, in the thread of Qt."""
    return _Post()


# Work in a thread of its own, whose news come to the window as calls in its own thread.

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
