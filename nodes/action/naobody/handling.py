"""What hands do to a virtual robot: they push it, and put it somewhere else."""

from __future__ import annotations

import math

import numpy as np

from nodes.action.naobody.pose import VirtualRobot

Place = tuple[float, float, float]


def push(robot: VirtualRobot, towards: Place) -> None:
    """Push a robot towards a place (x, y m from its feet) so hard that it tips over."""
    x, y, _ = towards
    if math.isfinite(x) and math.isfinite(y):
        robot.stance.push(float(robot.base[2]) + math.atan2(y, x))


def put(robot: VirtualRobot, place: Place) -> None:
    """Put a robot down at a place (x m, y m, theta rad on the floor), in the posture it is in."""
    if all(math.isfinite(value) for value in place):
        robot.base[:] = place
        robot.stance.put_down(
            robot.angles, np.array(place), robot.body.postures[robot.posture].down
        )
