"""What a virtual robot runs into: things on the floor around it, seen from above."""

from __future__ import annotations

import math

import numpy as np

from nep_core.messages import Thing
from nodes.action.naobody.body import Angles
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.skeleton import Points

PLAIN_KINDS = {"person": "a person", "ball": "a ball", "wall": "a wall", "mark": "a mark"}
BUMPERS = {
    "bumper_left": (("L_ankle", (0.1, 0.019)), ("L_ankle", (0.1, -0.014))),
    "bumper_right": (("R_ankle", (0.1, 0.014)), ("R_ankle", (0.1, -0.019))),
}
"""Where the front of each foot is, before the ankle and to its left, m."""
HALF_WIDTH_M = 0.12
"""So far to each side the robot's arms reach while it walks."""
BODY_M = 0.09
"""So near to its middle the robot runs into something with its body."""
LOW_M = 0.5
"""What begins higher above the floor than this is not in the way."""


def bump(robot: VirtualRobot, way: Angles) -> str:
    """Return what the robot runs into on its way, "" for nothing; bumpers that touch it feel it."""
    robot.bumped = frozenset()
    for thing in robot.things:
        if thing.place[2] > LOW_M or not _is_near(robot, thing):
            continue
        touched = {name for name, points in BUMPERS.items() if _touches(robot, thing, points)}
        if touched or (_body_touches(robot, thing) and _approaches(robot, thing, way)):
            robot.bumped = frozenset(touched)
            return PLAIN_KINDS[thing.kind]
    return ""


def distance_m(thing: Thing, x: float, y: float) -> float:
    """Return how far a place on the floor is outside a thing; below 0: inside it."""
    seen = seen_from(thing, np.array([[x, y]]))[0]
    if thing.kind == "ball":
        return math.hypot(*seen) - thing.size[0] / 2.0
    half = np.array(half_size(thing))
    outside = np.maximum(np.abs(seen) - half, 0.0)
    inside = float(np.max(np.abs(seen) - half))
    return float(np.hypot(*outside)) if outside.any() else inside


def ways_m(thing: Thing, start: Points, rays: Points) -> Points:
    """Return how far rays (n, 2) over the floor go from a place until they meet a thing, or inf."""
    cosine, sine = math.cos(thing.heading), math.sin(thing.heading)
    origin = seen_from(thing, start[None, :2])[0]
    into = rays @ np.array([[cosine, -sine], [sine, cosine]])
    if thing.kind == "ball":
        return _ways_to_circle_m(origin, into, thing.size[0] / 2.0)
    half = np.array(half_size(thing))
    safe = np.where(np.abs(into) < 1e-12, 1e-12, into)
    first, last = (-half - origin) / safe, (half - origin) / safe
    enters = np.minimum(first, last).max(axis=1)
    leaves = np.maximum(first, last).min(axis=1)
    meets = (leaves >= np.maximum(enters, 0.0)) & (leaves >= 0.0)
    ways: Points = np.where(meets, np.maximum(enters, 0.0), np.inf)
    return ways


def _ways_to_circle_m(origin: Points, rays: Points, radius_m: float) -> Points:
    along = -(rays @ origin)
    beside = float(origin @ origin) - along**2
    inside = np.maximum(radius_m**2 - beside, 0.0)
    meets = (beside <= radius_m**2) & (along >= 0.0)
    ways: Points = np.where(meets, np.maximum(along - np.sqrt(inside), 0.0), np.inf)
    return ways


def half_size(thing: Thing) -> tuple[float, float]:
    """Return how far a thing reaches forward and to the side of its middle, m."""
    width, depth, _ = thing.size
    return depth / 2.0, width / 2.0


def seen_from(thing: Thing, places: Points) -> Points:
    """Return places on the floor (n, 2) as the thing sees them: x before it, y to its left."""
    dx, dy = places[:, 0] - thing.place[0], places[:, 1] - thing.place[1]
    cosine, sine = math.cos(thing.heading), math.sin(thing.heading)
    return np.column_stack([dx * cosine + dy * sine, dy * cosine - dx * sine])


def _is_near(robot: VirtualRobot, thing: Thing) -> bool:
    x, y, _ = robot.base
    return distance_m(thing, float(x), float(y)) < 2.0 * HALF_WIDTH_M


def _touches(
    robot: VirtualRobot, thing: Thing, points: tuple[tuple[str, tuple[float, float]], ...]
) -> bool:
    if not robot.stance.skeleton.soles:
        return False
    for link, (ahead, left) in points:
        x, y, _ = robot.stance.link_place(link, (ahead, left, -0.035))
        if distance_m(thing, float(x), float(y)) <= 0.0:
            return True
    return False


def _body_touches(robot: VirtualRobot, thing: Thing) -> bool:
    x, y, _ = robot.base
    return distance_m(thing, float(x), float(y)) < BODY_M


def _approaches(robot: VirtualRobot, thing: Thing, way: Angles) -> bool:
    """Whether going on would bring the robot nearer to a thing that it touches."""
    x, y, theta = robot.base
    cosine, sine = math.cos(theta), math.sin(theta)
    step = 0.01 * way[:2] / max(float(np.hypot(*way[:2])), 1e-9)
    ahead_x, ahead_y = step[0] * cosine - step[1] * sine, step[0] * sine + step[1] * cosine
    here = distance_m(thing, float(x), float(y))
    return distance_m(thing, float(x + ahead_x), float(y + ahead_y)) < here - 1e-4
