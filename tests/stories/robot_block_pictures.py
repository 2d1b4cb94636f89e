"""Looks into the files of a robot on the screen: whether its pictures show the ball before it."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from PySide6.QtGui import QImage

from nep_core.places import robot_folder
from nep_core.wire.messages import RobotState, Thing
from tests.stories.robot_block_seen import Seen

BALL = Thing(id="ball", kind="ball", place=(0.7, 0.0, 0.3), size=(0.12, 0.12, 0.12))
"""Where it is before the robot that looks."""
SIZE = (320, 240)
FEWEST_RED = 200


def before(robot: RobotState, thing: Thing) -> Thing:
    """A thing that is told as the robot sees it, where it is in the room."""
    x, y, theta = robot.base
    ahead, left, up = thing.place
    cosine, sine = math.cos(theta), math.sin(theta)
    place = (x + ahead * cosine - left * sine, y + ahead * sine + left * cosine, up)
    return Thing(id=thing.id, kind=thing.kind, place=place, size=thing.size)


def shows_the_ball(folder: str, name: str) -> Callable[[Seen], bool]:
    """Whether the robot has a picture, or a video, of the right size with something red in it."""

    def holds(seen: Seen) -> bool:
        path = robot_folder(seen.before.robot) / folder / f"{name}.png"
        return path.is_file() and _is_of_the_ball(path)

    return holds


def _is_of_the_ball(path: Path) -> bool:
    image = QImage(str(path))
    colours = [image.pixelColor(x, y) for x in range(image.width()) for y in range(image.height())]
    red = [c for c in colours if c.red() > 100 and 2 * max(c.green(), c.blue()) < c.red()]
    return image.size().toTuple() == SIZE and len(red) > FEWEST_RED
