"""What is in the room: robots, things on the floor, walked paths; plain data for the painters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache
from operator import attrgetter

import msgspec
import numpy as np
from numpy.typing import NDArray

from nep_core.wire.messages import RobotState, Thing
from nep_studio import paths

from .figure import Assembly, Placed, RobotFigure
from .parts import Triple, ViewFile, all_parts, read_view, rotation

FloorPlace = tuple[float, float]


@dataclass(frozen=True, eq=False)
class SceneRobot:
    """A robot where its state says it is; a pale one is not there really."""

    name: str
    figure: RobotFigure
    state: RobotState
    placed: Placed
    is_pale: bool = False
    path: tuple[FloorPlace, ...] = ()


@dataclass(frozen=True)
class Marked:
    """The parts that stand out: under the pointer or the keyboard, pressed, or felt."""

    robot: str = ""
    sensor: str = ""
    is_pressed: bool = False
    thing: str = ""
    link: str = ""


@dataclass(frozen=True)
class Scene:
    """All that is painted, beside the camera and the theme."""

    robots: tuple[SceneRobot, ...] = ()
    things: tuple[Thing, ...] = ()
    marked: Marked = field(default_factory=Marked)
    has_floor: bool = True
    has_bubbles: bool = True


# Makes the 30 states a second that robots tell into movement that is smooth to the eye.

SHORTEST_S, LONGEST_S = 0.02, 0.12
"""How long it takes to go from one state to the next: as long as states are apart, about."""
JUMP_M = 0.4
"""A robot that is suddenly so far away has been put there; it did not walk."""
UNSEEN = ("time", "battery", "sees", "settings", "listening", "sensors", "moving")
SEEN = tuple(name for name in RobotState.__struct_fields__ if name not in UNSEEN)
"""What of a state changes the picture of it, beside the sensors that are felt."""


MOVING = attrgetter("joints", "base", "torso", "posture")
"""What of a state says where the parts are."""


class RobotHere:
    """One robot of a room, on its way from the state that is seen to the last one that was told."""

    def __init__(self, name: str, figure: RobotFigure, state: RobotState, now_s: float) -> None:
        self.name, self.figure = name, figure
        self.goal = self.shown = self._start = state
        self._told_s = self._heard_s = now_s
        self._lasts_s = 0.0
        self.is_pale = self.can_touch = False
        self.last: RobotState | None = None
        self.path: list[FloorPlace] = []
        self.picture: SceneRobot | None = None

    def go(self, state: RobotState, now_s: float) -> bool:
        """Take in a new state; whether anything is seen of it."""
        since, self._heard_s = now_s - self._heard_s, now_s
        looks = [
            (*(getattr(one, name) for name in SEEN), {n for n, x in one.sensors.items() if x > 0})
            for one in (state, self.goal)
        ]
        if looks[0] == looks[1]:
            self.shown = state if self.shown is self.goal else self.shown
            self.goal = state
            return False
        self._lasts_s = min(max(since, SHORTEST_S), LONGEST_S)
        self._start, self.goal, self._told_s = self.shown, state, now_s
        if math.dist(self.shown.base[:2], state.base[:2]) > JUMP_M:
            self._start = self.shown = state
        return True

    def step(self, now_s: float) -> bool:
        """Go on to where the robot is now; whether there is more to come."""
        share = 1.0 if self._lasts_s <= 0 else (now_s - self._told_s) / self._lasts_s
        start, goal = self._start, self.goal
        moves = (start.joints, start.base, start.torso) != (goal.joints, goal.base, goal.torso)
        is_there = share >= 1.0 or not moves
        self.shown = goal if is_there else between(start, goal, max(share, 0.0))
        # Remember where it has come to.
        here = self.shown.base[:2]
        far = math.dist(self.path[-1], here) if self.path else math.inf
        if far > STEP_M:
            self.path = [*(self.path[-LONGEST_PATH:] if far <= JUMP_M else []), here]
        return not is_there


def between(start: RobotState, goal: RobotState, share: float) -> RobotState:
    """The state on the way from one to another; what cannot be halved is as in the goal."""
    joints = {
        name: angle + (goal.joints.get(name, angle) - angle) * share
        for name, angle in start.joints.items()
    }
    moved: dict[str, tuple[float, ...]] = {}
    for key, turns_from in (("base", 2), ("torso", 3)):
        if getattr(start, key) is not None and getattr(goal, key) is not None:
            ways = [b - a for a, b in zip(getattr(start, key), getattr(goal, key), strict=True)]
            # The later ones are angles, which take the shorter way round.
            ways[turns_from:] = [math.remainder(way, 2 * math.pi) for way in ways[turns_from:]]
            there = zip(getattr(start, key), ways, strict=True)
            moved[key] = tuple(a + way * share for a, way in there)
    return msgspec.structs.replace(goal, joints=goal.joints | joints, **moved)


# What is in a robot view at the moment, and how it moves on from one told state to the next.

STEP_M = 0.015
"""A walked path has a corner as often as this."""
LONGEST_PATH = 1500
UPRIGHT = "Stand"
Base = tuple[float, float, float]
ORIGIN: Base = (0.0, 0.0, 0.0)


class Room:
    """The robots and things that a view shows."""

    def __init__(self) -> None:
        self.robots: dict[str, RobotHere] = {}
        self.things: tuple[Thing, ...] = ()
        """What stands on the floor."""
        self._scene: Scene | None = None
        self.marked = Marked()
        self.has_floor = self.has_bubbles = True

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
        here = self.robots.get(name)
        is_new = here is None or here.figure is not figure
        last = here.last if here is not None and not is_new else None
        told = state or last
        if told is None:  # it stands where it will begin
            postures = figure.body.postures
            posture = UPRIGHT if UPRIGHT in postures else next(iter(postures))
            joints = dict(zip(figure.body.names, postures[posture].angles, strict=True))
            told = RobotState(robot=name, joints=joints, posture=posture, base=start)
        if here is None or is_new:
            here = self.robots[name] = RobotHere(name, figure, told, now_s)
        if state is not None:
            here.last = msgspec.structs.replace(state, saying="", leds={})
        was = (here.is_pale, here.can_touch)
        here.is_pale, here.can_touch = state is None, can_touch and state is not None
        is_seen = here.go(told, now_s) or is_new or was != (here.is_pale, here.can_touch)
        if was != (here.is_pale, here.can_touch):
            here.picture = None
        self._scene = None
        return is_new, is_seen

    def remove_robot(self, name: str) -> bool:
        """Take a robot away; whether it was there."""
        self._scene = None
        return self.robots.pop(name, None) is not None

    def show_things(self, things: Sequence[Thing]) -> bool:
        """Have these things; whether they are others than before."""
        if tuple(things) == self.things:
            return False
        self.things, self._scene = tuple(things), None
        return True

    def mark(self, marked: Marked) -> bool:
        """Let something stand out; whether it is something else than before."""
        if marked == self.marked:
            return False
        self.marked, self._scene = marked, None
        return True

    def clear_paths(self) -> None:
        """Forget the ways that were walked."""
        for robot in self.robots.values():
            robot.path, robot.picture = [], None
        self._scene = None

    def step(self, now_s: float) -> bool:
        """Move all robots on; whether some will move on further."""
        more = [robot.step(now_s) for robot in self.robots.values()]
        self._scene = None
        return any(more)

    def can_touch(self, name: str) -> bool:
        """Whether a robot feels it when it is touched here."""
        return name in self.robots and self.robots[name].can_touch

    def scene(self) -> Scene:
        """What is painted; the same object until something changes."""
        if self._scene is None:
            for robot in self.robots.values():
                state, before = robot.shown, robot.picture
                if before is None or before.state is not state:
                    # When only lights or words have changed its parts are where they were.
                    is_still = before is not None and MOVING(before.state) == MOVING(state)
                    placed = before.placed if before and is_still else robot.figure.pose(state)
                    kept = robot.is_pale, tuple(robot.path)
                    robot.picture = SceneRobot(robot.name, robot.figure, state, placed, *kept)
            robots = tuple(one.picture for one in self.robots.values() if one.picture is not None)
            self._scene = Scene(robots, self.things, self.marked, self.has_floor, self.has_bubbles)
        return self._scene


def moved(things: Sequence[Thing], thing: str, x: float, y: float) -> list[Thing]:
    """Return the things with one of them at another place."""
    return [
        msgspec.structs.replace(one, place=(x, y, one.place[2])) if one.id == thing else one
        for one in things
    ]


# What stands on the floor beside robots, people, balls, walls and landmarks, as placed parts.

Array = NDArray[np.float64]
UP = np.array([0.0, 0.0, 1.0])
KIND_SIZES: dict[str, Triple] = {
    "person": (0.32, 0.2, 1.15),
    "ball": (0.12, 0.12, 0.12),
    "wall": (1.2, 0.05, 0.7),
    "mark": (0.16, 0.02, 0.5),
}
"""How wide, deep and high things of a kind usually are, m; people are children here."""


@lru_cache(maxsize=128)
def placed_thing(thing: Thing) -> Placed:
    """The parts of a thing where it is; the same object for the same thing."""
    made = _made(thing.kind, thing.size)
    spin = rotation(UP, thing.heading)
    frame = np.eye(4)
    frame[:3, :3], frame[:3, 3] = spin, thing.place
    origins = frame[:3, 3] + made.origins @ spin.T
    return replace(made, origins=origins, turns=spin @ made.turns, links={"thing": frame})


def thing_colours(kind: str) -> Mapping[str, str]:
    """The colours of the parts of a kind of thing, by name."""
    return _view(kind).colours


@cache
def _view(kind: str) -> ViewFile:
    return read_view(paths.resources() / "things" / f"{kind}.toml")


@lru_cache(maxsize=64)
def _made(kind: str, size: Triple) -> Placed:
    """The parts of a thing of some size that stands in the middle of the floor."""
    view = _view(kind)
    wide, deep, high = size
    scale = np.array([deep, wide, high] if view.stretches else [high, high, high])
    shaped = list(all_parts(view))
    known = Assembly.of(shaped)
    # Only parts that are not turned can be stretched one way more than the others.
    return Placed(
        replace(known, solids=known.solids.scaled(scale)),
        np.array([one.at for one in shaped]) * scale,
        np.array([one.turn for one in shaped]),
        {},
    )
