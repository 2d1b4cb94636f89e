"""What a virtual robot does for requests about its joints: hands, single joints, locks, sleep."""

from __future__ import annotations

import math

import numpy as np

from nep_core.errors import ActionFailed
from nodes.action.naobody.body import Body
from nodes.action.naobody.body_actions import MoveJoint, Track, WalkFreely
from nodes.action.naobody.gait import STEP_FORWARD_M, STEP_LEFT_M, STEP_TURN_RAD
from nodes.action.naobody.gaze import head_angles, in_torso, look_at_seen, place_of
from nodes.action.naobody.limbs import Limb
from nodes.action.naobody.motion import move
from nodes.action.naobody.parts import SINGLE_PARTS, part_of, single_parts
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task
from nodes.action.naobody.tasks import play_motion, take_posture
from nodes.action.naobody.walking import walk

HAND_SPEED = 0.4
STEPS_AT_ONCE = 10
SIDES = {"left": ("LHand",), "right": ("RHand",), "both": ("LHand", "RHand")}


def move_hands(robot: VirtualRobot, side: str, *, is_open: bool) -> Task:
    """Open or close hands."""
    columns = [robot.body.index[name] for name in SIDES[side]]
    goal = robot.angles.copy()
    goal[columns] = 1.0 if is_open else 0.0
    motion = move(robot.body, robot.angles, goal, columns, speed=HAND_SPEED)
    return (yield from play_motion(robot, motion))


def check_joint(body: Body, joint: str) -> None:
    """Raise ActionFailed with the joints that there are when there is no such one."""
    if joint not in body.index:
        raise ActionFailed(f'There is no joint "{joint}". Possible: {", ".join(body.names)}.')


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


def lock(robot: VirtualRobot, part: str, *, on: bool) -> Task:
    """Lock or release the joints of a part."""
    parts = set(single_parts(part))
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


def walk_freely(robot: VirtualRobot, action: WalkFreely) -> Task:
    """Walk on and on."""
    longest = np.array([STEP_FORWARD_M, STEP_LEFT_M, STEP_TURN_RAD])
    way = longest * [action.forward, action.left, action.turn] * STEPS_AT_ONCE
    if not way.any():
        return ""
    while True:
        forward, left, turn = way.tolist()
        yield from walk(robot, forward, left, turn, at_least_steps=STEPS_AT_ONCE)


def track(robot: VirtualRobot, action: Track) -> Task:
    """Turn to something, and remember to follow it with the head."""
    robot.settings["tracking"] = "" if action.using == "off" else action.thing
    if action.using == "off":
        yield
        return ""
    place = place_of(robot, action.thing)
    if action.using == "body":
        yaw, _ = head_angles(in_torso(robot, place, "world"), robot.body)
        yield from walk(robot, 0.0, 0.0, yaw)
    return (yield from look_at_seen(robot, action.thing))


def tracking_limbs(action: Track) -> frozenset[Limb]:
    """Return what following something moves."""
    if action.using == "off":
        return frozenset()
    return frozenset({Limb.HEAD, Limb.LEGS} if action.using == "body" else {Limb.HEAD})
