"""Looks for robots and tests the way to one, in threads of their own, with news as signals."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence

from PySide6.QtCore import QObject, Signal

log = logging.getLogger(__name__)


class _Job(QObject):
    """One thing at a time in a thread; a new one, or ``stop``, lets the old one end unheard.

    The libraries are loaded in the thread: the window must not wait for them.
    """

    ended = Signal(str)
    """The problem, in the words of the system; "" when there was none."""
    _came = Signal(object, object)
    """News of the thread: whether they are not wanted any more, and what tells them."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._cancelled = threading.Event()
        self._thread: threading.Thread | None = None
        self._came.connect(self._on_came)

    @property
    def is_running(self) -> bool:
        """Whether it works."""
        return self._thread is not None and self._thread.is_alive()

    def stop(self) -> None:
        """Let it end; nothing is told of it any more."""
        self._cancelled.set()
        self._thread = None

    def _start(self, work: Callable[[threading.Event], None]) -> None:
        self.stop()
        self._cancelled = cancelled = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(work, cancelled), daemon=True)
        self._thread.start()

    def _run(self, work: Callable[[threading.Event], None], cancelled: threading.Event) -> None:
        problem = ""
        try:
            work(cancelled)
        except OSError as error:
            problem = str(error)
        except Exception as error:  # the dialog must not wait for ever
            log.exception("looking for robots")
            problem = str(error)
        self._tell(cancelled, lambda: self.ended.emit(problem))

    def _tell(self, cancelled: threading.Event, tell: Callable[[], None]) -> None:
        try:
            self._came.emit(cancelled, tell)
        except RuntimeError:  # the dialog is gone
            return

    def _on_came(self, cancelled: threading.Event, tell: Callable[[], None]) -> None:
        """Tell news in the window's thread, unless they were given up on their way."""
        if not cancelled.is_set():
            tell()


class RobotSearch(_Job):
    """Robots that announce themselves in the network."""

    found = Signal(str, str)
    """The name and the address of a robot."""

    def start(self, seconds: float, interfaces: Sequence[str] = ()) -> None:
        """Listen for some seconds; ``interfaces`` as in ``find_robots``."""

        def work(cancelled: threading.Event) -> None:
            from nodes.action.naoqi.discovery import FoundRobot, find_robots

            def tell(robot: FoundRobot) -> None:
                self._tell(cancelled, lambda: self.found.emit(robot.name, robot.address))

            find_robots(tell, cancelled, seconds=seconds, interfaces=interfaces)

        self._start(work)


class RobotTest(_Job):
    """The steps on the way to a robot."""

    checked = Signal(object)
    """The Check of a step."""

    def start(self, address: str, user: str, password: str, robot: str) -> None:
        """Try every step; the login is used when there is a password."""

        def work(cancelled: threading.Event) -> None:
            from nodes.action.naoqi.client import Login
            from nodes.action.naoqi.probe import Check, probe

            def tell(check: Check) -> None:
                self._tell(cancelled, lambda: self.checked.emit(check))

            login = Login(user, password) if password else None
            for check in probe(address, login, robot):
                if cancelled.is_set():
                    return
                tell(check)

        self._start(work)
