"""What hands do in a house, a street and a classroom that looks a little like a gesture.

Nothing here is a sign that somebody would teach a robot: such (clapping, waving) are in lively.py.
"""

from __future__ import annotations

import numpy as np

from nodes.sensory.arm.gestures import arm, trunk
from nodes.sensory.arm.motion import Motion
from nodes.sensory.arm.moving import Activity, jolt, settle, shift, sway
from nodes.sensory.arm.skeleton import Joint

_HANGING = arm(3, 8, 5, 15, 25)
_ON_PAPER = arm(30, 14, 42, 80, 55)
_PLATE, _MOUTH = arm(35, 16, 40, 85, 45), arm(48, 30, 50, 136, 5)
_PHONE = arm(28, 10, 48, 105, 10)
_POT = arm(38, 14, 30, 80, 30)
_TABLE = arm(45, 15, 30, 55, 70)
_ARMS_ABOUT = arm(45, 20, 40, 85, 15)


def write_by_hand(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Write: the fingers pull at the forearm, the hand goes along the line and jumps back."""
    now_s = settle(motion, start_s, {**_ON_PAPER, **trunk(0, 8)}, rng)
    end_s = now_s + rng.uniform(3.0, 6.0)
    stroke = {Joint.PRONATION: 1.5, Joint.ROTATION: 0.8, Joint.ELBOW: 0.6}
    sway(motion, now_s, end_s, rng.uniform(3.0, 5.0), stroke, rng)
    while now_s < end_s - 2.0:
        motion.move({Joint.ROTATION: _ON_PAPER[Joint.ROTATION] - 12}, now_s, 1.6)
        motion.move({Joint.ROTATION: _ON_PAPER[Joint.ROTATION]}, now_s + 1.6, 0.4)
        now_s += 2.0
    return end_s


def wipe_table(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Wipe a table in circles."""
    now_s = settle(motion, start_s, {**_TABLE, **trunk(0, 15)}, rng)
    end_s = now_s + rng.uniform(2.0, 5.0)
    round_hz = rng.uniform(0.9, 1.6)
    sway(motion, now_s, end_s, round_hz, {Joint.ROTATION: rng.uniform(8, 18)}, rng)
    sway(motion, now_s, end_s, round_hz, {Joint.FLEXION: 8, Joint.ELBOW: 10}, rng)
    return settle(motion, end_s, {**_HANGING, **trunk(0)}, rng)


def brush_teeth(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Brush teeth, changing the side."""
    now_s = settle(motion, start_s, arm(55, 35, 48, 132, 10), rng)
    for _ in range(rng.integers(2, 4)):
        end_s = now_s + rng.uniform(1.2, 2.5)
        brush = {Joint.ROTATION: rng.uniform(2, 5), Joint.PRONATION: rng.uniform(2, 7)}
        sway(motion, now_s, end_s, rng.uniform(2.8, 4.5), brush, rng)
        now_s = shift(motion, end_s - 0.3, arm(55, 35, 48, 132, 10), 8.0, rng)
    return settle(motion, now_s, _HANGING, rng)


def eat(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Bring a fork to the mouth a few times."""
    now_s = settle(motion, start_s, {**_PLATE, **trunk(0, 8)}, rng)
    for _ in range(rng.integers(2, 5)):
        now_s = shift(motion, now_s, _PLATE, 5.0, rng)
        now_s = settle(motion, now_s, _MOUTH, rng, haste=1.3) + rng.uniform(0.1, 0.4)
        now_s = settle(motion, now_s, _PLATE, rng, haste=1.3) + rng.uniform(0.2, 1.0)
    return now_s


def phone_to_ear(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Make a call."""
    now_s = settle(motion, start_s, _PHONE, rng) + rng.uniform(0.3, 1.0)
    now_s = settle(motion, now_s, arm(52, 42, 35, 142, -15), rng, haste=1.4)
    end_s = now_s + rng.uniform(2.0, 4.0)
    sway(motion, now_s, end_s, rng.uniform(0.4, 0.9), {Joint.TWIST: 6, Joint.ABDUCTION: 3}, rng)
    return settle(motion, end_s, _HANGING, rng)


def tap_on_phone(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Write on a phone, tilting it now and then."""
    now_s = settle(motion, start_s, _PHONE, rng)
    end_s = now_s + rng.uniform(2.5, 5.0)
    sway(motion, now_s, end_s, rng.uniform(3.0, 6.0), {Joint.PRONATION: 0.8}, rng)
    while now_s < end_s - 1.2:
        now_s = shift(motion, now_s + rng.uniform(0.2, 0.8), _PHONE, 6.0, rng, (0.25, 0.6))
    return end_s


def stir(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Stir in a pot."""
    now_s = settle(motion, start_s, _POT, rng)
    end_s = now_s + rng.uniform(2.0, 5.0)
    round_hz = rng.uniform(1.1, 2.2)
    sway(motion, now_s, end_s, round_hz, {Joint.ROTATION: rng.uniform(4, 9)}, rng)
    sway(motion, now_s, end_s, round_hz, {Joint.ELBOW: rng.uniform(4, 8)}, rng)
    return end_s


def reach_to_shelf(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Take something from a shelf, high or low."""
    high = rng.uniform(85, 130)
    shelf = {**arm(high, 8, 15, 35, 30), **trunk(rng.uniform(-12, 12))}
    now_s = settle(motion, start_s, shelf, rng, haste=1.2) + rng.uniform(0.3, 0.8)
    now_s = settle(motion, now_s, arm(high - 25, 8, 20, 75, 30), rng, haste=1.3)
    return settle(motion, now_s, {**_HANGING, **trunk(0)}, rng)


def pick_up(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Bend down for something on the floor."""
    down = {Joint.LEAN: rng.uniform(50, 75), Joint.UP: -rng.uniform(0.1, 0.3)}
    now_s = settle(motion, start_s, {**arm(30, 6, 5, 10, 20), **down}, rng, haste=1.2)
    jolt(motion, now_s, 0.0015)
    up = {Joint.LEAN: 0.0, Joint.UP: 0.0}
    now_s = settle(motion, now_s + rng.uniform(0.1, 0.5), {**_PHONE, **up}, rng)
    return settle(motion, now_s + rng.uniform(0.2, 1.0), _HANGING, rng)


def open_door(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Press a door handle, and pull or push the door."""
    now_s = settle(motion, start_s, arm(40, 8, 15, 40, 40), rng, haste=1.3)
    motion.move({Joint.PRONATION: 75}, now_s, 0.35)
    jolt(motion, now_s + 0.3, 0.001)
    way = rng.choice([-1, 1]) * rng.uniform(20, 35)
    motion.move({Joint.FLEXION: 40 + way, Joint.ELBOW: 55 - way}, now_s + 0.35, 0.8)
    return settle(motion, now_s + 1.2, _HANGING, rng)


def put_on_jacket(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Get into sleeves: wide movements one after the other."""
    now_s = start_s
    for pose in (arm(-30, 35, -30, 60, 0), arm(60, 60, 20, 90, 30), arm(40, 20, 60, 110, -20)):
        now_s = shift(motion, now_s, pose, 14.0, rng, (0.5, 1.0)) - 0.1
    motion.move({Joint.TWIST: rng.uniform(-25, 25)}, start_s, 1.0)
    return settle(motion, now_s + 0.1, {**_HANGING, **trunk(0)}, rng)


def talk_widely(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Talk with big gestures of the arms."""
    now_s = settle(motion, start_s, _ARMS_ABOUT, rng)
    for _ in range(rng.integers(5, 12)):
        now_s = shift(motion, now_s, _ARMS_ABOUT, rng.uniform(12, 30), rng, (0.25, 0.8))
        now_s += rng.uniform(-0.15, 0.4)
    return settle(motion, now_s, _HANGING, rng)


def climb_stairs(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Climb stairs: slower than walking, each step heavier."""
    now_s = settle(motion, start_s, {**_HANGING, Joint.UP: 0.0, **trunk(0, 8)}, rng)
    end_s = now_s + rng.uniform(3.0, 7.0)
    stride_hz = rng.uniform(0.6, 0.85)
    swing = {Joint.FLEXION: rng.uniform(6, 14), Joint.ELBOW: rng.uniform(3, 8), Joint.TWIST: 5.0}
    sway(motion, now_s, end_s, stride_hz, swing, rng)
    sway(motion, now_s, end_s, 2 * stride_hz, {Joint.UP: rng.uniform(0.02, 0.04)}, rng)
    _tread(motion, now_s, end_s, 2 * stride_hz, rng.uniform(0.0005, 0.0015))
    return end_s


def run_a_little(motion: Motion, start_s: float, rng: np.random.Generator) -> float:
    """Run some steps."""
    running = {**arm(5, 12, 15, 90, 10), Joint.UP: 0.0, **trunk(0, 10)}
    now_s = settle(motion, start_s, running, rng, haste=1.4)
    end_s = now_s + rng.uniform(2.5, 5.0)
    stride_hz = rng.uniform(1.2, 1.45)
    swing = {Joint.FLEXION: rng.uniform(18, 32), Joint.ELBOW: rng.uniform(5, 12), Joint.TWIST: 7.0}
    sway(motion, now_s, end_s, stride_hz, swing, rng)
    sway(motion, now_s, end_s, 2 * stride_hz, {Joint.UP: rng.uniform(0.025, 0.045)}, rng)
    _tread(motion, now_s, end_s, 2 * stride_hz, rng.uniform(0.001, 0.003))
    return settle(motion, end_s, {**_HANGING, **trunk(0)}, rng)


CHORES: tuple[Activity, ...] = (
    write_by_hand,
    wipe_table,
    brush_teeth,
    eat,
    phone_to_ear,
    tap_on_phone,
    stir,
    reach_to_shelf,
    pick_up,
    open_door,
    put_on_jacket,
    talk_widely,
    climb_stairs,
    run_a_little,
)


def _tread(
    motion: Motion, start_s: float, end_s: float, steps_a_second: float, size_m: float
) -> None:
    """The heels, in a regular row."""
    for at_s in np.arange(start_s + 0.5, end_s - 0.5, 1 / steps_a_second).tolist():
        jolt(motion, at_s, size_m)
