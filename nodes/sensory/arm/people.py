"""Simulated people: how each is built, moves, and wears the watch.

A person is a pure function of a number. Numbers below 100 are for training, so that those from
100 on are people whom no model has seen. Every tenth (9, 19, ...) is left-handed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nodes.sensory.arm.motion import Swing
from nodes.sensory.arm.sensor import Sensor
from nodes.sensory.arm.skeleton import LENGTHS, Body, Floats, Joint

FIRST_UNSEEN = 100
_SEED = 2018
_SCALES = 7  # a source of chance of its own: people stay who they were
_LEFT_HANDED = 9
_STYLE_DEG = 6.0  # how much people differ in each joint of each key pose
_CARE_DEG = 3.0  # how much one person's performances differ


@dataclass(frozen=True)
class Person:
    """Who moves: ``pace`` 1.1 is a tenth faster, ``reach`` 1.1 moves a tenth further."""

    number: int
    body: Body
    sensor: Sensor
    pace: float
    reach: float
    tremor: tuple[Swing, ...]

    def style(self, gesture: str, stroke: int) -> Floats:
        """How this person's key pose differs from the written one: (11,) in rad, m."""
        rng = np.random.default_rng([_SEED, self.number, stroke, *gesture.encode()])
        return _angles(rng, _STYLE_DEG)


def person_numbered(number: int) -> Person:
    """The person of this number, 0 or more: always the same one."""
    rng = np.random.default_rng([_SEED, number])
    size = rng.normal(1.0, 0.05)
    return Person(
        number=number,
        body=_body(rng, size),
        sensor=_sensor(rng, number),
        pace=float(np.clip(rng.normal(1.0, 0.08), 0.85, 1.18)),
        reach=float(np.clip(rng.normal(1.0, 0.06), 0.85, 1.15)),
        tremor=tuple(_tremor(rng)),
    )


def performance_variation(rng: np.random.Generator) -> Floats:
    """How one key pose differs from one performance to the next: (11,) in rad, m."""
    return _angles(rng, _CARE_DEG)


def _body(rng: np.random.Generator, size: float) -> Body:
    upper_arm, forearm, watch = rng.normal(1.0, (0.04, 0.04, 0.25))
    return Body(
        shoulder_height_m=0.48 * size,
        shoulder_width_m=0.18 * size,
        upper_arm_m=0.30 * size * upper_arm,
        forearm_m=0.25 * size * forearm,
        watch_to_wrist_m=0.03 * watch,
    )


def _sensor(rng: np.random.Generator, number: int) -> Sensor:
    """A loose strap lets the watch turn about the forearm (its x axis) more than tilt."""
    about_x, about_y, about_z = np.radians(rng.normal(0.0, (10.0, 3.0, 4.0)))
    return Sensor(
        turned=_turned(about_x, about_y, about_z),
        scale=np.random.default_rng([_SEED, number, _SCALES]).normal(1.0, 0.01, 3),
        acc_bias=rng.normal(0.0, 0.06, 3),
        gyr_bias=rng.normal(0.0, 0.01, 3),
        acc_noise=float(rng.uniform(0.03, 0.08)),
        gyr_noise=float(rng.uniform(0.003, 0.01)),
        left_wrist=number % 10 == _LEFT_HANDED,
    )


def _tremor(rng: np.random.Generator) -> list[Swing]:
    """Never ending small movements: the sway of standing, and the tremor of muscles."""
    kinds = ((0.3, 0.5, 0.6), (0.8, 1.4, 0.1), (7.0, 11.0, 0.002))  # Hz from, Hz to, degrees
    return [
        Swing(
            start_s=-10.0,
            end_s=np.inf,
            frequency_hz=float(rng.uniform(low, high)),
            phase=float(rng.uniform(0, 2 * np.pi)),
            amplitude=_angles(rng, degrees),
        )
        for low, high, degrees in kinds
    ]


def _angles(rng: np.random.Generator, deviation_deg: float) -> Floats:
    angles = rng.normal(0.0, np.radians(deviation_deg), len(Joint))
    angles[list(LENGTHS)] = 0.0
    angles[Joint.HEADING] = 0.0
    return angles


def _turned(about_x: float, about_y: float, about_z: float) -> Floats:
    """A rotation by three small angles, exactly orthogonal."""
    skew = np.array([[0.0, -about_z, about_y], [about_z, 0.0, -about_x], [-about_y, about_x, 0.0]])
    cayley = np.linalg.solve(np.eye(3) - skew / 2, np.eye(3) + skew / 2)
    return np.asarray(cayley, dtype=np.float64)
