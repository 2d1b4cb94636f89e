"""Where a place is as the robot's head and arms see it: angles to look and to point at it."""

from __future__ import annotations

import math

import numpy as np

from faults import Text, text_of
from robots.errors import ActionFailed

from .body import Angles, Body
from .motion import move
from .pose import VirtualRobot
from .schedule import Task
from .tasks import look, play_motion

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
    """Stretch an arm out towards a place, as far as the shoulder goes."""
    goal, columns = pointing(robot, place, frame, side)
    allowed, clamped = robot.body.clamped(goal)
    motion = move(robot.body, robot.angles, allowed, columns, speed=POINTING_SPEED)
    yield from play_motion(robot, motion)
    return "pointed as far as its arm goes" if clamped else ""


def pointing(robot: VirtualRobot, place: Place, frame: str, side: str) -> tuple[Angles, list[int]]:
    """Return the angles of every joint while pointing, and which joints that moves."""
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
    """Return the arm to point with: the wanted one, else the one on the side of the place."""
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
