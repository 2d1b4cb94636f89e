"""A robot that runs: a person moves its limbs by hand and its pose is read, or it plays them."""

from __future__ import annotations

import uuid
from functools import partial
from typing import TYPE_CHECKING, Any

import msgspec
from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMenu

from nep_core import messages as m
from nep_studio.ui.motion import editing
from nep_studio.ui.motion.desk import FIRST_POSE_S
from nep_studio.ui.motion.menu_titles import add_title
from nep_studio.ui.words import tr

if TYPE_CHECKING:
    from nep_studio.blocks.language import Language
    from nep_studio.plan import PlannedNode
    from nep_studio.ui.motion.desk import MotionDesk
    from nep_studio.ui.running.runner import Runner
    from nep_studio.ui.running.tap import Heard

ACTION = "action/"
HEAD = "head_middle"
NEXT_POSE_S = 1.0
"""So much later than the last one the next pose of a robot comes."""


class RobotPoses(QObject):
    """Hears the robots that run, and lets their joints go or hold.

    While one is moved by hand, a touch of its head takes its pose: both hands are busy there.
    """

    def __init__(self, runner: Runner, desk: MotionDesk, parent: QObject) -> None:
        super().__init__(parent)
        self._runner, self._desk = runner, desk
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
            play.setEnabled(bool(self._desk.motion.joints))
            if name in self._by_hand:
                hint = tr("Or touch the middle of its head")
                menu.addAction(hint).setEnabled(False)
            self._add_parts(menu, tr("Let it be moved by hand"), name, language, is_on=False)
            self._add_parts(menu, tr("Hold it again"), name, language, is_on=True)
        waiting = [node for node in self._planned() if node.name not in self.states]
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
        times = editing.key_times(self._desk.motion)
        is_taken = any(abs(self._desk.cursor_s - time) < editing.SAME_S for time in times)
        if not times:
            self._desk.show(FIRST_POSE_S)
        elif is_taken or self._desk.cursor_s < editing.SAME_S:
            self._desk.show(times[-1] + NEXT_POSE_S)
        self._desk.set_pose(state.joints, tr("take the pose of the robot"))

    def play(self, name: str) -> None:
        """Let a robot play the motion as it is now, kept or not."""
        motion = self._desk.motion
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

    def _planned(self) -> list[PlannedNode]:
        return [node for node in self._runner.planned() if node.node.startswith(ACTION)]

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
