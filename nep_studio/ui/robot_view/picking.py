"""What is under the pointer: a robot's part, a thing, or the floor."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF

from .bodies import Bodies
from .camera import Place
from .parts import Part
from .scene import Scene

NEAR_PX = 9.0
"""A sensor is found from so near: fingers and small pads are hard to hit."""


@dataclass(frozen=True)
class Found:
    """What is at a pixel; empty where there is only the floor."""

    robot: str = ""
    part: Part | None = None
    thing: str = ""
    place: Place = (0.0, 0.0, 0.0)
    """The middle of the part, or of the thing, in the room."""

    @property
    def sensor(self) -> str:
        """The sensor that is touched there; "" none."""
        return self.part.sensor if self.part is not None else ""


def find_at(bodies: Bodies | None, scene: Scene, at: QPointF) -> Found:
    """What is seen at a pixel; a sensor also where it is missed by very little."""
    if bodies is None:
        return Found()
    for x, y in _around(at):
        number = bodies.part_at(x, y)
        found = Found() if number is None else _found(bodies, scene, number)
        if found.sensor or ((x, y) == (at.x(), at.y()) and found != Found()):
            return found
    return Found()


def _around(at: QPointF) -> list[tuple[float, float]]:
    x, y, near = at.x(), at.y(), NEAR_PX / 2
    return [(x, y), (x - near, y), (x + near, y), (x, y - near), (x, y + near)]


def _found(bodies: Bodies, scene: Scene, number: int) -> Found:
    group = int(bodies.whose[number])
    middle = bodies.placed.middles()[number]
    place = (float(middle[0]), float(middle[1]), float(middle[2]))
    if group < len(scene.robots):
        return Found(scene.robots[group].name, bodies.placed.parts[number], place=place)
    return Found(thing=scene.things[group - len(scene.robots)].id, place=place)


def place_of_sensor(bodies: Bodies | None, scene: Scene, robot: str, sensor: str) -> QPointF | None:
    """A pixel where a sensor is seen, else the middle of it; None where there is no such sensor."""
    if bodies is None:
        return None
    names = [one.name for one in scene.robots]
    group = names.index(robot) if robot in names else -1
    parts = bodies.placed.parts
    mine = np.flatnonzero(bodies.whose == group).tolist()
    numbers = [number for number in mine if parts[number].sensor == sensor]
    for number in numbers:
        middle = bodies.seen.centres[number]
        for share in (0.0, 0.35, 0.7):
            for x, y in (middle + share * (bodies.seen.outlines[number][::4] - middle)).tolist():
                found = bodies.part_at(x, y)
                if found is not None and found in numbers:
                    return QPointF(x, y)
    return QPointF(*bodies.seen.centres[numbers[0]].tolist()) if numbers else None
