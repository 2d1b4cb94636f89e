"""What a virtual robot does unasked: it falls when it lost its balance, breathes, looks at people.

It falls onto its belly or its back; the rest it does with limbs that nothing uses.
"""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np

from faults import Text, text_of

from .body import SINGLE_PARTS, Angles, part_of, parts_of_limbs
from .inverse import Place, head_angles, in_torso
from .limbs import Limb
from .motion import TICK_S, move
from .pose import VirtualRobot
from .schedule import Task
from .stance import Carried
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
    """Fall where the body tips to, lie there, and let all motors go, as NAO's fall manager does."""
    robot.fallen = True
    posture = "LyingBelly" if robot.stance.down[0] > 0.0 else "LyingBack"
    if posture not in robot.body.postures:
        yield from _come_to_rest(robot)
        return _let_go(robot)
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
    return _let_go(robot)


def _let_go(robot: VirtualRobot) -> str:
    robot.released = frozenset(SINGLE_PARTS)
    robot.stiffness = {}
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
        # For each joint's column its link, and all links that hang on it
        skeleton = robot.stance.skeleton
        joints = skeleton.body.joints
        parents = {joint.child: joint.parent for joint in joints if joint.child}

        def hangs_on(link: str, root: str) -> bool:
            while link and link != root:
                link = parents.get(link, "")
            return link == root

        self._lever = {
            column: (
                skeleton.index[joint.child],
                [skeleton.index[link] for link in parents if hangs_on(link, joint.child)],
            )
            for column, joint in enumerate(joints)
            if joint.child
        }
        self._rested: frozenset[str] | None = frozenset()

    @property
    def is_active(self) -> bool:
        """Whether released limbs do not hang still yet."""
        return self._loose != self._rested

    @property
    def _loose(self) -> frozenset[str]:
        if self._robot.fallen:  # the floor holds the limbs of one that lies
            return frozenset()
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
        torque = self._torques_nm()[columns]
        pulled = np.sign(torque) * np.maximum(np.abs(torque) - STICKING_NM, 0.0)
        fastest = FASTEST_PART * robot.body.max_speed[columns]
        goal = robot.angles.copy()
        goal[columns] += np.clip(RAD_S_PER_NM * pulled, -fastest, fastest) * TICK_S
        allowed, _ = robot.body.clamped(goal)
        moved = np.abs(allowed[columns] - robot.angles[columns]).max(initial=0.0)
        robot.angles[columns] = allowed[columns]
        self._rested = loose if moved < 1e-5 else None

    def _torques_nm(self) -> Angles:
        """Return how hard the weight of what hangs on each joint turns it."""
        robot, stance = self._robot, self._robot.stance
        centres, masses = stance.skeleton.mass_centres(stance.frames), stance.skeleton.masses_kg
        torques = np.zeros(len(robot.body.names))
        down = stance.down
        for column, (link, carried) in self._lever.items():
            frame = stance.frames[link]
            axis = frame[:3, :3] @ robot.body.joints[column].axis
            # the pull of all links together
            arm = masses[carried] @ (centres[carried] - frame[:3, 3])
            # axis @ cross(arm, down); numpy's cross product is slow for single vectors
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = axis.tolist(), arm.tolist(), down.tolist()
            torques[column] = GRAVITY_M_S2 * float(
                ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
            )
        return torques


# What a virtual robot does by itself with limbs that nothing uses: breathe, look at people.

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
        for limb, depths in BREATH_RAD.items():
            if limb in used or not self._is_held(limb):
                self._centres.pop(limb, None)
            elif self._breathes or limb in self._centres:
                self._move_with_breath(limb, depths, now_s)
        self._swing_arms(used)
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
