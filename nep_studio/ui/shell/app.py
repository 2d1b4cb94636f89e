"""The application: its look, its words, its block language, and its window."""

from __future__ import annotations

import gc
import logging
import signal
import socket
import sys
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import (
    QCoreApplication,
    QEvent,
    QObject,
    QSocketNotifier,
    Qt,
    QThread,
    QTimer,
    Signal,
)
from PySide6.QtGui import QFileOpenEvent
from PySide6.QtWidgets import QApplication

from nep_studio import __version__, settings
from nep_studio.support import safe_mode
from nep_studio.support.safe_mode import StartNote
from nep_studio.ui.services import Studio
from nep_studio.ui.theme.icons import application_icon

if TYPE_CHECKING:
    from .main_window import MainWindow

log = logging.getLogger(__name__)


# The application, which macOS asks to open files instead of naming them when it starts it.


class Application(QApplication):
    """Tells which files the system asks it to open, as after a double click in the Finder."""

    file_asked_for = Signal(str)

    def event(self, event: QEvent) -> bool:
        """Tell it; all other events go their way."""
        if isinstance(event, QFileOpenEvent):
            self.file_asked_for.emit(event.file())
            return True
        return super().event(event)


SAFE_AFTER_MS = 5000
"""A start has gone well when the whole window was there for so long."""


def make_application() -> Application:
    """The application with its name and icon."""
    app = Application(sys.argv[:1])
    app.setApplicationName("nep-studio")
    app.setApplicationDisplayName("NEP Studio")
    app.setApplicationVersion(__version__)
    app.setDesktopFileName("nep-studio")
    app.setWindowIcon(application_icon())
    return app


def main(arguments: list[str]) -> int:
    """Open the window, with a project if one is named; the exit code."""
    gc.disable()  # until the window is there: what is made before stays as long as it does
    from .crash_handler import LastResort
    from .main_window import MainWindow

    app = make_application()
    with LastResort(settings.log_file()) as last_resort, StopSignals() as stop_signals:
        note = StartNote(settings.user_folder())
        app.commitDataRequest.connect(note.succeeded)  # the session ends: that is no crash
        safe_mode.keep_crashes(settings.user_folder())
        if note.last_failed and not safe_mode.is_on() and not _may_start():
            note.succeeded()  # the person has closed it
            return 0
        window = MainWindow(Studio(app), is_gradual=True)
        last_resort.watch(window)
        stop_signals.came.connect(lambda: _end_at_once(window))
        once = Qt.ConnectionType.SingleShotConnection
        window.lazy.completed.connect(_collect_from_now_on, once)
        window.lazy.completed.connect(lambda: _begin_later(window, note), once)
        window.show()
        window.start(Path(arguments[0]) if arguments else None)
        app.file_asked_for.connect(lambda file: window.files.open(Path(file)))
        code = app.exec()
        note.succeeded()
        window.deleteLater()
    return code


def _end_at_once(window: MainWindow) -> None:
    """End without a question; work that is not saved is offered at the next start."""
    if (document := window.files.document) is not None:
        document.close(keep=document.is_modified)
    window.close_now()


def _may_start() -> bool:
    """Ask what is to be done after a start that failed; False to end."""
    from .support import ask

    return ask()


def _begin_later(window: MainWindow, note: StartNote) -> None:
    """What can wait until all of the window is there."""
    from .support import tell_how_it_runs

    QTimer.singleShot(SAFE_AFTER_MS, window, note.succeeded)
    tell_how_it_runs(window)


def _collect_from_now_on() -> None:
    """Collect garbage, but never look through what stays: that would hold the window up."""
    gc.freeze()
    gc.enable()
    _give_back()


def _give_back() -> None:
    """Give the system the memory that only the start has needed: glibc would keep it."""
    if sys.platform != "linux":
        return
    import ctypes

    with suppress(OSError, AttributeError):  # other C libraries have no such function
        ctypes.CDLL(None).malloc_trim(0)


# Lets a signal of the system, as at the end of a session, close the program in an orderly way.

NAMES = ("SIGTERM", "SIGINT", "SIGHUP", "SIGBREAK")
BY_A_SIGNAL = 128
"""By the shells' custom the exit code is this and the signal's number."""
LOOK_MS = 50


class StopSignals(QObject):
    """While it is entered, such a signal ends the event loop; one at the start, as it begins.

    Qt sleeps without Python, which answers signals: a byte on a socket wakes both.
    """

    came = Signal()

    def __init__(self) -> None:
        super().__init__()
        self._before: dict[int, Any] = {}
        self._code = 0
        self._ending = QTimer(self, interval=LOOK_MS)
        self._ending.timeout.connect(self._end)
        self._reading, self._writing = socket.socketpair()
        for end in (self._reading, self._writing):
            end.setblocking(False)
        kind = QSocketNotifier.Type.Read
        self._notifier = QSocketNotifier(self._reading.fileno(), kind, self)
        self._notifier.activated.connect(self._on_woken)

    def __enter__(self) -> StopSignals:
        signal.set_wakeup_fd(self._writing.fileno(), warn_on_full_buffer=False)
        for number in (getattr(signal, name) for name in NAMES if hasattr(signal, name)):
            if signal.getsignal(number) is not signal.SIG_IGN:  # as nohup wants it
                self._before[number] = signal.signal(number, self._on_signal)
        return self

    def __exit__(
        self,
        _kind: type[BaseException] | None,
        _error: BaseException | None,
        _trace: TracebackType | None,
    ) -> None:
        for number, answer in self._before.items():
            signal.signal(number, answer or signal.SIG_DFL)
        signal.set_wakeup_fd(-1)
        self._notifier.setEnabled(False)
        self._reading.close()
        self._writing.close()

    def _on_woken(self) -> None:
        self._reading.recv(1024)

    def _on_signal(self, number: int, _frame: object) -> None:
        self._code = BY_A_SIGNAL + number
        self._ending.start()

    def _end(self) -> None:
        if QThread.currentThread().loopLevel() == 0:  # only a look at events during the start
            return
        self._ending.stop()
        self.came.emit()
        QCoreApplication.exit(self._code)
