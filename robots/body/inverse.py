"""Inverse kinematics: the joint angles that bring points of the body to places, within limits.

Damped least squares with joints that stop at their limits. Source: S. R. Buss and J.-S. Kim,
Selectively damped least squares for inverse kinematics, J. Graphics Tools 10, 2005. For looking
and pointing the angles are worked out directly.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from faults import Text, text_of
from robots.errors import ActionFailed

from .body import Angles, Body
from .keyframes import mirror_angle
from .kinematics import TORSO, Frames, Points, Skeleton
from .motion import move
from .pose import VirtualRobot
from .schedule import Task
from .tasks import look, play_motion

STEPS = 12
DAMPING = 0.012
"""In m per rad: what a joint may turn to come nearer by this much less."""
LARGEST_TURN_RAD = 0.35
"""In one step; a joint's way is straight for no longer."""
LEAST_GAIN = 1e-3
"""A step that brings it nearer by less than this part is the last one."""
NEAR_M = 5e-4
NEAR_RAD = 0.005
TURN_WEIGHT_M = 0.06
"""What a rad in the wrong direction weighs, in m."""


@dataclass(frozen=True)
class Goal:
    """A point of a link (m, in its frame) that is to come to a place (m, in the torso's frame).

    ``turn``: how the link is to be turned (3, 3, in the torso's frame), None where that is free.
    """

    link: str
    point: tuple[float, float, float]
    place: Points
    turn: Frames | None = None


class Reach:
    """Moves the joints of one skeleton so that points of its links come to places."""

    def __init__(self, skeleton: Skeleton) -> None:
        self.skeleton, self.body = skeleton, skeleton.body
        turning = [(i, joint) for i, joint in enumerate(self.body.joints) if joint.child]
        self._joint_of = {joint.child: i for i, joint in turning}
        self._parent = {joint.child: joint.parent for _, joint in turning}
        axes = {joint.child: np.array(joint.axis) for _, joint in turning}
        self._axes = {link: axis / np.linalg.norm(axis) for link, axis in axes.items()}
        followers = self.body.same_motor
        self._shared = {self.body.index[n] for pair in followers.items() for n in pair}

    def columns(self, link: str) -> list[int]:
        """Where the joints between the torso and a link are in the body's joint order.

        Joints that share a motor with another limb's are left out: they would move that one too.
        """
        return [c for _, c in self._chain(link) if c not in self._shared]

    def place(self, angles: Angles, link: str, point: Sequence[float]) -> Points:
        """Where a point of a link is, in the torso's frame."""
        frame = self.skeleton.transforms(angles)[self.skeleton.index[link]]
        place: Points = frame[:3, :3] @ np.asarray(point) + frame[:3, 3]
        return place

    def reached(self, angles: Angles, *goals: Goal, steps: int = STEPS) -> Angles:
        """Return angles that bring the points as near to their places as the joints allow.

        Other joints stay. The angles are always such as the body can have.
        """
        columns = sorted({c for goal in goals for c in self.columns(goal.link)})
        best = now = self.body.clamped(angles)[0]
        least = np.inf
        for _ in range(steps + 1):
            frames = self.skeleton.transforms(now)
            wrong = np.concatenate([self._wrong(frames, goal) for goal in goals])
            size = float(wrong @ wrong)
            gained = least - size
            if gained > 0.0:
                best, least = now, size
            if gained < LEAST_GAIN * size or self._is_near(wrong, goals):
                break
            jacobian = np.vstack([self._jacobian(frames, goal, columns) for goal in goals])
            now = self._stepped(now, columns, jacobian, wrong)
        return best

    def _chain(self, link: str) -> list[tuple[str, int]]:
        """The links from the torso to one, each with the column of the joint that turns it."""
        found: list[tuple[str, int]] = []
        while link != TORSO:
            found.append((link, self._joint_of[link]))
            link = self._parent[link]
        return found[::-1]

    def _wrong(self, frames: Frames, goal: Goal) -> Points:
        """What is missing to a goal: m, and where the turn counts rad, weighted."""
        frame = frames[self.skeleton.index[goal.link]]
        way = goal.place - frame[:3, :3] @ np.asarray(goal.point) - frame[:3, 3]
        if goal.turn is None:
            return np.asarray(way)
        return np.append(way, TURN_WEIGHT_M * turn_between(frame[:3, :3], goal.turn))

    def _jacobian(self, frames: Frames, goal: Goal, columns: list[int]) -> Points:
        """How the point (and the turn) move for each of the joints: (3 or 6, columns)."""
        index = self.skeleton.index
        frame = frames[index[goal.link]]
        point = frame[:3, :3] @ np.asarray(goal.point) + frame[:3, 3]
        rows = np.zeros((3 if goal.turn is None else 6, len(columns)))
        for link, column in self._chain(goal.link):
            if column not in columns:
                continue
            own = frames[index[link]]
            axis = own[:3, :3] @ self._axes[link]
            at = columns.index(column)
            rows[:3, at] = _crossed(axis, point - own[:3, 3])
            if goal.turn is not None:
                rows[3:, at] = TURN_WEIGHT_M * axis
        return rows

    def _stepped(
        self, angles: Angles, columns: list[int], jacobian: Points, wrong: Points
    ) -> Angles:
        """One step; a joint at its limit that would go beyond it lets the others do it."""
        free = list(range(len(columns)))
        low, high = self._limits(angles, columns)
        now = angles[columns]
        change = np.zeros(len(columns))
        while free:
            part = jacobian[:, free]
            square = part @ part.T + DAMPING**2 * np.eye(len(wrong))
            change[:] = 0.0
            change[free] = part.T @ np.linalg.solve(square, wrong)
            change *= min(1.0, LARGEST_TURN_RAD / max(float(np.abs(change).max()), 1e-12))
            beyond = [
                i
                for i in free
                if (now[i] >= high[i] - 1e-9 and change[i] > 0.0)
                or (now[i] <= low[i] + 1e-9 and change[i] < 0.0)
            ]
            if not beyond:
                break
            free = [i for i in free if i not in beyond]
        result = angles.copy()
        result[columns] = np.clip(now + change, low, high) if free else now
        return self.body.clamped(result)[0]

    def _limits(self, angles: Angles, columns: list[int]) -> tuple[Angles, Angles]:
        """The limits of some joints; the head nods as far as the shell lets it as it is turned."""
        low, high = self.body.min[columns], self.body.max[columns]
        yaw, pitch = self.body.head
        if pitch in columns:
            at = columns.index(pitch)
            least, most = self.body.pitch_limits(angles[yaw])
            low[at], high[at] = max(low[at], float(least)), min(high[at], float(most))
        return low, high

    @staticmethod
    def _is_near(wrong: Points, goals: Sequence[Goal]) -> bool:
        at = 0
        for goal in goals:
            if np.linalg.norm(wrong[at : at + 3]) > NEAR_M:
                return False
            at += 3
            if goal.turn is not None:
                if np.linalg.norm(wrong[at : at + 3]) > NEAR_RAD * TURN_WEIGHT_M:
                    return False
                at += 3
        return True


def twist_of(turn: Frames) -> Points:
    """Return the axis of a rotation, twice as long as the sine of its angle."""
    return np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])


def turn_between(now: Frames, goal: Frames) -> Points:
    """Return the turn (axis times rad, in the outer frame) that brings one rotation to another."""
    between = goal @ now.T
    axis = twist_of(between)
    sine, cosine = float(np.linalg.norm(axis)) / 2.0, (float(np.trace(between)) - 1.0) / 2.0
    if sine < 1e-9:
        return np.zeros(3) if cosine > 0.0 else np.array([np.pi, 0.0, 0.0])
    turn: Points = axis / (2.0 * sine) * np.arctan2(sine, cosine)
    return turn


def mirrored_pose(angles: dict[str, float]) -> dict[str, float]:
    """Return angles for the other side of the body, as in a mirror; the head's stay."""
    found = {}
    for name, angle in angles.items():
        if name[:1] in "LR" and not name.startswith("Head"):
            found[{"L": "R", "R": "L"}[name[0]] + name[1:]] = mirror_angle(name, angle)
    return found


def _crossed(a: Points, b: Points) -> Points:
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


# Where a place is as the robot's head and arms see it: angles to look and to point at it.

Place = tuple[float, float, float]

NECK_M = 0.1265
POINTING_SPEED = 0.3
NOUNS = {"face": "a face", "ball": "the red ball", "mark": "a mark"}
NAMED = {"face": "the face {name}", "mark": "the mark {name}"}


def torso_height_m(robot: VirtualRobot) -> float:
    """Return how high the torso is above the floor."""
    return float(robot.stance.place[2])


def in_torso(robot: VirtualRobot, place: Place, frame: str) -> Place:
    """Return a place (m) of a frame as seen from the torso: robot is at its feet, world the floor.

    The torso may lean.
    """
    if frame == "torso":
        return place
    world = np.array(place if frame == "world" else to_world(robot, place))
    x, y, z = robot.stance.turn.T @ (world - robot.stance.place)
    return float(x), float(y), float(z)


def from_world(robot: VirtualRobot, place: Place) -> Place:
    """Return a place on the floor as seen from the robot's feet."""
    x, y = place[0] - robot.base[0], place[1] - robot.base[1]
    cosine, sine = math.cos(robot.base[2]), math.sin(robot.base[2])
    return float(x * cosine + y * sine), float(y * cosine - x * sine), place[2]


def to_world(robot: VirtualRobot, place: Place) -> Place:
    """Return a place seen from the robot's feet as one on the floor."""
    x, y, z = place
    cosine, sine = math.cos(robot.base[2]), math.sin(robot.base[2])
    return (
        float(robot.base[0] + x * cosine - y * sine),
        float(robot.base[1] + x * sine + y * cosine),
        z,
    )


def head_angles(place: Place, body: Body) -> tuple[float, float]:
    """Return yaw and pitch (rad) that turn the head to a place in the torso's frame."""
    x, y, z = _from_joint(place, body, "HeadYaw")
    return math.atan2(y, x), -math.atan2(z, math.hypot(x, y))


def arm_angles(place: Place, side: str, body: Body) -> tuple[float, float]:
    """Return the pitch and roll (rad) of a shoulder that point its straight arm at a place."""
    x, y, z = _from_joint(place, body, "LShoulderPitch" if side == "left" else "RShoulderPitch")
    way = max(math.hypot(x, y, z), 1e-6)
    return math.atan2(-z, x), math.asin(y / way)


def _from_joint(place: Place, body: Body, joint: str) -> Place:
    """Return a place of the torso's frame as seen from a joint at the torso."""
    x, y, z = body.origin_m(joint)
    return place[0] - x, place[1] - y, place[2] - z


def look_at(robot: VirtualRobot, place: Place, frame: str) -> Task:
    """Turn the head to a place as far as it goes."""
    yaw, pitch = head_angles(in_torso(robot, place, frame), robot.body)
    return (yield from look(robot, yaw, pitch))


def point_at(robot: VirtualRobot, place: Place, frame: str, side: str) -> Task:
    """Stretch an arm out towards a place, as far as the shoulder goes.

    ``robot`` points with the arm of a ``side``, "left" or "right", to ``place`` (x, y, z), m,
    in a ``frame``.
    """
    goal, columns = pointing(robot, place, frame, side)
    allowed, clamped = robot.body.clamped(goal)
    motion = move(robot.body, robot.angles, allowed, columns, speed=POINTING_SPEED)
    yield from play_motion(robot, motion)
    return "pointed as far as its arm goes" if clamped else ""


def pointing(robot: VirtualRobot, place: Place, frame: str, side: str) -> tuple[Angles, list[int]]:
    """Return the angles of every joint while pointing, and which joints that moves.

    ``robot`` points with the arm of a ``side``, "left" or "right", to ``place`` (x, y, z), m,
    in a ``frame``.
    """
    pitch, roll = arm_angles(in_torso(robot, place, frame), side, robot.body)
    letter, bend = ("L", -0.0349) if side == "left" else ("R", 0.0349)
    joints = {"ShoulderPitch": pitch, "ShoulderRoll": roll, "ElbowYaw": 0.0, "ElbowRoll": bend}
    joints |= {"WristYaw": 0.0, "Hand": 1.0}
    index = robot.body.index
    there = {index[letter + name]: rad for name, rad in joints.items() if letter + name in index}
    goal = robot.angles.copy()
    goal[list(there)] = list(there.values())
    return goal, list(there)


def arm_for(robot: VirtualRobot, place: Place, frame: str, arm: str) -> str:
    """Return the arm to point with: the wanted one, else the one on the side of the place.

    ``robot`` is who points, to ``place`` (x, y, z), m, in a ``frame``.
    """
    return arm or ("left" if in_torso(robot, place, frame)[1] >= 0 else "right")


def place_of(robot: VirtualRobot, thing: str) -> Place:
    """Return where on the floor (world frame) something is that the robot sees.

    Raises ActionFailed when it sees none.
    """
    seen = robot.seen
    if thing not in seen:
        kind, _, name = thing.partition("_")
        if kind == "sound":
            raise ActionFailed(
                "{name} does not hear a sound. Make one, or try it with a real NAO.",
                name=robot.name,
            )
        is_named = name and kind in NAMED
        noun = text_of(NAMED[kind], name=name) if is_named else Text(NOUNS.get(kind, thing))
        raise ActionFailed(
            "{name} does not see {noun}. Show it one, or try it with a real NAO.",
            name=robot.name,
            noun=noun,
        )
    return seen[thing]


def look_at_seen(robot: VirtualRobot, thing: str) -> Task:
    """Turn the head to something that the robot sees now."""
    return (yield from look_at(robot, place_of(robot, thing), "world"))
