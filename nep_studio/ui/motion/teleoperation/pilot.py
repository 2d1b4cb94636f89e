"""Asks a robot to do what its pilot wants; it stops when it is not asked any more."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer, Signal

from nep_core import messages as m
from nep_studio.ui.motion.teleoperation.drive import STILL, Drive

if TYPE_CHECKING:
    from nep_studio.ui.running.runner import Runner

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
        yaw = _within(self._head[0] + self.drive.head_left * way, -FARTHEST_YAW, FARTHEST_YAW)
        pitch = _within(self._head[1] - self.drive.head_up * way, HIGHEST_PITCH, LOWEST_PITCH)
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


def _within(value: float, low: float, high: float) -> float:
    return min(max(value, low), high)
