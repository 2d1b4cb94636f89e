"""How NAO ends a walk in the middle of a step: it puts its feet side by side."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nodes.action.naobody.body import Angles
from nodes.action.naobody.curves import minimum_jerk, ticks
from nodes.action.naobody.gait import FOOT_LIFT_M
from nodes.action.naobody.legs import leg_sizes, write_legs
from nodes.action.naobody.limbs import Limb
from nodes.action.naobody.motion import TICK_S, Motion
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.skeleton import Points, turned
from nodes.action.naobody.stance import Carried

JOINING_S = 0.5
FASTEST_PART = 0.9
TRIES = 4
SIDES = {"L": 1.0, "R": -1.0}
SOLE_DOWN_M = 0.04511
BESIDE_M = 0.005
"""Feet that are so near to where they belong need not be lifted."""


@dataclass(frozen=True)
class Joining:
    """The legs' movement, where the torso is meanwhile, and the base at the end."""

    legs: Motion
    guides: list[Carried]
    base: Angles


@dataclass(frozen=True)
class _Foot:
    place: Points
    heading: float


def plan_joining(robot: VirtualRobot, standing: Angles) -> Joining:
    """Return how a walking robot comes to stand. ``standing``: every joint when it stands still."""
    feet = {side: _foot(robot, side) for side in SIDES}
    firm = min(feet, key=lambda side: _looseness(robot, feet[side]))
    there = _Foot(feet[firm].place, feet[firm].heading)
    middle = there.place + turned(there.heading) @ [
        0.0,
        -SIDES[firm] * leg_sizes(robot.body).hip_left,
        0.0,
    ]
    base = np.array([middle[0], middle[1], there.heading])
    seconds = JOINING_S
    for _ in range(TRIES):
        angles, guides = _planned(robot, standing, feet, firm, base, seconds)
        steps = np.abs(np.diff(angles, axis=0, prepend=robot.angles[None]))
        part = float((steps / TICK_S / robot.body.max_speed).max())
        if part <= FASTEST_PART:
            break
        seconds *= part / FASTEST_PART
    columns = robot.body.columns({Limb.LEGS})
    return Joining(Motion(tuple(columns), angles[:, columns]), guides, base)


def _planned(
    robot: VirtualRobot,
    standing: Angles,
    feet: dict[str, _Foot],
    firm: str,
    base: Angles,
    seconds: float,
) -> tuple[Angles, list[Carried]]:
    skeleton, stance = robot.stance.skeleton, robot.stance
    part = minimum_jerk(ticks(seconds, TICK_S) / seconds)
    lean = skeleton.resting_turn(standing)
    heading = math.atan2(stance.turn[1, 0], stance.turn[0, 0])
    yaw = heading + part * math.remainder(base[2] - heading, 2.0 * math.pi)
    feet_middle = lean @ skeleton.feet_middle(skeleton.transforms(standing))
    goal = np.array([*base[:2], SOLE_DOWN_M]) - turned(float(base[2])) @ feet_middle
    torso = stance.place + part[:, None] * (goal - stance.place)
    ankles, yaws = {}, {}
    for side, sign in SIDES.items():
        aside_m = sign * leg_sizes(robot.body).hip_left
        places, yaws[side] = _way(feet[side], base, aside_m, part)
        ankles[side] = _level(places - torso, yaw) @ lean
    angles = np.repeat(standing[None, :], len(part), axis=0)
    write_legs(robot.body, angles, ankles, lean[2], yaws["L"] - yaws["R"])
    first = angles[0].copy()
    angles += (1.0 - part)[:, None] * (robot.angles - first)
    guides = [
        Carried(turned(float(turn)) @ lean, float(x), float(y))
        for turn, (x, y, _) in zip(yaw, torso, strict=True)
    ]
    return robot.body.clamped(angles)[0], guides


def _foot(robot: VirtualRobot, side: str) -> _Foot:
    link = f"{side}_ankle"
    turn = robot.stance.link_turn(link)
    return _Foot(robot.stance.link_place(link), math.atan2(turn[1, 0], turn[0, 0]))


def _looseness(robot: VirtualRobot, foot: _Foot) -> float:
    """Return how little a foot carries: the higher it is, or the farther from below the mass."""
    away_m = float(np.linalg.norm(foot.place[:2] - robot.stance.centre_of_mass[:2]))
    return float(foot.place[2]) + 0.01 * away_m


def _way(foot: _Foot, base: Angles, aside_m: float, part: Angles) -> tuple[Points, Angles]:
    """Return where a foot is while it comes to its side of the base, and how it is turned."""
    goal = np.array([*base[:2], SOLE_DOWN_M])
    goal += turned(float(base[2])) @ [0.0, aside_m, 0.0]
    way = goal - foot.place
    places = foot.place + part[:, None] * way
    if float(np.hypot(*way[:2])) > BESIDE_M:
        places[:, 2] += np.sin(np.pi * part) ** 2 * FOOT_LIFT_M
    turn = math.remainder(base[2] - foot.heading, 2.0 * math.pi)
    return places, foot.heading + part * turn


def _level(vectors: Points, yaw: Angles) -> Points:
    """Return vectors (ticks, 3) of the room as something sees them that is turned by ``yaw``."""
    cosine, sine = np.cos(yaw), np.sin(yaw)
    x, y, z = vectors.T
    return np.column_stack([x * cosine + y * sine, y * cosine - x * sine, z])
