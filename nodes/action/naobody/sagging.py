"""How limbs hang whose motors are off: their weight turns their joints, slowly, until they rest."""

from __future__ import annotations

import numpy as np

from nodes.action.naobody.body import Angles
from nodes.action.naobody.motion import TICK_S
from nodes.action.naobody.parts import part_of
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.skeleton import Skeleton

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
