"""What a virtual robot does for each action: generators that move it on by one tick at a time.

A task yields once a tick (TICK_S) and returns what there is to say at its end, mostly nothing.
Closing it leaves the robot as it is. It raises ActionFailed when the robot cannot do it.
"""

from __future__ import annotations

import math
from collections.abc import Collection

import numpy as np

from robots.errors import ActionFailed

from . import body as leds
from .actions import Play, Say
from .animations import NO_GESTURE, Animation
from .body import Angles, posture_path
from .keyframes import Keyframes, minimum_jerk, ticks
from .limbs import Limb
from .motion import POSTURE_SPEED, TICK_S, Motion, approach_delay_s, keyframe_motion, move
from .pose import VirtualRobot
from .schedule import Task
from .speech import BODY_LANGUAGES, Spoken, speaking_time_s, spoken_parts
from .stance import Leaning, between, leaning_s

LOOKING_SPEED = 0.3
RETURN_SPEED = 0.5
MOVED_FEET_M = 0.01
"""Feet that are so far from where they were said to be have moved."""
SHORTEST_GESTURE = 0.8
"""A gesture is not played in less than this part of its time, even if the words are shorter."""
DOES_NOT_STAND = {"sitting": "sits", "lying": "lies", "crouching": "crouches", "resting": "rests"}


HOTTEST_WALK_C = 85.0
"""With a hotter motor a robot begins no walk: it has hardly any strength left. Source: NAOqi
switches the motors of a NAO off at about 95."""
LOWEST_WALK_BATTERY = 0.15
"""With less in its battery a robot begins no walk: it may lie down where it is."""


def check_fit_to_walk(name: str, hottest: tuple[str, float], battery: float) -> None:
    """Raise ActionFailed when a robot should rest instead of walking.

    ``name`` is the robot's, ``hottest`` the joint with the hottest motor and its °C, ``battery`` is
    0 to 1.
    """
    joint, celsius = hottest
    if celsius > HOTTEST_WALK_C:
        raise ActionFailed(
            "{name} does not walk now: the motor of {joint} has {celsius} °C. Let it rest until "
            "it has cooled down.",
            code="too_hot_to_walk",
            checklist=COOLING,
            name=name,
            joint=joint,
            celsius=f"{celsius:.0f}",
        )
    if battery < LOWEST_WALK_BATTERY:
        raise ActionFailed(
            "{name} does not walk now: its battery is nearly empty, {battery} %. Let it rest, and "
            "plug it in.",
            code="battery_too_low_to_walk",
            checklist=CHARGING,
            name=name,
            battery=f"{battery * 100:.0f}",
        )


COOLING = (
    'Let {name} rest for some minutes: the block "{name} rests" does it.',
    "Let {name} sit between what it does standing.",
)
CHARGING = (
    'Let {name} rest: the block "{name} rests" does it.',
    "Plug {name} in, and wait until it is charged.",
)


def speak(robot: VirtualRobot, text: str, seconds: float) -> Task:
    """Be saying a text for some seconds."""
    robot.saying = text
    try:
        for _ in range(round(seconds / TICK_S)):
            yield
    finally:
        robot.saying = ""
    return ""


def take_posture(robot: VirtualRobot, goal: str) -> Task:
    """Move to a posture, through the postures and key poses that lie between."""
    body = robot.body
    path = posture_path(body, robot.posture, goal)
    if robot.passed and path[0] != robot.towards:
        yield from _go_back(robot)
    for posture in path:
        poses = body.key_poses(robot.posture, posture)[len(robot.passed) :]
        robot.towards = posture
        for pose in poses:
            yield from lean(robot, np.array(pose.angles), np.array(pose.down))
            robot.passed = (*robot.passed, pose)
        yield from lean(robot, body.posture_angles(posture), resting_down(robot, posture))
        robot.be_in(posture)
    if robot.family != "lying":
        robot.fallen = False
    feet = robot.stance.feet_base()
    if robot.family == "standing" and not np.allclose(robot.base, feet, atol=MOVED_FEET_M):
        robot.base = feet
    return ""


def _go_back(robot: VirtualRobot) -> Task:
    """Go back to the posture that was left on a way which was not gone to its end."""
    while robot.passed:
        pose = robot.passed[-1]
        yield from lean(robot, np.array(pose.angles), np.array(pose.down))
        robot.passed = robot.passed[:-1]
    goal = robot.body.posture_angles(robot.posture)
    return (yield from lean(robot, goal, resting_down(robot, robot.posture)))


def lean(robot: VirtualRobot, goal: Angles, down: Angles) -> Task:
    """Move all joints to a pose while the torso leans over to where ``down`` is down in it."""
    body, before = robot.body, robot.stance.down
    motion = move(
        body, robot.angles, goal, range(len(body.names)), at_least_s=leaning_s(before, down)
    )
    if np.allclose(robot.angles, goal, atol=1e-4) and np.allclose(before, down, atol=1e-3):
        return ""
    progress = minimum_jerk(ticks(motion.duration_s, TICK_S) / motion.duration_s)
    for part, _ in zip(progress, play_motion(robot, motion), strict=True):
        robot.stance.guide = Leaning(between(before, down, float(part)))
        yield
    return ""


def resting_down(robot: VirtualRobot, posture: str) -> Angles:
    """Return which way is down in the torso of a robot that rests in a posture."""
    known = robot.body.postures[posture]
    turn = robot.stance.skeleton.resting_turn(robot.body.posture_angles(posture), known.down)
    down: Angles = -turn[2]
    return down


def play(robot: VirtualRobot, animation: Animation, keyframes: Keyframes | None = None) -> Task:
    """Play an animation, or its changed keyframes, and go back to the posture it began in."""
    if animation.starts_from and animation.starts_from != robot.posture:
        yield from take_posture(robot, animation.starts_from)
    tasks = [_act(robot, keyframes or animation.keyframes)]
    if animation.says:
        tasks.append(speak(robot, animation.says, speaking_time_s(animation.says)))
    return (yield from at_once(tasks))


def look(robot: VirtualRobot, yaw: float, pitch: float) -> Task:
    """Turn the head as far as it goes towards a direction (rad)."""
    goal = robot.angles.copy()
    head = list(robot.body.head)
    goal[head] = yaw, pitch
    goal, clamped = robot.body.clamped(goal)
    yield from play_motion(
        robot, move(robot.body, robot.angles, goal, head, speed=LOOKING_SPEED, at_least_s=0.3)
    )
    if not clamped:
        return ""
    left, down = np.degrees(goal[head])
    return f"looked as far as its head goes: {left:.0f} degrees to the left, {down:.0f} down"


def light(robot: VirtualRobot, group: str, colour: int, seconds: float) -> Task:
    """Fade a group of lights to a colour.

    ``robot`` is whose lights they are, ``group`` which of them, ``colour`` 0xRRGGBB, reached in
    so many ``seconds``.
    """
    before = {name: leds.shining(robot.leds, name) for name in leds.lights(group)}
    steps = max(1, round(seconds / TICK_S))
    for step in range(1, steps + 1):
        for name, old in before.items():
            leds.shine(robot.leds, name, leds.mixed(old, colour, step / steps))
        yield
    return ""


def _act(robot: VirtualRobot, keyframes: Keyframes) -> Task:
    motion = keyframe_motion(robot.body, robot.angles, keyframes)
    yield from play_motion(robot, motion)
    yield from go(robot, robot.posture, robot.body.limbs_of(keyframes.tracks), RETURN_SPEED)
    return "; ".join(motion.notes)


def go(
    robot: VirtualRobot, posture: str, limbs: Collection[Limb], speed: float = POSTURE_SPEED
) -> Task:
    """Move some limbs to where they are in a posture.

    ``robot`` moves, at most at ``speed`` (0 to 1) times its joints' top speeds.
    """
    body = robot.body
    columns = body.columns(limbs)
    goal = body.posture_angles(posture)
    if np.allclose(robot.angles[columns], goal[columns], atol=1e-4):
        return ""
    return (yield from play_motion(robot, move(body, robot.angles, goal, columns, speed=speed)))


def play_motion(robot: VirtualRobot, motion: Motion) -> Task:
    """Move joints through every row of a motion, one a tick."""
    columns = list(motion.columns)
    for row in motion.angles:
        robot.angles[columns] = row
        yield
    return ""


def at_once(tasks: list[Task]) -> Task:
    """Run tasks at the same time, until the last one ends."""
    notes = []
    while tasks:
        for task in tuple(tasks):
            try:
                next(task)
            except StopIteration as end:
                tasks.remove(task)
                notes.append(end.value)
        if tasks:
            yield
    return "; ".join(filter(None, notes))


def changed(keyframes: Keyframes, action: Play) -> Keyframes:
    """Return keyframes for the other side, backwards, slower or faster, as an action asks."""
    if action.mirror:
        keyframes = keyframes.mirrored()
    if action.reverse:
        keyframes = keyframes.reversed()
    return keyframes.stretched(action.stretch)


def fitted(robot: VirtualRobot, keyframes: Keyframes, seconds: float) -> Keyframes:
    """Return a gesture as often as goes into some seconds, a little faster or slower to fit."""
    seconds -= approach_delay_s(robot.body, robot.angles, keyframes)
    repeats = max(1, round(seconds / keyframes.duration_s))
    factor = seconds / (repeats * keyframes.duration_s)
    return keyframes.stretched(max(factor, SHORTEST_GESTURE)).repeated(repeats)


def moved_base(base: Angles, way: Angles) -> Angles:
    """Return the base after going a way (m, m, rad) that is relative to it."""
    forward, left, turn = way
    cosine, sine = math.cos(base[2]), math.sin(base[2])
    x, y = forward * cosine - left * sine, forward * sine + left * cosine
    moved: Angles = base + np.array([x, y, turn])
    return moved


# What a virtual robot does to say something: it speaks for its time, and makes gestures.


def say(robot: VirtualRobot, action: Say) -> Task:
    """Speak, moving as the gesture says, over and over until the words end."""
    part = action.speed / 100.0
    seconds = speaking_time_s(action.text) / part
    voice = {"voice_speed": action.speed, "voice_pitch": action.pitch}
    spoken_in = action.language or action.usual_language or str(robot.settings["language"])
    robot.settings |= voice | {"voice_language": spoken_in}
    tasks = [speak(robot, action.text, seconds)]
    if seconds > 0.0:
        tasks.append(_gestures(robot, spoken(robot, action), part))
    return (yield from at_once(tasks))


def spoken(robot: VirtualRobot, action: Say) -> list[Spoken]:
    """Return the parts of what is said, each with its gesture. Raises ActionFailed."""
    if action.gesture in BODY_LANGUAGES:
        return spoken_parts(action.text, action.gesture, robot.animations, robot.gesture_words)
    if action.gesture != NO_GESTURE:
        robot.animations.get(action.gesture, "gesture")
    return [Spoken(action.text, action.gesture)]


def speaking_limbs(robot: VirtualRobot, action: Say) -> frozenset[Limb]:
    """Return what speaking moves: the voice, and what the gestures need. Raises ActionFailed."""
    limbs = frozenset({Limb.VOICE})
    for part in spoken(robot, action):
        if part.gesture != NO_GESTURE:
            limbs |= robot.animations.get(part.gesture, "gesture").limbs
    return limbs


def _gestures(robot: VirtualRobot, parts: list[Spoken], speed: float) -> Task:
    for part in parts:
        seconds = speaking_time_s(part.text) / speed
        if part.gesture == NO_GESTURE or seconds <= 0.0:
            for _ in range(round(seconds * 100.0)):
                yield
            continue
        animation = robot.animations.get(part.gesture, "gesture")
        yield from play(robot, animation, fitted(robot, animation.keyframes, seconds))
    return ""
