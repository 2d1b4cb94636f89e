"""What the sensors of a virtual NAO measure: what it was told to feel, else what its body does.

The model: motors need current to hold the body and more to move it; the floor carries the body at
the points that touch it, and feet feel their part of that.
"""

from __future__ import annotations

import numpy as np

from .body import Angles, part_of
from .limbs import TOUCH_SENSORS
from .pose import VirtualRobot
from .stance import TOUCHING_M, Stance
from .surroundings import sonar_m

GRAVITY_M_S2 = 9.81
HOLDING_A, MOVING_A = 0.05, 0.6
FOOT_SENSORS = {
    "foot_left": ("L_ankle", 1.0),
    "foot_right": ("R_ankle", -1.0),
}
"""The link of each foot, and the sign of what is outside on it."""
FOOT_CORNERS = {
    "front_left": (0.07025, 0.0299, 0.0231),
    "front_right": (0.07025, -0.0231, -0.0299),
    "rear_left": (-0.03025, 0.0299, 0.0191),
    "rear_right": (-0.02965, -0.0191, -0.0299),
}
"""Where a left and a right foot measure: forward of the ankle, and to the left of it on the left
and on the right foot, m. Source: nao_description V50 URDF."""
SOLE_DOWN_M = 0.04511


def measured(robot: VirtualRobot, joint_speed: Angles, turning: Angles) -> dict[str, float]:
    """Return all sensors by name: m, m/s², rad, rad/s, kg, A; touch sensors 0 or 1.

    ``turning``: how fast the torso turns about its own axes, rad/s.
    """
    sensors = dict.fromkeys(TOUCH_SENSORS, 0.0) | dict.fromkeys(robot.bumped, 1.0)
    sensors |= {name: sonar_m(robot, name) for name in robot.body.sonars}
    down = robot.stance.down
    for axis, part, rate in zip("xyz", down.tolist(), turning.tolist(), strict=True):
        sensors[f"acc_{axis}"] = round(GRAVITY_M_S2 * part, 4)
        sensors[f"gyro_{axis}"] = round(rate, 4)
    _, _, _, roll, pitch, _ = robot.stance.pose
    sensors |= {"angle_x": round(roll, 4), "angle_y": round(pitch, 4)}
    sensors |= weights_kg(robot.stance)
    sensors |= _currents(robot, joint_speed)
    sensors["fallen"] = float(robot.fallen)
    return sensors | {name: value for name, value in robot.felt.items() if name != "battery"}


def turning_rad_s(before: Angles, after: Angles, seconds: float) -> Angles:
    """Return how fast a torso turns about its own axes, from how it was and is turned (3, 3)."""
    change = before.T @ after
    rates = np.array(
        [change[2, 1] - change[1, 2], change[0, 2] - change[2, 0], change[1, 0] - change[0, 1]]
    )
    turning: Angles = rates / 2.0 / seconds
    return turning


def weights_kg(stance: Stance) -> dict[str, float]:
    """Return how much of the weight each corner of each foot feels, and each foot, kg."""
    names, places = _carriers(stance)
    parts = _shares(places, stance.centre_of_mass[:2]) if len(places) else np.zeros(0)
    felt = dict(zip(names, (parts * stance.skeleton.mass_kg).round(3).tolist(), strict=True))
    weights: dict[str, float] = {}
    for foot in FOOT_SENSORS:
        corners = {f"{foot}_{corner}": felt.get(f"{foot}_{corner}", 0.0) for corner in FOOT_CORNERS}
        weights |= corners | {foot: round(sum(corners.values()), 3)}
    return weights


def _carriers(stance: Stance) -> tuple[list[str], Angles]:
    """Return what carries the body, by name, and where (n, 2): corners of feet, other links."""
    skeleton, feet = stance.skeleton, {link for link, _ in FOOT_SENSORS.values()}
    names, places = [], []
    for foot, (link, sign) in FOOT_SENSORS.items():
        for corner, (ahead, on_left, on_right) in FOOT_CORNERS.items():
            if link not in skeleton.soles:
                continue
            left = on_left if sign > 0.0 else on_right
            place = stance.link_place(link, (ahead, left, -SOLE_DOWN_M))
            if place[2] < TOUCHING_M:
                names.append(f"{foot}_{corner}")
                places.append(place[:2])
    links = skeleton.point_links[stance.touching]
    for number in sorted(set(links.tolist())):
        if skeleton.links[number] not in feet:
            names.append(skeleton.links[number])
            touching = stance.places[stance.touching][links == number]
            places.append(touching[:, :2].mean(axis=0))
    return names, np.array(places).reshape(-1, 2)


def _shares(places: Angles, centre: Angles) -> Angles:
    """Return which part of the weight each place carries: the most even one that balances."""
    parts, carrying = np.zeros(len(places)), np.ones(len(places), dtype=bool)
    while True:
        rows = np.vstack([np.ones(int(carrying.sum())), (places[carrying] - centre).T])
        found = np.linalg.pinv(rows) @ np.array([1.0, 0.0, 0.0])
        if (found >= 0.0).all() or carrying.sum() < 2:
            parts[carrying] = np.clip(found, 0.0, 1.0)
            return np.asarray(parts / max(parts.sum(), 1e-9))
        carrying[np.flatnonzero(carrying)[found < 0.0]] = False


def _currents(robot: VirtualRobot, joint_speed: Angles) -> dict[str, float]:
    load = np.abs(joint_speed) / robot.body.max_speed
    return {
        f"current_{name}": 0.0
        if part_of(robot.body, name) in robot.released
        else round(HOLDING_A + MOVING_A * float(part), 3)
        for name, part in zip(robot.body.names, load, strict=True)
    }
