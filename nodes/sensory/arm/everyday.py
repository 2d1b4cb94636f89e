"""Everyday movement: what people do with their hands when they make no gesture."""

from __future__ import annotations

import numpy as np

from nodes.sensory.arm.chores import CHORES
from nodes.sensory.arm.gestures import arm, trunk
from nodes.sensory.arm.motion import Motion
from nodes.sensory.arm.moving import Activity, settle, shift, sway
from nodes.sensory.arm.skeleton import Joint, Pose

HANGING = arm(3, 8, 5, 15, 25)
_ON_THE_LAP = arm(20, 10, 35, 75, 40)
_ON_THE_DESK = arm(35, 15, 40, 75, 70)
_BEFORE_THE_CHEST = arm(35, 12, 45, 95, 20)
_STANDING: Pose = {Joint.FORWARD: 0.0, Joint.UP: 0.0}
_SITTING: Pose = {Joint.FORWARD: -0.25, Joint.UP: -0.42}


def rest(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Let the arm hang."""
    return settle(motion, start_s, {**HANGING, **trunk(0)}, rng) + rng.uniform(1.0, 3.0)


def hand_on_lap(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Lay the hand down, and shift it now and then."""
    now_s = settle(motion, start_s, {**_ON_THE_LAP, **trunk(0)}, rng)
    for _ in range(rng.integers(1, 4)):
        now_s = shift(motion, now_s + rng.uniform(0.5, 2.0), _ON_THE_LAP, 5.0, rng)
    return now_s


def type_on_keyboard(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Type: quick small turns of the forearm, the hand going to and fro over the keys."""
    now_s = settle(motion, start_s, {**_ON_THE_DESK, **trunk(0, 5)}, rng)
    end_s = now_s + rng.uniform(3.0, 7.0)
    for joint, degrees in ((Joint.PRONATION, 1.2), (Joint.ELBOW, 0.5), (Joint.ROTATION, 0.6)):
        sway(motion, now_s, end_s, rng.uniform(2.0, 5.0), {joint: degrees}, rng)
    while now_s < end_s - 1.5:
        now_s = shift(motion, now_s + rng.uniform(0.3, 1.0), _ON_THE_DESK, 4.0, rng)
    return end_s


def drink(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Reach for a cup, bring it to the mouth, tilt it, put it back."""
    cup, mouth = arm(50, 10, 20, 50, 0), arm(60, 25, 45, 132, -5)
    now_s = settle(motion, start_s, cup, rng) + 0.4
    now_s = settle(motion, now_s, mouth, rng) + 0.2
    motion.move({Joint.FLEXION: 72, Joint.PRONATION: 15}, now_s, 0.8)
    now_s = settle(motion, now_s + rng.uniform(1.5, 2.5), cup, rng) + 0.3
    return settle(motion, now_s, _ON_THE_DESK, rng)


def scratch_head(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Scratch an ear."""
    now_s = settle(motion, start_s, arm(75, 45, 40, 140, 0), rng)
    end_s = now_s + rng.uniform(1.5, 2.5)
    sway(motion, now_s, end_s, rng.uniform(3.0, 4.5), {Joint.ELBOW: 4, Joint.PRONATION: 5}, rng)
    return settle(motion, end_s, _ON_THE_LAP, rng)


def gesticulate(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Talk with the hands."""
    now_s = settle(motion, start_s, _BEFORE_THE_CHEST, rng)
    for _ in range(rng.integers(4, 9)):
        now_s = shift(motion, now_s, _BEFORE_THE_CHEST, 16.0, rng) + rng.uniform(-0.15, 0.5)
    return now_s


def look_at_watch(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Lift the watch before the eyes."""
    now_s = settle(motion, start_s, arm(40, 20, 65, 105, 75), rng) + rng.uniform(0.8, 2.0)
    return settle(motion, now_s, HANGING, rng)


def walk(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Walk: the arm swings, the hips go up and down with each step."""
    now_s = settle(motion, start_s, {**HANGING, **_STANDING, **trunk(0, 2)}, rng)
    end_s = now_s + rng.uniform(4.0, 9.0)
    stride_hz = rng.uniform(0.8, 1.05)
    swing = {Joint.FLEXION: rng.uniform(10, 24), Joint.ELBOW: rng.uniform(2, 9), Joint.TWIST: 4.0}
    sway(motion, now_s, end_s, stride_hz, swing, rng)
    steps = {Joint.UP: rng.uniform(0.012, 0.028), Joint.FORWARD: 0.01}
    sway(motion, now_s, end_s, 2 * stride_hz, steps, rng)
    sway(motion, now_s, end_s, 4 * stride_hz, {Joint.UP: 0.002, Joint.FLEXION: 0.3}, rng)
    return end_s


def turn_round(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Turn on the spot."""
    heading = np.degrees(motion.goal[Joint.HEADING]) + rng.choice([-1, 1]) * rng.uniform(60, 180)
    duration_s = rng.uniform(1.2, 2.2)
    motion.move({Joint.HEADING: heading}, start_s, duration_s)
    sway(motion, start_s, start_s + duration_s, 1.8, {Joint.UP: 0.012}, rng)
    return settle(motion, start_s + duration_s / 2, {**HANGING, **_STANDING}, rng) + 0.5


def sit_down(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Sit down, leaning forward on the way."""
    duration_s = rng.uniform(1.2, 1.9)
    motion.move({Joint.LEAN: 35}, start_s, duration_s * 0.7)
    motion.move(_SITTING, start_s + 0.2, duration_s)
    motion.move({**_ON_THE_LAP, **trunk(0)}, start_s + duration_s * 0.6, duration_s * 0.8)
    return start_s + duration_s * 1.4 + rng.uniform(0.5, 2.0)


def stand_up(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Stand up, leaning forward on the way."""
    duration_s = rng.uniform(1.1, 1.8)
    motion.move({Joint.LEAN: 38}, start_s, duration_s * 0.6)
    motion.move(_STANDING, start_s + 0.3, duration_s)
    motion.move({**HANGING, **trunk(0)}, start_s + duration_s * 0.5, duration_s * 0.9)
    return start_s + duration_s * 1.4 + rng.uniform(0.3, 1.5)


CALM: tuple[Activity, ...] = (rest, hand_on_lap, type_on_keyboard, gesticulate, look_at_watch)
EVERYDAY: tuple[Activity, ...] = (
    *CALM, drink, scratch_head, walk, walk, turn_round, sit_down, stand_up, *CHORES,
)  # fmt: skip
