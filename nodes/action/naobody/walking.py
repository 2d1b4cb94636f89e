"""How a virtual robot walks over the floor, and comes to rest when it is told to stop."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from nep_core.errors import ActionFailed
from nodes.action.naobody.body import Angles
from nodes.action.naobody.curves import minimum_jerk
from nodes.action.naobody.gait import Walk, plan_walk
from nodes.action.naobody.joining import plan_joining
from nodes.action.naobody.limbs import Limb
from nodes.action.naobody.motion import TICK_S, braking
from nodes.action.naobody.obstacles import bump
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.rolling import plan_roll
from nodes.action.naobody.running import Task
from nodes.action.naobody.skeleton import turned
from nodes.action.naobody.stance import Carried, Leaning
from nodes.action.naobody.tasks import DOES_NOT_STAND, at_once, go, moved_base, play_motion

WALKING_POSTURE = "StandInit"
JOINING_S = 0.3
"""In this time a robot that stands a little beside where it should comes to stand there."""


def walk(
    robot: VirtualRobot,
    forward_m: float,
    left_m: float,
    turn: float,
    *,
    at_least_steps: int = 1,
) -> Task:
    """Walk over the floor with steps, turning by ``turn`` rad on the way.

    Raises ActionFailed when the robot does not stand, and when it walks into something.
    """
    if robot.family in DOES_NOT_STAND:
        raise ActionFailed(
            f"{robot.name} {DOES_NOT_STAND[robot.family]}: it must stand before it can walk. "
            'Let it do "posture_stand" first.'
        )
    way = np.array([forward_m, left_m, turn])
    if not way.any():
        return ""
    if not robot.stance.skeleton.soles:
        return (yield from _roll(robot, way))
    yield from go(robot, WALKING_POSTURE, {Limb.LEGS})
    robot.posture = WALKING_POSTURE
    plan = plan_walk(robot.body, _standing(robot), *way.tolist(), at_least_steps=at_least_steps)
    start, steps = robot.base, play_motion(robot, plan.legs)
    for guide, place, _ in zip(_guides(robot, plan), plan.base, steps, strict=True):
        robot.stance.guide = guide
        robot.base = moved_base(start, place)
        if what := bump(robot, way):
            yield from _end_step(robot)
            raise ActionFailed(_bumped(robot, what, start))
        yield
    robot.base = moved_base(start, way)
    return ""


def come_to_rest(robot: VirtualRobot, limbs: Collection[Limb], joint_speed: Angles) -> Task:
    """Brake some limbs from the speeds that they have: every joint's, rad/s.

    A robot that walks ends its step; what leans from posture to posture leans no further.
    """
    guide = robot.stance.last_guide
    tasks = [_end_step(robot)] if isinstance(guide, Carried) and Limb.LEGS in limbs else []
    others = set(limbs) - {Limb.LEGS} if tasks else set(limbs)
    tasks.append(_brake(robot, others, joint_speed, is_led=isinstance(guide, Leaning)))
    yield from at_once(tasks)
    if Limb.LEGS in limbs and robot.family == "standing" and robot.stance.skeleton.soles:
        yield from go(robot, robot.posture, {Limb.LEGS})
    return ""


def _brake(
    robot: VirtualRobot, limbs: Collection[Limb], joint_speed: Angles, *, is_led: bool
) -> Task:
    motion = braking(robot.body, robot.angles, joint_speed, robot.body.columns(limbs))
    for _ in play_motion(robot, motion):
        if is_led:
            robot.stance.guide = Leaning(robot.stance.down)
        yield
    return ""


def _end_step(robot: VirtualRobot) -> Task:
    """Put the feet side by side in the middle of a walk."""
    standing = _standing(robot)
    plan = plan_joining(robot, standing)
    for guide, _ in zip(plan.guides, play_motion(robot, plan.legs), strict=True):
        robot.stance.guide = guide
        robot.base = robot.stance.feet_base()
        yield
    robot.base = plan.base
    return ""


def _standing(robot: VirtualRobot) -> Angles:
    """Return the angles of every joint when the legs stand ready to walk."""
    columns = robot.body.columns({Limb.LEGS})
    standing = robot.angles.copy()
    standing[columns] = robot.body.posture_angles(WALKING_POSTURE)[columns]
    return standing


def _roll(robot: VirtualRobot, way: Angles) -> Task:
    """Drive a way on wheels."""
    start = robot.base
    for place in plan_roll(way):
        robot.base = moved_base(start, place)
        robot.stance.roll_to(robot.base)
        if what := bump(robot, way):
            raise ActionFailed(_bumped(robot, what, start))
        yield
    return ""


def _guides(robot: VirtualRobot, plan: Walk) -> Iterator[Carried]:
    """Yield where the torso is at each tick of a walk from here."""
    start = robot.base
    first = moved_base(start, plan.torso[0])
    missing = robot.stance.place[:2] - first[:2]
    joined = minimum_jerk(np.clip(np.arange(len(plan.torso)) * TICK_S / JOINING_S, 0.0, 1.0))
    for place, part in zip(plan.torso, joined, strict=True):
        x, y, yaw = moved_base(start, place)
        x, y = (x, y) + (1.0 - part) * missing
        yield Carried(turned(float(yaw)) @ plan.lean, float(x), float(y))


def _bumped(robot: VirtualRobot, what: str, start: Angles) -> str:
    way_m = float(np.hypot(*(robot.base - start)[:2]))
    return f"{robot.name} walked into {what} after {way_m:.2f} m and stopped."
