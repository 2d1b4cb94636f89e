"""What a virtual robot does when it has lost its balance: it falls onto its belly or its back."""

from __future__ import annotations

import numpy as np

from faults import Text, text_of

from .body import Angles, part_of
from .kinematics import Skeleton
from .limbs import Limb
from .motion import TICK_S, move
from .pose import VirtualRobot
from .schedule import Task
from .tasks import lean, play_motion, resting_down

PROTECTING_SPEED = 0.5
LONGEST_FALL_S = 3.0
LYING_DOWN = -0.25
"""How much of the way down is along the torso of one that lies: nearly nothing."""
SUNK_POSTURE = "Crouch"


def fallen_sentence(robot: VirtualRobot) -> Text:
    """Return what happened, and what to do."""
    return text_of(
        '{name} lost its balance and fell. Let it get up: ask it for "posture_stand", or wake it '
        "up.",
        name=robot.name,
    )


def gives_way(robot: VirtualRobot) -> bool:
    """Whether a robot stands on legs whose motors are off."""
    return (
        robot.family == "standing"
        and {"left_leg", "right_leg"} <= robot.released
        and SUNK_POSTURE in robot.body.postures
    )


def sunk_sentence(robot: VirtualRobot) -> Text:
    """Return what happened, and what to do."""
    return text_of(
        "{name}'s legs were released, and it sank down. Lock them first, or let the robot wake up.",
        name=robot.name,
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


# How limbs hang whose motors are off: their weight turns their joints, slowly, until they rest.

HANGING_PARTS = ("head", "left_arm", "right_arm")
"""Legs carry the body: what happens when they are released is a matter of its balance."""
GRAVITY_M_S2 = 9.81
RAD_S_PER_NM = 6.0
"""A motor that is off is hard to turn: so fast its joint moves with each Nm."""
FASTEST_PART = 0.2
STICKING_NM = 0.02
"""Gears hold still against less than this."""


class Sagging:
    """Lets released limbs of one robot hang."""

    def __init__(self, robot: VirtualRobot) -> None:
        self._robot = robot
        self._lever = _levers(robot.stance.skeleton)
        self._rested: frozenset[str] | None = frozenset()

    @property
    def is_active(self) -> bool:
        """Whether released limbs do not hang still yet."""
        return self._loose != self._rested

    @property
    def _loose(self) -> frozenset[str]:
        return self._robot.released & frozenset(HANGING_PARTS)

    def step(self) -> None:
        """Let released limbs sink by one tick."""
        loose = self._loose
        if not loose:
            self._rested = loose
            return
        robot = self._robot
        columns = [
            i for i, name in enumerate(robot.body.names) if part_of(robot.body, name) in loose
        ]
        torque = self._torques()[columns]
        pulled = np.sign(torque) * np.maximum(np.abs(torque) - STICKING_NM, 0.0)
        fastest = FASTEST_PART * robot.body.max_speed[columns]
        goal = robot.angles.copy()
        goal[columns] += np.clip(RAD_S_PER_NM * pulled, -fastest, fastest) * TICK_S
        allowed, _ = robot.body.clamped(goal)
        moved = np.abs(allowed[columns] - robot.angles[columns]).max(initial=0.0)
        robot.angles[columns] = allowed[columns]
        self._rested = loose if moved < 1e-5 else None

    def _torques(self) -> Angles:
        """Return how hard the weight of what hangs on each joint turns it, Nm."""
        stance = self._robot.stance
        centres, masses = stance.skeleton.mass_centres(stance.frames), stance.skeleton.masses_kg
        torques = np.zeros(len(self._robot.body.names))
        down = stance.down
        for column, (link, carried) in self._lever.items():
            frame = stance.frames[link]
            axis = frame[:3, :3] @ self._robot.body.joints[column].axis
            # the pull of all links together: numpy's cross product is slow for single vectors
            arm = masses[carried] @ (centres[carried] - frame[:3, 3])
            torques[column] = GRAVITY_M_S2 * _triple(axis, arm, down)
        return torques


def _triple(a: Angles, b: Angles, c: Angles) -> float:
    """Return how much of the cross product of b and c is along a."""
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = a.tolist(), b.tolist(), c.tolist()
    return float(ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx))


def _levers(skeleton: Skeleton) -> dict[int, tuple[int, list[int]]]:
    """Return for each joint's column its link, and all links that hang on it."""
    joints = skeleton.body.joints
    parents = {joint.child: joint.parent for joint in joints if joint.child}

    def hangs_on(link: str, root: str) -> bool:
        while link and link != root:
            link = parents.get(link, "")
        return link == root

    return {
        column: (
            skeleton.index[joint.child],
            [skeleton.index[link] for link in parents if hangs_on(link, joint.child)],
        )
        for column, joint in enumerate(joints)
        if joint.child
    }
