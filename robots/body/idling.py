"""What a virtual robot does by itself with limbs that nothing uses: breathe, look at people."""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np

from .body import Angles, parts_of_limbs
from .gaze import Place, head_angles, in_torso
from .limbs import Limb
from .motion import TICK_S
from .pose import VirtualRobot
from .stance import Carried

BREATH_S = 3.0
BREATHING_IN_S = 1.5
"""In this time breathing becomes as deep as it is."""
BREATH_RAD: dict[Limb, dict[str, float]] = {
    Limb.LEFT_ARM: {"LShoulderPitch": 0.035, "LShoulderRoll": 0.02, "LElbowRoll": -0.03},
    Limb.RIGHT_ARM: {"RShoulderPitch": 0.035, "RShoulderRoll": -0.02, "RElbowRoll": 0.03},
    Limb.LEGS: {
        f"{side}{joint}": rad
        for side in "LR"
        for joint, rad in (("HipPitch", -0.02), ("KneePitch", 0.04), ("AnklePitch", -0.02))
    },
}
"""How far joints go to and fro; the knees bend so that the feet stay flat."""

FEET = ("L_ankle", "R_ankle")
SWINGING = {Limb.LEFT_ARM: ("LShoulderPitch", 1.0), Limb.RIGHT_ARM: ("RShoulderPitch", -1.0)}
SWING_RAD_PER_M, SWING_RAD_S = 3.0, 1.0
"""How far arms swing for each m that one foot is ahead of the other, and how fast they can."""

LOOKING_RAD_S = 1.8
GAIN_PER_S = 5.0
STARTS_AT_RAD, STOPS_AT_RAD = 0.05, 0.01
"""The head goes after what is so far from where it looks, until it is so near."""


class Idling:
    """The small movements of one robot that nobody asks for one by one."""

    def __init__(self, robot: VirtualRobot) -> None:
        self._robot = robot
        self._centres: dict[Limb, Angles] = {}
        self._depths: dict[Limb, float] = {}
        self._is_turning = False
        self._swings: dict[Limb, float] = {}

    @property
    def is_active(self) -> bool:
        """Whether something moves by itself, or is about to."""
        by_itself = self._breathes or self._centres or self._is_turning or self._looks_away
        return bool(by_itself or any(abs(swung) > 1e-6 for swung in self._swings.values()))

    def step(self, used: Collection[Limb], now_s: float) -> None:
        """Go on by one tick with the limbs that are not used."""
        self._breathe(used, now_s)
        self._swing_arms(used)
        self._turn_head(used)

    @property
    def _looks_away(self) -> bool:
        """Whether the head is not yet turned to what it follows."""
        place = self._target()
        if place is None or "head" in self._robot.released:
            return False
        return self._missing(place)[1] > STARTS_AT_RAD

    @property
    def _breathes(self) -> bool:
        return bool(self._robot.settings["breathing"]) and not self._robot.fallen

    def _breathe(self, used: Collection[Limb], now_s: float) -> None:
        for limb, depths in BREATH_RAD.items():
            if limb in used or not self._is_held(limb):
                self._centres.pop(limb, None)
            elif self._breathes or limb in self._centres:
                self._move_with_breath(limb, depths, now_s)

    def _move_with_breath(self, limb: Limb, depths: dict[str, float], now_s: float) -> None:
        robot = self._robot
        columns = [robot.body.index[name] for name in depths if name in robot.body.index]
        if limb not in self._centres:
            self._centres[limb], self._depths[limb] = robot.angles[columns].copy(), 0.0
        change = TICK_S / BREATHING_IN_S * (1.0 if self._breathes else -3.0)
        self._depths[limb] = depth = min(max(self._depths[limb] + change, 0.0), 1.0)
        breath = 0.5 - 0.5 * math.cos(2.0 * math.pi * now_s / BREATH_S)
        goal = robot.angles.copy()
        ways = np.array([rad for name, rad in depths.items() if name in robot.body.index])
        goal[columns] = self._centres[limb] + depth * breath * ways
        allowed, _ = robot.body.clamped(goal)
        robot.angles[columns] = allowed[columns]
        if depth == 0.0:
            del self._centres[limb]

    def _swing_arms(self, used: Collection[Limb]) -> None:
        """Swing free arms against the legs while it walks, and let them come back after that."""
        stance = self._robot.stance
        ahead_m = 0.0
        if isinstance(stance.last_guide, Carried) and stance.skeleton.soles:
            left, right = (stance.frames[stance.skeleton.index[link], 0, 3] for link in FEET)
            ahead_m = float(left - right)
        for limb, (joint, sign) in SWINGING.items():
            if limb in used or limb in self._centres or not self._is_held(limb):
                self._swings.pop(limb, None)
                continue
            swung = self._swings.get(limb, 0.0)
            wanted = sign * SWING_RAD_PER_M * ahead_m
            step = float(np.clip(wanted - swung, -SWING_RAD_S * TICK_S, SWING_RAD_S * TICK_S))
            if step:
                self._robot.angles[self._robot.body.index[joint]] += step
                self._swings[limb] = swung + step

    def _is_held(self, limb: Limb) -> bool:
        """Whether a limb can breathe: its motors hold it, and legs stand."""
        if parts_of_limbs(frozenset({limb})) & self._robot.released:
            return False
        return limb is not Limb.LEGS or self._robot.family == "standing"

    def _turn_head(self, used: Collection[Limb]) -> None:
        robot = self._robot
        place = self._target()
        if place is None or Limb.HEAD in used or "head" in robot.released:
            self._is_turning = False
            return
        head = list(robot.body.head)
        missing, far = self._missing(place)
        self._is_turning = far > (STOPS_AT_RAD if self._is_turning else STARTS_AT_RAD)
        if self._is_turning:
            goal = robot.angles.copy()
            speed = np.clip(GAIN_PER_S * missing, -LOOKING_RAD_S, LOOKING_RAD_S)
            goal[head] += speed * TICK_S
            allowed, _ = robot.body.clamped(goal)
            robot.angles[head] = allowed[head]

    def _missing(self, place: Place) -> tuple[Angles, float]:
        """Return how far the head's joints are from looking at a place, and the farther one."""
        goal = self._robot.angles.copy()
        head = list(self._robot.body.head)
        goal[head] = head_angles(in_torso(self._robot, place, "world"), self._robot.body)
        allowed, _ = self._robot.body.clamped(goal)
        missing: Angles = allowed[head] - self._robot.angles[head]
        return missing, float(np.abs(missing).max())

    def _target(self) -> Place | None:
        """Return where on the floor is what the head follows, if anything."""
        robot = self._robot
        if robot.fallen:
            return None
        tracked = str(robot.settings["tracking"])
        wanted = [tracked] if tracked else ["face", "sound"] if robot.settings["awareness"] else []
        seen = robot.seen
        return next((seen[thing] for thing in wanted if thing in seen), None)
