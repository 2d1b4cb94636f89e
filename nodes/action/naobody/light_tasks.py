"""What a virtual robot does with its lights: brightness, as at the start, a play of colours."""

from __future__ import annotations

import random
from collections.abc import Callable

from nodes.action.naobody import leds
from nodes.action.naobody.motion import TICK_S
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task

EYES = ("LeftFaceLeds", "RightFaceLeds")
CHANGE_S = 0.2
RASTA = (0x00FF00, 0xFFFF00, 0xFF0000)


def set_intensity(robot: VirtualRobot, group: str, percent: float) -> Task:
    """Make lights brighter or darker; those that are off become white or blue, as they can."""
    for light in leds.lights(group):
        lit = leds.shining(robot.leds, light) or leds.at_start(light) or leds.WHITE
        leds.shine(robot.leds, light, leds.mixed(leds.OFF, leds.brightest(lit), percent / 100.0))
    yield
    return ""


def reset(robot: VirtualRobot, group: str) -> Task:
    """Light a group as it was when the robot started."""
    for light in leds.lights(group):
        leds.shine(robot.leds, light, leds.at_start(light))
    yield
    return ""


def random_eyes(robot: VirtualRobot, seconds: float) -> Task:
    """Change the colour of each eye by chance, then let them be as they were."""
    chance = random.Random(robot.name)

    def colour(_: int) -> None:
        for eye in EYES:
            leds.shine(robot.leds, eye, chance.randrange(0x1000000))

    return (yield from _play_of_colours(robot, seconds, colour))


def rotate_eyes(robot: VirtualRobot, seconds: float) -> Task:
    """Let three colours go round each eye, lamp by lamp, then let them be as they were."""

    def colour(turn: int) -> None:
        for eye in EYES:
            lamps = leds.LAMPS[eye]
            leds.shine(robot.leds, eye, RASTA[turn % len(RASTA)])
            for place, lamp in enumerate(lamps):
                part = (place + turn) % len(lamps) * len(RASTA) // len(lamps)
                leds.shine(robot.leds, lamp, RASTA[part])

    return (yield from _play_of_colours(robot, seconds, colour))


def _play_of_colours(robot: VirtualRobot, seconds: float, change: Callable[[int], None]) -> Task:
    before = dict(robot.leds)
    try:
        for tick in range(round(seconds / TICK_S)):
            turn, rest = divmod(tick, round(CHANGE_S / TICK_S))
            if rest == 0:
                change(turn)
            yield
    finally:
        for eye in EYES:
            leds.shine(robot.leds, eye, before[eye])
            robot.leds |= {lamp: before[lamp] for lamp in leds.LAMPS[eye] if lamp in before}
    return ""
