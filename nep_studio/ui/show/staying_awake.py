"""Keeps the screen from going blank during a show, where the system lets a program do that."""

from __future__ import annotations

import contextlib
import ctypes
import logging
import os
import subprocess
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # only the Linux desktop is asked in this way, and only during a show
    from PySide6.QtDBus import QDBusMessage, QDBusPendingCallWatcher

log = logging.getLogger(__name__)

_SERVICE = "org.freedesktop.ScreenSaver"
_PATH = "/org/freedesktop/ScreenSaver"
_CONNECTION = "nep-studio-show"
_CONTINUOUS, _SYSTEM, _DISPLAY = 0x80000000, 0x00000001, 0x00000002
"""Flags of SetThreadExecutionState of Windows."""


class StayingAwake:
    """The screen stays on between ``begin`` and ``end``; nothing waits, nothing fails."""

    def __init__(self, system: str = sys.platform) -> None:
        self._system = system
        self._is_on = False
        self._process: subprocess.Popen[bytes] | None = None
        self._is_asked = False
        self._watcher: QDBusPendingCallWatcher | None = None

    def begin(self) -> None:
        """Keep the screen on."""
        if self._is_on:
            return
        self._is_on = True
        if self._system == "win32":
            _tell_windows(_CONTINUOUS | _SYSTEM | _DISPLAY)
        elif self._system == "darwin":
            with contextlib.suppress(OSError):
                self._process = subprocess.Popen(["caffeinate", "-d", "-w", str(os.getpid())])
        else:
            self._ask_the_desktop()

    def end(self) -> None:
        """Let the screen go blank as it usually does."""
        if not self._is_on:
            return
        self._is_on = False
        if self._system == "win32":
            _tell_windows(_CONTINUOUS)
        elif self._process is not None:
            self._process.terminate()
            self._process.wait()
            self._process = None
        elif self._is_asked:
            from PySide6.QtDBus import QDBusConnection

            QDBusConnection.disconnectFromBus(_CONNECTION)
            self._is_asked = False

    def _ask_the_desktop(self) -> None:
        """Ask over a connection of its own: the desktop forgets what it was asked when it ends.

        To take it back by its number would need an unsigned one, which Python cannot send.
        """
        from PySide6.QtDBus import QDBusConnection, QDBusPendingCallWatcher

        bus = QDBusConnection.connectToBus(QDBusConnection.BusType.SessionBus, _CONNECTION)
        if not bus.isConnected():
            QDBusConnection.disconnectFromBus(_CONNECTION)
            log.info("The desktop cannot be asked to keep the screen on.")
            return
        self._is_asked = True
        call = _call("Inhibit", "NEP Studio", "A show is on")
        self._watcher = QDBusPendingCallWatcher(bus.asyncCall(call))
        self._watcher.finished.connect(self._on_answered)

    def _on_answered(self, watcher: QDBusPendingCallWatcher) -> None:
        from PySide6.QtDBus import QDBusMessage

        answer = watcher.reply()
        if answer.type() != QDBusMessage.MessageType.ReplyMessage:
            log.info("The desktop does not keep the screen on: %s", answer.errorMessage())


def _call(method: str, *arguments: object) -> QDBusMessage:
    from PySide6.QtDBus import QDBusMessage

    call = QDBusMessage.createMethodCall(_SERVICE, _PATH, _SERVICE, method)
    call.setArguments(list(arguments))
    return call


def _tell_windows(flags: int) -> None:
    kernel = getattr(ctypes, "windll", None)
    if kernel is not None:
        kernel.kernel32.SetThreadExecutionState(flags)
