"""What a virtual robot does to learn and to forget the face of somebody it sees."""

from __future__ import annotations

import math

from nep_core.errors import ActionFailed
from nep_core.words import plain
from nodes.action.naobody.pose import VirtualRobot
from nodes.action.naobody.running import Task
from nodes.action.naobody.surroundings import seen_things

FACE = "face_"
LOOKING_TICKS = 20
"""After these the robot has looked around again: the name is noticed when the block ends."""


def learn_face(robot: VirtualRobot, name: str) -> Task:
    """Give the nearest face that the robot sees a name, by which it is noticed from then on."""
    yield
    if not plain(name):
        raise ActionFailed("The name of a face needs a letter or a number, as in Anna.")
    if told := _told_face(robot):
        place = robot.sees[told] if told == "face" else robot.sees.pop(told)
        robot.sees[FACE + plain(name)] = place
        robot.faces.learn(robot.faces.told_as(told.removeprefix("face").strip("_")), name)
        return ""
    people = [thing for thing in seen_things(robot) if thing.kind == "person"]
    if not people:
        raise ActionFailed(
            f"{robot.name} sees nobody whose face it could learn. Show it a face, or place a "
            "person in front of it who looks at it."
        )
    robot.noticed.pop(FACE + robot.faces.name_of(people[0].id, people[0].name), None)
    robot.faces.learn(people[0].id, name)
    for _ in range(LOOKING_TICKS):
        yield
    return ""


def forget_face(robot: VirtualRobot, name: str) -> Task:
    """Notice a name no more, also that of a person who was placed under it."""
    yield
    placed = {plain(thing.name) for thing in robot.things if thing.kind == "person"}
    told = {key.removeprefix(FACE) for key in robot.sees if key.startswith(FACE)}
    if not robot.faces.forget(name, placed | told):
        raise ActionFailed(f'{robot.name} has learnt no face called "{name}".')
    _notice_no_more(robot, name)
    return ""


def forget_all_faces(robot: VirtualRobot) -> None:
    """Forget all names that were learnt; people who were placed under a name keep it."""
    for name in list(robot.faces.learnt.values()):
        robot.faces.unlearn(name)
        _notice_no_more(robot, name)


def _notice_no_more(robot: VirtualRobot, name: str) -> None:
    robot.sees.pop(FACE + plain(name), None)
    robot.noticed.pop(FACE + plain(name), None)


def _told_face(robot: VirtualRobot) -> str:
    """The nearest face that the robot was told to see, "face_anna" or "face"; "" for none."""
    named = [key for key in robot.sees if key.startswith(FACE)]
    if not named:
        return "face" if "face" in robot.sees else ""
    return min(named, key=lambda key: math.dist(robot.sees[key][:2], robot.base[:2]))
