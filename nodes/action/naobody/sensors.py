"""What the sensors of a virtual NAO measure: what it was told to feel, else a plain model.

The model: nothing is near, nobody touches it, its weight rests on its feet while it stands, motors
need current to hold the body and more to move it.
"""

from __future__ import annotations

import math

import numpy as np

from nodes.action.naobody.body import Angles
from nodes.action.naobody.parts import part_of
from nodes.action.naobody.pose import VirtualRobot

TOUCH_SENSORS = (
    "head_front",
    "head_middle",
    "head_rear",
    "hand_left",
    "hand_right",
    "bumper_left",
    "bumper_right",
    "chest_button",
)
MASS_KG = 5.305
GRAVITY_M_S2 = 9.81
SONAR_RANGE_M = 2.55
HOLDING_A, MOVING_A = 0.05, 0.6
LYING = {"LyingBack": (-1.0, 0.0, 0.0), "LyingBelly": (1.0, 0.0, 0.0)}
"""Which way is down in the torso, by posture; else it is below."""


def measured(robot: VirtualRobot, joint_speed: Angles, base_speed: Angles) -> dict[str, float]:
    """Return all sensors by name: m, m/s², rad/s, kg, A; touch sensors 0 or 1."""
    down = LYING.get(robot.posture, (0.0, 0.0, -1.0))
    sensors = dict.fromkeys(TOUCH_SENSORS, 0.0)
    sensors |= {"sonar_left": SONAR_RANGE_M, "sonar_right": SONAR_RANGE_M}
    sensors |= {f"acc_{axis}": GRAVITY_M_S2 * part for axis, part in zip("xyz", down, strict=True)}
    sensors |= {"gyro_x": 0.0, "gyro_y": 0.0, "gyro_z": round(float(base_speed[2]), 4)}
    sensors |= _weights(robot)
    sensors |= _currents(robot, joint_speed)
    return sensors | {name: value for name, value in robot.felt.items() if name != "battery"}


def _weights(robot: VirtualRobot) -> dict[str, float]:
    """Return how much of its weight is on each foot: more where it leans to."""
    if robot.family != "standing":
        return {"foot_left": 0.0, "foot_right": 0.0}
    rolls = [robot.angles[robot.body.index[name]] for name in ("LHipRoll", "RHipRoll")]
    lean = math.sin(float(np.mean(rolls))) * 8.0
    left = min(max(0.5 - lean / 2.0, 0.0), 1.0)
    return {"foot_left": round(MASS_KG * left, 3), "foot_right": round(MASS_KG * (1 - left), 3)}


def _currents(robot: VirtualRobot, joint_speed: Angles) -> dict[str, float]:
    load = np.abs(joint_speed) / robot.body.max_speed
    return {
        f"current_{name}": 0.0
        if part_of(robot.body, name) in robot.released
        else round(HOLDING_A + MOVING_A * float(part), 3)
        for name, part in zip(robot.body.names, load, strict=True)
    }
