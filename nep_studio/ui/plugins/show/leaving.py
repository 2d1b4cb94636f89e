"""How show mode is left: by holding Esc, or the corner, and with the PIN if there is one."""

from __future__ import annotations

import contextlib
import ctypes
import logging
import os
import subprocess
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QElapsedTimer, QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QTouchEvent, QWindow
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QWidget,
)

from nep_studio.ui.messages import announce
from nep_studio.ui.widgets.forms import styled
from nep_studio.ui.widgets.layouts import in_column, in_row
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from PySide6.QtDBus import QDBusPendingCallWatcher

log = logging.getLogger(__name__)


HOLD_MS = 2000
STEP_MS = 50
LONGEST_STEP_MS = 4 * STEP_MS
"""On a slow computer steps come late, and count as longer; a window that hung counts no more."""
GAP_MS = 100
"""Remote desktops send a held key as presses and releases in turn, at most so long apart."""
TOLD_MS = 5000
"""How long a show says at its beginning how it is left."""
RESTS_MS = 4000
"""After so long without the pointer what belongs to it goes."""
PIN_STAYS_MS = 30_000
"""After so long without a key the question for the PIN goes: a visitor may have found it."""


class Holding(QObject):
    """Watches whether Esc, or a widget, is held long enough; ``progress`` goes from 0 to 1."""

    progress = Signal(float)
    held = Signal()

    def __init__(self, keys_of: QWidget, handle: QWidget) -> None:
        super().__init__(keys_of)
        self._handle = handle
        self._elapsed_ms = 0
        self._since_step = QElapsedTimer()
        self._timer = QTimer(self, interval=STEP_MS)
        self._timer.timeout.connect(self._on_step)
        self._letting_go = QTimer(self, singleShot=True, interval=GAP_MS)
        self._letting_go.timeout.connect(self._end)
        keys_of.installEventFilter(self)
        handle.installEventFilter(self)

    @property
    def is_held(self) -> bool:
        """Whether somebody holds it now."""
        return self._timer.isActive()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Begin when it is pressed, end when it is let go."""
        kind = event.type()
        if isinstance(event, QKeyEvent) and event.key() == Qt.Key.Key_Escape:
            if kind == QEvent.Type.KeyPress:
                self._begin()
            elif kind == QEvent.Type.KeyRelease and self.is_held and not event.isAutoRepeat():
                self._letting_go.start()  # perhaps it is the next pair of a key that is held
            return True
        if watched is self._handle and isinstance(event, QMouseEvent):
            if kind in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick):
                self._begin()
            elif kind == QEvent.Type.MouseButtonRelease:
                self._end()
        elif kind in (QEvent.Type.WindowDeactivate, QEvent.Type.FocusOut):
            self._end()
        return False

    def _begin(self) -> None:
        self._letting_go.stop()
        if not self.is_held:
            self._elapsed_ms = 0
            self._since_step.start()
            self._timer.start()

    def _end(self) -> None:
        self._letting_go.stop()
        self._timer.stop()
        self.progress.emit(0.0)

    def _on_step(self) -> None:
        self._elapsed_ms += min(self._since_step.restart(), LONGEST_STEP_MS)
        self.progress.emit(min(1.0, self._elapsed_ms / HOLD_MS))
        if self._elapsed_ms >= HOLD_MS:
            self._end()
            self.held.emit()


class HoldBar(QFrame):
    """Says how the show is left: at its beginning, after a click, and while somebody holds."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._over = parent
        self.bar = QProgressBar(textVisible=False)
        self.words = QLabel(wordWrap=True, alignment=Qt.AlignmentFlag.AlignCenter)
        in_column(self.words, self.bar, of=styled(self, kind="card"))
        self._going = QTimer(self, singleShot=True)
        self._going.timeout.connect(self.hide)
        self.hide()

    def say_how(self) -> None:
        """Say for a while what is to be done to leave."""
        self.bar.hide()
        words = tr("To leave the show, hold Esc or the cross in the corner for two seconds.")
        self._show(words)
        self._going.start(TOLD_MS)
        announce(self, words)

    def show_progress(self, progress: float) -> None:
        """Show how far it is; nothing for a short touch."""
        self.bar.setValue(round(100 * progress))
        if progress > 0.1:
            self._going.stop()
            self.bar.show()
            self._show(tr("Keep holding to leave the show"))
        elif not self._going.isActive():
            self.hide()

    def fit(self, pixels: int) -> None:
        """Be as large as the screen is, with words of this height, below what is in its corners."""
        self.words.setStyleSheet(f"font-size: {pixels}px;")
        parent = self._over
        self.setFixedWidth(min(parent.width(), pixels * 26))
        self.adjustSize()
        self.move((parent.width() - self.width()) // 2, round(parent.height() * 0.15))

    def _show(self, words: str) -> None:
        self.words.setText(words)
        self.adjustSize()
        self.show()
        self.raise_()


class Pointing(QObject):
    """Tells when somebody moves the mouse or touches the screen, and when nobody did for a while.

    The window of the system hears of it wherever in the window that is.
    """

    changed = Signal(bool)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._resting = QTimer(self, singleShot=True, interval=RESTS_MS)
        self._resting.timeout.connect(lambda: self.changed.emit(False))

    @property
    def is_there(self) -> bool:
        """Whether somebody did lately."""
        return self._resting.isActive()

    def follow(self, window: QWindow | None) -> None:
        """Listen to the window."""
        if window is not None:
            window.installEventFilter(self)

    def seen(self) -> None:
        """Somebody is there."""
        was_there = self.is_there
        self._resting.start()
        if not was_there:
            self.changed.emit(True)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Hear of it, and take nothing."""
        if isinstance(event, QMouseEvent | QTouchEvent):
            self.seen()
        return False


class PinQuestion(QFrame):
    """Asks for the PIN, also where there is no keyboard; goes by itself after a while."""

    right = Signal()

    def __init__(self, is_pin: Callable[[str], bool], parent: QWidget) -> None:
        super().__init__(parent)
        self._over = parent
        self._is_pin = is_pin
        self.line = QLineEdit(echoMode=QLineEdit.EchoMode.Password)
        self.line.setAccessibleName(tr("PIN"))
        self.words = QLabel(tr("The PIN to leave the show"))
        self.leave_button = styled(QPushButton(tr("Leave")), kind="primary")
        self.back_button = QPushButton(tr("Back to the show"))
        self._going = QTimer(self, singleShot=True, interval=PIN_STAYS_MS)
        self._going.timeout.connect(self.hide)
        digits = QWidget()
        digits.setLayoutDirection(Qt.LayoutDirection.LeftToRight)  # as on every telephone
        grid = QGridLayout(digits)
        grid.setContentsMargins(0, 0, 0, 0)
        for number, digit in enumerate("123456789⌫0"):
            button = QPushButton(digit)
            button.setMinimumHeight(self.fontMetrics().height() * 3)
            button.setAccessibleName(tr("Delete") if digit == "⌫" else digit)
            button.clicked.connect(lambda _=False, digit=digit: self._on_digit(digit))
            grid.addWidget(button, number // 3, number % 3)
        foot = in_row(self.back_button, self.leave_button)
        in_column(self.words, self.line, digits, foot, of=styled(self, kind="card"))
        self.line.returnPressed.connect(self._on_given)
        self.line.textEdited.connect(lambda: self._going.start())
        self.leave_button.clicked.connect(self._on_given)
        self.back_button.clicked.connect(self.hide)
        self.hide()

    def ask(self) -> None:
        """Show it in the middle."""
        self.line.clear()
        self.words.setText(tr("The PIN to leave the show"))
        parent = self._over
        self.adjustSize()
        self.move((parent.width() - self.width()) // 2, (parent.height() - self.height()) // 2)
        self.show()
        self.raise_()
        self.line.setFocus()
        self._going.start()

    def _on_digit(self, digit: str) -> None:
        self._going.start()
        if digit == "⌫":
            self.line.backspace()
        else:
            self.line.insert(digit)

    def _on_given(self) -> None:
        if self._is_pin(self.line.text()):
            self.hide()
            self.right.emit()
            return
        self.line.clear()
        self.words.setText(tr("This is not the PIN. Try again."))
        announce(self, self.words.text())


# Keeps the screen from going blank during a show, where the system lets a program do that.

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
        from PySide6.QtDBus import QDBusConnection, QDBusMessage, QDBusPendingCallWatcher

        bus = QDBusConnection.connectToBus(QDBusConnection.BusType.SessionBus, _CONNECTION)
        if not bus.isConnected():
            QDBusConnection.disconnectFromBus(_CONNECTION)
            log.info("The desktop cannot be asked to keep the screen on.")
            return
        self._is_asked = True
        call = QDBusMessage.createMethodCall(_SERVICE, _PATH, _SERVICE, "Inhibit")
        call.setArguments(["NEP Studio", "A show is on"])
        self._watcher = QDBusPendingCallWatcher(bus.asyncCall(call))
        self._watcher.finished.connect(self._on_answered)

    def _on_answered(self, watcher: QDBusPendingCallWatcher) -> None:
        from PySide6.QtDBus import QDBusMessage

        answer = watcher.reply()
        if answer.type() != QDBusMessage.MessageType.ReplyMessage:
            log.info("The desktop does not keep the screen on: %s", answer.errorMessage())


def _tell_windows(flags: int) -> None:
    kernel = getattr(ctypes, "windll", None)
    if kernel is not None:
        kernel.kernel32.SetThreadExecutionState(flags)
