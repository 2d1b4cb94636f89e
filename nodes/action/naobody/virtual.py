"""The driver of the NAO on the screen: a body in numpy that moves on a clock of its own."""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from nep_core.errors import ActionFailed
from nep_core.messages import RobotState, SenseRequest
from nodes.action.naobody.actions import Action
from nodes.action.naobody.driver import Connection, Ended
from nodes.action.naobody.gaze import from_world
from nodes.action.naobody.limbs import MOVING, Limb
from nodes.action.naobody.motion import TICK_S
from nodes.action.naobody.parts import SINGLE_PARTS
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.repertoire import limbs_of, task_of
from nodes.action.naobody.sensing import sense
from nodes.action.naobody.sensors import measured
from nodes.action.naobody.tasks import Task, come_to_rest


class VirtualDriver:
    """Plays actions on a virtual robot, one tick (TICK_S) after the other.

    ``now_s`` may run faster than real time; nothing here reads a clock.
    """

    def __init__(self, robot: VirtualRobot, now_s: float = 0.0) -> None:
        self.robot = robot
        self.connection = Connection("disconnected", "")
        self._clock_s = now_s
        self._running: dict[str, _Running] = {}
        self._held_up: dict[str, _Running] = {}  # until limbs that brake have come to rest
        self._braking: list[Task] = []
        self._joint_speed = np.zeros(len(robot.body.names))
        self._base_speed = np.zeros(3)

    @property
    def moving(self) -> bool:
        """Whether the robot does something."""
        return bool(self._running or self._held_up or self._braking)

    def connect(self) -> None:
        """Be connected at once: the robot is in this process."""
        self.connection = Connection("connected", f"virtual NAO, {self.robot.family}")

    def disconnect(self) -> None:
        """Let the robot be."""
        self.stop({*self._running, *self._held_up})
        self.connection = Connection("disconnected", "")

    def limbs(self, action: Action) -> frozenset[Limb]:
        """Return the limbs that an action needs. Raises ActionFailed if a name is unknown."""
        return limbs_of(self.robot, action)

    def start(self, command_id: str, action: Action) -> None:
        """Begin an action; ``step`` tells when it has ended."""
        task = task_of(self.robot, action)
        started = self._held_up if self._braking else self._running
        started[command_id] = _Running(task, self.limbs(action))

    def stop(self, command_ids: Collection[str]) -> None:
        """End some actions: their joints brake, which holds up later actions for a moment."""
        limbs: set[Limb] = set()
        for command_id in command_ids:
            self._held_up.pop(command_id, None)
            if stopped := self._running.pop(command_id, None):
                stopped.task.close()
                limbs |= stopped.limbs
        if limbs & MOVING:
            rest = come_to_rest(self.robot, limbs, self._joint_speed, self._base_speed)
            self._braking.append(rest)

    def step(self, now_s: float) -> list[Ended]:
        """Go on to a time, or to the first tick in which a command ends."""
        while self.moving and self._clock_s + TICK_S <= now_s:
            self._clock_s += TICK_S
            if ended := self._tick():
                return ended
        if not self.moving:
            self._clock_s = now_s
        return []

    def state(self) -> RobotState:
        """Return where the robot's body is."""
        robot = self.robot
        x, y, theta = (float(value) for value in robot.base)
        return RobotState(
            robot=robot.name,
            joints=dict(zip(robot.body.names, robot.angles.round(5).tolist(), strict=True)),
            base=(x, y, theta),
            posture=robot.posture,
            leds=dict(robot.leds),
            saying=robot.saying,
            moving=self.moves_joints,
            battery=robot.felt.get("battery", 1.0),
            sensors=measured(robot, self._joint_speed, self._base_speed),
            sees={thing: from_world(robot, place) for thing, place in robot.sees.items()},
            settings=self._settings(),
            listening=list(robot.listening),
        )

    def sense(self, request: SenseRequest) -> list[str]:
        """Feel, see or hear something; return the human states that follow from it."""
        return sense(self.robot, request)

    @property
    def moves_joints(self) -> bool:
        """Whether joints move, or are about to."""
        running = [*self._running.values(), *self._held_up.values()]
        return bool(self._braking or any(one.limbs & MOVING for one in running))

    def _settings(self) -> dict[str, bool | float | str]:
        robot = self.robot
        locked = {f"locked_{part}": part not in robot.released for part in SINGLE_PARTS}
        awake = not robot.released and robot.posture != "Rest"
        return {**robot.settings, "awake": awake, **locked}

    def _tick(self) -> list[Ended]:
        angles, base = self.robot.angles.copy(), self.robot.base.copy()
        self._braking = [task for task in self._braking if not _is_over(task)]
        ended = [end for name in tuple(self._running) if (end := self._advance(name))]
        if not self._braking:
            self._running |= self._held_up
            self._held_up.clear()
        self._joint_speed = (self.robot.angles - angles) / TICK_S
        self._base_speed = (self.robot.base - base) / TICK_S
        return ended

    def _advance(self, command_id: str) -> Ended | None:
        try:
            next(self._running[command_id].task)
        except StopIteration as end:
            ended = Ended(command_id, "done", end.value)
        except ActionFailed as problem:
            ended = Ended(command_id, "failed", problem.sentence)
        else:
            return None
        del self._running[command_id]
        return ended


class _Running(NamedTuple):
    task: Task
    limbs: frozenset[Limb]


def _is_over(task: Task) -> bool:
    """Advance a task by one tick, and return whether that was its end."""
    try:
        next(task)
    except StopIteration:
        return True
    return False
