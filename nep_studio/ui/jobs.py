"""Work in a thread of its own, whose news come to the window as calls in its own thread."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from queue import SimpleQueue
from typing import NamedTuple

from PySide6.QtCore import QObject, QTimer, Signal

log = logging.getLogger(__name__)

LOOK_MS = 30
"""How often the window looks for news."""


class _Ended(NamedTuple):
    problem: str


News = SimpleQueue[object]
Work = Callable[[threading.Event, News], None]
Tell = Callable[[object], None]


def _tell_nobody(what: object) -> None:
    """Nothing has begun yet."""


class Job(QObject):
    """One thing at a time in a thread; a new one, or ``stop``, lets the old one end unheard.

    The libraries are loaded in the thread: the window must not wait for them. The thread puts its
    news where the window takes them; it never touches the dialog, which may be gone by then.
    """

    ended = Signal(str)
    """The problem, in the words of the system; "" when there was none."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._cancelled = threading.Event()
        self._news: News = SimpleQueue()
        self._tell_news: Tell = _tell_nobody
        self._thread: threading.Thread | None = None
        self._next_look = QTimer(self, interval=LOOK_MS)
        self._next_look.timeout.connect(self._take_news)

    @property
    def is_running(self) -> bool:
        """Whether it works."""
        return self._next_look.isActive()

    def stop(self) -> None:
        """Let it end; nothing is told of it any more."""
        self._cancelled.set()
        self._news = SimpleQueue()
        self._next_look.stop()

    def _start(self, work: Work, tell: Tell) -> None:
        """Work in a thread; ``tell`` is called here for each of its news."""
        self.stop()
        self._tell_news = tell
        self._cancelled = threading.Event()
        told = (work, self._cancelled, self._news)
        self._thread = threading.Thread(target=_work, args=told, daemon=True)
        self._thread.start()
        self._next_look.start()

    def _take_news(self) -> None:
        news = self._news
        while news is self._news and not news.empty():
            what = news.get()
            if isinstance(what, _Ended):
                self.stop()
                self.ended.emit(what.problem)
            else:
                self._tell_news(what)


def _work(work: Work, cancelled: threading.Event, news: News) -> None:
    problem = ""
    try:
        work(cancelled, news)
    except OSError as error:
        problem = str(error)
    except Exception as error:  # the dialog must not wait for ever
        log.exception("looking for robots")
        problem = str(error)
    news.put(_Ended(problem))
