"""What a virtual robot does for each action: generators that move it on by one tick at a time.

A task yields once a tick (TICK_S) and returns what there is to say at its end, mostly nothing.
Closing it leaves the robot as it is. It raises ActionFailed when the robot cannot do it.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Generator

import numpy as np

from nep_core.errors import ActionFailed
from nodes.action.naobody import leds
from nodes.action.naobody.actions import Play
from nodes.action.naobody.animations import NO_GESTURE, Animation
from nodes.action.naobody.body import Angles
from nodes.action.naobody.gait import plan_walk
from nodes.action.naobody.keyframes import Keyframes
from nodes.action.naobody.limbs import MOVING, Limb
from nodes.action.naobody.motion import (
    POSTURE_SPEED,
    TICK_S,
    Motion,
    approach_delay_s,
    braking,
    braking_way_s,
    keyframe_motion,
    move,
)
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.postures import posture_path
from nodes.action.naobody.speech import speaking_time_s

Task = Generator[None, None, str]

WALKING_POSTURE = "StandInit"
LOOKING_SPEED = 0.3
RETURN_SPEED = 0.5
SHORTEST_GESTURE = 0.8
"""A gesture is not played in less than this part of its time, even if the words are shorter."""
DOES_NOT_STAND = {"sitting": "sits", "lying": "lies", "crouching": "crouches", "resting": "rests"}


def say(robot: VirtualRobot, text: str, gesture: str, speed: float = 1.0) -> Task:
    """Speak, moving as the gesture says, over and over until the words end."""
    seconds = speaking_time_s(text) / speed
    tasks = [speak(robot, text, seconds)]
    if gesture != NO_GESTURE and seconds > 0.0:
        animation = robot.animations.get(gesture, "gesture")
        tasks.append(play(robot, animation, _fitted(robot, animation.keyframes, seconds)))
    return (yield from at_once(tasks))


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
    """Move to a posture, through the postures that lie between."""
    for posture in posture_path(robot.body, robot.posture, goal):
        yield from go(robot, posture, MOVING)
        robot.posture = posture
    return ""


def play(robot: VirtualRobot, animation: Animation, keyframes: Keyframes | None = None) -> Task:
    """Play an animation, or its changed keyframes, and go back to the posture it began in."""
    if animation.starts_from and animation.starts_from != robot.posture:
        yield from take_posture(robot, animation.starts_from)
    tasks = [_act(robot, keyframes or animation.keyframes)]
    if animation.says:
        tasks.append(speak(robot, animation.says, speaking_time_s(animation.says)))
    return (yield from at_once(tasks))


def walk(
    robot: VirtualRobot,
    forward_m: float,
    left_m: float,
    turn: float,
    *,
    at_least_steps: int = 1,
) -> Task:
    """Walk over the floor with steps, turning by ``turn`` rad on the way.

    Raises ActionFailed when the robot does not stand.
    """
    if robot.family in DOES_NOT_STAND:
        raise ActionFailed(
            f"{robot.name} {DOES_NOT_STAND[robot.family]}: it must stand before it can walk. "
            'Let it do "posture_stand" first.'
        )
    if not (forward_m or left_m or turn):
        return ""
    yield from go(robot, WALKING_POSTURE, {Limb.LEGS})
    robot.posture = WALKING_POSTURE
    standing = robot.body.posture_angles(WALKING_POSTURE)
    plan = plan_walk(robot.body, standing, forward_m, left_m, turn, at_least_steps=at_least_steps)
    start = robot.base
    for place, _ in zip(plan.base, play_motion(robot, plan.legs), strict=True):
        robot.base = moved_base(start, place)
        yield
    robot.base = moved_base(start, np.array([forward_m, left_m, turn]))
    return ""


def look(robot: VirtualRobot, yaw: float, pitch: float) -> Task:
    """Turn the head as far as it goes towards a direction (rad)."""
    goal = robot.angles.copy()
    head = list(robot.body.head)
    goal[head] = yaw, pitch
    goal, clamped = robot.body.clamped(goal)
    yield from play_motion(
        robot, move(robot.body, robot.angles, goal, head, speed=LOOKING_SPEED, at_least_s=0.3)
    )
    return _as_far_as_it_goes(goal[head]) if clamped else ""


def light(robot: VirtualRobot, group: str, colour: int, seconds: float) -> Task:
    """Fade a group of lights to a colour."""
    before = {name: robot.leds[name] for name in leds.lights(group)}
    steps = max(1, round(seconds / TICK_S))
    for step in range(1, steps + 1):
        for name, old in before.items():
            robot.leds[name] = leds.mixed(old, colour, step / steps)
        yield
    return ""


def come_to_rest(
    robot: VirtualRobot, limbs: Collection[Limb], joint_speed: Angles, base_speed: Angles
) -> Task:
    """Brake some limbs from the speeds they have: every joint's (rad/s), the base's (m/s, rad/s).

    A standing robot that stops its legs also puts its feet back under itself.
    """
    motion = braking(robot.body, robot.angles, joint_speed, robot.body.columns(limbs))
    start = robot.base
    for part, _ in zip(braking_way_s(), play_motion(robot, motion), strict=True):
        if Limb.LEGS in limbs:
            robot.base = start + part * base_speed
        yield
    if Limb.LEGS in limbs and robot.family == "standing":
        yield from go(robot, robot.posture, {Limb.LEGS})
    return ""


def _act(robot: VirtualRobot, keyframes: Keyframes) -> Task:
    motion = keyframe_motion(robot.body, robot.angles, keyframes)
    yield from play_motion(robot, motion)
    yield from go(robot, robot.posture, robot.body.limbs_of(keyframes.tracks), RETURN_SPEED)
    return "; ".join(motion.notes)


def go(
    robot: VirtualRobot, posture: str, limbs: Collection[Limb], speed: float = POSTURE_SPEED
) -> Task:
    """Move some limbs to where they are in a posture."""
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


def _fitted(robot: VirtualRobot, keyframes: Keyframes, seconds: float) -> Keyframes:
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


def _as_far_as_it_goes(head: Angles) -> str:
    yaw, pitch = np.degrees(head)
    return f"looked as far as its head goes: {yaw:.0f} degrees to the left, {pitch:.0f} down"
