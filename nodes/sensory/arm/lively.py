"""Signs that people make to each other all day: what fools a recogniser of other gestures.

They are for testing recognisers, and for a virtual watch that is to be provoking. A model that is
trained on somebody's own clapping must not learn that clapping is nothing: they are not part of
the everyday movement that models are trained with.
"""

from __future__ import annotations

import numpy as np

from nodes.sensory.arm.everyday import EVERYDAY, HANGING
from nodes.sensory.arm.gestures import arm
from nodes.sensory.arm.motion import Motion
from nodes.sensory.arm.moving import Activity, jolt, settle, sway
from nodes.sensory.arm.skeleton import Joint


def clap(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Applaud."""
    apart = arm(38, 5, 45, 95, 0)
    now_s = settle(motion, start_s, apart, rng)
    for _ in range(rng.integers(4, 10)):
        beat_s = rng.uniform(0.22, 0.34)
        motion.move({Joint.ROTATION: 70}, now_s, beat_s / 2)
        jolt(motion, now_s + 0.42 * beat_s, rng.uniform(0.002, 0.006))
        motion.move({Joint.ROTATION: 45 + rng.normal(0, 4)}, now_s + beat_s / 2, beat_s / 2)
        now_s += beat_s
    return settle(motion, now_s, HANGING, rng)


def wave(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Wave hello, the hand beside the head."""
    now_s = settle(motion, start_s, arm(65, 50, -35, 115, -20), rng, haste=1.4)
    end_s = now_s + rng.uniform(1.6, 2.6)
    to_and_fro = {Joint.ROTATION: rng.uniform(10, 22), Joint.PRONATION: rng.uniform(5, 20)}
    sway(motion, now_s, end_s, rng.uniform(1.6, 3.0), to_and_fro, rng)
    return settle(motion, end_s, HANGING, rng)


def shake_hands(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Shake somebody's hand."""
    now_s = settle(motion, start_s, arm(35, 5, 12, 55, 5), rng, haste=1.4)
    end_s = now_s + rng.uniform(1.3, 2.0)
    shaking = {Joint.ELBOW: rng.uniform(5, 12), Joint.FLEXION: 3}
    sway(motion, now_s, end_s, rng.uniform(2.0, 3.2), shaking, rng)
    return settle(motion, end_s, HANGING, rng)


def knock(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Knock at a door."""
    at_the_door = arm(60, 10, 25, 80, 20)
    now_s = settle(motion, start_s, at_the_door, rng, haste=1.3)
    for _ in range(rng.integers(2, 5)):
        beat_s = rng.uniform(0.22, 0.32)
        motion.move({Joint.ELBOW: 68}, now_s, beat_s / 2)
        jolt(motion, now_s + 0.45 * beat_s, rng.uniform(0.002, 0.005))
        motion.move({Joint.ELBOW: 80}, now_s + beat_s / 2, beat_s / 2)
        now_s += beat_s
    return settle(motion, now_s, HANGING, rng)


def throw(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Toss something to somebody, underarm."""
    now_s = settle(motion, start_s, arm(-28, 8, 5, 25, 10), rng, haste=1.3)
    thrown_s = rng.uniform(0.35, 0.55)
    motion.move({Joint.FLEXION: rng.uniform(55, 80), Joint.ELBOW: 30}, now_s, thrown_s)
    return settle(motion, now_s + thrown_s + 0.2, HANGING, rng)


def point(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Point at something."""
    there = arm(rng.uniform(60, 95), rng.uniform(-5, 30), 15, 8, rng.uniform(20, 70))
    now_s = settle(motion, start_s, there, rng, haste=1.5) + rng.uniform(0.4, 1.2)
    return settle(motion, now_s, HANGING, rng)


SIGNS: tuple[Activity, ...] = (clap, wave, shake_hands, knock, throw, point)
LIVELY: tuple[Activity, ...] = (*EVERYDAY, *SIGNS, *SIGNS)
"""Everyday movement with many signs in it."""
