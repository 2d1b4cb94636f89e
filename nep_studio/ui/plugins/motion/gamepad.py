"""A gamepad, read without a library: the joystick files of Linux, XInput of Windows.

Qt has no gamepads any more, and a games library is larger than this program. On a Mac there is no
such simple way: there a gamepad is not offered.
"""

from __future__ import annotations

import ctypes
import os
import struct
import sys
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from .drive import STILL, Drive

READ_MS = 20
DEAD_PART = 0.15
"""A stick that is let go is never quite in its middle."""
AXIS, BUTTON, INITIAL = 0x02, 0x01, 0x80
EVENT = struct.Struct("IhBB")
MOST_EVENTS = 200
FULL = 32767.0


class Sticks:
    """Where the sticks are (-1 to 1; right and down are above 0), and which buttons are pressed."""

    def __init__(self) -> None:
        self.axes = [0.0] * 8
        self.pressed: set[int] = set()

    def take(self, data: bytes) -> None:
        """Take in what a joystick file of Linux says: events of 8 bytes."""
        for _, value, kind, number in EVENT.iter_unpack(data[: len(data) // 8 * 8]):
            kind &= ~INITIAL
            if kind == AXIS and number < len(self.axes):
                self.axes[number] = max(-1.0, value / FULL)
            elif kind == BUTTON and value:
                self.pressed.add(number)
            elif kind == BUTTON:
                self.pressed.discard(number)

    def drive(self) -> Drive:
        """Left stick: forward and turning; right stick: the head; shoulder buttons: sideways."""
        if not any(map(_felt, self.axes[:5])) and not self.pressed & {4, 5}:
            return STILL
        aside = float(4 in self.pressed) - float(5 in self.pressed)
        x, y, _, head_x, head_y = (_felt(axis) for axis in self.axes[:5])
        return Drive(-y, aside, -x, -head_x, -head_y)

    @property
    def wants_stop(self) -> bool:
        """Whether the button is pressed that stops all: B, or the circle."""
        return 1 in self.pressed


class Gamepad(QObject):
    """The first gamepad there is. ``changed`` gives its Drive, ``stopped`` that all is to stop."""

    changed = Signal(object)
    stopped = Signal()
    lost = Signal()

    def __init__(self, parent: QObject | None = None, folder: Path = Path("/dev/input")) -> None:
        super().__init__(parent)
        self._folder = folder
        self._file = -1
        self._pad: _WindowsPad | None = None
        self._last = STILL
        self._did_stop = False
        self.sticks = Sticks()
        self._timer = QTimer(self, interval=READ_MS)
        self._timer.timeout.connect(self._on_time)

    @property
    def is_open(self) -> bool:
        """Whether one is read."""
        return self._timer.isActive()

    def open(self) -> bool:
        """Begin to read the first one; whether there is one."""
        self.close()
        self.sticks, self._last, self._did_stop = Sticks(), STILL, False
        if sys.platform == "win32":
            self._pad = _windows_pad()
        else:
            self._file = _first_file(self._folder)
        if self._pad is not None or self._file >= 0:
            self._timer.start()
        return self.is_open

    def close(self) -> None:
        """Read no more."""
        self._timer.stop()
        self._pad = None
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _on_time(self) -> None:
        try:
            is_there = self._read()
        except OSError:
            is_there = False
        if not is_there:
            self.close()
            self.changed.emit(STILL)
            self.lost.emit()
            return
        if self.sticks.wants_stop and not self._did_stop:
            self.stopped.emit()
        self._did_stop = self.sticks.wants_stop
        if (drive := self.sticks.drive()) != self._last:
            self._last = drive
            self.changed.emit(drive)

    def _read(self) -> bool:
        if self._pad is not None:
            return self._pad.read(self.sticks)
        try:
            data = os.read(self._file, EVENT.size * MOST_EVENTS)
        except BlockingIOError:
            return True
        self.sticks.take(data)
        return bool(data)


class _State(ctypes.Structure):
    """XINPUT_STATE: https://learn.microsoft.com/windows/win32/api/xinput/ns-xinput-xinput_state."""

    _fields_ = [
        ("packet", ctypes.c_uint32),
        ("buttons", ctypes.c_uint16),
        ("left_trigger", ctypes.c_uint8),
        ("right_trigger", ctypes.c_uint8),
        ("left_x", ctypes.c_int16),
        ("left_y", ctypes.c_int16),
        ("right_x", ctypes.c_int16),
        ("right_y", ctypes.c_int16),
    ]


LEFT_SHOULDER, RIGHT_SHOULDER, BUTTON_B = 0x0100, 0x0200, 0x2000


class _WindowsPad:
    """One gamepad of XInput."""

    def __init__(self, library: ctypes.CDLL, number: int) -> None:
        self._library, self._number = library, number

    def read(self, sticks: Sticks) -> bool:
        """Read it; False when it is gone."""
        state = _State()
        if self._library.XInputGetState(self._number, ctypes.byref(state)) != 0:
            return False
        sticks.axes[0], sticks.axes[1] = state.left_x / FULL, -state.left_y / FULL
        sticks.axes[3], sticks.axes[4] = state.right_x / FULL, -state.right_y / FULL
        masks = {4: LEFT_SHOULDER, 5: RIGHT_SHOULDER, 1: BUTTON_B}
        sticks.pressed = {button for button, mask in masks.items() if state.buttons & mask}
        return True


def _windows_pad() -> _WindowsPad | None:
    try:
        library = ctypes.CDLL("xinput1_4.dll")
    except OSError:
        return None
    found = (_WindowsPad(library, number) for number in range(4))
    return next((pad for pad in found if pad.read(Sticks())), None)


def _first_file(folder: Path) -> int:
    for path in sorted(folder.glob("js*")):
        try:
            return os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        except OSError:
            continue
    return -1


def _felt(axis: float) -> float:
    """A stick's way without what its middle is off."""
    if abs(axis) < DEAD_PART:
        return 0.0
    sign = 1.0 if axis > 0 else -1.0
    return sign * min(1.0, (abs(axis) - DEAD_PART) / (1.0 - DEAD_PART))
