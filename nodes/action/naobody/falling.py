"""What a virtual robot does when it has lost its balance: it falls onto its belly or its back."""

from __future__ import annotations

import numpy as np

from nodes.action.naobody.limbs import Limb
from nodes.action.naobody.motion import TICK_S, move
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task
from nodes.action.naobody.tasks import lean, play_motion, resting_down

PROTECTING_SPEED = 0.5
LONGEST_FALL_S = 3.0
LYING_DOWN = -0.25
"""How much of the way down is along the torso of one that lies: nearly nothing."""
SUNK_POSTURE = "Crouch"


def fallen_sentence(robot: VirtualRobot) -> str:
    """Return what happened, and what to do."""
    return (
        f"{robot.name} lost its balance and fell. "
        'Let it get up: ask it for "posture_stand", or wake it up.'
    )


def gives_way(robot: VirtualRobot) -> bool:
    """Whether a robot stands on legs whose motors are off."""
    return (
        robot.family == "standing"
        and {"left_leg", "right_leg"} <= robot.released
        and SUNK_POSTURE in robot.body.postures
    )


def sunk_sentence(robot: VirtualRobot) -> str:
    """Return what happened, and what to do."""
    return (
        f"{robot.name}'s legs were released, and it sank down. "
        "Lock them first, or let the robot wake up."
    )


def sink(robot: VirtualRobot) -> Task:
    """Sink down on legs that do not hold the body any more."""
    columns = robot.body.columns({Limb.LEGS})
    goal = robot.angles.copy()
    goal[columns] = robot.body.posture_angles(SUNK_POSTURE)[columns]
    robot.be_in(SUNK_POSTURE)
    yield from lean(robot, goal, -robot.stance.skeleton.resting_turn(goal)[2])
    return ""


def steadily(robot: VirtualRobot, task: Task) -> Task:
    """Do a task; it has ended when the robot tips no more: it may fall over what it has done."""
    said = yield from task
    while not robot.stance.is_steady:
        yield
    return said


def fall(robot: VirtualRobot) -> Task:
    """Fall where the body tips to, and lie there."""
    robot.fallen = True
    posture = "LyingBelly" if robot.stance.down[0] > 0.0 else "LyingBack"
    if posture not in robot.body.postures:
        return (yield from _come_to_rest(robot))
    goal = robot.body.posture_angles(posture)
    columns = range(len(robot.body.names))
    motion = move(robot.body, robot.angles, goal, columns, speed=PROTECTING_SPEED)
    for _ in play_motion(robot, motion):
        if _lies(robot):
            break
        yield
    if not _lies(robot):
        yield from _come_to_rest(robot)
    robot.be_in(posture)
    yield from lean(robot, goal, np.asarray(resting_down(robot, posture)))
    return ""


def _lies(robot: VirtualRobot) -> bool:
    """Whether the torso is down: from then on the floor holds it, and it does not roll over."""
    return bool(robot.stance.down[2] > LYING_DOWN)


def _come_to_rest(robot: VirtualRobot) -> Task:
    for _ in range(round(LONGEST_FALL_S / TICK_S)):
        if robot.stance.is_steady:
            break
        yield
    return ""
