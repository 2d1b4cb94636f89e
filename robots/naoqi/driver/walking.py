"""What a real robot does for requests to walk, to turn, to look and to follow."""

from __future__ import annotations

import math

from faults import Text
from robots.body import actions as b
from robots.body.gaze import arm_for, head_angles, in_torso, pointing
from robots.body.limbs import MOVING
from robots.body.schedule import Task
from robots.body.tasks import DOES_NOT_STAND
from robots.errors import ActionFailed

from .calls import Calling
from .real import RealRobot

SLOWEST_M_S = 0.03
SLOWEST_RAD_S = 0.12
LONGEST_TURN_RAD = 2.6
"""NAOqi takes the short way round: it must not be asked for more than half a turn."""
OFF_M, OFF_PART = 0.08, 0.25
LOOKING_SPEED, POINTING_SPEED = 0.3, 0.3
NOUNS = {"face": "a face", "ball": "the red ball", "mark": "a mark", "sound": "a sound"}
TARGETS: dict[str, tuple[str, object]] = {
    "face": ("Face", 0.15),
    "ball": ("RedBall", 0.06),
    "sound": ("Sound", [1.0, 0.4]),
}
"""What NAOqi can follow: its name, and how large (m) or how sure it is."""


def walk(robot: RealRobot, forward_m: float, left_m: float, turn: float) -> Task:
    """Walk over the floor, turning by ``turn`` rad on the way, and look how far it got."""
    _check_standing(robot)
    if not (forward_m or left_m or turn):
        return ""
    start = yield from _place(robot)
    pieces = max(1, math.ceil(abs(turn) / LONGEST_TURN_RAD))
    for piece in range(pieces):
        way = _piece(forward_m, left_m, turn, piece, pieces)
        limit_s = 15.0 + math.hypot(*way[:2]) / SLOWEST_M_S + abs(way[2]) / SLOWEST_RAD_S
        yield from robot.call("ALMotion", "moveTo", *way, limit_s=limit_s, uses=robot.names(MOVING))
    end = yield from _place(robot)
    _check_way(robot, start, end, (forward_m, left_m, turn))
    posture = yield from robot.call("ALRobotPosture", "getPosture")
    robot.known.posture = str(posture)
    return ""


def walk_freely(robot: RealRobot, action: b.WalkFreely) -> Task:
    """Walk on and on."""
    _check_standing(robot)
    speeds = float(action.forward), float(action.left), float(action.turn)
    if not any(speeds):
        return ""
    try:
        yield from robot.call("ALMotion", "moveToward", *speeds, limit_s=5.0)
        while True:
            yield
    finally:
        robot.calls.tell("ALMotion", "stopMove")


def look(robot: RealRobot, yaw: float, pitch: float) -> Task:
    """Turn the head as far as it goes towards a direction (rad)."""
    goal, clamped = robot.goal_of({"HeadYaw": yaw, "HeadPitch": pitch})
    yield from robot.go_to(goal, LOOKING_SPEED)
    if not clamped:
        return ""
    yaw_deg, pitch_deg = math.degrees(goal["HeadYaw"]), math.degrees(goal["HeadPitch"])
    return (
        f"looked as far as its head goes: {yaw_deg:.0f} degrees to the left, {pitch_deg:.0f} down"
    )


def look_at(robot: RealRobot, place: tuple[float, float, float], frame: str) -> Task:
    """Turn the head to a place."""
    yield from _place(robot)
    yaw, pitch = head_angles(in_torso(robot.known, place, frame), robot.known.body)
    return (yield from look(robot, yaw, pitch))


def look_at_seen(robot: RealRobot, thing: str) -> Task:
    """Turn the head to something that the robot notices."""
    if thing not in robot.known.sees:
        raise ActionFailed(
            "{name} does not notice {get} now.", name=robot.name, get=Text(NOUNS.get(thing, thing))
        )
    return (yield from look_at(robot, robot.known.sees[thing], "world"))


def point_at(robot: RealRobot, action: b.PointAt) -> Task:
    """Stretch an arm out towards a place, as far as the shoulder goes."""
    yield from _place(robot)
    place = action.x_m, action.y_m, action.z_m
    side = arm_for(robot.known, place, action.frame, action.arm)
    goal, columns = pointing(robot.known, place, action.frame, side)
    names = [robot.known.body.names[column] for column in columns]
    allowed, clamped = robot.goal_of(robot.picked(goal, names))
    hands = {name: angle for name, angle in allowed.items() if name.endswith("Hand")}
    for hand in hands:
        robot.calls.tell("ALMotion", "setAngles", [hand], [allowed.pop(hand)], 0.5)
    yield from robot.go_to(allowed, POINTING_SPEED)
    return "pointed as far as its arm goes" if clamped else ""


def track(robot: RealRobot, action: b.Track) -> Task:
    """Keep the head or the whole body turned to something, until that is ended."""
    yield from robot.call("ALTracker", "stopTracker")
    yield from robot.call("ALTracker", "unregisterAllTargets")
    robot.known.settings["tracking"] = ""
    if action.using == "off":
        return ""
    if action.thing not in TARGETS:
        known = ", ".join(TARGETS)
        raise ActionFailed(
            '{name} cannot follow "{thing}". Possible: {known}.',
            name=robot.name,
            thing=action.thing,
            known=known,
        )
    name, size = TARGETS[action.thing]
    yield from robot.call("ALTracker", "registerTarget", name, size)
    mode = "Head" if action.using == "head" else "Move"
    yield from robot.call("ALTracker", "setMode", mode)
    yield from robot.call("ALTracker", "track", name)
    active = yield from robot.call("ALTracker", "getActiveTarget")
    if active != name:
        raise ActionFailed("{name} does not follow: it did not take that in.", name=robot.name)
    robot.known.settings["tracking"] = action.thing
    return ""


def _place(robot: RealRobot) -> Calling:
    told = yield from robot.call("ALMotion", "getRobotPosition", True)
    place = robot.be_at(told)
    yield from robot.measure(robot.names(MOVING))
    robot.stand_as_told()
    return place


def _check_standing(robot: RealRobot) -> None:
    postures = robot.known.body.postures
    family = postures[robot.known.posture].family if robot.known.posture in postures else ""
    if family in DOES_NOT_STAND:
        raise ActionFailed(
            '{name} {family}: it must stand before it can walk. Let it do "posture_stand" first.',
            name=robot.name,
            family=Text(DOES_NOT_STAND[family]),
        )


def _piece(
    forward_m: float, left_m: float, turn: float, piece: int, pieces: int
) -> tuple[float, float, float]:
    """One of several equal parts of a turn; all of the way is in the first."""
    if piece == 0:
        return float(forward_m), float(left_m), turn / pieces
    return 0.0, 0.0, turn / pieces


def _check_way(
    robot: RealRobot,
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    asked: tuple[float, float, float],
) -> None:
    """Raise ActionFailed when the robot is far from where it was to go."""
    east, north = end[0] - start[0], end[1] - start[1]
    cosine, sine = math.cos(start[2]), math.sin(start[2])
    forward, left = east * cosine + north * sine, north * cosine - east * sine
    way = math.hypot(asked[0], asked[1])
    off = math.hypot(forward - asked[0], left - asked[1])
    if off > OFF_M + OFF_PART * way:
        raise ActionFailed(
            "{name} got only {hypot} m of {way} m far. Look whether something is in its way.",
            name=robot.name,
            hypot=f"{math.hypot(forward, left):.2f}",
            way=f"{way:.2f}",
        )
