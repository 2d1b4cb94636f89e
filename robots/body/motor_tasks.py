"""What a virtual robot does for requests about single motors.

A joint whose motor is off does not move, and nobody is told: so it is on the robot.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence

import numpy as np

from robots.errors import ActionFailed

from . import actions as m
from .actions import MoveJoint, WalkFreely
from .body import SINGLE_PARTS, Angles, Body, part_of, single_parts
from .gait import STEP_FORWARD_M, STEP_LEFT_M, STEP_TURN_RAD, walk
from .inverse import head_angles, in_torso, look_at_seen, place_of, torso_height_m
from .keyframes import Keyframes, Track
from .limbs import Limb
from .motion import TICK_S, Motion, keyframe_motion, move
from .pose import VirtualRobot
from .schedule import Task
from .tasks import check_fit_to_walk, play_motion, take_posture

# What a virtual robot does for requests about its joints: hands, single joints, locks, sleep.

HAND_SPEED = 0.4
STEPS_AT_ONCE = 10
LEG_PARTS = {"left_leg", "right_leg"}
SIDES = {"left": ("LHand",), "right": ("RHand",), "both": ("LHand", "RHand")}


def move_hands(robot: VirtualRobot, side: str, *, is_open: bool) -> Task:
    """Open or close hands."""
    columns = [robot.body.index[name] for name in SIDES[side]]
    goal = robot.angles.copy()
    goal[columns] = 1.0 if is_open else 0.0
    motion = move(robot.body, robot.angles, goal, columns, speed=HAND_SPEED)
    return (yield from play_motion(robot, motion))


def move_joint(robot: VirtualRobot, action: MoveJoint) -> Task:
    """Move a joint as far as it goes; joints with one motor move together."""
    body = robot.body
    motor = body.same_motor.get(action.joint, action.joint)
    columns = [body.index[name] for name in body.names if body.same_motor.get(name, name) == motor]
    start = robot.angles[columns] if action.relative else 0.0
    goal = robot.angles.copy()
    goal[columns] = start + math.radians(action.degrees)
    allowed, clamped = body.clamped(goal)
    motion = move(body, robot.angles, allowed, columns, speed=action.speed)
    yield from play_motion(robot, motion)
    if not clamped:
        return ""
    return f"moved as far as it goes: {math.degrees(allowed[columns[0]]):.0f} degrees"


HOLDS = 0.5
"""A joint that is held less firmly does not carry the body."""
STANDING_M = 0.28
"""A torso of a robot on feet that is higher than this is carried by its legs."""


def check_release(robot: VirtualRobot, family: str) -> None:
    """Raise ActionFailed when a robot stands; ``family`` of its posture is "" when unknown."""
    is_high = not family and torso_height_m(robot) > STANDING_M
    if family == "standing" or is_high:
        raise ActionFailed(
            "{name} stands on its legs: without their motors it would fall over. Let it rest, or "
            'do "posture_sit" first.',
            code="stands",
            checklist=(
                'Put the block "{name} rests" instead: it goes down, then releases all.',
                "Or let {name} sit before its legs are released.",
            ),
            name=robot.name,
        )


def lock(robot: VirtualRobot, part: str, *, on: bool) -> Task:
    """Lock or release the joints of a part. Raises ActionFailed for legs that it stands on."""
    parts = set(single_parts(part))
    if not on and parts & LEG_PARTS and robot.stance.skeleton.soles:
        check_release(robot, robot.family)
    robot.released = robot.released - parts if on else robot.released | parts
    robot.stiffness = {
        n: v for n, v in robot.stiffness.items() if part_of(robot.body, n) not in parts
    }
    yield
    return ""


def wake_up(robot: VirtualRobot) -> Task:
    """Lock all joints; stand up."""
    robot.released = frozenset()
    robot.stiffness = {}
    if robot.family != "standing":
        return (yield from take_posture(robot, "Stand"))
    yield
    return ""


def rest(robot: VirtualRobot) -> Task:
    """Go down, then release all joints."""
    yield from take_posture(robot, "Rest")
    robot.released = frozenset(SINGLE_PARTS)
    return ""


def check_walk(robot: VirtualRobot) -> None:
    """Raise ActionFailed when the robot is too hot to walk, or its battery too empty."""
    told = {name: robot.felt.get(f"temperature_{name}", 0.0) for name in robot.body.names}
    hottest = max(told.items(), key=lambda one: one[1])
    check_fit_to_walk(robot.name, hottest, robot.felt.get("battery", robot.battery))


def walk_freely(robot: VirtualRobot, action: WalkFreely) -> Task:
    """Walk on and on."""
    longest = np.array([STEP_FORWARD_M, STEP_LEFT_M, STEP_TURN_RAD])
    way = longest * [action.forward, action.left, action.turn] * STEPS_AT_ONCE
    if not way.any():
        return ""
    while True:
        forward, left, turn = way.tolist()
        yield from walk(robot, forward, left, turn, at_least_steps=STEPS_AT_ONCE)


def track(robot: VirtualRobot, action: m.Track) -> Task:
    """Turn to something, and remember to follow it with the head."""
    robot.settings["tracking"] = "" if action.using == "off" else action.thing
    if action.using == "off":
        yield
        return ""
    place = place_of(robot, action.thing)
    if action.using == "body":
        check_walk(robot)
        yaw, _ = head_angles(in_torso(robot, place, "world"), robot.body)
        yield from walk(robot, 0.0, 0.0, yaw)
    return (yield from look_at_seen(robot, action.thing))


def tracking_limbs(action: m.Track) -> frozenset[Limb]:
    """Return what following something moves."""
    if action.using == "off":
        return frozenset()
    return frozenset({Limb.HEAD, Limb.LEGS} if action.using == "body" else {Limb.HEAD})


TO_FULL_SPEED_S = 0.15
"""In this time a joint gets from rest to its top speed."""
NEAR_RAD = 1e-4


def stiffness(robot: VirtualRobot, joint: str) -> float:
    """Return how firmly a joint is held, 0 to 1."""
    if part_of(robot.body, joint) in robot.released:
        return 0.0
    return robot.stiffness.get(joint, 1.0)


def approach(robot: VirtualRobot, action: m.Approach) -> Task:
    """Go to the targets, which may change on the way; start and stop softly."""
    columns = robot.body.columns({action.limb})
    speed = np.zeros(len(columns))
    while action.targets:
        goal = _goal(robot, {joint: target.angle for joint, target in action.targets.items()})
        held = np.array([stiffness(robot, robot.body.names[column]) > 0.0 for column in columns])
        way = np.where(held, goal[columns] - robot.angles[columns], 0.0)
        speed = _next_speed(robot.body, columns, way, speed, _parts(robot.body, action.targets))
        _write(robot, columns, robot.angles[columns] + speed * TICK_S)
        if not speed.any():
            action.targets.clear()
        yield
    return ""


def reach(robot: VirtualRobot, action: m.ReachAngles) -> Task:
    """Move joints to angles, all in the time that the slowest one needs."""
    goal = _goal(robot, action.angles)
    columns = _columns(robot.body, action.angles)
    motion = move(
        robot.body, robot.angles, goal, columns, speed=action.speed, at_least_s=2 * TICK_S
    )
    return (yield from _play(robot, motion))


def move_through(robot: VirtualRobot, action: m.MoveThrough) -> Task:
    """Move joints through their keys."""
    tracks = {
        name: _allowed(robot, name, track, relative=action.relative)
        for name, track in action.tracks.items()
        if track.times
    }
    if not tracks:
        return ""
    keyframes = Keyframes(tracks)
    motion = keyframe_motion(robot.body, robot.angles, keyframes, softly=False)
    yield from _play(robot, motion)
    return "; ".join(motion.notes)


def at_pace(robot: VirtualRobot, task: Task, pace: float) -> Task:
    """Do a task so many times as fast: several of its ticks in one, or not one in each.

    In a tick that the task does not have, the robot is held as it was in the one before.
    """
    gone = 0.0
    try:
        while True:
            gone += pace
            while gone >= 1.0 - 1e-9:
                gone -= 1.0
                next(task)
            robot.stance.hold()
            yield
    except StopIteration as end:
        note: str = end.value
        return note
    finally:
        task.close()


def wait(seconds: float) -> Task:
    """Let some seconds pass."""
    for _ in range(round(seconds / TICK_S)):
        yield
    return ""


def set_stiffness(robot: VirtualRobot, action: m.SetStiffness) -> Task:
    """Set how firmly joints are held; a part of which no joint is held is released."""
    yield from wait(action.seconds)
    joints = action.joints
    before = {name: stiffness(robot, name) for name in robot.body.names}
    robot.stiffness = before | joints
    parts = {part_of(robot.body, name) for name in joints}
    loose = {
        part
        for part in SINGLE_PARTS
        if not any(robot.stiffness[n] for n in robot.body.names if part_of(robot.body, n) == part)
    }
    robot.released = robot.released - parts | (loose & parts)
    yield
    return ""


def _next_speed(
    body: Body, columns: list[int], way: Angles, speed: Angles, parts: Angles
) -> Angles:
    """Return the speeds (rad/s) for the next tick on a way (rad); all 0 when joints are there.

    ``parts``: of its top speed, how fast every joint of the body may be.
    """
    top_speed = body.max_speed[columns]
    fastest = top_speed * parts[columns]
    change = top_speed / TO_FULL_SPEED_S * TICK_S
    stopping = np.sqrt(2.0 * top_speed / TO_FULL_SPEED_S * np.abs(way))
    wanted = np.sign(way) * np.minimum(np.minimum(fastest, stopping), np.abs(way) / TICK_S)
    changed = speed + np.clip(wanted - speed, -change, change)
    arrived = (np.abs(way) <= NEAR_RAD + change * TICK_S) & (np.abs(speed) <= 2.0 * change)
    return np.where(arrived, np.where(np.abs(way) > NEAR_RAD, way / TICK_S, 0.0), changed)


def _parts(body: Body, targets: dict[str, m.Target]) -> Angles:
    parts = np.ones(len(body.names))
    for name, target in targets.items():
        parts[_columns(body, [name])] = target.speed
    return parts


def _goal(robot: VirtualRobot, angles: dict[str, float]) -> Angles:
    """Return the nearest allowed angles of every joint with some of them changed."""
    goal = robot.angles.copy()
    for name, angle in angles.items():
        goal[_columns(robot.body, [name])] = angle
    allowed, _ = robot.body.clamped(goal)
    return allowed


def _play(robot: VirtualRobot, motion: Motion) -> Task:
    for row in motion.angles:
        _write(robot, motion.columns, row)
        yield
    return ""


def _write(robot: VirtualRobot, columns: Sequence[int], row: Angles) -> None:
    """Set the angles of joints whose motors are on."""
    angles = robot.angles.copy()
    angles[list(columns)] = row
    allowed, _ = robot.body.clamped(angles)
    held = [column for column in columns if stiffness(robot, robot.body.names[column]) > 0.0]
    robot.angles[held] = allowed[held]


def _columns(body: Body, joints: Iterable[str]) -> list[int]:
    """Return where joints are in the joint order, with those that share a motor with them."""
    motors = {body.same_motor.get(name, name) for name in joints}
    return [i for i, name in enumerate(body.names) if body.same_motor.get(name, name) in motors]


def limbs_of_joints(body: Body, joints: Collection[str]) -> frozenset[Limb]:
    """Return the limbs that joints are in. Raises ActionFailed when there is no such joint."""
    for joint in joints:
        if joint not in body.index:
            raise ActionFailed(
                'There is no joint "{joint}". Possible: {names}.',
                joint=joint,
                names=", ".join(body.names),
            )
    return body.limbs_of(joints)


def _allowed(robot: VirtualRobot, joint: str, track: Track, *, relative: bool) -> Track:
    """Return a joint's keys within its limits, counted from where it is if they are relative."""
    column = robot.body.index[joint]
    start = float(robot.angles[column]) if relative else 0.0
    low, high = float(robot.body.min[column]), float(robot.body.max[column])
    keys = tuple(min(max(key + start, low), high) for key in track.keys)
    return Track(track.times, keys, track.handles)


# What a virtual robot does for requests about how it is set, and what it listens for.


def change_setting(robot: VirtualRobot, name: str, value: bool | float | str) -> Task:
    """Set a setting of the robot."""
    robot.settings[name] = value
    yield
    return ""


def listen(robot: VirtualRobot, words: list[str], seconds: float) -> Task:
    """Listen for words for some seconds; no words: for anything."""
    robot.listening = tuple(words) or ("",)
    try:
        for _ in range(max(1, round(seconds / TICK_S))):
            yield
    finally:
        robot.listening = ()
    return ""
