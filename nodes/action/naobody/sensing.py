"""What a virtual robot is told to feel, see and hear, and what that says about the person."""

from __future__ import annotations

from nep_core.messages import SenseRequest
from nep_core.words import plain, state_of_thing, state_of_word
from nodes.action.naobody.faces import TOLD
from nodes.action.naobody.gaze import to_world
from nodes.action.naobody.handling import push, put
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.surroundings import distance_word
from nodes.action.naobody.touch import TOUCH_SENSORS

THINGS = ("face", "ball", "sound", "mark")
HANDLED = {"push": push, "place": put}


def sense(robot: VirtualRobot, request: SenseRequest) -> list[str]:
    """Take in what the robot is told to sense; return the human states that follow from it."""
    if request.sense == "word":
        return [state_of_word(request.name)] if plain(request.name) else []
    if request.sense in THINGS:
        return _see(robot, request)
    if request.sense == "usual":
        robot.felt.clear()
        return []
    if request.sense in HANDLED:
        HANDLED[request.sense](robot, request.place)
        return []
    was_touched = robot.felt.get(request.sense, 0.0) > 0.0
    robot.felt[request.sense] = request.value
    if request.sense in TOUCH_SENSORS and request.value > 0.0 and not was_touched:
        return _touched(request.sense)
    return []


def _see(robot: VirtualRobot, request: SenseRequest) -> list[str]:
    name = plain(request.name)
    if request.sense == "face":
        name = robot.faces.name_of(TOLD + name, name)
    things = [request.sense, *([f"{request.sense}_{name}"] if name else [])]
    new = [thing for thing in things if thing not in robot.sees]
    if request.value <= 0.0:
        for thing in things:
            robot.sees.pop(thing, None)
        return []
    place = to_world(robot, request.place)
    robot.sees |= dict.fromkeys(things, place)
    states = [state_of_thing(thing) for thing in reversed(new)]
    if request.sense == "face":
        states.append(f"person_{distance_word(request.place)}")
    return states


def _touched(sensor: str) -> list[str]:
    """The sensor by itself, then the part of the body that it is on."""
    part = sensor.partition("_")[0]
    return [f"touched_{sensor}", f"touched_{part}"]
