"""What is in a robot view at the moment, and how it moves on from one told state to the next."""

from __future__ import annotations

import math
from collections.abc import Sequence

import msgspec

from nep_core.messages import RobotState, Thing

from .figure import RobotFigure
from .motion import Motion
from .placed import Placed
from .scene import FloorPlace, Marked, Scene, SceneRobot

STEP_M = 0.015
"""A walked path has a corner as often as this."""
JUMP_M = 0.4
"""A robot that is suddenly so far away has been put there; it did not walk."""
LONGEST_PATH = 1500
UPRIGHT = "Stand"
Base = tuple[float, float, float]
ORIGIN: Base = (0.0, 0.0, 0.0)


class _RobotHere:
    """One robot of the room."""

    def __init__(self, name: str, figure: RobotFigure, state: RobotState, now_s: float) -> None:
        self.name, self.figure = name, figure
        self.motion = Motion(state, now_s)
        self.is_pale = self.can_touch = False
        self.last: RobotState | None = None
        self.path: list[FloorPlace] = []
        self._seen: SceneRobot | None = None

    def forget_picture(self) -> None:
        self._seen = None

    def seen(self) -> SceneRobot:
        """The robot as it is shown now; the same object until it moves on."""
        state = self.motion.shown
        if self._seen is None or self._seen.state is not state:
            placed = self._placed(state)
            path = tuple(self.path)
            self._seen = SceneRobot(self.name, self.figure, state, placed, self.is_pale, path)
        return self._seen

    def _placed(self, state: RobotState) -> Placed:
        """Its parts; those of before when only lights or words have changed."""
        if self._seen is not None and self._seen.figure is self.figure:
            before = self._seen.state
            kept = (before.joints, before.base, before.torso, before.posture)
            if kept == (state.joints, state.base, state.torso, state.posture):
                return self._seen.placed
        return self.figure.pose(state)

    def walk(self) -> None:
        """Remember where it has come to."""
        x, y, _ = self.motion.shown.base
        if not self.path:
            self.path = [(x, y)]
            return
        far = math.dist(self.path[-1], (x, y))
        if far > JUMP_M:
            self.path = [(x, y)]
        elif far > STEP_M:
            self.path = [*self.path[-LONGEST_PATH:], (x, y)]


class Room:
    """The robots and things that a view shows."""

    def __init__(self) -> None:
        self._robots: dict[str, _RobotHere] = {}
        self._things: tuple[Thing, ...] = ()
        self._scene: Scene | None = None
        self.marked = Marked()
        self.has_floor = self.has_bubbles = True

    @property
    def names(self) -> tuple[str, ...]:
        """The robots' names."""
        return tuple(self._robots)

    @property
    def things(self) -> tuple[Thing, ...]:
        """What stands on the floor."""
        return self._things

    def show_robot(
        self,
        name: str,
        figure: RobotFigure,
        state: RobotState | None,
        now_s: float,
        can_touch: bool = True,
        start: Base = ORIGIN,
    ) -> tuple[bool, bool]:
        """Take in a robot's state; whether the robot is new, and whether anything is seen of it."""
        here = self._robots.get(name)
        is_new = here is None or here.figure is not figure
        last = here.last if here is not None and not is_new else None
        told = state or last or _standing(name, figure, start)
        if here is None or is_new:
            here = self._robots[name] = _RobotHere(name, figure, told, now_s)
        if state is not None:
            here.last = msgspec.structs.replace(state, saying="", leds={})
        was = (here.is_pale, here.can_touch)
        here.is_pale, here.can_touch = state is None, can_touch and state is not None
        is_seen = here.motion.go(told, now_s) or is_new or was != (here.is_pale, here.can_touch)
        if was != (here.is_pale, here.can_touch):
            here.forget_picture()
        self._scene = None
        return is_new, is_seen

    def remove_robot(self, name: str) -> bool:
        """Take a robot away; whether it was there."""
        self._scene = None
        return self._robots.pop(name, None) is not None

    def show_things(self, things: Sequence[Thing]) -> bool:
        """Have these things; whether they are others than before."""
        if tuple(things) == self._things:
            return False
        self._things, self._scene = tuple(things), None
        return True

    def mark(self, marked: Marked) -> bool:
        """Let something stand out; whether it is something else than before."""
        if marked == self.marked:
            return False
        self.marked, self._scene = marked, None
        return True

    def clear_paths(self) -> None:
        """Forget the ways that were walked."""
        for robot in self._robots.values():
            robot.path = []
            robot.forget_picture()
        self._scene = None

    def step(self, now_s: float) -> bool:
        """Move all robots on; whether some will move on further."""
        more = [robot.motion.step(now_s) for robot in self._robots.values()]
        for robot in self._robots.values():
            robot.walk()
        self._scene = None
        return any(more)

    def can_touch(self, name: str) -> bool:
        """Whether a robot feels it when it is touched here."""
        return name in self._robots and self._robots[name].can_touch

    def goal(self, name: str) -> RobotState | None:
        """The last state that a robot told; None for one that is not there."""
        here = self._robots.get(name)
        return None if here is None or here.is_pale else here.motion.goal

    def scene(self) -> Scene:
        """What is painted; the same object until something changes."""
        if self._scene is None:
            robots = tuple(robot.seen() for robot in self._robots.values())
            self._scene = Scene(robots, self._things, self.marked, self.has_floor, self.has_bubbles)
        return self._scene


def _standing(name: str, figure: RobotFigure, start: Base) -> RobotState:
    """A robot of which nothing is known stands where it will begin."""
    postures = figure.body.postures
    posture = UPRIGHT if UPRIGHT in postures else next(iter(postures))
    angles = figure.body.posture_angles(posture).tolist()
    joints = dict(zip(figure.body.names, angles, strict=True))
    return RobotState(robot=name, joints=joints, posture=posture, base=start)


def moved(things: Sequence[Thing], thing: str, x: float, y: float) -> list[Thing]:
    """Return the things with one of them at another place."""
    return [
        msgspec.structs.replace(one, place=(x, y, one.place[2])) if one.id == thing else one
        for one in things
    ]
