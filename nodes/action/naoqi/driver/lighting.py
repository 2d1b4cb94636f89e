"""What a real robot does with its lights; NAOqi cannot tell how they shine, so we remember it."""

from __future__ import annotations

from nodes.action.naobody import actions as a
from nodes.action.naobody import leds
from nodes.action.naobody import sense_actions as s
from nodes.action.naobody.running import Task
from nodes.action.naoqi.driver.real import RealRobot

ONE_COLOUR = frozenset({"LeftEarLeds", "RightEarLeds", "BrainLeds"})
"""Lights that can only be brighter or darker: blue."""
SLACK_S = 3.0


def light(robot: RealRobot, action: a.Leds) -> Task:
    """Fade a group of lights to a colour."""
    colour = leds.colour_number(action.colour)
    seconds = float(action.seconds)
    yield from robot.call(
        "ALLeds", "fadeRGB", action.group, colour, seconds, limit_s=seconds + SLACK_S
    )
    for name in leds.lights(action.group):
        robot.known.leds[name] = colour
    return ""


def set_intensity(robot: RealRobot, action: s.Intensity) -> Task:
    """Make lights brighter or darker, with the hue that they have."""
    for name in leds.lights(action.group):
        before = robot.known.leds[name] or leds.AT_START[name] or leds.WHITE
        colour = leds.mixed(leds.OFF, leds.brightest(before), action.percent / 100.0)
        if name in ONE_COLOUR:
            yield from robot.call("ALLeds", "setIntensity", name, action.percent / 100.0)
        else:
            yield from robot.call("ALLeds", "fadeRGB", name, colour, 0.0)
        robot.known.leds[name] = colour
    return ""


def reset(robot: RealRobot, action: s.ResetLeds) -> Task:
    """Light a group as it was when the robot started."""
    yield from robot.call("ALLeds", "reset", action.group)
    for name in leds.lights(action.group):
        robot.known.leds[name] = leds.AT_START[name]
    return ""


def play_of_colours(robot: RealRobot, action: s.RandomEyes | s.RotateEyes) -> Task:
    """Let the eyes change colours for some seconds, then be as they were."""
    method = "randomEyes" if isinstance(action, s.RandomEyes) else "rasta"
    eyes = leds.lights("FaceLeds")
    before = {name: robot.known.leds[name] for name in eyes}
    seconds = float(action.seconds)
    try:
        yield from robot.call("ALLeds", method, seconds, limit_s=seconds + SLACK_S)
    finally:
        for name, colour in before.items():
            robot.calls.tell("ALLeds", "fadeRGB", name, colour, 0.1)
    return ""
