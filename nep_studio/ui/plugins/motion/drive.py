"""What a person wants a robot to do at this moment, said by keys, a watch or a gamepad."""

from __future__ import annotations

import ctypes
import math
import os
import struct
import sys
import time
import uuid
from collections.abc import Callable, Iterable
from dataclasses import astuple, dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from nep_core.wire import messages as m
from nep_core.wire.messages import Imu

if TYPE_CHECKING:
    from nep_studio.ui.running.runner import Runner


@dataclass(frozen=True)
class Drive:
    """Parts (-1 to 1) of the highest speeds: forward, left, turning left; head left, head up."""

    forward: float = 0.0
    left: float = 0.0
    turn: float = 0.0
    head_left: float = 0.0
    head_up: float = 0.0

    @property
    def walk(self) -> tuple[float, float, float]:
        """The part of the legs, in steps of a tenth: less is not felt."""
        return (round(self.forward, 1), round(self.left, 1), round(self.turn, 1))

    def slowed(self, part: float) -> Drive:
        """The same with slower legs."""
        forward, left, turn = self.forward * part, self.left * part, self.turn * part
        return replace(self, forward=forward, left=left, turn=turn)


STILL = Drive()
Key = Qt.Key
KEYS: dict[int, Drive] = {
    int(Key.Key_Up): Drive(forward=1.0),
    int(Key.Key_Down): Drive(forward=-1.0),
    int(Key.Key_Left): Drive(turn=1.0),
    int(Key.Key_Right): Drive(turn=-1.0),
    int(Key.Key_Q): Drive(left=1.0),
    int(Key.Key_E): Drive(left=-1.0),
    int(Key.Key_W): Drive(head_up=1.0),
    int(Key.Key_S): Drive(head_up=-1.0),
    int(Key.Key_A): Drive(head_left=1.0),
    int(Key.Key_D): Drive(head_left=-1.0),
}
"""What each key does while it is held."""


def sum_of(drives: Iterable[Drive]) -> Drive:
    """What several keys or devices want together; none goes beyond the highest speed."""
    parts = zip(*map(astuple, drives), strict=True)
    return Drive(*(max(-1.0, min(1.0, sum(part))) for part in parts))


# Asks a robot to do what its pilot wants; it stops when it is not asked any more.

TICK_MS = 60
ASK_AGAIN_MS = 300
UNLESS_ASKED_S = 1.0
"""So long a robot walks on when nothing is heard of its pilot any more."""
HEAD_RAD_S = 1.2
HEAD_SPEED = 0.3
FARTHEST_YAW, LOWEST_PITCH, HIGHEST_PITCH = 1.6, 0.5, -0.65


class Pilot(QObject):
    """Drives one robot at a time. ``sent`` gives each request, for those who show them."""

    sent = Signal(object)

    def __init__(self, runner: Runner, parent: QObject) -> None:
        super().__init__(parent)
        self._runner = runner
        self.robot = ""
        self.drive = STILL
        self._walk_id = ""
        self._walk: tuple[float, float, float] = (0.0, 0.0, 0.0)
        self._asked_s = -math.inf
        self._head = (0.0, 0.0)
        self._timer = QTimer(self, interval=TICK_MS)
        self._timer.timeout.connect(self._on_tick)
        self._again = QTimer(self, interval=ASK_AGAIN_MS)
        self._again.timeout.connect(self._ask_again)

    def choose(self, robot: str) -> None:
        """Drive this robot from now on; the one that was driven stops."""
        if robot != self.robot:
            self.let_go()
            self.robot = robot

    def see(self, state: m.RobotState) -> None:
        """Take in where the head is, while it is not driven."""
        if state.robot == self.robot and not (self.drive.head_left or self.drive.head_up):
            joints = state.joints
            self._head = (joints.get("HeadYaw", 0.0), joints.get("HeadPitch", 0.0))

    def steer(self, drive: Drive) -> None:
        """Do this from now on, until another is wanted."""
        if not self.robot or drive == self.drive:
            return
        self.drive = drive
        if drive.head_left or drive.head_up:
            self._timer.start()
        else:
            self._timer.stop()
        if drive.walk == self._walk:
            return
        self._walk = drive.walk
        if any(self._walk):
            self._walk_id = f"drive-{uuid.uuid4().hex}"
            self._ask_again()
            self._again.start()
        else:
            self._again.stop()
            self._ask("stop", {"request": self._walk_id})

    def let_go(self) -> None:
        """Nobody holds on any more: the legs stop."""
        self.steer(STILL)

    def stop(self) -> None:
        """Stop all that the robot does, at once."""
        self.let_go()
        if self.robot:
            self._ask("stop", {})

    def set_angles(self, angles: dict[str, float]) -> None:
        """Let joints go to angles (rad)."""
        if self.robot:
            self._ask("set_angles", {"angles": angles, "speed": HEAD_SPEED})

    def _ask_again(self) -> None:
        now_s = time.monotonic()
        if now_s - self._asked_s > UNLESS_ASKED_S / 2.0:
            # Anew after standing still: what the robot has ended meanwhile it does not begin again
            self._walk_id = f"drive-{uuid.uuid4().hex}"
        self._asked_s = now_s
        forward, left, turn = self._walk
        args = {"forward": forward, "left": left, "turn": turn, "unless_asked_s": UNLESS_ASKED_S}
        self._ask("walk_freely", args, self._walk_id)

    def _on_tick(self) -> None:
        way = HEAD_RAD_S * TICK_MS / 1000.0
        yaw = min(max(self._head[0] + self.drive.head_left * way, -FARTHEST_YAW), FARTHEST_YAW)
        pitch = min(max(self._head[1] - self.drive.head_up * way, HIGHEST_PITCH), LOWEST_PITCH)
        self._head = (yaw, pitch)
        self.set_angles({"HeadYaw": yaw, "HeadPitch": pitch})

    def _ask(self, action: str, args: dict[str, Any], request_id: str = "") -> None:
        request_id = request_id or f"drive-{uuid.uuid4().hex}"
        request = m.ActionRequest(id=request_id, robots=[self.robot], action=action, args=args)
        self._runner.send(m.ACTION_REQUEST, request)
        self.sent.emit(request)


# A watch that is tilted drives a robot: forward and back to walk, to the sides to turn.

SMOOTHING_S = 0.15
SETTLING_S = 0.6
"""So long the watch is held still at first: that is the middle from then on."""
DEAD_RAD = math.radians(12)
FULL_RAD = math.radians(45)
SILENT_S = 0.5
"""A watch that says nothing for so long is gone."""


class Tilt:
    """How far a watch is tilted from how it was held first."""

    def __init__(self) -> None:
        self.forward_rad = 0.0
        self.aside_rad = 0.0
        self._gravity: list[float] = []
        self._middle: tuple[float, float] | None = None
        self._heard_s = 0.0

    @property
    def is_settled(self) -> bool:
        """Whether it is known how it is held."""
        return self._middle is not None

    def hear(self, imu: Imu) -> None:
        """Take in a batch of samples."""
        step_s = 1.0 / max(imu.rate_hz, 1.0)
        part = step_s / (SMOOTHING_S + step_s)
        for sample in imu.acc:
            before = zip(self._gravity or sample, sample, strict=True)
            self._gravity = [old + part * (new - old) for old, new in before]
        self._heard_s += step_s * len(imu.acc)
        if self._gravity:
            x, y, z = self._gravity
            forward, aside = math.atan2(y, math.hypot(x, z)), math.atan2(x, math.hypot(y, z))
            if self._middle is None:
                if self._heard_s >= SETTLING_S:
                    self._middle = forward, aside
                return
            self.forward_rad = forward - self._middle[0]
            self.aside_rad = aside - self._middle[1]

    def drive(self) -> Drive:
        """What the tilt asks for."""
        forward = _share(self.forward_rad, DEAD_RAD, FULL_RAD)
        aside = _share(self.aside_rad, DEAD_RAD, FULL_RAD)
        return Drive(forward=forward, turn=-aside) if forward or aside else STILL

    def arm(self) -> dict[str, float]:
        """The angles of the right shoulder that follow the tilt, rad."""
        return {
            "RShoulderPitch": min(max(1.4 - 1.6 * self.forward_rad, -2.0), 2.0),
            "RShoulderRoll": min(max(-0.15 - 1.2 * self.aside_rad, -1.3), 0.3),
        }


def _share(way: float, dead: float, full: float) -> float:
    """A part of full speed for a tilt, or for a stick's way; up to ``dead`` it is none."""
    beyond = max(0.0, abs(way) - dead) / (full - dead)
    return math.copysign(min(1.0, beyond), way) if beyond else 0.0


# A gamepad, read without a library: the joystick files of Linux, XInput of Windows.
#
# Qt has no gamepads any more, and a games library is larger than this program. On a Mac there is
# no such simple way: there a gamepad is not offered.

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
        aside = float(4 in self.pressed) - float(5 in self.pressed)
        x, y, _, head_x, head_y = (_share(axis, DEAD_PART, 1.0) for axis in self.axes[:5])
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
        self._pad: Callable[[Sticks], bool] | None = None
        """What reads a gamepad of Windows into the sticks; False when it is gone."""
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
            return self._pad(self.sticks)
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


def _read_pad(library: ctypes.CDLL, number: int, sticks: Sticks) -> bool:
    """Read one gamepad of XInput; False when it is gone."""
    state = _State()
    if library.XInputGetState(number, ctypes.byref(state)) != 0:
        return False
    sticks.axes[0], sticks.axes[1] = state.left_x / FULL, -state.left_y / FULL
    sticks.axes[3], sticks.axes[4] = state.right_x / FULL, -state.right_y / FULL
    masks = {4: LEFT_SHOULDER, 5: RIGHT_SHOULDER, 1: BUTTON_B}
    sticks.pressed = {button for button, mask in masks.items() if state.buttons & mask}
    return True


def _windows_pad() -> Callable[[Sticks], bool] | None:
    try:
        library = ctypes.CDLL("xinput1_4.dll")
    except OSError:
        return None
    found = (partial(_read_pad, library, number) for number in range(4))
    return next((read for read in found if read(Sticks())), None)


def _first_file(folder: Path) -> int:
    for path in sorted(folder.glob("js*")):
        try:
            return os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        except OSError:
            continue
    return -1
