"""What a virtual robot notices of the things around it: what its cameras see, and its sonars."""

from __future__ import annotations

import math

import numpy as np

from .body import Angles, Camera
from .driver import Thing, plain, state_of_thing
from .kinematics import Points, rotation
from .pose import VirtualRobot

# What a virtual robot runs into: things on the floor around it, seen from above.

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
        far_m = distance_m(thing, float(robot.base[0]), float(robot.base[1]))
        if thing.place[2] > LOW_M or far_m >= 2.0 * HALF_WIDTH_M:
            continue
        touched = {name for name, points in BUMPERS.items() if _touches(robot, thing, points)}
        if touched or (far_m < BODY_M and _approaches(robot, thing, way)):
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
    return np.where(meets, np.maximum(enters, 0.0), np.inf)


def _ways_to_circle_m(origin: Points, rays: Points, radius_m: float) -> Points:
    along = -(rays @ origin)
    beside = float(origin @ origin) - along**2
    inside = np.maximum(radius_m**2 - beside, 0.0)
    meets = (beside <= radius_m**2) & (along >= 0.0)
    return np.where(meets, np.maximum(along - np.sqrt(inside), 0.0), np.inf)


def half_size(thing: Thing) -> tuple[float, float]:
    """Return how far a thing reaches forward and to the side of its middle, m."""
    width, depth, _ = thing.size
    return depth / 2.0, width / 2.0


def seen_from(thing: Thing, places: Points) -> Points:
    """Return places on the floor (n, 2) as the thing sees them: x before it, y to its left."""
    dx, dy = places[:, 0] - thing.place[0], places[:, 1] - thing.place[1]
    cosine, sine = math.cos(thing.heading), math.sin(thing.heading)
    return np.column_stack([dx * cosine + dy * sine, dy * cosine - dx * sine])


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


def _approaches(robot: VirtualRobot, thing: Thing, way: Angles) -> bool:
    """Whether going on would bring the robot nearer to a thing that it touches."""
    x, y, theta = robot.base
    cosine, sine = math.cos(theta), math.sin(theta)
    step = 0.01 * way[:2] / max(float(np.hypot(*way[:2])), 1e-9)
    ahead_x, ahead_y = step[0] * cosine - step[1] * sine, step[0] * sine + step[1] * cosine
    here = distance_m(thing, float(x), float(y))
    return distance_m(thing, float(x + ahead_x), float(y + ahead_y)) < here - 1e-4


Place = tuple[float, float, float]

HALF_VIEW_RAD = (math.radians(60.97 / 2.0), math.radians(47.64 / 2.0))
"""What a camera sees to each side, and up and down. Source: NAO documentation, video cameras."""
SIGHT_M = {"person": 3.0, "ball": 3.0, "mark": 2.5}
TURNED_AWAY_RAD = math.radians(75.0)
"""A face or a mark that is turned further away than this is not seen."""
EYES_PART, LOWEST_EYES_PART = 0.93, 0.3
"""So high on a person are the eyes, of one who stands and of one who kneels."""
BENDING = 0.3
"""People bend down to a small robot, until they look down at it no more than this much a m."""
CLOSE_M, MIDDLE_M = 1.0, 2.0
FORGETTING_S = 1.0
"""What is out of sight for less than this is still taken to be there."""
SENSES = {"person": "face", "ball": "ball", "mark": "mark"}

SONAR_RANGE_M, SONAR_NEAREST_M = 2.55, 0.2
SONAR_HALF_RAD = (math.radians(30.0), 0.13)
"""How wide a sonar hears to each side, and up and down."""
SONAR_RAYS = 9


def distance_word(place: tuple[float, float, float]) -> str:
    """Return how far a person at a place (m from the robot's feet) is: close, middle or far."""
    way_m = math.hypot(*place[:2])
    return "close" if way_m < CLOSE_M else "middle" if way_m < MIDDLE_M else "far"


class Notice:
    """Keeps what a robot notices up to date, and says which human states follow from it."""

    def __init__(self, robot: VirtualRobot) -> None:
        self._robot = robot
        self._seen_s: dict[str, float] = {}
        self._distance = ""
        self._bumped: frozenset[str] = frozenset()

    def look(self, now_s: float) -> list[str]:
        """Look around; return the human states that follow from what is new."""
        robot = self._robot
        seen = visible(robot)
        self._seen_s |= dict.fromkeys(seen, now_s)
        kept = {
            key: place
            for key, place in robot.noticed.items()
            if now_s - self._seen_s.get(key, -math.inf) < FORGETTING_S
        }
        new = [key for key in seen if key not in robot.noticed]
        robot.noticed = kept | seen
        states = [state_of_thing(key) for key in reversed(new)]
        return [*self._bumps(), *states, *self._distance_states()]

    def _bumps(self) -> list[str]:
        """The bumpers by themselves that run into something, then what they are on."""
        new = sorted(self._robot.bumped - self._bumped)
        self._bumped = self._robot.bumped
        return [f"touched_{name}" for name in new] + (["touched_bumper"] if new else [])

    def _distance_states(self) -> list[str]:
        place = self._robot.noticed.get("face")
        x, y, _ = self._robot.base
        word = distance_word((place[0] - x, place[1] - y, 0.0)) if place else ""
        changed, self._distance = word != self._distance, word
        return [f"person_{word}"] if word and changed else []


def visible(robot: VirtualRobot) -> dict[str, Place]:
    """Return where what the robot sees is on the floor, by "face", "face_anna", "ball", ...

    Of several of a kind, the nearest is "face", "ball" or "mark".
    """
    if not robot.body.cameras:
        return {}
    eye = _eye(robot)
    seen: dict[str, Place] = {}
    for thing in seen_things(robot):
        sense, name, place = SENSES[thing.kind], _name(robot, thing), looked_at(thing, eye)
        seen.setdefault(sense, place)
        if name:
            seen.setdefault(f"{sense}_{name}", place)
    return seen


def seen_things(robot: VirtualRobot) -> list[Thing]:
    """Return the people, balls and marks that the robot sees, the nearest first."""
    if not robot.body.cameras:
        return []
    eye = _eye(robot)
    things = sorted(robot.things, key=lambda thing: math.dist(thing.place, eye))
    return [thing for thing in things if thing.kind in SENSES and _is_seen(robot, thing)]


def _name(robot: VirtualRobot, thing: Thing) -> str:
    """By what name the robot knows a thing; people by what it has learnt and forgotten."""
    return (
        robot.faces.name_of(thing.id, thing.name) if thing.kind == "person" else plain(thing.name)
    )


def sonar_m(robot: VirtualRobot, sonar: str) -> float:
    """Return how far the nearest thing before a sonar is (m), or its range when there is none."""
    built, stance = robot.body.sonars[sonar], robot.stance
    if stance.turn[2, 2] < 0.5 or not robot.things:
        return SONAR_RANGE_M
    start = stance.link_place(built.link, built.at_m)
    heading = math.atan2(stance.turn[1, 0], stance.turn[0, 0]) + built.yaw_rad
    side, upwards = SONAR_HALF_RAD
    turns = heading + np.linspace(-side, side, SONAR_RAYS)
    rays = np.column_stack([np.cos(turns), np.sin(turns)])
    nearest_m = SONAR_RANGE_M
    for thing in robot.things:
        way_m = float(ways_m(thing, start, rays).min())
        spread_m = way_m * math.tan(upwards)
        low, high = thing.place[2], thing.place[2] + thing.size[2]
        if way_m < nearest_m and low <= start[2] + spread_m and high >= start[2] - spread_m:
            nearest_m = way_m
    return round(max(SONAR_NEAREST_M, nearest_m), 3)


def looked_at(thing: Thing, eye: Points) -> Place:
    """Return what of a thing is looked at: the eyes of a person, who bends down, or its middle."""
    x, y, z = thing.place
    if thing.kind != "person":
        return x, y, z + 0.5 * thing.size[2]
    way_m = math.hypot(x - eye[0], y - eye[1])
    bent = max(float(eye[2]) + BENDING * way_m, z + LOWEST_EYES_PART * thing.size[2])
    return x, y, min(z + EYES_PART * thing.size[2], bent)


def _is_seen(robot: VirtualRobot, thing: Thing) -> bool:
    eye = _eye(robot)
    target = np.array(looked_at(thing, eye))
    if float(np.linalg.norm(target - eye)) > SIGHT_M[thing.kind]:
        return False
    if thing.kind != "ball" and _turned_away(thing, eye) > TURNED_AWAY_RAD:
        return False
    if not any(_in_view(robot, target, camera) for camera in robot.body.cameras):
        return False
    others = [other for other in robot.things if other.id != thing.id]
    return not any(_hides(other, eye, target) for other in others)


def _turned_away(thing: Thing, eye: Points) -> float:
    to_eye = math.atan2(eye[1] - thing.place[1], eye[0] - thing.place[0])
    return abs(math.remainder(to_eye - thing.heading, 2.0 * math.pi))


def _eye(robot: VirtualRobot) -> Points:
    """Return where the first camera is in the room."""
    return robot.stance.link_place("Head", robot.body.cameras[0].at_m)


def _in_view(robot: VirtualRobot, target: Points, camera: Camera) -> bool:
    stance = robot.stance
    turn = stance.link_turn("Head") @ rotation(0.0, camera.down_rad, 0.0)
    x, y, z = turn.T @ (target - stance.link_place("Head", camera.at_m))
    sideways, upwards = HALF_VIEW_RAD
    return x > 0.0 and abs(math.atan2(y, x)) < sideways and abs(math.atan2(z, x)) < upwards


def _hides(thing: Thing, eye: Points, target: Points) -> bool:
    """Whether a wall or a person stands between an eye and what it looks at."""
    if thing.kind not in ("wall", "person"):
        return False
    ends = seen_from(thing, np.array([eye[:2], target[:2]]))
    bottom = thing.place[2]
    low = np.array([*(-np.array(half_size(thing))), bottom])
    high = np.array([*half_size(thing), bottom + thing.size[2]])
    start, end = np.array([*ends[0], eye[2]]), np.array([*ends[1], target[2]])
    # Whether a way from a place goes through a box
    way = end - start
    safe = np.where(np.abs(way) < 1e-12, 1e-12, way)
    first, last = (low - start) / safe, (high - start) / safe
    enters = float(np.minimum(first, last).max())
    leaves = float(np.maximum(first, last).min())
    return max(enters, 0.0) < min(leaves, 1.0)
