"""Lets a signal of the system, as at the end of a session, close the program in an orderly way."""

from __future__ import annotations

import signal
import socket
from types import TracebackType
from typing import Any

from PySide6.QtCore import QCoreApplication, QObject, QSocketNotifier, QThread, QTimer, Signal

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
