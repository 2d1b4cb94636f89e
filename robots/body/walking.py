"""How a virtual robot walks over the floor, and comes to rest when it is told to stop."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import numpy as np

from faults import Text, text_of
from robots.errors import ActionFailed

from .body import Angles
from .gait import Walk, plan_joining, plan_walk
from .keyframes import MINIMUM_JERK_PEAK, minimum_jerk, ticks
from .kinematics import turned
from .limbs import Limb
from .motion import TICK_S, braking
from .pose import VirtualRobot
from .schedule import Task
from .stance import Carried, Leaning
from .surroundings import bump
from .tasks import DOES_NOT_STAND, at_once, go, moved_base, play_motion

# How a robot on wheels drives: all at once, speeding up and slowing down evenly.

FASTEST = np.array([0.35, 0.35, 1.0])
"""Forward and to the left, m/s, and turning, rad/s: what looks calm."""


def plan_roll(way: Angles) -> Angles:
    """Return the base (ticks, 3) on a way of m, m and rad, relative to where it starts."""
    duration_s = float(np.max(MINIMUM_JERK_PEAK * np.abs(way) / FASTEST))
    times_s = ticks(duration_s, TICK_S)
    path: Angles = minimum_jerk(times_s / times_s[-1])[:, None] * way
    return path


WALKING_POSTURE = "StandInit"
MERGING_S = 0.3
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
            '{name} {family}: it must stand before it can walk. Let it do "posture_stand" first.',
            name=robot.name,
            family=Text(DOES_NOT_STAND[robot.family]),
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
    joined = minimum_jerk(np.clip(np.arange(len(plan.torso)) * TICK_S / MERGING_S, 0.0, 1.0))
    for place, part in zip(plan.torso, joined, strict=True):
        x, y, yaw = moved_base(start, place)
        x, y = (x, y) + (1.0 - part) * missing
        yield Carried(turned(float(yaw)) @ plan.lean, float(x), float(y))


def _bumped(robot: VirtualRobot, what: str, start: Angles) -> Text:
    way_m = float(np.hypot(*(robot.base - start)[:2]))
    return text_of(
        "{name} walked into {what} after {way_m} m and stopped.",
        name=robot.name,
        what=Text(what),
        way_m=f"{way_m:.2f}",
    )
