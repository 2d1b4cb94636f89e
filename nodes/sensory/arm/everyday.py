"""Everyday movement: what people do with their hands when they make no gesture."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .gestures import arm, trunk
from .motion import LENGTHS, Joint, Motion, Pose, Swing, joint_values

# What everyday movements are made of: going to a pose, small shifts, oscillations, jolts.

Chance = np.random.Generator
Activity = Callable[[Motion, float, Chance], float]
"""Plans something from a time on; tells until when."""

_JOLT_S = 0.05


def settle(motion: Motion, start_s: float, pose: Pose, rng: Chance, haste: float = 1.0) -> float:
    """Go to about this pose, slower where it is farther; tells when it is reached.

    ``motion`` gets the movement, from ``start_s``; ``rng`` is the chance, ``haste`` 2 twice as
    fast.
    """
    goal = {
        joint: value if joint in LENGTHS else value + rng.normal(0.0, 4.0)
        for joint, value in pose.items()
    }
    now = motion.goal
    ways_rad = [
        abs(np.radians(value) - now[joint]) for joint, value in goal.items() if joint not in LENGTHS
    ]
    duration_s = (rng.uniform(0.6, 0.9) + 0.35 * max(ways_rad, default=0.0)) / haste
    motion.move(goal, start_s, duration_s)
    return start_s + duration_s


def shift(
    motion: Motion,
    start_s: float,
    pose: Pose,
    wide_deg: float,
    rng: Chance,
    lasting_s: tuple[float, float] = (0.35, 0.9),
) -> float:
    """A free movement about a pose; tells when it ends.

    ``motion`` gets the movement, from ``start_s``, about ``wide_deg`` wide; ``rng`` is the
    chance, ``lasting_s`` the shortest and longest time.
    """
    duration_s = rng.uniform(*lasting_s)
    around = {joint: value + rng.normal(0.0, wide_deg) for joint, value in pose.items()}
    motion.move(around, start_s, duration_s)
    return start_s + duration_s


def sway(
    motion: Motion, start_s: float, end_s: float, frequency_hz: float, pose: Pose, rng: Chance
) -> None:
    """An oscillation; ``pose`` holds how far, in degrees (hips in m).

    ``motion`` gets it from ``start_s`` to ``end_s``, ``frequency_hz`` times a second; ``rng``
    is the chance.
    """
    phase = float(rng.uniform(0, 2 * np.pi))
    motion.swing(Swing(start_s, end_s, frequency_hz, phase, joint_values(pose)))


def jolt(motion: Motion, at_s: float, size_m: float) -> None:
    """A knock that goes through the arm: heels on the floor, a hand on a door, clapping hands."""
    up = float(motion.goal[Joint.UP])
    motion.move({Joint.UP: up + size_m}, at_s, _JOLT_S)
    motion.move({Joint.UP: up}, at_s + 0.6 * _JOLT_S, _JOLT_S)


# What hands do in a house, a street and a classroom that looks a little like a gesture.
#
# Nothing here is a sign that somebody would teach a robot: such (clapping, waving) are in SIGNS.

HANGING = arm(3, 8, 5, 15, 25)
_ON_PAPER = arm(30, 14, 42, 80, 55)
_PLATE, _MOUTH = arm(35, 16, 40, 85, 45), arm(48, 30, 50, 136, 5)
_PHONE = arm(28, 10, 48, 105, 10)
_POT = arm(38, 14, 30, 80, 30)
_TABLE = arm(45, 15, 30, 55, 70)
_ARMS_ABOUT = arm(45, 20, 40, 85, 15)


def write_by_hand(motion: Motion, start_s: float, rng: Chance) -> float:
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


def wipe_table(motion: Motion, start_s: float, rng: Chance) -> float:
    """Wipe a table in circles."""
    now_s = settle(motion, start_s, {**_TABLE, **trunk(0, 15)}, rng)
    end_s = now_s + rng.uniform(2.0, 5.0)
    round_hz = rng.uniform(0.9, 1.6)
    sway(motion, now_s, end_s, round_hz, {Joint.ROTATION: rng.uniform(8, 18)}, rng)
    sway(motion, now_s, end_s, round_hz, {Joint.FLEXION: 8, Joint.ELBOW: 10}, rng)
    return settle(motion, end_s, {**HANGING, **trunk(0)}, rng)


def brush_teeth(motion: Motion, start_s: float, rng: Chance) -> float:
    """Brush teeth, changing the side."""
    now_s = settle(motion, start_s, arm(55, 35, 48, 132, 10), rng)
    for _ in range(rng.integers(2, 4)):
        end_s = now_s + rng.uniform(1.2, 2.5)
        brush = {Joint.ROTATION: rng.uniform(2, 5), Joint.PRONATION: rng.uniform(2, 7)}
        sway(motion, now_s, end_s, rng.uniform(2.8, 4.5), brush, rng)
        now_s = shift(motion, end_s - 0.3, arm(55, 35, 48, 132, 10), 8.0, rng)
    return settle(motion, now_s, HANGING, rng)


def eat(motion: Motion, start_s: float, rng: Chance) -> float:
    """Bring a fork to the mouth a few times."""
    now_s = settle(motion, start_s, {**_PLATE, **trunk(0, 8)}, rng)
    for _ in range(rng.integers(2, 5)):
        now_s = shift(motion, now_s, _PLATE, 5.0, rng)
        now_s = settle(motion, now_s, _MOUTH, rng, haste=1.3) + rng.uniform(0.1, 0.4)
        now_s = settle(motion, now_s, _PLATE, rng, haste=1.3) + rng.uniform(0.2, 1.0)
    return now_s


def phone_to_ear(motion: Motion, start_s: float, rng: Chance) -> float:
    """Make a call."""
    now_s = settle(motion, start_s, _PHONE, rng) + rng.uniform(0.3, 1.0)
    now_s = settle(motion, now_s, arm(52, 42, 35, 142, -15), rng, haste=1.4)
    end_s = now_s + rng.uniform(2.0, 4.0)
    sway(motion, now_s, end_s, rng.uniform(0.4, 0.9), {Joint.TWIST: 6, Joint.ABDUCTION: 3}, rng)
    return settle(motion, end_s, HANGING, rng)


def tap_on_phone(motion: Motion, start_s: float, rng: Chance) -> float:
    """Write on a phone, tilting it now and then."""
    now_s = settle(motion, start_s, _PHONE, rng)
    end_s = now_s + rng.uniform(2.5, 5.0)
    sway(motion, now_s, end_s, rng.uniform(3.0, 6.0), {Joint.PRONATION: 0.8}, rng)
    while now_s < end_s - 1.2:
        now_s = shift(motion, now_s + rng.uniform(0.2, 0.8), _PHONE, 6.0, rng, (0.25, 0.6))
    return end_s


def stir(motion: Motion, start_s: float, rng: Chance) -> float:
    """Stir in a pot."""
    now_s = settle(motion, start_s, _POT, rng)
    end_s = now_s + rng.uniform(2.0, 5.0)
    round_hz = rng.uniform(1.1, 2.2)
    sway(motion, now_s, end_s, round_hz, {Joint.ROTATION: rng.uniform(4, 9)}, rng)
    sway(motion, now_s, end_s, round_hz, {Joint.ELBOW: rng.uniform(4, 8)}, rng)
    return end_s


def reach_to_shelf(motion: Motion, start_s: float, rng: Chance) -> float:
    """Take something from a shelf, high or low."""
    high = rng.uniform(85, 130)
    shelf = {**arm(high, 8, 15, 35, 30), **trunk(rng.uniform(-12, 12))}
    now_s = settle(motion, start_s, shelf, rng, haste=1.2) + rng.uniform(0.3, 0.8)
    now_s = settle(motion, now_s, arm(high - 25, 8, 20, 75, 30), rng, haste=1.3)
    return settle(motion, now_s, {**HANGING, **trunk(0)}, rng)


def pick_up(motion: Motion, start_s: float, rng: Chance) -> float:
    """Bend down for something on the floor."""
    down = {Joint.LEAN: rng.uniform(50, 75), Joint.UP: -rng.uniform(0.1, 0.3)}
    now_s = settle(motion, start_s, {**arm(30, 6, 5, 10, 20), **down}, rng, haste=1.2)
    jolt(motion, now_s, 0.0015)
    up = {Joint.LEAN: 0.0, Joint.UP: 0.0}
    now_s = settle(motion, now_s + rng.uniform(0.1, 0.5), {**_PHONE, **up}, rng)
    return settle(motion, now_s + rng.uniform(0.2, 1.0), HANGING, rng)


def open_door(motion: Motion, start_s: float, rng: Chance) -> float:
    """Press a door handle, and pull or push the door."""
    now_s = settle(motion, start_s, arm(40, 8, 15, 40, 40), rng, haste=1.3)
    motion.move({Joint.PRONATION: 75}, now_s, 0.35)
    jolt(motion, now_s + 0.3, 0.001)
    connector = rng.choice([-1, 1]) * rng.uniform(20, 35)
    motion.move({Joint.FLEXION: 40 + connector, Joint.ELBOW: 55 - connector}, now_s + 0.35, 0.8)
    return settle(motion, now_s + 1.2, HANGING, rng)


def put_on_jacket(motion: Motion, start_s: float, rng: Chance) -> float:
    """Get into sleeves: wide movements one after the other."""
    now_s = start_s
    for pose in (arm(-30, 35, -30, 60, 0), arm(60, 60, 20, 90, 30), arm(40, 20, 60, 110, -20)):
        now_s = shift(motion, now_s, pose, 14.0, rng, (0.5, 1.0)) - 0.1
    motion.move({Joint.TWIST: rng.uniform(-25, 25)}, start_s, 1.0)
    return settle(motion, now_s + 0.1, {**HANGING, **trunk(0)}, rng)


def talk_widely(motion: Motion, start_s: float, rng: Chance) -> float:
    """Talk with big gestures of the arms."""
    now_s = settle(motion, start_s, _ARMS_ABOUT, rng)
    for _ in range(rng.integers(5, 12)):
        now_s = shift(motion, now_s, _ARMS_ABOUT, rng.uniform(12, 30), rng, (0.25, 0.8))
        now_s += rng.uniform(-0.15, 0.4)
    return settle(motion, now_s, HANGING, rng)


def climb_stairs(motion: Motion, start_s: float, rng: Chance) -> float:
    """Climb stairs: slower than walking, each step heavier."""
    now_s = settle(motion, start_s, {**HANGING, Joint.UP: 0.0, **trunk(0, 8)}, rng)
    end_s = now_s + rng.uniform(3.0, 7.0)
    stride_hz = rng.uniform(0.6, 0.85)
    swing = {Joint.FLEXION: rng.uniform(6, 14), Joint.ELBOW: rng.uniform(3, 8), Joint.TWIST: 5.0}
    sway(motion, now_s, end_s, stride_hz, swing, rng)
    sway(motion, now_s, end_s, 2 * stride_hz, {Joint.UP: rng.uniform(0.02, 0.04)}, rng)
    _tread(motion, now_s, end_s, 2 * stride_hz, rng.uniform(0.0005, 0.0015))
    return end_s


def run_a_little(motion: Motion, start_s: float, rng: Chance) -> float:
    """Run some steps."""
    running = {**arm(5, 12, 15, 90, 10), Joint.UP: 0.0, **trunk(0, 10)}
    now_s = settle(motion, start_s, running, rng, haste=1.4)
    end_s = now_s + rng.uniform(2.5, 5.0)
    stride_hz = rng.uniform(1.2, 1.45)
    swing = {Joint.FLEXION: rng.uniform(18, 32), Joint.ELBOW: rng.uniform(5, 12), Joint.TWIST: 7.0}
    sway(motion, now_s, end_s, stride_hz, swing, rng)
    sway(motion, now_s, end_s, 2 * stride_hz, {Joint.UP: rng.uniform(0.025, 0.045)}, rng)
    _tread(motion, now_s, end_s, 2 * stride_hz, rng.uniform(0.001, 0.003))
    return settle(motion, end_s, {**HANGING, **trunk(0)}, rng)


CHORES: tuple[Activity, ...] = (
    write_by_hand, wipe_table, brush_teeth, eat, phone_to_ear, tap_on_phone, stir, reach_to_shelf,
    pick_up, open_door, put_on_jacket, talk_widely, climb_stairs, run_a_little,
)  # fmt: skip


def _tread(
    motion: Motion, start_s: float, end_s: float, steps_a_second: float, size_m: float
) -> None:
    """The heels, in a regular row."""
    for at_s in np.arange(start_s + 0.5, end_s - 0.5, 1 / steps_a_second).tolist():
        jolt(motion, at_s, size_m)


_ON_THE_LAP = arm(20, 10, 35, 75, 40)
_ON_THE_DESK = arm(35, 15, 40, 75, 70)
_BEFORE_THE_CHEST = arm(35, 12, 45, 95, 20)
_STANDING: Pose = {Joint.FORWARD: 0.0, Joint.UP: 0.0}
_SITTING: Pose = {Joint.FORWARD: -0.25, Joint.UP: -0.42}


def rest(motion: Motion, start_s: float, rng: Chance) -> float:
    """Let the arm hang."""
    return settle(motion, start_s, {**HANGING, **trunk(0)}, rng) + rng.uniform(1.0, 3.0)


def hand_on_lap(motion: Motion, start_s: float, rng: Chance) -> float:
    """Lay the hand down, and shift it now and then."""
    now_s = settle(motion, start_s, {**_ON_THE_LAP, **trunk(0)}, rng)
    for _ in range(rng.integers(1, 4)):
        now_s = shift(motion, now_s + rng.uniform(0.5, 2.0), _ON_THE_LAP, 5.0, rng)
    return now_s


def type_on_keyboard(motion: Motion, start_s: float, rng: Chance) -> float:
    """Type: quick small turns of the forearm, the hand going to and fro over the keys."""
    now_s = settle(motion, start_s, {**_ON_THE_DESK, **trunk(0, 5)}, rng)
    end_s = now_s + rng.uniform(3.0, 7.0)
    for joint, degrees in ((Joint.PRONATION, 1.2), (Joint.ELBOW, 0.5), (Joint.ROTATION, 0.6)):
        sway(motion, now_s, end_s, rng.uniform(2.0, 5.0), {joint: degrees}, rng)
    while now_s < end_s - 1.5:
        now_s = shift(motion, now_s + rng.uniform(0.3, 1.0), _ON_THE_DESK, 4.0, rng)
    return end_s


def drink(motion: Motion, start_s: float, rng: Chance) -> float:
    """Reach for a cup, bring it to the mouth, tilt it, put it back."""
    cup, mouth = arm(50, 10, 20, 50, 0), arm(60, 25, 45, 132, -5)
    now_s = settle(motion, start_s, cup, rng) + 0.4
    now_s = settle(motion, now_s, mouth, rng) + 0.2
    motion.move({Joint.FLEXION: 72, Joint.PRONATION: 15}, now_s, 0.8)
    now_s = settle(motion, now_s + rng.uniform(1.5, 2.5), cup, rng) + 0.3
    return settle(motion, now_s, _ON_THE_DESK, rng)


def scratch_head(motion: Motion, start_s: float, rng: Chance) -> float:
    """Scratch an ear."""
    now_s = settle(motion, start_s, arm(75, 45, 40, 140, 0), rng)
    end_s = now_s + rng.uniform(1.5, 2.5)
    sway(motion, now_s, end_s, rng.uniform(3.0, 4.5), {Joint.ELBOW: 4, Joint.PRONATION: 5}, rng)
    return settle(motion, end_s, _ON_THE_LAP, rng)


def gesticulate(motion: Motion, start_s: float, rng: Chance) -> float:
    """Talk with the hands."""
    now_s = settle(motion, start_s, _BEFORE_THE_CHEST, rng)
    for _ in range(rng.integers(4, 9)):
        now_s = shift(motion, now_s, _BEFORE_THE_CHEST, 16.0, rng) + rng.uniform(-0.15, 0.5)
    return now_s


def look_at_watch(motion: Motion, start_s: float, rng: Chance) -> float:
    """Lift the watch before the eyes."""
    now_s = settle(motion, start_s, arm(40, 20, 65, 105, 75), rng) + rng.uniform(0.8, 2.0)
    return settle(motion, now_s, HANGING, rng)


def walk(motion: Motion, start_s: float, rng: Chance) -> float:
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


def turn_round(motion: Motion, start_s: float, rng: Chance) -> float:
    """Turn on the spot."""
    heading = np.degrees(motion.goal[Joint.HEADING]) + rng.choice([-1, 1]) * rng.uniform(60, 180)
    duration_s = rng.uniform(1.2, 2.2)
    motion.move({Joint.HEADING: heading}, start_s, duration_s)
    sway(motion, start_s, start_s + duration_s, 1.8, {Joint.UP: 0.012}, rng)
    return settle(motion, start_s + duration_s / 2, {**HANGING, **_STANDING}, rng) + 0.5


def sit_down(motion: Motion, start_s: float, rng: Chance) -> float:
    """Sit down, leaning forward on the way."""
    duration_s = rng.uniform(1.2, 1.9)
    motion.move({Joint.LEAN: 35}, start_s, duration_s * 0.7)
    motion.move(_SITTING, start_s + 0.2, duration_s)
    motion.move({**_ON_THE_LAP, **trunk(0)}, start_s + duration_s * 0.6, duration_s * 0.8)
    return start_s + duration_s * 1.4 + rng.uniform(0.5, 2.0)


def stand_up(motion: Motion, start_s: float, rng: Chance) -> float:
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


# Signs that people make to each other all day: what fools a recogniser of other gestures.
#
# They are for testing recognisers, and for a virtual watch that is to be provoking. A model that is
# trained on somebody's own clapping must not learn that clapping is nothing: they are not part of
# the everyday movement that models are trained with.


def clap(motion: Motion, start_s: float, rng: Chance) -> float:
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


def wave(motion: Motion, start_s: float, rng: Chance) -> float:
    """Wave hello, the hand beside the head."""
    now_s = settle(motion, start_s, arm(65, 50, -35, 115, -20), rng, haste=1.4)
    end_s = now_s + rng.uniform(1.6, 2.6)
    to_and_fro = {Joint.ROTATION: rng.uniform(10, 22), Joint.PRONATION: rng.uniform(5, 20)}
    sway(motion, now_s, end_s, rng.uniform(1.6, 3.0), to_and_fro, rng)
    return settle(motion, end_s, HANGING, rng)


def shake_hands(motion: Motion, start_s: float, rng: Chance) -> float:
    """Shake somebody's hand."""
    now_s = settle(motion, start_s, arm(35, 5, 12, 55, 5), rng, haste=1.4)
    end_s = now_s + rng.uniform(1.3, 2.0)
    shaking = {Joint.ELBOW: rng.uniform(5, 12), Joint.FLEXION: 3}
    sway(motion, now_s, end_s, rng.uniform(2.0, 3.2), shaking, rng)
    return settle(motion, end_s, HANGING, rng)


def knock(motion: Motion, start_s: float, rng: Chance) -> float:
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


def throw(motion: Motion, start_s: float, rng: Chance) -> float:
    """Toss something to somebody, underarm."""
    now_s = settle(motion, start_s, arm(-28, 8, 5, 25, 10), rng, haste=1.3)
    thrown_s = rng.uniform(0.35, 0.55)
    motion.move({Joint.FLEXION: rng.uniform(55, 80), Joint.ELBOW: 30}, now_s, thrown_s)
    return settle(motion, now_s + thrown_s + 0.2, HANGING, rng)


def point(motion: Motion, start_s: float, rng: Chance) -> float:
    """Point at something."""
    there = arm(rng.uniform(60, 95), rng.uniform(-5, 30), 15, 8, rng.uniform(20, 70))
    now_s = settle(motion, start_s, there, rng, haste=1.5) + rng.uniform(0.4, 1.2)
    return settle(motion, now_s, HANGING, rng)


SIGNS: tuple[Activity, ...] = (clap, wave, shake_hands, knock, throw, point)
LIVELY: tuple[Activity, ...] = (*EVERYDAY, *SIGNS, *SIGNS)
"""Everyday movement with many signs in it."""
