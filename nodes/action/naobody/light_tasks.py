"""What a virtual robot does with its lights: brightness, as at the start, a play of colours."""

from __future__ import annotations

import random

from nodes.action.naobody import leds
from nodes.action.naobody.motion import TICK_S
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.tasks import Task

EYES = ("LeftFaceLeds", "RightFaceLeds")
CHANGE_S = 0.2
RASTA = (0x00FF00, 0xFFFF00, 0xFF0000)


def set_intensity(robot: VirtualRobot, group: str, percent: float) -> Task:
    """Make lights brighter or darker; those that are off become white or blue, as they can."""
    for light in leds.lights(group):
        full = leds.brightest(robot.leds[light] or leds.AT_START[light] or leds.WHITE)
        robot.leds[light] = leds.mixed(leds.OFF, full, percent / 100.0)
    yield
    return ""


def reset(robot: VirtualRobot, group: str) -> Task:
    """Light a group as it was when the robot started."""
    for light in leds.lights(group):
        robot.leds[light] = leds.AT_START[light]
    yield
    return ""


def random_eyes(robot: VirtualRobot, seconds: float) -> Task:
    """Change the colour of each eye by chance, then let them be as they were."""
    chance = random.Random(robot.name)
    return (yield from _play_of_colours(robot, seconds, lambda _: chance.randrange(0x1000000)))


def rotate_eyes(robot: VirtualRobot, seconds: float) -> Task:
    """Let three colours go from eye to eye, then let them be as they were."""
    return (yield from _play_of_colours(robot, seconds, lambda turn: RASTA[turn % len(RASTA)]))


def _play_of_colours(robot: VirtualRobot, seconds: float, colour: leds.Colouring) -> Task:
    before = {eye: robot.leds[eye] for eye in EYES}
    try:
        for tick in range(round(seconds / TICK_S)):
            turn, rest = divmod(tick, round(CHANGE_S / TICK_S))
            if rest == 0:
                for number, eye in enumerate(EYES):
                    robot.leds[eye] = colour(turn + number)
            yield
    finally:
        robot.leds.update(before)
    return ""
