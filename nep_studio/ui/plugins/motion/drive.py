"""What a person wants a robot to do at this moment, and what keys mean."""

from __future__ import annotations

import math
import uuid
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
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
        return Drive(
            self.forward * part, self.left * part, self.turn * part, self.head_left, self.head_up
        )


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
    found = list(drives)

    def within(value: float) -> float:
        return max(-1.0, min(1.0, value))

    return Drive(
        within(sum(one.forward for one in found)),
        within(sum(one.left for one in found)),
        within(sum(one.turn for one in found)),
        within(sum(one.head_left for one in found)),
        within(sum(one.head_up for one in found)),
    )


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

    def __init__(self, runner: Runner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._runner = runner
        self.robot = ""
        self.drive = STILL
        self._walk_id = ""
        self._walk: tuple[float, float, float] = (0.0, 0.0, 0.0)
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
        self._follow_walk()
        if drive.head_left or drive.head_up:
            self._timer.start()
        else:
            self._timer.stop()

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

    def _follow_walk(self) -> None:
        walk = self.drive.walk
        if walk == self._walk:
            return
        self._walk = walk
        if any(walk):
            self._walk_id = f"drive-{uuid.uuid4().hex}"
            self._ask_again()
            self._again.start()
        else:
            self._again.stop()
            self._ask("stop", {"request": self._walk_id})

    def _ask_again(self) -> None:
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
        request = m.ActionRequest(
            id=request_id or f"drive-{uuid.uuid4().hex}",
            robots=[self.robot],
            action=action,
            args=args,
        )
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

Vector = Sequence[float]


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
            if not self._gravity:
                self._gravity = list(sample)
            else:
                self._gravity = [
                    old + part * (new - old) for old, new in zip(self._gravity, sample, strict=True)
                ]
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
        forward, aside = _share(self.forward_rad), _share(self.aside_rad)
        return Drive(forward=forward, turn=-aside) if forward or aside else STILL

    def arm(self) -> dict[str, float]:
        """The angles of the right shoulder that follow the tilt, rad."""
        return {
            "RShoulderPitch": min(max(1.4 - 1.6 * self.forward_rad, -2.0), 2.0),
            "RShoulderRoll": min(max(-0.15 - 1.2 * self.aside_rad, -1.3), 0.3),
        }


def _share(angle: float) -> float:
    """A part of full speed for a tilt; a little tilt is none."""
    beyond = max(0.0, abs(angle) - DEAD_RAD) / (FULL_RAD - DEAD_RAD)
    return math.copysign(min(1.0, beyond), angle) if beyond else 0.0
