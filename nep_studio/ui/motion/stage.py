"""The robot that shows the motion, and whose limbs can be dragged into a pose."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QObject, QTimer

from nep_core.messages import RobotState
from nep_studio.ui.motion.balance import torso_for_posing
from nep_studio.ui.motion.desk import MotionDesk
from nep_studio.ui.motion.rehearsal import starting_posture
from nep_studio.ui.robot_view.view import RobotView
from nep_studio.ui.words import tr
from nodes.action.naobody.body import Angles
from nodes.action.naobody.inverse import Goal, Reach
from nodes.action.naobody.skeleton import TORSO, Frames, Skeleton, rotation

ROBOT = "motion"
FRAME_MS = 16

Place = tuple[float, float, float]


class PosingStage(QObject):
    """Keeps a robot view and a desk together."""

    def __init__(self, view: RobotView, desk: MotionDesk, model: str = "") -> None:
        super().__init__(view)
        self.view, self.desk, self._model = view, desk, model
        self.skeleton = Skeleton(desk.body)
        self.reach = Reach(self.skeleton)
        self._grip: _Grip | None = None
        self._soon = QTimer(self, singleShot=True, interval=FRAME_MS)
        self._soon.timeout.connect(self.refresh)
        view.is_posing = True
        view.limb_pressed.connect(self._on_pressed)
        view.limb_dragged.connect(self._on_dragged)
        view.limb_released.connect(self._on_released)
        desk.changed.connect(self._soon.start)
        desk.moved.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the pose of the moment."""
        self._soon.stop()
        desk = self.desk
        pose = desk.rehearsal.pose(desk.cursor_s)
        names = desk.body.names
        state = RobotState(
            robot=ROBOT,
            joints={name: float(angle) for name, angle in zip(names, pose, strict=True)},
            posture=starting_posture(desk.body, desk.motion),
            torso=self.torso(pose),
            model=self._model,
        )
        self.view.show_robot(ROBOT, state, can_touch=False)

    def torso(self, pose: Angles) -> tuple[float, float, float, float, float, float]:
        """Where the torso of a robot is that stands, sits or lies there like this."""
        posture = self.desk.body.postures[starting_posture(self.desk.body, self.desk.motion)]
        return torso_for_posing(self.skeleton, pose, posture)

    def _frame(self, pose: Angles) -> Frames:
        """The torso's frame in the room."""
        x, y, z, roll, pitch, yaw = self.torso(pose)
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = rotation(roll, pitch, yaw), (x, y, z)
        return frame

    def _on_pressed(self, _robot: str, link: str, place: Place) -> None:
        pose = self.desk.rehearsal.pose(self.desk.cursor_s)
        torso = self._frame(pose)
        frames = self.skeleton.frames(pose)
        whole = torso @ frames.get(link, np.eye(4))
        point = np.linalg.inv(whole) @ np.append(place, 1.0)
        x, y, z = (float(part) for part in point[:3])
        feet = {foot: torso @ frames[foot] for foot in self.skeleton.soles}
        self._grip = _Grip(link, (x, y, z), np.array(place), torso, feet)

    def _on_dragged(self, _robot: str, link: str, place: Place) -> None:
        grip = self._grip
        if grip is None or grip.link != link:
            return
        pose = self.desk.rehearsal.pose(self.desk.cursor_s)
        goals = grip.feet_goals(place) if link == TORSO else [self._goal(grip, pose, place)]
        if not goals:
            return
        found = self.reach.reached(pose, *goals)
        columns = {column for goal in goals for column in self.reach.columns(goal.link)}
        angles = {self.desk.body.names[column]: float(found[column]) for column in columns}
        self.desk.set_joints(angles, tr("pose the robot"), merge=f"drag {link}")

    def _goal(self, grip: _Grip, pose: Angles, place: Place) -> Goal:
        back = np.linalg.inv(self._frame(pose))
        wanted = (back @ np.append(place, 1.0))[:3]
        is_foot = grip.link in self.skeleton.soles
        turn = (back @ grip.feet[grip.link])[:3, :3] if is_foot else None
        return Goal(grip.link, grip.point, wanted, turn)

    def _on_released(self, _robot: str, _link: str) -> None:
        self._grip = None
        self.desk.seal()


class _Grip:
    """Where a limb is held: the point in its own frame, and all around as it was then."""

    def __init__(
        self, link: str, point: Place, place: Angles, torso: Frames, feet: dict[str, Frames]
    ) -> None:
        self.link, self.point, self.place = link, point, place
        self.torso, self.feet = torso, feet

    def feet_goals(self, place: Place) -> list[Goal]:
        """The feet stay where they are on the floor while the torso goes with the pointer."""
        torso = self.torso.copy()
        torso[:3, 3] += np.array(place) - self.place
        back = np.linalg.inv(torso)
        goals = []
        for foot, frame in self.feet.items():
            wanted = back @ frame
            goals.append(Goal(foot, (0.0, 0.0, 0.0), wanted[:3, 3], wanted[:3, :3]))
        return goals
