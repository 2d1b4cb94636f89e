"""The robot that shows the motion, and whose limbs can be dragged into a pose."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QMenu

from nep_core.wire import messages as m
from nep_core.wire.messages import RobotState
from nep_studio.ui.robot_view.view import RobotView
from nep_studio.ui.widgets.forms import add_title
from nep_studio.ui.words import tr
from robots.body.body import Angles
from robots.body.inverse import Goal, Reach
from robots.body.kinematics import TORSO, Frames, Skeleton, rotation

from . import editing
from .motion_controller import FIRST_POSE_S, MotionController
from .rehearsal import starting_posture, torso_for_posing

if TYPE_CHECKING:
    from nep_studio.blocks.language import Language
    from nep_studio.ui.running.runner import Heard, Runner


ROBOT = "motion"
FRAME_MS = 16

Place = tuple[float, float, float]


class PosingStage(QObject):
    """Keeps a robot view and a controller together."""

    def __init__(self, view: RobotView, controller: MotionController, model: str = "") -> None:
        super().__init__(view)
        self.view, self.controller, self._model = view, controller, model
        self.skeleton = Skeleton(controller.body)
        self.reach = Reach(self.skeleton)
        self._grip: _Grip | None = None
        self._soon = QTimer(self, singleShot=True, interval=FRAME_MS)
        self._soon.timeout.connect(self.refresh)
        view.is_posing = True
        view.limb_pressed.connect(self._on_pressed)
        view.limb_dragged.connect(self._on_dragged)
        view.limb_released.connect(self._on_released)
        controller.changed.connect(self._soon.start)
        controller.moved.connect(self.refresh)
        self.refresh()

    def refresh(self) -> None:
        """Show the pose of the moment."""
        self._soon.stop()
        controller = self.controller
        pose = controller.rehearsal.pose(controller.cursor_s)
        names = controller.body.names
        state = RobotState(
            robot=ROBOT,
            joints={name: float(angle) for name, angle in zip(names, pose, strict=True)},
            posture=starting_posture(controller.body, controller.motion),
            torso=self.torso(pose),
            model=self._model,
        )
        self.view.show_robot(ROBOT, state, can_touch=False)

    def torso(self, pose: Angles) -> tuple[float, float, float, float, float, float]:
        """Where the torso of a robot is that stands, sits or lies there like this."""
        body = self.controller.body
        posture = body.postures[starting_posture(body, self.controller.motion)]
        return torso_for_posing(self.skeleton, pose, posture)

    def _frame(self, pose: Angles) -> Frames:
        """The torso's frame in the room."""
        x, y, z, roll, pitch, yaw = self.torso(pose)
        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = rotation(roll, pitch, yaw), (x, y, z)
        return frame

    def _on_pressed(self, _robot: str, link: str, place: Place) -> None:
        pose = self.controller.rehearsal.pose(self.controller.cursor_s)
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
        pose = self.controller.rehearsal.pose(self.controller.cursor_s)
        goals = grip.feet_goals(place) if link == TORSO else [self._goal(grip, pose, place)]
        if not goals:
            return
        found = self.reach.reached(pose, *goals)
        columns = {column for goal in goals for column in self.reach.columns(goal.link)}
        angles = {self.controller.body.names[column]: float(found[column]) for column in columns}
        self.controller.set_joints(angles, tr("pose the robot"), merge=f"drag {link}")

    def _goal(self, grip: _Grip, pose: Angles, place: Place) -> Goal:
        back = np.linalg.inv(self._frame(pose))
        wanted = (back @ np.append(place, 1.0))[:3]
        is_foot = grip.link in self.skeleton.soles
        turn = (back @ grip.feet[grip.link])[:3, :3] if is_foot else None
        return Goal(grip.link, grip.point, wanted, turn)

    def _on_released(self, _robot: str, _link: str) -> None:
        self._grip = None
        self.controller.seal()


@dataclass(frozen=True)
class _Grip:
    """Where a limb is held: the point in its own frame, and all around as it was then."""

    link: str
    point: Place
    place: Angles
    torso: Frames
    feet: dict[str, Frames]

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


# A robot that runs: a person moves its limbs by hand and its pose is read, or it plays them.

ACTION = "action/"
HEAD = "head_middle"
NEXT_POSE_S = 1.0
"""So much later than the last one the next pose of a robot comes."""


class RobotPoses(QObject):
    """Hears the robots that run, and lets their joints go or hold.

    While one is moved by hand, a touch of its head takes its pose: both hands are busy there.
    """

    def __init__(self, runner: Runner, controller: MotionController, parent: QObject) -> None:
        super().__init__(parent)
        self._runner, self._controller = runner, controller
        self.states: dict[str, m.RobotState] = {}
        self._by_hand: set[str] = set()
        self._tap = runner.tap(m.ROBOT_STATE, kind=m.RobotState, parent=self)
        self._tap.arrived.connect(self._on_arrived)
        runner.nodes_changed.connect(self._on_nodes_changed)
        runner.disconnected.connect(self.states.clear)

    def fill(self, menu: QMenu, language: Language) -> None:
        """Put into a menu what can be done with the robots that run, or how to start one."""
        menu.clear()
        for name in sorted(self.states):
            add_title(menu, name)
            menu.addAction(tr("Take its pose"), partial(self.take, name))
            play = menu.addAction(tr("Let it play the motion"), partial(self.play, name))
            play.setEnabled(bool(self._controller.motion.joints))
            if name in self._by_hand:
                menu.addAction(tr("Or touch the middle of its head")).setEnabled(False)
            self._add_parts(menu, tr("Let it be moved by hand"), name, language, is_on=False)
            self._add_parts(menu, tr("Hold it again"), name, language, is_on=True)
        planned = [node for node in self._runner.planned() if node.node.startswith(ACTION)]
        waiting = [node for node in planned if node.name not in self.states]
        if waiting:
            add_title(menu, tr("Not started"))
        for node in waiting:
            words = tr("Start {robot}", robot=node.name)
            menu.addAction(words, partial(self._runner.start_node, node))
        if menu.isEmpty():
            hint = tr("Add a robot on the Robots page, then start it here.")
            menu.addAction(hint).setEnabled(False)

    def take(self, name: str) -> None:
        """Set the pose of a robot as a key, at the moment shown or after the last pose."""
        state = self.states.get(name)
        if state is None:
            return
        times = editing.key_times(self._controller.motion)
        is_taken = any(abs(self._controller.cursor_s - time) < editing.SAME_S for time in times)
        if not times:
            self._controller.show(FIRST_POSE_S)
        elif is_taken or self._controller.cursor_s < editing.SAME_S:
            self._controller.show(times[-1] + NEXT_POSE_S)
        self._controller.set_pose(state.joints, tr("take the pose of the robot"))

    def play(self, name: str) -> None:
        """Let a robot play the motion as it is now, kept or not."""
        motion = self._controller.motion
        if motion.starts_from:
            self._ask(name, "do", {"posture": motion.starts_from})
        tracks = {joint: msgspec.to_builtins(keys) for joint, keys in motion.joints.items()}
        if tracks:
            self._ask(name, "move_through", {"tracks": tracks})

    def let_go(self, name: str, part: str, *, is_on: bool) -> None:
        """Switch the motors of a part of a robot on or off."""
        if is_on:
            self._by_hand.discard(name)
        else:
            self._by_hand.add(name)
        self._ask(name, "stiffness", {"part": part, "on": is_on})

    def _ask(self, name: str, action: str, args: dict[str, Any]) -> None:
        request_id = f"motion-{uuid.uuid4().hex}"
        request = m.ActionRequest(id=request_id, robots=[name], action=action, args=args)
        self._runner.send(m.ACTION_REQUEST, request)

    def _add_parts(
        self, menu: QMenu, words: str, name: str, language: Language, *, is_on: bool
    ) -> None:
        inner = menu.addMenu(words)
        for part, label in language.choices.get("lock_parts", {"body": "body"}).items():
            inner.addAction(label, partial(self.let_go, name, part, is_on=is_on))

    def _on_arrived(self, batch: list[Heard]) -> None:
        for heard in batch:
            state: m.RobotState = heard.message
            before = self.states.get(state.robot)
            self.states[state.robot] = state
            is_touch = before is not None and not _is_touched(before) and _is_touched(state)
            if is_touch and state.robot in self._by_hand:
                self.take(state.robot)

    def _on_nodes_changed(self, names: list[str]) -> None:
        nodes = self._runner.board.nodes
        for name in names:
            if name in nodes and not nodes[name].is_there:
                self.states.pop(name, None)


def _is_touched(state: m.RobotState) -> bool:
    return state.sensors.get(HEAD, 0.0) > 0.5
