"""How a virtual robot stands, sits or lies on the floor, tick by tick: it can lose its balance.

What touches the floor stays where it is. The body tips over the edge of its support when its
centre of mass is not above it, slowly first, as things fall; postures and the walk say themselves
how the torso leans.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .body import Angles, Vector
from .kinematics import TORSO, Frames, Skeleton, TorsoPose, pose_of, turned
from .settling import Points, Rotation, hull, inside_by, tilt_for, tipped

Touching = NDArray[np.bool_]

FOLLOWING_RAD_S = 1.5
"""So fast a body that stands still follows its own small movements."""
FALLING_RAD_S2 = 12.0
"""How quickly tipping becomes faster: about gravity over the height of the centre of mass, / 3."""
LOST_RAD = 0.6
"""A body that has tipped so far away from where it was steady falls."""
LEANING_RAD_S, LEAST_LEANING_S = 0.65, 0.4
"""How fast a torso leans over between postures, on the whole."""
TOUCHING_M = 0.003
"""What is so little above the floor is taken to touch it."""


@dataclass(frozen=True)
class Leaning:
    """The torso leans as a task says: ``down`` is which way is down, in the torso's frame."""

    down: Points


@dataclass(frozen=True)
class Carried:
    """The torso is where a walk says: how it is turned, and x, y (m) on the floor.

    ``stands``: both feet are down and stay there, only the weight goes back between them.
    """

    turn: Rotation
    x: float
    y: float
    stands: bool = False


PUSHED_RAD, PUSHED_S = 0.5, 0.1
"""How far a hard push tips the body, and how long it has been falling then."""
TRIPPING_RAD_S = 0.4
"""How fast a body begins to tip that is stopped in the middle of a step."""


class Stance:
    """Where the torso of one robot is over the floor, and what of the body touches it."""

    def __init__(self, skeleton: Skeleton, angles: Angles, down: Vector) -> None:
        self.skeleton = skeleton
        self.guide: Leaning | Carried | None = None
        """How the torso is held at the next tick; a task says it anew at every tick."""
        self.has_lost_balance = False
        self.last_guide: Leaning | Carried | None = None
        """How a task held the torso at the last tick, if one did."""
        self._speed_rad_s = FOLLOWING_RAD_S
        self._drift: Points = np.zeros(3)
        self._thrown: float | None = None
        self._angles: Angles = angles
        self.places: Points = np.zeros((0, 3))
        """Where the skeleton's outline points are in the room (points, 3), m."""
        self.frames: Frames = np.zeros((0, 4, 4))
        """Where each link is in the torso's frame (links, 4, 4)."""
        self.put_down(angles, np.zeros(3), down)

    def put_down(self, angles: Angles, base: Angles, down: Vector) -> None:
        """Put the robot down at rest, its feet at a base (x m, y m, theta rad)."""
        frames = self.skeleton.transforms(angles)
        self.turn: Rotation = turned(float(base[2])) @ self.skeleton.resting_turn(angles, down)
        middle = self.turn @ self.skeleton.feet_middle(frames)
        self.place: Points = np.array([base[0] - middle[0], base[1] - middle[1], 0.0])
        self._steady_down = self.down
        self._thrown = None
        self._take_places(angles)

    def roll_to(self, base: Angles) -> None:
        """Be at a base (x m, y m, theta rad) without steps, as a robot on wheels."""
        x, y, theta = self.feet_base()
        turn = turned(float(base[2] - theta))
        self.turn = turn @ self.turn
        self.place[:2] = base[:2] + turn[:2, :2] @ (self.place[:2] - (x, y))
        self._take_places(self._angles)

    def hold(self) -> None:
        """Hold the torso as at the last tick, unless it is held otherwise or was not held."""
        self.guide = self.guide or self.last_guide

    @property
    def down(self) -> Points:
        """Which way is down, in the torso's frame."""
        down: Points = -self.turn[2]
        return down

    @property
    def is_steady(self) -> bool:
        """Whether the body does not tip."""
        return self._speed_rad_s == FOLLOWING_RAD_S

    @property
    def pose(self) -> TorsoPose:
        """Where the torso is, as RobotState.torso has it."""
        return pose_of(self.turn, self.place)

    def follow(self, angles: Angles, tick_s: float) -> None:
        """Take in how the joints are now: stay on the floor, lean, or tip."""
        guide, self.guide = self.guide, None
        if self._thrown is not None:
            guide = None
        self.last_guide = guide
        if guide is None and self.is_steady and np.array_equal(angles, self._angles):
            return
        before = self.places
        touched = self.touching
        outline = self._bend(angles)
        self._turn_by(guide, outline, tick_s)
        places = outline @ self.turn.T
        if isinstance(guide, Carried):
            place = np.array([guide.x, guide.y, 0.0])
            self._drift = place - self.place
            self.place = place
        else:
            # Move the body over the floor so that what touches it slides as little as it can
            low = places[:, 2] < places[:, 2].min() + TOUCHING_M
            both = low & touched
            kept = both if both.any() else touched
            new, old = places[kept, :2], before[kept, :2]
            new_middle, old_middle = new.mean(axis=0), old.mean(axis=0)
            turn = turned(_turn_between(new - new_middle, old - old_middle))
            self.turn = turn @ self.turn
            x, y = old_middle - turn[:2, :2] @ new_middle
            self.place = np.array([x, y, 0.0])
            places = outline @ self.turn.T
        self.place[2] = -places[:, 2].min()
        self.places = places + self.place

    def _turn_by(self, guide: Leaning | Carried | None, outline: Points, tick_s: float) -> None:
        if isinstance(guide, Carried):
            self.turn = guide.turn
        elif isinstance(guide, Leaning):
            self.turn = tilt_for(self.turn @ guide.down) @ self.turn
        else:
            self._tip(outline, tick_s)
            return
        self._speed_rad_s = FOLLOWING_RAD_S
        self._steady_down = self.down
        self.has_lost_balance = False

    def _tip(self, outline: Points, tick_s: float) -> None:
        angle, left = self._speed_rad_s * tick_s, 0.0
        if self._thrown is not None:
            self.turn = _tilt(self._thrown, angle) @ self.turn
        else:
            self.turn, left = tipped(outline - self._centre, self.turn, angle)
        if left > 0.0:
            self._speed_rad_s = FOLLOWING_RAD_S
            self._steady_down = self.down
            return
        self._speed_rad_s += FALLING_RAD_S2 * tick_s
        if float(self.down @ self._steady_down) < math.cos(LOST_RAD):
            self.has_lost_balance = True
            self._thrown = None

    def _bend(self, angles: Angles) -> Points:
        """Have joints at angles; return the body's outline in the torso's frame."""
        self._angles = angles.copy()
        self.frames = self.skeleton.transforms(angles)
        self._centre = self.skeleton.mass_centre(self.frames)
        return self.skeleton.outline(self.frames)

    def _take_places(self, angles: Angles) -> None:
        places = self._bend(angles) @ self.turn.T
        self.place[2] = -places[:, 2].min()
        self.places = places + self.place

    def push(self, heading: float) -> None:
        """Tip the body over towards a direction on the floor (rad), as a hard push does."""
        self.turn = _tilt(heading, PUSHED_RAD) @ self.turn
        self._take_places(self._angles)
        self._speed_rad_s = FOLLOWING_RAD_S + FALLING_RAD_S2 * PUSHED_S

    def trip(self) -> None:
        """Fall over the step that is under way: its swing goes on, and nothing holds the torso."""
        forward = float(self.turn[1, 0]), float(self.turn[0, 0])
        swing = (float(self._drift[1]), float(self._drift[0])) if self._drift.any() else forward
        self._thrown, self.last_guide = math.atan2(*swing), None
        self._speed_rad_s = TRIPPING_RAD_S
        self._steady_down = self.down

    @property
    def touching(self) -> Touching:
        """Which of the skeleton's outline points touch the floor (points,), true or false."""
        return self.places[:, 2] < TOUCHING_M

    @property
    def centre_of_mass(self) -> Points:
        """Where the centre of mass is in the room (3,), m."""
        return self.turn @ self._centre + self.place

    def link_place(self, link: str, offset: Vector = (0.0, 0.0, 0.0)) -> Points:
        """Return where a place of a link is in the room (3,), m."""
        frame = self.frames[self.skeleton.index[link]]
        place: Points = self.turn @ (frame[:3, :3] @ np.array(offset) + frame[:3, 3]) + self.place
        return place

    def link_turn(self, link: str) -> Rotation:
        """Return how a link is turned in the room (3, 3)."""
        turn: Rotation = self.turn @ self.frames[self.skeleton.index[link]][:3, :3]
        return turn

    @property
    def margin_m(self) -> float:
        """How far the centre of mass is inside the support, seen from above; below 0: outside."""
        corners = hull(self.places[self.touching, :2])
        x, y, _ = self.centre_of_mass
        return inside_by(corners, (float(x), float(y))) if len(corners) > 2 else -math.inf

    def feet_base(self) -> Angles:
        """Return where the feet are: the middle between them, x m, y m, and their heading, rad.

        Of a robot without feet: where its torso is.
        """
        links = tuple(self.skeleton.soles) or (TORSO,)
        places = np.array([self.link_place(link)[:2] for link in links])
        headings = np.array([self.link_turn(link)[:2, 0] for link in links]).sum(axis=0)
        return np.array([*places.mean(axis=0), math.atan2(headings[1], headings[0])])


def _tilt(heading: float, angle: float) -> Rotation:
    """Return the rotation that tips what is up towards a direction on the floor (both rad)."""
    axis = np.array([-math.sin(heading), math.cos(heading), 0.0])
    cross = np.cross(np.eye(3), axis)
    turn: Rotation = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    return turn


def leaning_s(before: Points, after: Points) -> float:
    """Return how long it calmly takes to lean from one way down to another."""
    return max(LEAST_LEANING_S, _angle(before, after) / LEANING_RAD_S)


def between(before: Points, after: Points, part: float) -> Points:
    """Return the direction that is a part (0 to 1) of the way from one to another."""
    angle = _angle(before, after)
    if angle < 1e-6:
        return after
    mixed: Points = math.sin((1.0 - part) * angle) * before + math.sin(part * angle) * after
    return mixed / np.linalg.norm(mixed)


def _angle(before: Points, after: Points) -> float:
    (a, b, c), (x, y, z) = before.tolist(), after.tolist()
    across = math.hypot(b * z - c * y, c * x - a * z, a * y - b * x)  # as numpy, but at each tick
    return math.atan2(across, a * x + b * y + c * z)


def _turn_between(new: Points, old: Points) -> float:
    """Return the turn (rad) about the vertical that brings points (n, 2) nearest to old places."""
    cross = float((new[:, 0] * old[:, 1] - new[:, 1] * old[:, 0]).sum())
    dot = float((new * old).sum())
    return math.atan2(cross, dot) if math.hypot(cross, dot) > 1e-5 else 0.0
